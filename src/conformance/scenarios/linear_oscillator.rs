//! `x'' + 2 zeta x' + x = 0` from x = 1 at rest, over ten periods of the undamped motion, for zeta = 0, 0.1 and 1.5.
//!
//! ```text
//! zeta < 1:  x = e^(-zeta t) (cos q t + (zeta/q) sin q t),   q = sqrt(1 - zeta^2);     zeta > 1: cosh, sinh, q = sqrt(zeta^2 - 1)
//! ```

use crate::conformance::experiment::{Experiment, finish_ladder, hook_cases};
use crate::conformance::fit::fit_modes;
use crate::conformance::modal_rows::{ModeAt, expected_orders};
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::theory::DifferenceEquation;
use crate::conformance::{ConformanceError, Ladder, ORDER_TOLERANCE, Row, Subject};
use crate::dynamics::State;
use crate::model::{ChainBuilder, LinearMode};
use std::f64::consts::TAU;

/// Free decay of a linear oscillator.
#[derive(Debug, Clone, Copy)]
pub struct LinearOscillator;

const ID: &str = "linear_oscillator";
const RATIOS: [(&str, f64); 3] = [("damping ratio 0", 0.0), ("damping ratio 0.1", 0.1), ("damping ratio 1.5", 1.5)];
const PERIODS: u32 = 10;

impl Scenario for LinearOscillator {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Linear oscillator"
    }

    fn description(&self) -> &'static str {
        "x'' + 2 ζ x' + x = 0 from x = 1 at rest, ten periods, ζ = 0, 0.1, 1.5. Measured: state error, frequency, damping."
    }

    fn reference(&self) -> &'static str {
        "closed form: exponentials, cosines, hyperbolic functions"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        RATIOS.iter().flat_map(|(variant, _)| hook_cases(ID, variant, depth)).collect()
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let ratio = RATIOS.iter().find(|(variant, _)| *variant == case.variant).map_or(0.0, |(_, ratio)| *ratio);
        free_decay(&subject(self, case), case, bench, ratio)
    }
}

/// The exact state at a time.
pub(super) fn exact(ratio: f64, t: f64) -> State {
    let decay = (-ratio * t).exp();
    let q = (1.0 - ratio * ratio).abs().sqrt();
    let (cosine, sine) = if ratio < 1.0 { ((q * t).cos(), (q * t).sin()) } else { ((q * t).cosh(), (q * t).sinh()) };
    // v = x' with x'' = -2 zeta x' - x: in both cases -(1/q) e^(-zeta t) sine.
    State {
        positions: vec![decay * (cosine + ratio / q * sine)],
        velocities: vec![-decay * sine / q],
        slider_forces: vec![],
    }
}

/// Rows about a decay, or growth for negative ratios, over the ladder.
pub(super) fn free_decay(
    subject: &Subject,
    case: &Case,
    bench: &dyn Bench,
    ratio: f64,
) -> Result<Vec<Row>, ConformanceError> {
    let chain = ChainBuilder::new(vec![1.0]).ground_spring(0, 1.0).ground_damper(0, 2.0 * ratio).build()?;
    let experiment = Experiment { scenario: ID, chain, start: exact(ratio, 0.0), period: TAU, periods: PERIODS };
    let configuration = case.configuration;
    let growth = (-ratio * experiment.duration()).exp().max(1.0);
    let truth = LinearMode { angular_frequency: (1.0 - ratio * ratio).max(0.0).sqrt(), damping: 2.0 * ratio };
    let empty = |scale| Ladder { scale, points: Vec::new() };
    let (mut states, mut frequencies, mut dampings) = (empty(growth), empty(1.0), empty(1.0));
    let mut rows = Vec::new();
    for &steps in &case.steps {
        let at = subject.at(steps, TAU);
        let step = TAU / f64::from(steps);
        let measured = experiment.measure(bench, configuration, steps)?;
        let exact: Vec<State> = measured.times().iter().map(|&t| exact(ratio, t)).collect();
        let error = measured.state_error(&exact);
        states.points.push((step, error.found, measured.floor));
        rows.push(error.row(&at, &measured, growth));
        if ratio >= 1.0 {
            continue;
        }
        let x: Vec<f64> = measured.trajectory.samples.iter().map(|sample| sample.state.positions[0]).collect();
        let times = measured.times();
        let predicted = DifferenceEquation::new(&experiment.chain, configuration, step).modes();
        let (Some(predicted), Some(found)) = (predicted.first(), fit_modes(&x, times[1], &[truth])) else {
            rows.push(at.failed("damping", "no oscillation could be fitted to the motion"));
            continue;
        };
        // A rounding error of the state moves the phase, and through it the frequency, over the time in which the motion is seen.
        let seen = 1.0 / (1.0 / experiment.duration() + ratio.abs());
        let rounding = measured.floor / measured.scale / seen;
        let mode = ModeAt { subject: &at, prefix: "", found: found[0], predicted: *predicted, truth, rounding };
        rows.extend(mode.rows());
        if ratio == 0.0 {
            rows.push(mode.formula_row(step));
        }
        frequencies.points.push((step, (found[0].angular_frequency - truth.angular_frequency).abs(), rounding));
        dampings.points.push((step, (found[0].damping - truth.damping).abs(), rounding));
    }
    finish_ladder(&mut rows, subject, "state_error", &states, configuration.expected_order(), ORDER_TOLERANCE);
    if ratio < 1.0 {
        let ladders = [("angular_frequency", frequencies), ("damping", dampings)];
        for ((quantity, ladder), order) in ladders.iter().zip(expected_orders(configuration, ratio != 0.0)) {
            if let Some(order) = order {
                finish_ladder(&mut rows, subject, quantity, ladder, order, ORDER_TOLERANCE);
            }
        }
    }
    Ok(rows)
}
