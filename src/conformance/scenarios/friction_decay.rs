//! Free decay by friction alone: `x'' + 0.9 x + 0.1 f = 0` with a Jenkins element of stiffness and slip force 0.1, from x = 3 at rest, f = 1.

use super::near_motion::{Quantities, rows};
use crate::conformance::exchange::Setup;
use crate::conformance::experiment::{Experiment, SAMPLES_PER_PERIOD, friction_cases};
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{ConformanceError, Row};
use crate::dynamics::State;
use crate::exact::ChainFlow;
use crate::model::{Attachment, ChainBuilder, JenkinsElement};
use std::f64::consts::TAU;

/// Free decay with the Jenkins element.
#[derive(Debug, Clone, Copy)]
pub struct FrictionDecay;

const ID: &str = "friction_decay";
/// Friction takes 0.4 (a - 1) of the energy a^2/2 per period: after five periods the element still slips.
const PERIODS: u32 = 5;

impl Scenario for FrictionDecay {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Free decay with the Jenkins element"
    }

    fn description(&self) -> &'static str {
        "x'' + 0.9 x + 0.1 f[x] = 0 from x = 3 at rest with f = 1, five periods: decay by dry friction alone. Measured: state error, times of \
         stick and slip."
    }

    fn reference(&self) -> &'static str {
        "exact solution by contact states (matrix exponential, certified event location)"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        friction_cases(ID, "", depth)
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let experiment = experiment()?;
        let motion = ChainFlow::new(&experiment.chain).solve(&experiment.start, experiment.duration())?;
        rows(&subject(self, case), case, bench, &experiment, &motion, Quantities::StateAndSwitching)
    }

    fn setups(&self) -> Result<Vec<Setup>, ConformanceError> {
        let experiment = experiment()?;
        let motion = ChainFlow::new(&experiment.chain).solve(&experiment.start, experiment.duration())?;
        Ok(vec![Setup::of(&experiment, ID, |t| Ok(motion.state_at(t.min(motion.end()))?.state))?])
    }
}

fn experiment() -> Result<Experiment, ConformanceError> {
    let element = JenkinsElement { attachment: Attachment::Ground(0), stiffness: 0.1, slip_force: 0.1 };
    let chain = ChainBuilder::new(vec![1.0]).ground_spring(0, 0.9).jenkins(element).build()?;
    let start = State { positions: vec![3.0], velocities: vec![0.0], slider_forces: vec![1.0] };
    Ok(Experiment { scenario: ID, chain, start, period: TAU, periods: PERIODS, samples: SAMPLES_PER_PERIOD })
}
