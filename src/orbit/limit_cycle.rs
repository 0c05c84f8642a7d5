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

/// The mode whose negative damping feeds a limit cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Fed by `xi1 < 0`.
    InPhase,
    /// Fed by `xi2 < 0`.
    OutOfPhase,
}

/// The limit cycle of the in-phase mode: [`limit_cycle_of`].
///
/// # Errors
/// As [`limit_cycle_of`].
pub fn limit_cycle<M, F>(parameters: RigParameters, map_at: F) -> Result<PeriodicOrbit, OrbitError>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    limit_cycle_of(Mode::InPhase, parameters, map_at)
}

/// The limit cycle on the branch that starts at amplitude 1 where the damping of a mode is zero, up to its first fold. `map_at` builds
/// the section map for given parameters.
///
/// # Errors
/// [`OrbitError::NoGuess`] where there is no such cycle (the mode is not excited, or `kappa = 0`), [`OrbitError::BeyondFold`],
/// [`OrbitError::Unbounded`], and what `map_at` and the continuation return.
pub fn limit_cycle_of<M, F>(mode: Mode, parameters: RigParameters, map_at: F) -> Result<PeriodicOrbit, OrbitError>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    let RigParameters { xi1, xi2, kappa, .. } = parameters;
    let excitation = if mode == Mode::InPhase { xi1 } else { xi2 };
    if excitation >= 0.0 || kappa <= 0.0 {
        return Err(OrbitError::NoGuess { mode, xi1, xi2, kappa });
    }
    match mode {
        Mode::InPhase => {
            let start = RigParameters { xi1: starting_xi1(&parameters), ..parameters };
            let orbit = weakly_excited(start, &map_at)?;
            followed(start, orbit, (RigParameter::Xi1, xi1), &map_at)
        }
        Mode::OutOfPhase => {
            let square = 1.0 + 2.0 * kappa;
            let weakest = -parameters.gamma * TRUSTED_ANGLE * TRUSTED_ANGLE / (std::f64::consts::TAU * square);
            let start = RigParameters { xi2: xi2.max(weakest), ..parameters };
            // Both masses move by a, 4 gamma (a - 1) of friction against 2 pi |xi2| w^2 a^2 of self-excitation in a period.
            let amplitude = 1.0 - 0.5 * std::f64::consts::PI * start.xi2 * square / start.gamma;
            let guess = ReversalPoint::new(amplitude, -amplitude, 0.0);
            let orbit = shoot_section(&map_at(start)?, guess, Closure::HalfPeriod)?;
            followed(start, orbit, (RigParameter::Xi2, xi2), &map_at)
        }
    }
}

/// The in-phase cycle where the estimate of `xi1` is good: for `xi2` beyond what the estimate allows, followed there from weaker damping.
fn weakly_excited<M, F>(start: RigParameters, map_at: &F) -> Result<PeriodicOrbit, OrbitError>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    let shot = |p: RigParameters| {
        let no_guess = || OrbitError::NoGuess { mode: Mode::InPhase, xi1: p.xi1, xi2: p.xi2, kappa: p.kappa };
        let guess = p.harmonic_estimate().map(reversal_of).ok_or_else(no_guess)?;
        shoot_section(&map_at(p)?, guess, Closure::HalfPeriod)
    };
    let trusted = TRUSTED_ANGLE * start.kappa;
    match shot(start) {
        Err(_) if start.xi2 > trusted => {
            let weak = RigParameters { xi2: trusted, ..start };
            followed(weak, shot(weak)?, (RigParameter::Xi2, start.xi2), map_at)
        }
        shot => shot,
    }
}

/// The orbit followed to the value `wanted` of a parameter, up to the first fold.
fn followed<M, F>(
    start: RigParameters,
    orbit: PeriodicOrbit,
    (varied, wanted): (RigParameter, f64),
    map_at: &F,
) -> Result<PeriodicOrbit, OrbitError>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    if start.get(varied) == wanted {
        return Ok(orbit);
    }
    let heading = if wanted > start.get(varied) { Heading::Increasing } else { Heading::Decreasing };
    let branch = PseudoArclength::new(map_at, start, &orbit, varied, heading)?;
    let mut before = BranchPoint { parameters: start, orbit, parameter_rate: heading.sign() };
    let name = varied.name();
    for point in branch {
        let point = point?;
        let reached = point.parameters.get(varied);
        if (reached - wanted) * heading.sign() >= 0.0 {
            let map = map_at(start.with(varied, wanted))?;
            return orbit_between(&before, &point, &map, (before.parameters.get(varied), reached, wanted));
        }
        if point.parameter_rate * heading.sign() < 0.0 {
            return Err(OrbitError::BeyondFold { name, reached: before.parameters.get(varied), wanted });
        }
        before = point;
    }
    Err(OrbitError::Unbounded { name, reached: before.parameters.get(varied), wanted })
}

/// The orbit at the wanted value of the parameter, which lies between those of two points of the branch.
fn orbit_between<M: SectionMap>(
    from: &BranchPoint,
    to: &BranchPoint,
    map: &M,
    (at_from, at_to, wanted): (f64, f64, f64),
) -> Result<PeriodicOrbit, OrbitError> {
    let part = (wanted - at_from) / (at_to - at_from);
    shoot_section(map, from.orbit.section + (to.orbit.section - from.orbit.section) * part, Closure::HalfPeriod)
}
