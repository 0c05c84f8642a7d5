//! How far carriages leave their rail over ten periods beside the limit cycle, with the weight of the carriages on the joints.

use super::rig_motion::beside_the_cycle;
use crate::conformance::experiment::hook_cases;
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{Basis, ConformanceError, Judgement, Row};
use crate::dynamics::Sampling;
use crate::engine::trajectory_hash;

/// Joint drift.
#[derive(Debug, Clone, Copy)]
pub struct JointDrift;

const ID: &str = "joint_drift";
/// Roundings of a unit length that a constraint solver may leave; the largest over all steps is looked at.
const ROUNDINGS: f64 = 64.0;
/// A tilt or offset of this size shortens the motion along the rail by its square: beyond every digit of interest.
const HARMLESS: f64 = 1e-3;

impl Scenario for JointDrift {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Joint drift"
    }

    fn description(&self) -> &'static str {
        "The two-mass rig at ξ₁ = -0.06 beside its limit cycle, ten periods, gravity across the rail. Measured: largest displacement across \
         the rail and largest rotation of a carriage, over all steps."
    }

    fn reference(&self) -> &'static str {
        "the joints' own constraint: zero"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        // The scheme has no influence on what holds the carriages: one is enough.
        let mut cases = hook_cases(ID, "", depth);
        cases.retain(|case| case.configuration.scheme == crate::engine::Scheme::SecondOrder);
        cases
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let (experiment, _) = beside_the_cycle(ID)?;
        let mut rows = Vec::new();
        for &steps in &case.steps {
            let step = experiment.period / f64::from(steps);
            let sampling = Sampling { interval: 0.25 * experiment.period, t_end: experiment.duration() };
            let record =
                bench.free(&experiment.chain, case.configuration, step)?.record(&experiment.start, sampling)?;
            let hash = trajectory_hash(&record.trajectory);
            let at = subject(self, case).at(steps, experiment.period);
            let tolerance = ROUNDINGS * case.configuration.unit_roundoff();
            for (quantity, found) in
                [("lateral_drift", record.drift.lateral), ("rotation_drift", record.drift.rotation)]
            {
                let reason = format!(
                    "{ROUNDINGS} roundings of a unit length or angle; right: below 1e-3, whose square is beyond every digit"
                );
                let judgement = Judgement { basis: Basis::Exact, expected: 0.0, found, tolerance, reason };
                rows.push(
                    at.row(quantity, judgement).against(0.0, HARMLESS).with_floor(tolerance).with_trajectory(&hash),
                );
            }
        }
        Ok(rows)
    }
}
