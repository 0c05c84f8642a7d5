//! The torus at xi1 = -0.06: how far the maxima of x1 range, and how fast they go up and down.

use super::rig_motion::{orbit, rig};
use super::settled::Settled;
use crate::conformance::experiment::{Experiment, RIGHT, bounded_row, friction_cases, is_notable};
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{Basis, ConformanceError, Judgement, Row};
use crate::dynamics::{Flow, Sampling};
use crate::exact::TwoMassFlow;

/// The torus.
#[derive(Debug, Clone, Copy)]
pub struct Torus;

const ID: &str = "torus";
const XI1: f64 = -0.06;
/// Far enough from the unstable limit cycle to be on the torus soon.
const PERTURBATION: f64 = 0.3;
/// Periods before the watched part.
const TRANSIENT: u32 = 250;
/// Periods watched: twelve modulations.
const PERIODS: u32 = 150;
/// Steps per period of configurations that tell less.
const FEW: [u32; 3] = [128, 377, 1024];
const SAMPLES: u32 = 128;
const ROUNDINGS: f64 = 16.0;

impl Scenario for Torus {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Torus"
    }

    fn description(&self) -> &'static str {
        "The two-mass rig at ξ₁ = -0.06 on its limit torus, 150 periods after a transient of 250, which the difference equation goes through before the engine takes over. Measured: largest and smallest maximum of x1, \
         and the angular frequency of their modulation."
    }

    fn reference(&self) -> &'static str {
        "exact solution by contact states (closed form in modal coordinates) from the same start, measured in the same way"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        let mut cases = friction_cases(ID, "", depth);
        for case in &mut cases {
            let (coarsest, finest) = if depth == Depth::Quick { (128, 512) } else { (64, 2048) };
            case.steps.retain(|steps| (coarsest..=finest).contains(steps));
            if !is_notable(case.configuration) {
                case.steps.retain(|steps| FEW.contains(steps));
            }
        }
        cases
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let (orbit, rig) = (orbit(XI1)?, rig(XI1)?);
        let mut start = orbit.reversal();
        start.positions[1] += PERTURBATION;
        let chain = rig.chain().clone();
        let experiment =
            Experiment { scenario: ID, chain, start, period: orbit.period, periods: PERIODS, samples: SAMPLES };
        let from = f64::from(TRANSIENT) * orbit.period;
        let sampling = Sampling { interval: orbit.period / f64::from(SAMPLES), t_end: from + experiment.duration() };
        let exact = Settled::of(ID, &TwoMassFlow::new(&rig).trajectory(&experiment.start, sampling)?, from)?;
        let mut rows = Vec::new();
        for &steps in &case.steps {
            let at = subject(self, case).at(steps, orbit.period);
            let experiment = experiment.clone().settled(case.configuration, steps, TRANSIENT);
            let measured = experiment.measure(bench, case.configuration, steps)?;
            rows.push(bounded_row(&at, &measured.trajectory, &measured.predicted));
            if measured.diverged() {
                continue;
            }
            let found = Settled::of(ID, &measured.trajectory, 0.0)?;
            let predicted = Settled::of(ID, &measured.predicted, 0.0)?;
            let numbers = [
                ("largest_maximum", Some(predicted.largest), Some(found.largest), Some(exact.largest)),
                ("smallest_maximum", Some(predicted.smallest), Some(found.smallest), Some(exact.smallest)),
                ("slow_frequency", predicted.slow_frequency, found.slow_frequency, exact.slow_frequency),
            ];
            for (quantity, expected, found, exact) in numbers {
                let (Some(expected), Some(found), Some(exact)) = (expected, found, exact) else {
                    rows.push(at.failed(quantity, "the maxima are not modulated: there is no torus"));
                    continue;
                };
                let reason = format!("{ROUNDINGS} floors of rounding over the whole motion; right: 1 %");
                let tolerance = ROUNDINGS * measured.floor;
                let judgement = Judgement { basis: Basis::DifferenceEquation, expected, found, tolerance, reason };
                let row = at.row(quantity, judgement).against(exact, RIGHT * exact.abs());
                rows.push(row.with_floor(measured.floor).with_trajectory(&measured.hash));
            }
        }
        Ok(rows)
    }
}
