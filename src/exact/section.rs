//! Maps of the section `v1 = 0`, `f = +1` with their exact derivatives with respect to state and parameters.
//!
//! In each phase `y' = A(p) y` with A linear in every parameter, so with `E = exp(A t)` and its derivative `E_p` in the direction
//! `t dA/dp`, a phase that starts at y carries
//!
//! ```text
//! dy <- E S dy,      y_p <- E S y_p + E_p y,      S = I - e_f e_f^T  into slip,  I  into stick.
//! ```
//!
//! The guards |f| = 1 and v1 = 0 contain no parameter, so the saltation matrix S serves both. At the end `Pi = I - F e_v1^T / v1'`
//! projects along the vector field F onto the section. A half-period return is mirrored.

use super::error::ExactError;
use super::half_period::{LONGEST_HALF_PERIOD, exponential_with_derivative};
use super::pattern::extended_matrix;
use super::tangent::FORCE;
use super::two_mass::TwoMassFlow;
use crate::dynamics::{
    Closure, Event, EventKind, Outcome, ParameterTangent, ReversalPoint, SectionMap, SectionReturn, State,
};
use crate::model::RigParameter;
use nalgebra::{Matrix3, Matrix5, Vector3, Vector5};

/// Places of `(x1, x2, v2)` in `y`.
const POINT: [usize; 3] = [0, 1, 3];
const V1: usize = 2;
/// Switches in which each cycle must close: two slip phases and as many more as small reversals between them can cause.
const SWITCHES_PER_CYCLE: usize = 16;

/// A start that decelerates less than this is taken for the equilibrium of slip at f = +1 (x1 = x1*, v = 0), which Newton's method
/// would otherwise find as an orbit of any period.
const LEAST_DECELERATION: f64 = 1e-9;

/// Derivatives of the state at one time with respect to the starting state and to parameters.
#[derive(Debug, Clone)]
pub(super) struct Sensitivity {
    pub(super) tangent: Matrix5<f64>,
    pub(super) parameters: Vec<Vector5<f64>>,
}

impl SectionMap for TwoMassFlow {
    type Error = ExactError;

    fn section_return(
        &self,
        start: ReversalPoint,
        closure: Closure,
        parameters: &[RigParameter],
    ) -> Result<SectionReturn, ExactError> {
        let initial = State::two_mass([start[0], start[1], 0.0, start[2], 1.0]);
        let (events, sign) = match closure {
            Closure::HalfPeriod => (self.half_period_events(start, &initial)?.to_vec(), -1.0),
            Closure::FullPeriod { cycles } => (self.full_period_events(start, &initial, cycles)?, 1.0),
        };
        let (mut state, mut time) = (&initial, 0.0);
        let mut sensitivity = Sensitivity::new(parameters.len());
        for event in &events {
            let sticks = event.kind == EventKind::StickToSlip;
            self.carry_sensitivity(&mut sensitivity, state, sticks, event.time - time, parameters);
            (state, time) = (&event.state, event.time);
        }
        let [dx1, dx2, dv1, dv2, _] = self.slip_field(state);
        let field = [dx1, dx2, dv1, dv2];
        let project = |column: Vector5<f64>| {
            let delay = column[V1] / field[V1];
            Vector3::from_fn(|row, _| sign * (column[POINT[row]] - field[POINT[row]] * delay))
        };
        Ok(SectionReturn {
            image: sign * Vector3::new(state.positions[0], state.positions[1], state.velocities[1]),
            duration: time,
            jacobian: Matrix3::from_columns(&POINT.map(|i| project(sensitivity.tangent.column(i).into_owned()))),
            sensitivities: sensitivity.parameters.into_iter().map(project).collect(),
        })
    }
}

impl ParameterTangent for TwoMassFlow {
    type Error = ExactError;

