//! `x'' + 2 zeta x' + x = 0` from x = 1 at rest, over ten periods of the undamped motion, for zeta = 0, 0.1 and 1.5.
//!
//! ```text
//! v = -e^(-zeta t) sin(q t)/q,
//! zeta < 1:  x = e^(-zeta t) (cos q t + (zeta/q) sin q t),   q = sqrt(1 - zeta^2);     zeta > 1: cosh, sinh, q = sqrt(zeta^2 - 1)
//! ```

use crate::conformance::exchange::Setup;
use crate::conformance::experiment::{Experiment, SAMPLES_PER_PERIOD, finish_ladder, hook_cases};
use crate::conformance::fit::fit_modes;
use crate::conformance::modal_rows::{ModeAt, finish_modes};
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
        free_decay(&subject(self, case), case, bench, &experiment(ID, ratio)?, ratio)
    }

    fn setups(&self) -> Result<Vec<Setup>, ConformanceError> {
        let name = |ratio: f64| {
            format!(
                "linear_oscillator_{}",
                if ratio == 0.0 {
                    "0"
                } else if ratio < 1.0 {
                    "0.1"
                } else {
                    "1.5"
                }
            )
        };
        RATIOS.iter().map(|(_, ratio)| setup(ID, &name(*ratio), *ratio)).collect()
    }
}

/// Displacement and velocity of `x'' + 2 zeta w x' + w^2 x = 0` from (1, 0), at a time.
pub(super) fn exact(ratio: f64, w: f64, t: f64) -> (f64, f64) {
    let t = w * t;
    let decay = (-ratio * t).exp();
    let q = (1.0 - ratio * ratio).abs().sqrt();
    let (cosine, sine) = if ratio < 1.0 { ((q * t).cos(), (q * t).sin()) } else { ((q * t).cosh(), (q * t).sinh()) };
    (decay * (cosine + ratio / q * sine), -w * decay * sine / q)
}

fn state(ratio: f64, t: f64) -> State {
    let (x, v) = exact(ratio, 1.0, t);
    State { positions: vec![x], velocities: vec![v], slider_forces: vec![] }
}

/// The motion of a decay, or of growth for negative ratios.
pub(super) fn experiment(scenario: &'static str, ratio: f64) -> Result<Experiment, ConformanceError> {
    let chain = ChainBuilder::new(vec![1.0]).ground_spring(0, 1.0).ground_damper(0, 2.0 * ratio).build()?;
    Ok(Experiment {
        scenario,
        chain,
        start: state(ratio, 0.0),
        period: TAU,
        periods: PERIODS,
        samples: SAMPLES_PER_PERIOD,
    })
}

/// Set-up and reference for other engines.
pub(super) fn setup(scenario: &'static str, name: &str, ratio: f64) -> Result<Setup, ConformanceError> {
    let experiment = experiment(scenario, ratio)?;
    Setup::of(&experiment, name, move |t| Ok(state(ratio, t)))
}

/// Rows about a decay or growth over the ladder.
pub(super) fn free_decay(
    subject: &Subject,
    case: &Case,
    bench: &dyn Bench,
    experiment: &Experiment,
    ratio: f64,
) -> Result<Vec<Row>, ConformanceError> {
    let configuration = case.configuration;
    let growth = (-ratio * experiment.duration()).exp().max(1.0);
    let truth = LinearMode { angular_frequency: (1.0 - ratio * ratio).max(0.0).sqrt(), damping: 2.0 * ratio };
    let oscillates = ratio < 1.0;
    let (mut states, mut ladders) = (Ladder::new(growth), [Ladder::new(1.0), Ladder::new(1.0)]);
    let mut rows = Vec::new();
    for &steps in &case.steps {
        let at = subject.at(steps, TAU);
        let step = TAU / f64::from(steps);
        let measured = experiment.measure(bench, configuration, steps)?;
        let exact: Vec<State> = measured.times().iter().map(|&t| state(ratio, t)).collect();
        let error = measured.state_error(&exact);
        states.push(step, error.found, measured.floor, Some(error.expected));
        rows.push(error.row(&at, &measured, growth));
        if !oscillates {
            continue;
        }
        let predicted = DifferenceEquation::new(&experiment.chain, configuration, step).modes();
        let fitted = fit_modes(&measured.positions(0), measured.interval(), &[truth]);
        let (Some(&predicted), Some(found)) = (predicted.first(), fitted) else {
            rows.push(at.failed("damping", "no oscillation could be fitted to the motion"));
            continue;
        };
        // A rounding error of the state moves the phase, and through it the frequency, over the time in which the motion is seen.
        let seen = 1.0 / (1.0 / experiment.duration() + ratio.abs());
        let rounding = measured.floor / measured.scale / seen;
        let mode = ModeAt { subject: &at, prefix: "", found: found[0], predicted, truth, rounding };
        rows.extend(mode.rows());
        if ratio == 0.0 {
            rows.push(mode.formula_row(step));
        }
        mode.climb(&mut ladders, step);
    }
    finish_ladder(&mut rows, subject, "state_error", &states, ORDER_TOLERANCE);
    if oscillates {
        finish_modes(&mut rows, subject, "", [&ladders[0], &ladders[1]], ratio != 0.0);
    }
    Ok(rows)
}
