//! The limit cycle at given parameters, without a guess from the user: the first-harmonic estimate holds for weak
//! self-excitation, and from there the branch is followed to the wanted `xi1` by pseudo-arclength, which does not jump to others.

use super::branch::{BranchPoint, Heading, PseudoArclength};
use super::error::OrbitError;
use super::shooting::{PeriodicOrbit, shoot_section};
use crate::dynamics::{Closure, ReversalPoint, SectionMap};
use crate::model::{HarmonicEstimate, RigParameter, RigParameters};

/// Largest `u = sqrt(-2 pi xi1/gamma)` and phase `|xi1/kappa|` at which the estimate is trusted to start Newton's method.
const TRUSTED_ANGLE: f64 = 0.4;
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

/// The limit cycle on the branch that starts at `xi1 = 0`, `a1 = 1`, up to its first fold. `map_at` builds the section map for
/// given parameters.
///
/// # Errors
/// [`OrbitError::NoGuess`] where there is no such cycle (`xi1 >= 0` or `kappa = 0`), [`OrbitError::BeyondFold`], and what `map_at` and the
/// continuation return.
pub fn limit_cycle<M, F>(parameters: RigParameters, map_at: F) -> Result<PeriodicOrbit, OrbitError>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    let wanted = parameters.xi1;
    let no_guess = || OrbitError::NoGuess { xi1: wanted, kappa: parameters.kappa };
    if wanted >= 0.0 || parameters.kappa <= 0.0 {
        return Err(no_guess());
    }
    let start = RigParameters { xi1: starting_xi1(&parameters), ..parameters };
    let guess = start.harmonic_estimate().map(reversal_of).ok_or_else(no_guess)?;
    let orbit = shoot_section(&map_at(start)?, guess, Closure::HalfPeriod)?;
    if start.xi1 == wanted {
        return Ok(orbit);
    }
    let branch = PseudoArclength::new(&map_at, start, &orbit, RigParameter::Xi1, Heading::Decreasing)?;
    let mut before = BranchPoint { parameters: start, orbit, parameter_rate: -1.0 };
    for point in branch {
        let point = point?;
        if point.parameters.xi1 <= wanted {
            return orbit_between(&before, &point, &map_at(parameters)?, wanted);
        }
        if point.parameter_rate > 0.0 {
            break;
        }
        before = point;
    }
    Err(OrbitError::BeyondFold { reached: before.parameters.xi1, wanted })
}

/// The orbit at the wanted xi1, which lies between two points of the branch.
fn orbit_between<M: SectionMap>(
    from: &BranchPoint,
    to: &BranchPoint,
    map: &M,
    wanted: f64,
) -> Result<PeriodicOrbit, OrbitError> {
    let part = (wanted - from.parameters.xi1) / (to.parameters.xi1 - from.parameters.xi1);
    shoot_section(map, from.orbit.section + (to.orbit.section - from.orbit.section) * part, Closure::HalfPeriod)
}
