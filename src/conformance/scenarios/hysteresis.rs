//! The hysteresis of the Jenkins element: mass 1 carried as `x = 2 sin t` by a kinematic body, three cycles.
//!
//! ```text
//! loop area 4 (a - 1);   slip begins at sin t = 1/2 on the first loading, later at x = -+(a - 2), ends at the extremes
//! ```
//!
//! Steps per cycle are 4 k + 2, so that extremes fall half-way between steps: the worst case of an incremental friction law.

use crate::conformance::experiment::{RIGHT, finish_ladder, ladder};
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{
    Basis, Configuration, ConformanceError, Judgement, Ladder, ORDER_TOLERANCE, Row, rounding_floor,
};
use crate::dynamics::{EventKind, Flow, Sampling, State, Trajectory};
use crate::engine::{Precision, trajectory_hash};
use crate::model::PrescribedMotion;
use std::f64::consts::{PI, TAU};

/// Hysteresis under prescribed motion.
#[derive(Debug, Clone, Copy)]
pub struct Hysteresis;

const ID: &str = "hysteresis";
const AMPLITUDE: f64 = 2.0;
/// Corners fall anywhere between steps and scatter the errors.
const SCATTER_TOLERANCE: f64 = 2.0 * ORDER_TOLERANCE;
const CYCLES: f64 = 3.0;

impl Scenario for Hysteresis {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Hysteresis under prescribed motion"
    }

    fn description(&self) -> &'static str {
        "Mass 1 moved as x = 2 sin t by a kinematic body, three cycles. Measured: area of the last loop of f over x, and times of all corners."
    }

    fn reference(&self) -> &'static str {
        "closed form: area 4 (a - 1), corners at arcsin(1/2), π/2, and where x = ∓(a - 2)"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        // Joints, substeps and scheme have no influence: nothing is free to move.
        let precisions = [Precision::Double, Precision::Single];
        let of = |precision| Case {
            scenario: ID.to_owned(),
            variant: String::new(),
            configuration: Configuration { precision, ..Configuration::SAMPLED_FRICTION },
            steps: ladder(depth).into_iter().map(|steps| steps / 4 * 4 + 2).collect(),
            depth: Depth::Quick,
        };
        precisions.into_iter().map(of).collect()
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let subject = subject(self, case);
        let chain = super::rig_motion::rig(-0.06)?.chain().clone();
        let motion = PrescribedMotion { amplitude: AMPLITUDE, angular_frequency: 1.0 };
        let start = State::two_mass([0.0, 0.0, AMPLITUDE, 0.0, 0.0]);
        let area = 4.0 * (AMPLITUDE - 1.0);
        let (mut areas, mut corners) = (Ladder::new(area), Ladder::new(1.0));
        let mut rows = Vec::new();
        for &steps in &case.steps {
            let (at, step) = (subject.at(steps, TAU), TAU / f64::from(steps));
            let flow = bench.prescribed(&chain, motion, case.configuration, step)?;
            let trajectory = flow.trajectory(&start, Sampling { interval: step, t_end: CYCLES * TAU })?;
            let floor = rounding_floor(case.configuration, AMPLITUDE, CYCLES * TAU, step);
            let found = loop_area(&trajectory);
            areas.push(step, (found - area).abs(), floor, None);
            let reason = "each of two extremes is missed by up to a h²/8 and four corners are cut by as much: 6 a h²/8, and rounding; right: 1 %";
            let tolerance = 0.75 * AMPLITUDE * step * step + 16.0 * floor;
            let judgement =
                Judgement { basis: Basis::Exact, expected: area, found, tolerance, reason: reason.to_owned() };
            let row = at.row("loop_area", judgement).against(area, RIGHT * area).with_floor(floor);
            rows.push(row.with_trajectory(&trajectory_hash(&trajectory)));
            let Some(found) = corner_error(&trajectory) else {
                rows.push(at.failed("corner_time", "the corners are not those of the closed form"));
                continue;
            };
            corners.push(step, found, floor, None);
            let reason = "a missed extreme, a h²/8, over the slowest rate at a corner, and h² of the interpolation; right: 1 % of a cycle";
            let tolerance = (AMPLITUDE / 8.0 + 1.0) * step * step + 16.0 * floor;
            let judgement =
                Judgement { basis: Basis::Exact, expected: 0.0, found, tolerance, reason: reason.to_owned() };
            rows.push(at.row("corner_time", judgement).against(0.0, RIGHT * TAU).with_floor(floor));
        }
        finish_ladder(&mut rows, &subject, "loop_area", &areas, SCATTER_TOLERANCE);
        finish_ladder(&mut rows, &subject, "corner_time", &corners, SCATTER_TOLERANCE);
        Ok(rows)
    }
}

/// Area of the last loop of f over x, by the trapezoidal rule.
fn loop_area(trajectory: &Trajectory) -> f64 {
    let last = trajectory.samples.windows(2).filter(|pair| pair[0].time >= (CYCLES - 1.0) * TAU - 1e-9);
    last.map(|pair| {
        let (a, b) = (&pair[0].state, &pair[1].state);
        0.5 * (a.slider_forces[0] + b.slider_forces[0]) * (b.positions[0] - a.positions[0])
    })
    .sum()
}

/// Largest error of a corner; `None` unless there are the right ones.
fn corner_error(trajectory: &Trajectory) -> Option<f64> {
    let corner = ((AMPLITUDE - 2.0) / AMPLITUDE).asin();
    let loading = std::iter::once(((1.0 / AMPLITUDE).asin(), EventKind::StickToSlip));
    let later = (0..).flat_map(|k| {
        let half = f64::from(k) * PI;
        [(half + 0.5 * PI, EventKind::SlipToStick), (half + PI - corner, EventKind::StickToSlip)]
    });
    // The last corner lies at the very end if the amplitude is 2.
    let expected: Vec<_> = loading.chain(later).take_while(|(time, _)| *time < CYCLES * TAU - 0.1).collect();
    let found = &trajectory.events;
    if found.len() < expected.len() {
        return None;
    }
    let pairs = found.iter().zip(expected);
    pairs
        .map(|(event, (time, kind))| (event.kind == kind).then(|| (event.time - time).abs()))
        .try_fold(0.0, |a: f64, e| Some(a.max(e?)))
}
