//! The half-period map of the two-mass rig with its exact derivative.
//!
//! From a reversal `(x1, x2, v2)` at `v1 = 0`, `f = +1`: one stick phase to f = -1 (duration t1), one slip phase to the next
//! reversal `v1 = 0` (duration t2), mirrored. With `y' = A y` in each phase for `y = (x1, x2, v1, v2, f)`, a perturbation obeys
//!
//! ```text
//! dP = -Pi exp(A_slip t2) S exp(A_stick t1),   S = I - e_f e_f^T,   Pi = I - F e_v1^T / v1'
//! ```
//!
//! S is the saltation matrix from stick to slip (the force is held at -1 from then on); the one from slip to stick is I,
//! because v1 = 0 there. Pi projects along the vector field F onto the section v1 = 0.

use super::error::ExactError;
use super::pattern::extended_matrix;
use super::series::ORDER;
use super::two_mass::TwoMassFlow;
use crate::dynamics::{Event, EventKind, HalfPeriodMap, HalfReturn, ReversalPoint, State};
use nalgebra::{Matrix3, Matrix5, Vector3};

/// Longest time for which the next reversal is waited for: 160 periods of the fundamental mode. A motion that sticks that
/// long after a reversal decays without slip.
const LONGEST_HALF_PERIOD: f64 = 1000.0;

/// Places of `(x1, x2, v2)` in `y`.
const POINT: [usize; 3] = [0, 1, 3];
const V1: usize = 2;
const FORCE: usize = 4;

impl HalfPeriodMap for TwoMassFlow {
    type Error = ExactError;

    fn half_return(&self, start: ReversalPoint) -> Result<HalfReturn, ExactError> {
        let initial = State::two_mass([start[0], start[1], 0.0, start[2], 1.0]);
        let [slip, stick] = self.half_period_events(start, &initial)?;
        let end = &stick.state;
        Ok(HalfReturn {
            image: -Vector3::new(end.positions[0], end.positions[1], end.velocities[1]),
            duration: stick.time,
            jacobian: self.derivative(slip.time, stick.time - slip.time, end),
        })
    }
}

impl TwoMassFlow {
    /// The switch to slip at f = -1 and the next reversal.
    fn half_period_events(&self, start: ReversalPoint, initial: &State) -> Result<[Event; 2], ExactError> {
        let [mut slip, mut stick] = [None, None];
        // Validates the state before anything is computed from it.
        let events = self.first_switches(initial, LONGEST_HALF_PERIOD, 2)?;
        let acceleration = self.acceleration1(initial);
        if acceleration >= 0.0 {
            return Err(ExactError::NotAReversal { x1: start[0], x2: start[1], v2: start[2], acceleration });
        }
        for event in events {
            match event.kind {
                EventKind::StickToSlip => slip = Some(event),
                EventKind::SlipToStick => stick = Some(event),
                EventKind::Grazing => {}
            }
        }
        let missing = |found, expected, time| Err(ExactError::NoHalfReturn { found, expected, time });
        match (slip, stick) {
            (None, _) => missing("no slip", "slip at f = -1", LONGEST_HALF_PERIOD),
            (Some(slip), _) if slip.state.slider_forces[0] > 0.0 => {
                missing("slip at f = +1", "slip at f = -1", slip.time)
            }
            (Some(slip), None) => missing("no further reversal", "a reversal at f = -1", slip.time),
            (Some(slip), Some(stick)) => Ok([slip, stick]),
        }
    }

    fn acceleration1(&self, state: &State) -> f64 {
        self.rig().chain().acceleration(&state.positions, &state.velocities, &state.slider_forces)[0]
    }

    fn derivative(&self, stick_time: f64, slip_time: f64, end: &State) -> Matrix3<f64> {
        let chain = self.rig().chain();
        let [stick, slip] = [(true, stick_time), (false, slip_time)].map(|(sticking, time)| {
            let matrix = extended_matrix(chain, &[sticking]);
            exponential(Matrix5::from_fn(|row, column| matrix[(row, column)] * time))
        });
        let mut saltation = Matrix5::identity();
        saltation[(FORCE, FORCE)] = 0.0;
        let tangent = slip * saltation * stick;
        let acceleration = chain.acceleration(&end.positions, &end.velocities, &end.slider_forces);
        let field = [0.0, end.velocities[1], acceleration[0], acceleration[1], 0.0];
        Matrix3::from_fn(|row, column| {
            let delay = tangent[(V1, POINT[column])] / field[V1];
            -(tangent[(POINT[row], POINT[column])] - field[POINT[row]] * delay)
        })
    }
}

/// `exp(A)` by its series for `A/2^s` of norm at most 1/2, squared s times.
pub(super) fn exponential(matrix: Matrix5<f64>) -> Matrix5<f64> {
    let norm = matrix.row_iter().map(|row| row.abs().sum()).fold(0.0, f64::max);
    let squarings = (2.0 * norm).max(1.0).log2().ceil() as i32;
    let scaled = matrix / 2.0_f64.powi(squarings);
    // Horner's scheme; the first term left out is below (1/2)^17/17! = 2e-20.
    let series = (1..=ORDER).rev().fold(Matrix5::identity(), |sum, k| Matrix5::identity() + scaled * sum / k as f64);
    (0..squarings).fold(series, |power, _| power * power)
}
