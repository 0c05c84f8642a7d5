//! Rows about a motion with friction over a few periods, beside its exact solution: state, switching times, energy.

use crate::conformance::experiment::{Experiment, RIGHT, ROUNDINGS, finish_ladder};
use crate::conformance::ledger::energy_residual;
use crate::conformance::scenario::{Bench, Case};
use crate::conformance::switching::{Switch, slowest_rate, switches_between, switches_of, switching_error};
use crate::conformance::{Basis, ConformanceError, Judgement, Ladder, ORDER_TOLERANCE, Row, Subject};
use crate::dynamics::State;
use crate::exact::ExactTrajectory;

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantities {
    StateAndSwitching,
    Energy,
}

pub(super) fn rows(
    subject: &Subject,
    case: &Case,
    bench: &dyn Bench,
    experiment: &Experiment,
    motion: &ExactTrajectory,
    quantities: Quantities,
) -> Result<Vec<Row>, ConformanceError> {
    let (mut rows, mut states, mut others) = (
        Vec::new(),
        Ladder::new(1.0),
        match quantities {
            Quantities::StateAndSwitching => Ladder::new(1.0),
            // Each reversal that is missed by a part of a step leaves its own residual.
            Quantities::Energy => Ladder::scattering(1.0),
        },
    );
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
                // A switch at the very end may fall on either side of it.
                let end = experiment.duration() - 20.0 * step.max(error.expected);
                let (predicted, _) = experiment.step_by_step(case.configuration, steps);
                let predicted = switches_between(&experiment.chain, &predicted);
                let of = |switches: &[Switch]| switching_error(motion.events(), switches, end);
                let (found, expected) = (of(&switches_of(&measured.trajectory)), of(&predicted));
                let (Some(found), Some(expected)) = (found, expected) else {
                    rows.push(other_switches(&at, found.is_some(), expected.is_some()));
                    continue;
                };
                let rate = slowest_rate(&experiment.chain, motion.events(), end);
                others.push(step, found, measured.floor / rate, Some(expected));
                rows.push(switching_row(&at, [found, expected], error.tolerance / rate, experiment.period));
            }
            Quantities::Energy => {
                let found = measured.trajectory.energy_residual();
                others.scale = scale * scale;
                let (predicted, stride) = experiment.step_by_step(case.configuration, steps);
                let expected = energy_residual(&experiment.chain, &predicted, stride);
                // Energies are products of two such components, one of them off by the floor of a motion of the size that is really there.
                let floor = measured.floor * measured.scale;
                others.push(step, found, floor, Some(expected));
                rows.push(energy_row(&at, [found, expected], scale, floor).with_trajectory(&measured.hash));
            }
        }
    }
    match quantities {
        Quantities::StateAndSwitching => {
            finish_ladder(&mut rows, subject, "state_error", &states, ORDER_TOLERANCE);
            finish_ladder(&mut rows, subject, "switching_time", &others, ORDER_TOLERANCE);
        }
        Quantities::Energy => finish_ladder(&mut rows, subject, "energy_residual", &others, ORDER_TOLERANCE),
    }
    Ok(rows)
}

/// Where engine or difference equation do not have the exact motion's switches, the one must do what the other does.
fn other_switches(at: &Subject, found: bool, expected: bool) -> Row {
    if found != expected {
        let who = if found { "the difference equation's" } else { "the engine's" };
        return at.failed("switching_time", &format!("{who} motion alone has other switches than the exact one"));
    }
    let (basis, found, expected, tolerance) = (Basis::DifferenceEquation, 0.0, 0.0, 0.0);
    let reason = "1 if the motion has the switches of the exact one in the same order; right: 1".to_owned();
    at.row("same_switches", Judgement { basis, expected, found, tolerance, reason }).against(1.0, 0.0)
}

fn switching_row(at: &Subject, [found, expected]: [f64; 2], tolerance: f64, period: f64) -> Row {
    let reason = "largest error, against that of the difference equation with its times interpolated alike; tolerance: that of the state over the slowest rate of an event function; right: 1 % of a period";
    let (basis, reason) = (Basis::DifferenceEquation, reason.to_owned());
    let judgement = Judgement { basis, expected, found, tolerance, reason };
    at.row("switching_time", judgement).against(0.0, RIGHT * period)
}

fn energy_row(at: &Subject, [found, expected]: [f64; 2], scale: f64, floor: f64) -> Row {
    let reason = format!(
        "the ledger of the difference equation by the same trapezoidal rule; tolerance: {ROUNDINGS} floors of rounding times the size of the motion; right: 1 % of A²"
    );
    let (basis, tolerance) = (Basis::DifferenceEquation, ROUNDINGS * floor);
    let judgement = Judgement { basis, expected, found, tolerance, reason };
    at.row("energy_residual", judgement).against(0.0, RIGHT * scale * scale).with_floor(floor)
}
