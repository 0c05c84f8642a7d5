//! Rows about a motion with friction over a few periods, beside its exact solution: state, switching times, energy.

use crate::conformance::experiment::{Experiment, Measured, RIGHT, finish_ladder};
use crate::conformance::scenario::{Bench, Case};
use crate::conformance::switching::switching_error;
use crate::conformance::{Basis, ConformanceError, Judgement, Ladder, ORDER_TOLERANCE, Row, Subject};
use crate::dynamics::State;
use crate::exact::ExactTrajectory;

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantities {
    StateAndSwitching,
    Energy,
}

/// A single event or residual scatters more than a state error: where a switch falls within a step shows in it.
const SCATTER_TOLERANCE: f64 = 2.0 * ORDER_TOLERANCE;

pub(super) fn rows(
    subject: &Subject,
    case: &Case,
    bench: &dyn Bench,
    experiment: &Experiment,
    motion: &ExactTrajectory,
    quantities: Quantities,
) -> Result<Vec<Row>, ConformanceError> {
    let (mut rows, mut states, mut others) = (Vec::new(), Ladder::new(1.0), Ladder::new(1.0));
    for &steps in &case.steps {
        let (at, step) = (subject.at(steps, experiment.period), experiment.period / f64::from(steps));
        let measured = experiment.measure(bench, case.configuration, steps)?;
        let exact = measured
            .times()
            .iter()
            .map(|&t| Ok(motion.state_at(t.min(motion.end()))?.state))
            .collect::<Result<Vec<State>, ConformanceError>>()?;
        let error = measured.state_error(&exact);
        let scale = exact.iter().flat_map(State::components).fold(0.0, |scale: f64, y| scale.max(y.abs()));
        states.scale = scale;
        states.push(step, error.found, measured.floor, Some(error.expected));
        match quantities {
            Quantities::StateAndSwitching => {
                rows.push(error.row(&at, &measured, scale));
                let found =
                    switching_error(&experiment.chain, motion.events(), &measured.trajectory, error.expected, step);
                let Some((found, largest)) = found else {
                    rows.push(at.failed("switching_time", "the engine's motion has other switches than the exact one"));
                    continue;
                };
                others.push(step, found, measured.floor, None);
                rows.push(switching_row(&at, found, largest + error.tolerance, experiment.period));
            }
            Quantities::Energy => {
                let found = measured.trajectory.energy_residual();
                others.scale = scale * scale;
                let floor = measured.floor * scale;
                others.push(step, found, floor, None);
                let pumped = pumped_energy(experiment, &measured, case.configuration.substeps, step);
                let judged = energy_row(&at, [found, pumped], experiment, step, scale, floor);
                rows.push(judged.with_trajectory(&measured.hash));
            }
        }
    }
    match quantities {
        Quantities::StateAndSwitching => {
            finish_ladder(&mut rows, subject, "state_error", &states, ORDER_TOLERANCE);
            finish_ladder(&mut rows, subject, "switching_time", &others, ORDER_TOLERANCE);
        }
        Quantities::Energy => finish_ladder(&mut rows, subject, "energy_residual", &others, SCATTER_TOLERANCE),
    }
    Ok(rows)
}

fn switching_row(at: &Subject, found: f64, tolerance: f64, period: f64) -> Row {
    let reason = "twice the predicted state error over the rate of the event function, h² of the interpolation, and rounding; right: 1 % of a period";
    let judgement = Judgement { basis: Basis::Exact, expected: 0.0, found, tolerance, reason: reason.to_owned() };
    at.row("switching_time", judgement).against(0.0, RIGHT * period)
}

/// What holding a force over n substeps pumps in, by the numerical damping `-w^2 h e`, `e = 1 - (n + 1)/(2 n)`: its power `w^2 h e v^2` is
/// `h e a^2` on average, a the acceleration. By the trapezoidal rule along the difference equation.
fn pumped_energy(experiment: &Experiment, measured: &Measured, substeps: usize, step: f64) -> f64 {
    let n = substeps as f64;
    let power = |state: &State| {
        let a = experiment.chain.acceleration(&state.positions, &state.velocities, &state.slider_forces);
        let terms = a.iter().zip(experiment.chain.mass().iter()).map(|(a, mass)| mass * a * a);
        step * (1.0 - (n + 1.0) / (2.0 * n)) * terms.sum::<f64>()
    };
    let pairs = measured.predicted.samples.windows(2);
    pairs.map(|pair| 0.5 * (pair[1].time - pair[0].time) * (power(&pair[0].state) + power(&pair[1].state))).sum()
}

/// `A^2 h^p (1 + t/12)`, p the order: friction missed at extremes and the trapezoidal rule, each of order h^2, or velocities h/2 off.
fn energy_row(
    at: &Subject,
    [found, expected]: [f64; 2],
    experiment: &Experiment,
    step: f64,
    scale: f64,
    floor: f64,
) -> Row {
    let order = at.configuration.expected_order();
    let whole = scale * scale;
    let tolerance = whole * step.powf(order) * (1.0 + experiment.duration() / 12.0) + 16.0 * floor;
    let reason = "predicted: energy pumped in over the substeps, h (1 - (n+1)/(2n)) ∫a² dt; tolerance A² h^p (1 + t/12): friction over missed \
                  extremes and the trapezoidal works (p = 2), or velocities half a step off (p = 1); right: 1 % of A²";
    let judgement = Judgement { basis: Basis::Formula, expected, found, tolerance, reason: reason.to_owned() };
    at.row("energy_residual", judgement).against(0.0, RIGHT * whole).with_floor(floor)
}
