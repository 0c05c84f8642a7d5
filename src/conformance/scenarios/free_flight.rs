//! A carriage alone on its rail, from x = 0 at speed 1, pushed by a constant force a = 0 or 0.1: `x = t + a t^2/2`.
//!
//! Positions run ahead by `a h t/(2 n)` if the engine's velocities are taken at face value: it moves a body with the velocity at the end of
//! each substep. With the velocities half a substep early the parabola is met exactly, for any number of substeps.

use crate::conformance::experiment::{RIGHT, hook_cases};
use crate::conformance::ladder::rounding_floor;
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{Basis, ConformanceError, Judgement, Row};
use crate::dynamics::{Flow, Sampling, State};
use crate::engine::{ForceLaw, Known, Scheme, trajectory_hash};
use crate::model::ChainBuilder;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Free flight and constant force.
#[derive(Debug, Clone, Copy)]
pub struct FreeFlight;

const ID: &str = "free_flight";
const PUSHES: [(&str, f64); 2] = [("no force", 0.0), ("constant force 0.1", 0.1)];
/// Two periods of the oscillators elsewhere.
const DURATION: f64 = 2.0 * TAU;
/// The engine rounds position and velocity at each step, always in the same sense if the increments are the same: one rounding per step
/// then adds up in proportion, and this many of them are allowed for.
const ROUNDINGS: f64 = 4.0;

#[derive(Debug)]
struct ConstantForce(f64);

impl ForceLaw for ConstantForce {
    fn add_force(&self, _known: &Known<'_>, force: &mut [f64]) {
        force[0] += self.0;
    }
}

impl Scenario for FreeFlight {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Free flight and constant force"
    }

    fn description(&self) -> &'static str {
        "x'' = a from x = 0 at speed 1, a = 0 and 0.1, over 4π. Measured: largest error of position and velocity."
    }

    fn reference(&self) -> &'static str {
        "closed form: x = t + a t²/2"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        PUSHES.iter().flat_map(|(variant, _)| hook_cases(ID, variant, depth)).collect()
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let push = PUSHES.iter().find(|(variant, _)| *variant == case.variant).map_or(0.0, |(_, push)| *push);
        case.steps.iter().map(|&steps| self.row(case, bench, push, steps)).collect()
    }
}

impl FreeFlight {
    fn row(&self, case: &Case, bench: &dyn Bench, push: f64, steps: u32) -> Result<Row, ConformanceError> {
        let step = TAU / f64::from(steps);
        let chain = ChainBuilder::new(vec![1.0]).build()?;
        let start = State { positions: vec![0.0], velocities: vec![1.0], slider_forces: vec![] };
        let flow = bench.free(&chain, case.configuration, step)?.with_laws(vec![Arc::new(ConstantForce(push))])?;
        let stride = f64::from((steps / 32).max(1));
        let sampling = Sampling { interval: step * stride, t_end: (DURATION / step / stride).floor() * stride * step };
        let motion = flow.trajectory(&start, sampling)?;
        let errors = motion.samples.iter().map(|sample| {
            let t = sample.time;
            let (x, v) = (sample.state.positions[0], sample.state.velocities[0]);
            (x - t - 0.5 * push * t * t).abs().max((v - 1.0 - push * t).abs())
        });
        let found = errors.fold(0.0, f64::max);
        let t = sampling.t_end;
        let formula = match case.configuration.scheme {
            Scheme::Plain => push * step * t / (2.0 * case.configuration.substeps as f64),
            Scheme::SecondOrder | Scheme::AveragedFriction | Scheme::LaggingDamping => 0.0,
        };
        let scale = t + 0.5 * push * t * t;
        let random = rounding_floor(case.configuration, scale, t, step);
        let steady = case.configuration.unit_roundoff() * scale * t / step;
        let judgement = Judgement {
            basis: Basis::Formula,
            expected: formula,
            found,
            tolerance: ROUNDINGS * steady.max(random),
            reason: format!(
                "a h t/(2 n) with velocities at face value, else 0; {ROUNDINGS} steady roundings per step; right: within 1 %"
            ),
        };
        let row = subject(self, case).at(steps, TAU).row("state_error", judgement);
        Ok(row.against(0.0, RIGHT * scale).with_floor(steady.max(random)).with_trajectory(&trajectory_hash(&motion)))
    }
}
