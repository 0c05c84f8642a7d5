//! How far carriages leave their rail over ten periods beside the limit cycle, with the weight of the carriages on the joints.
//!
//! Rapier's impulse joints are stiff springs of the natural frequency f = 1e6 (`joint_natural_frequency`), critically damped, so that a
//! carriage sags under gravity g by `g/(2 pi f)^2`; a multibody has no coordinate in which it could.

use super::rig_motion::beside_the_cycle;
use crate::conformance::experiment::hook_cases;
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{Basis, ConformanceError, Judgement, Row};
use crate::dynamics::Sampling;
use crate::engine::{Joints, trajectory_hash};
use std::f64::consts::TAU;

/// Joint drift.
#[derive(Debug, Clone, Copy)]
pub struct JointDrift;

const ID: &str = "joint_drift";
/// Roundings of a unit length that a constraint solver may leave; the largest over all steps is looked at.
const ROUNDINGS: f64 = 64.0;
/// Of the rig's world, in its units.
const GRAVITY: f64 = 9.81;
/// Rapier's default.
const JOINT_FREQUENCY: f64 = 1e6;
/// Of the sag: transients of the first steps, and the solver's own rounding.
const SAG_TOLERANCE: f64 = 0.02;
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
        "the joints' own constraint: zero; predicted: the sag of a spring under the carriage's weight"
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
            let floor = ROUNDINGS * case.configuration.unit_roundoff();
            let sag = match case.configuration.joints {
                Joints::Impulse => GRAVITY / (TAU * JOINT_FREQUENCY).powi(2),
                Joints::Multibody => 0.0,
            };
            let drifts = [("lateral_drift", record.drift.lateral, sag), ("rotation_drift", record.drift.rotation, 0.0)];
            for (quantity, found, expected) in drifts {
                let tolerance = SAG_TOLERANCE * expected + floor;
                let reason = format!(
                    "sag g/(2π f)² of impulse joints, f = 10⁶; 2 % of it and {ROUNDINGS} roundings of a unit length or angle; right: below \
                     1e-3, whose square is beyond every digit"
                );
                let judgement = Judgement { basis: Basis::Formula, expected, found, tolerance, reason };
                let row = at.row(quantity, judgement).against(0.0, HARMLESS);
                let row = row.with_floor(floor).with_trajectory(&hash);
                // Whether there is a sag cannot be seen below the floor; that it is harmless can.
                let hidden = expected > 0.0 && floor > expected;
                let physics = row.physics;
                rows.push(if hidden {
                    Row {
                        physics,
                        ..row.unresolved(&format!("the sag of {expected:.1e} lies below the floor of {floor:.1e}"))
                    }
                } else {
                    row
                });
            }
        }
        Ok(rows)
    }
}
