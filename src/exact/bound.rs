//! The amplitude beyond which a motion counts as diverged, and the initial states that lie within it.

use super::error::ExactError;
use crate::dynamics::State;
use crate::model::OscillatorChain;

/// Amplitude bound unless another is given, in units of length.
pub const DEFAULT_AMPLITUDE_BOUND: f64 = 1000.0;

/// Beyond this bound the slider force `x - anchor` has fewer than seven digits left.
const LARGEST_BOUND: f64 = 1e9;

/// Initial velocities may exceed the amplitude bound by this factor (per unit of time): faster motions leave the bound at once.
const FASTEST: f64 = 1e6;

/// # Errors
/// [`ExactError::OutOfRange`] unless the bound is positive and at most 1e9.
pub(super) fn checked_bound(bound: f64) -> Result<f64, ExactError> {
    if bound > 0.0 && bound <= LARGEST_BOUND {
        return Ok(bound);
    }
    Err(ExactError::OutOfRange { field: "amplitude_bound", found: bound, allowed: "greater than 0 and at most 1e9" })
}

/// Passes the state through if a motion can start there.
///
/// # Errors
/// [`ExactError::State`] and [`ExactError::StartsBeyondBound`].
pub(super) fn admitted(initial: &State, chain: &OscillatorChain, bound: f64) -> Result<State, ExactError> {
    let state = initial.clone().validated(chain)?;
    let parts = [("positions", &state.positions, bound), ("velocities", &state.velocities, FASTEST * bound)];
    for (field, values, bound) in parts {
        if let Some(index) = values.iter().position(|value| value.abs() > bound) {
            return Err(ExactError::StartsBeyondBound { field, index, found: values[index], bound });
        }
    }
    Ok(state)
}