    fn parameter_tangents(
        &self,
        initial: &State,
        duration: f64,
        parameters: &[RigParameter],
    ) -> Result<Vec<Vector5<f64>>, ExactError> {
        let motion = self.solve(initial, duration)?;
        if let Outcome::Diverged { time, bound } = motion.outcome() {
            return Err(ExactError::Diverged { time, bound, asked: duration });
        }
        let mut sensitivity = Sensitivity::new(parameters.len());
        for (state, contacts, span) in motion.phases() {
            let sticks = contacts.iter().all(|contact| contact.is_stick());
            self.carry_sensitivity(&mut sensitivity, &state, sticks, span, parameters);
        }
        Ok(sensitivity.parameters)
    }
}

impl Sensitivity {
    pub(super) fn new(parameters: usize) -> Self {
        Self { tangent: Matrix5::identity(), parameters: vec![Vector5::zeros(); parameters] }
    }
}

impl TwoMassFlow {
    /// Carries over one phase that starts at `state`.
    pub(super) fn carry_sensitivity(
        &self,
        sensitivity: &mut Sensitivity,
        state: &State,
        sticks: bool,
        span: f64,
        parameters: &[RigParameter],
    ) {
        let tangent = self.phase_tangent(sticks, span);
        let matrix = extended_matrix(self.rig().chain(), &[sticks]);
        let matrix = Matrix5::from_fn(|row, column| matrix[(row, column)] * span);
        let y = Vector5::from_iterator(state.components());
        for (carried, parameter) in sensitivity.parameters.iter_mut().zip(parameters) {
            let [_, slope] = exponential_with_derivative(matrix, matrix_derivative(*parameter) * span);
            *carried = tangent * *carried + slope * y;
        }
        sensitivity.tangent = tangent * sensitivity.tangent;
    }

    /// The vector field at the end of a slip phase, where v1 = 0.
    fn slip_field(&self, state: &State) -> [f64; 5] {
        let chain = self.rig().chain();
        let acceleration = chain.acceleration(&state.positions, &state.velocities, &state.slider_forces);
        [0.0, state.velocities[1], acceleration[0], acceleration[1], 0.0]
    }

    /// All switches up to the return to a reversal at f = +1 that completes the last cycle.
    fn full_period_events(
        &self,
        start: ReversalPoint,
        initial: &State,
        cycles: usize,
    ) -> Result<Vec<Event>, ExactError> {
        if cycles == 0 {
            return Err(ExactError::OutOfRange { field: "cycles", found: 0.0, allowed: "at least 1" });
        }
        let (switches, time) = (SWITCHES_PER_CYCLE * cycles, 2.0 * LONGEST_HALF_PERIOD * cycles as f64);
        let mut events = self.first_switches(initial, time, switches)?;
        let acceleration = self.acceleration1(initial);
        if acceleration > -LEAST_DECELERATION {
            return Err(ExactError::NotAReversal { x1: start[0], x2: start[1], v2: start[2], acceleration });
        }
        let closes = |event: &Event| event.kind == EventKind::SlipToStick && event.state.slider_forces[0] > 0.0;
        let returns: Vec<usize> = (0..events.len()).filter(|&index| closes(&events[index])).collect();
        let Some(last) = returns.get(cycles - 1) else {
            return Err(ExactError::NoReturn { found: returns.len(), expected: cycles, switches: events.len(), time });
        };
        events.truncate(last + 1);
        Ok(events)
    }
}

/// Derivative of the system matrix of equations (1)-(2) for `y = (x1, x2, v1, v2, f)`, the same in both contact states.
fn matrix_derivative(parameter: RigParameter) -> Matrix5<f64> {
    let mut derivative = Matrix5::zeros();
    let entries: &[(usize, usize, f64)] = match parameter {
        RigParameter::Xi1 => &[(2, 2, -0.5), (2, 3, -0.5), (3, 2, -0.5), (3, 3, -0.5)],
        RigParameter::Xi2 => &[(2, 2, -0.5), (2, 3, 0.5), (3, 2, 0.5), (3, 3, -0.5)],
        RigParameter::Kappa => &[(2, 0, -1.0), (2, 1, 1.0), (3, 0, 1.0), (3, 1, -1.0)],
        RigParameter::Gamma => &[(2, 0, 1.0), (2, FORCE, -1.0)],
    };
    for &(row, column, value) in entries {
        derivative[(row, column)] = value;
    }
    derivative
}
