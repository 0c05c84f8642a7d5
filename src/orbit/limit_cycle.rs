//! The limit cycle at given parameters, without a guess from the user: the first-harmonic estimate holds for weak
//! self-excitation, and from there the cycle is followed to the wanted `xi1` with a secant predictor.

use super::error::OrbitError;
use super::shooting::{PeriodicOrbit, shoot};
use crate::dynamics::{HalfPeriodMap, ReversalPoint};
use crate::model::{HarmonicEstimate, RigParameters};

/// Largest `u = sqrt(-2 pi xi1/gamma)` and phase `|xi1/kappa|` at which the estimate is trusted to start Newton's method.
const TRUSTED_ANGLE: f64 = 0.4;
/// First and smallest step of the continuation, relative to the xi1 wanted.
const FIRST_STEP: f64 = 0.1;
const SMALLEST_STEP: f64 = 1e-4;

fn reversal_of(estimate: HarmonicEstimate) -> ReversalPoint {
    let HarmonicEstimate { amplitude1, amplitude2, phase_difference, angular_frequency } = estimate;
    ReversalPoint::new(
        amplitude1,
        amplitude2 * phase_difference.cos(),
        amplitude2 * angular_frequency * phase_difference.sin(),
    )
}

/// The xi1 nearest to the wanted one where the first-harmonic estimate is good.
fn starting_xi1(p: &RigParameters) -> f64 {
    let by_slip = -p.gamma * TRUSTED_ANGLE * TRUSTED_ANGLE / std::f64::consts::TAU;
    p.xi1.max(by_slip).max(-p.kappa * TRUSTED_ANGLE)
}

/// The limit cycle on the branch that starts at `xi1 = 0`, `a1 = 1`, up to its first fold. `map_at` builds the half-period
/// map for given parameters.
///
/// # Errors
/// [`OrbitError::NoGuess`] where there is no such cycle (`xi1 >= 0` or `kappa = 0`), [`OrbitError::Stuck`] beyond a fold, and what
/// `map_at` returns.
pub fn limit_cycle<M, F>(parameters: RigParameters, map_at: F) -> Result<PeriodicOrbit, OrbitError>
where
    M: HalfPeriodMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    let wanted = parameters.xi1;
    let no_guess = || OrbitError::NoGuess { xi1: wanted, kappa: parameters.kappa };
    if wanted >= 0.0 || parameters.kappa <= 0.0 {
        return Err(no_guess());
    }
    let mut xi1 = starting_xi1(&parameters);
    let at = |xi1: f64| RigParameters { xi1, ..parameters };
    let guess = at(xi1).harmonic_estimate().map(reversal_of).ok_or_else(no_guess)?;
    let mut orbit = shoot(&map_at(at(xi1))?, guess)?;
    let mut slope = ReversalPoint::zeros();
    let mut step = FIRST_STEP * (wanted - xi1);
    while xi1 != wanted {
        let next = if (wanted - xi1).abs() <= step.abs() { wanted } else { xi1 + step };
        match shoot(&map_at(at(next))?, orbit.section + slope * (next - xi1)) {
            Ok(found) => {
                slope = (found.section - orbit.section) / (next - xi1);
                (orbit, xi1) = (found, next);
                step *= 1.5;
            }
            Err(_) if step.abs() > SMALLEST_STEP * wanted.abs() => step *= 0.5,
            Err(source) => return Err(OrbitError::Stuck { reached: xi1, wanted, source: Box::new(source) }),
        }
    }
    Ok(orbit)
}
