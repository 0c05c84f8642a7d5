//! The rig with its slider stuck for good: two coupled oscillators with an excited in-phase mode and a damped out-of-phase mode.
//!
//! ```text
//! x1 = (p + q)/2,  x2 = (p - q)/2,   p'' + xi1 p' + p = 0,   q'' + xi2 q' + (1 + 2 kappa) q = 0
//! ```

use super::linear_oscillator::exact;
use crate::conformance::exchange::Setup;
use crate::conformance::experiment::{Experiment, SAMPLES_PER_PERIOD, finish_ladder, hook_cases};
use crate::conformance::fit::fit_modes;
use crate::conformance::modal_rows::{ModeAt, finish_modes};
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::theory::DifferenceEquation;
use crate::conformance::{ConformanceError, Ladder, ORDER_TOLERANCE, Row};
use crate::dynamics::State;
use crate::model::{ChainBuilder, LinearMode};
use std::f64::consts::TAU;

/// Two coupled oscillators without friction.
#[derive(Debug, Clone, Copy)]
pub struct CoupledOscillators;

const ID: &str = "coupled_oscillators";
const XI1: f64 = -0.06;
const XI2: f64 = 0.011;
const KAPPA: f64 = 0.1;
/// One and a half beats of the two modes, so that they can be told apart.
const PERIODS: u32 = 16;

impl Scenario for CoupledOscillators {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Two coupled oscillators"
    }

    fn description(&self) -> &'static str {
        "The rig without slip: in-phase mode with ξ₁ = -0.06, ω = 1, out-of-phase mode with ξ₂ = 0.011, ω² = 1.2, from x1 = 1 at rest, \
         16 periods. Measured: state error, frequency and damping of both modes."
    }

    fn reference(&self) -> &'static str {
        "closed form in modal coordinates"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        hook_cases(ID, "", depth)
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let experiment = experiment()?;
        let subject = subject(self, case);
        let scale = (-0.5 * XI1 * experiment.duration()).exp();
        let mut rows = Vec::new();
        let mut states = Ladder::new(scale);
        let mut ladders = [(); 4].map(|()| Ladder::new(1.0));
        for &steps in &case.steps {
            let (at, step) = (subject.at(steps, TAU), TAU / f64::from(steps));
            let measured = experiment.measure(bench, case.configuration, steps)?;
            let exact: Vec<State> = measured.times().iter().map(|&t| state(t)).collect();
            let error = measured.state_error(&exact);
            states.push(step, error.found, measured.floor, Some(error.expected));
            rows.push(error.row(&at, &measured, scale));
            let predicted = DifferenceEquation::new(&experiment.chain, case.configuration, step).modes();
            let fitted = fit_modes(&measured.positions(0), measured.interval(), &modes());
            let (Some(found), 2) = (fitted, predicted.len()) else {
                rows.push(at.failed("mode_1_damping", "two oscillations could not be fitted to the motion"));
                continue;
            };
            // Relative to the smaller mode, which starts with half the displacement and fades while the other grows.
            let rounding = measured.floor / 0.5 / experiment.duration();
            for (k, truth) in modes().into_iter().enumerate() {
                let prefix = PREFIXES[k];
                let mode = ModeAt { subject: &at, prefix, found: found[k], predicted: predicted[k], truth, rounding };
                rows.extend(mode.rows());
                mode.climb(&mut ladders[2 * k..], step);
            }
        }
        finish_ladder(&mut rows, &subject, "state_error", &states, ORDER_TOLERANCE);
        finish_modes(&mut rows, &subject, PREFIXES[0], [&ladders[0], &ladders[1]], true);
        finish_modes(&mut rows, &subject, PREFIXES[1], [&ladders[2], &ladders[3]], true);
        Ok(rows)
    }

    fn setups(&self) -> Result<Vec<Setup>, ConformanceError> {
        Ok(vec![Setup::of(&experiment()?, ID, |t| Ok(state(t)))?])
    }
}

const PREFIXES: [&str; 2] = ["mode_1_", "mode_2_"];

fn frequency2() -> f64 {
    (1.0 + 2.0 * KAPPA).sqrt()
}

fn modes() -> [LinearMode; 2] {
    let damped = |w: f64, d: f64| LinearMode { angular_frequency: (w * w - 0.25 * d * d).sqrt(), damping: d };
    [damped(1.0, XI1), damped(frequency2(), XI2)]
}

fn state(t: f64) -> State {
    let (p, p_rate) = exact(0.5 * XI1, 1.0, t);
    let (q, q_rate) = exact(0.5 * XI2 / frequency2(), frequency2(), t);
    State {
        positions: vec![0.5 * (p + q), 0.5 * (p - q)],
        velocities: vec![0.5 * (p_rate + q_rate), 0.5 * (p_rate - q_rate)],
        slider_forces: vec![],
    }
}

fn experiment() -> Result<Experiment, ConformanceError> {
    let chain = ChainBuilder::new(vec![1.0, 1.0])
        .ground_spring(0, 1.0)
        .ground_spring(1, 1.0)
        .coupling_spring(0, 1, KAPPA)
        .self_excited(0, XI1)
        .self_excited(1, XI1)
        .coupling_damper(0, 1, 0.5 * (XI2 - XI1))
        .build()?;
    Ok(Experiment {
        scenario: ID,
        chain,
        start: state(0.0),
        period: TAU,
        periods: PERIODS,
        samples: SAMPLES_PER_PERIOD,
    })
}
