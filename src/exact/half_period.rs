//! The half-period map of the two-mass rig with its exact derivative.
//!
//! From a reversal `(x1, x2, v2)` at `v1 = 0`, `f = +1`: one stick phase to f = -1 (duration t1), one slip phase to the next
//! reversal `v1 = 0` (duration t2), mirrored. With `y' = A y` in each phase for `y = (x1, x2, v1, v2, f)`, a perturbation obeys
//!
//! ```text
//! dP = -Pi exp(A_slip t2) S exp(A_stick t1),   S = I - e_f e_f^T,   Pi = I - F e_v1^T / v1'
//! ```
//!
//! (see `section`, where the maps of other orbits are as well).

use super::error::ExactError;
use super::series::ORDER;
use super::two_mass::TwoMassFlow;
use crate::dynamics::{
    Closure, Event, EventKind, HalfPeriodMap, HalfReturn, ReversalPoint, SectionMap, SectionReturn, State,
};
use nalgebra::Matrix5;

/// Longest time for which the next reversal is waited for: 160 periods of the fundamental mode. A motion that sticks that
/// long after a reversal decays without slip.
pub(super) const LONGEST_HALF_PERIOD: f64 = 1000.0;

impl HalfPeriodMap for TwoMassFlow {
    type Error = ExactError;

    fn half_return(&self, start: ReversalPoint) -> Result<HalfReturn, ExactError> {
        let SectionReturn { image, duration, jacobian, .. } = self.section_return(start, Closure::HalfPeriod, &[])?;
        Ok(HalfReturn { image, duration, jacobian })
    }
}

impl TwoMassFlow {
    /// The switch to slip at f = -1 and the next reversal.
    pub(super) fn half_period_events(&self, start: ReversalPoint, initial: &State) -> Result<[Event; 2], ExactError> {
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

    pub(super) fn acceleration1(&self, state: &State) -> f64 {
        self.rig().chain().acceleration(&state.positions, &state.velocities, &state.slider_forces)[0]
    }
}

/// `exp(A)` and its derivative in direction `D` (Frechet), by the same series and squarings.
pub(super) fn exponential_with_derivative(matrix: Matrix5<f64>, direction: Matrix5<f64>) -> [Matrix5<f64>; 2] {
    let squarings = squarings(&matrix);
    let scale = 2.0_f64.powi(squarings);
    let (a, d) = (matrix / scale, direction / scale);
    let start = [Matrix5::identity(), Matrix5::zeros()];
    let series = (1..=ORDER).rev().fold(start, |[sum, slope], k| {
        let k = k as f64;
        [Matrix5::identity() + a * sum / k, (d * sum + a * slope) / k]
    });
    (0..squarings).fold(series, |[power, slope], _| [power * power, power * slope + slope * power])
}

/// Halvings that bring the norm to at most 1/2.
fn squarings(matrix: &Matrix5<f64>) -> i32 {
    let norm = matrix.row_iter().map(|row| row.abs().sum()).fold(0.0, f64::max);
    (2.0 * norm).max(1.0).log2().ceil() as i32
}

/// `exp(A)` by its series for `A/2^s` of norm at most 1/2, squared s times.
pub(super) fn exponential(matrix: Matrix5<f64>) -> Matrix5<f64> {
    let squarings = squarings(&matrix);
    let scaled = matrix / 2.0_f64.powi(squarings);
    // Horner's scheme; the first term left out is below (1/2)^17/17! = 2e-20.
    let series = (1..=ORDER).rev().fold(Matrix5::identity(), |sum, k| Matrix5::identity() + scaled * sum / k as f64);
    (0..squarings).fold(series, |power, _| power * power)
}
