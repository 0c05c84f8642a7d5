//! `x'' + xi x' + x = 0` with xi = -0.06: growth by negative damping, as the rig's in-phase mode has it.

use super::linear_oscillator::{experiment, free_decay, setup};
use crate::conformance::exchange::Setup;
use crate::conformance::experiment::hook_cases;
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{ConformanceError, Row};

/// Growth of a negatively damped oscillator.
#[derive(Debug, Clone, Copy)]
pub struct NegativeDamping;

const ID: &str = "negative_damping";
/// zeta = xi/2
const RATIO: f64 = -0.03;

impl Scenario for NegativeDamping {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Negative damping"
    }

    fn description(&self) -> &'static str {
        "x'' - 0.06 x' + x = 0 from x = 1 at rest, ten periods. Measured: state error, frequency, growth (as negative damping)."
    }

    fn reference(&self) -> &'static str {
        "closed form: exponential and cosine"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        hook_cases(ID, "", depth)
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        free_decay(&subject(self, case), case, bench, &experiment(ID, RATIO)?, RATIO)
    }

    fn setups(&self) -> Result<Vec<Setup>, ConformanceError> {
        Ok(vec![setup(ID, "negative_damping", RATIO)?])
    }
}
