//! Chaos at xi1 = -0.155: trajectories part, averages can agree.

use super::rig_motion::{orbit, rig};
use super::settled::Settled;
use crate::conformance::experiment::{RIGHT, bounded_row, hook_cases};
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::theory::DifferenceEquation;
use crate::conformance::{Basis, ConformanceError, Judgement, Row};
use crate::dynamics::{Flow, Sampling};
use crate::engine::trajectory_hash;
use crate::exact::TwoMassFlow;

/// Chaos.
#[derive(Debug, Clone, Copy)]
pub struct Chaos;

const ID: &str = "chaos";
const XI1: f64 = -0.155;
const PERTURBATION: f64 = 0.01;
const PERIODS: u32 = 600;
/// The reference is watched longer, so that its own statistical error hardly counts.
const REFERENCE_PERIODS: u32 = 3000;
const TRANSIENT: f64 = 100.0;
const SAMPLES: u32 = 64;
/// Standard errors of a difference: of the some hundred rows of a report one in 16000 lies beyond four by chance.
const DEVIATIONS: f64 = 4.0;

impl Scenario for Chaos {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Chaos"
    }

    fn description(&self) -> &'static str {
        "The two-mass rig at ξ₁ = -0.155, the last 500 of 600 periods. Trajectories part; invariants are compared: whether the motion \
         stays bounded, mean maximum of x1, mean angular frequency."
    }

    fn reference(&self) -> &'static str {
        "exact solution by contact states (closed form in modal coordinates) over 3000 periods"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        let mut cases = hook_cases(ID, "", depth);
        for case in &mut cases {
            case.steps = if depth == Depth::Quick { vec![512] } else { vec![128, 377, 1024] };
        }
        cases
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let (orbit, rig) = (orbit(XI1)?, rig(XI1)?);
        let mut start = orbit.reversal();
        start.positions[1] += PERTURBATION;
        let from = TRANSIENT * orbit.period;
        let sampling = |periods: u32| Sampling {
            interval: orbit.period / f64::from(SAMPLES),
            t_end: orbit.period * f64::from(periods),
        };
        let exact = TwoMassFlow::new(&rig).trajectory(&start, sampling(REFERENCE_PERIODS))?;
        let exact = Settled::of(ID, &exact, from)?;
        let mut rows = Vec::new();
        for &steps in &case.steps {
            let (at, step) = (subject(self, case).at(steps, orbit.period), orbit.period / f64::from(steps));
            let stride = (steps / SAMPLES).max(1);
            let sampling = Sampling { interval: f64::from(stride) * step, t_end: f64::from(PERIODS) * orbit.period };
            let found = bench.free(rig.chain(), case.configuration, step)?.trajectory(&start, sampling)?;
            let predicted =
                DifferenceEquation::new(rig.chain(), case.configuration, step).motion(&start, steps * PERIODS, stride);
            let hash = trajectory_hash(&found);
            rows.push(bounded_row(&at, &found, &predicted));
            if found.diverged() || predicted.diverged() {
                continue;
            }
            let (found, predicted) = (Settled::of(ID, &found, from)?, Settled::of(ID, &predicted, from)?);
            let errors = |motion: &Settled| motion.errors.unwrap_or((f64::NAN, f64::NAN));
            let (of_found, of_predicted, of_exact) = (errors(&found), errors(&predicted), errors(&exact));
            let numbers = [
                ("mean_maximum", predicted.mean, found.mean, exact.mean, [of_found.0, of_predicted.0, of_exact.0]),
                (
                    "angular_frequency",
                    predicted.angular_frequency,
                    found.angular_frequency,
                    exact.angular_frequency,
                    [of_found.1, of_predicted.1, of_exact.1],
                ),
            ];
            for (quantity, expected, found, exact, [a, b, c]) in numbers {
                let reason = format!(
                    "{DEVIATIONS} standard errors of the difference, by means over batches; right: 1 %, or as many standard errors"
                );
                let judgement = Judgement {
                    basis: Basis::DifferenceEquation,
                    expected,
                    found,
                    tolerance: DEVIATIONS * a.hypot(b),
                    reason,
                };
                let limit = (RIGHT * exact).max(DEVIATIONS * a.hypot(c));
                rows.push(at.row(quantity, judgement).against(exact, limit).with_trajectory(&hash));
            }
        }
        Ok(rows)
    }
}
