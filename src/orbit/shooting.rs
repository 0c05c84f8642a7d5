//! Periodic orbits by shooting: Newton's method on `P(z) - z = 0`, with `z = (x1, x2, v2)` at a reversal of mass 1 and P a map of
//! that section: to the mirror image of the next reversal (a fixed point is a symmetric orbit), or to the k-th reversal of the
//! same sign (any orbit of period k).
//!
//! The derivative comes exactly from the map, so convergence is quadratic. Its eigenvalues at the fixed point are the multipliers
//! of that map; for the half-period map, those over the full period are their squares.

use super::error::OrbitError;
use crate::dynamics::{Closure, HalfPeriodMap, HalfReturn, ReversalPoint, SectionMap, SectionReturn, State};
use nalgebra::{Complex, Matrix3};

/// Newton steps before giving up; quadratic convergence needs 4 to 6 from any useful guess.
const MAX_STEPS: usize = 30;
/// Largest residual of a converged orbit: about a hundred roundings of a state of order 1 carried round.
const RESIDUAL: f64 = 2e-13;
/// A step longer than this leaves the region in which the linearisation means anything.
const LONGEST_STEP: f64 = 0.5;

/// Largest residual of a converged orbit at `section`: roundings grow with the amplitude.
pub(super) fn tolerance(section: &ReversalPoint) -> f64 {
    RESIDUAL * section.amax().max(1.0)
}

/// A periodic orbit of the two-mass rig.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodicOrbit {
    /// `(x1, x2, v2)` at `v1 = 0`, `f = +1`.
    pub section: ReversalPoint,
    pub period: f64,
    /// The return that closes the orbit.
    pub closure: Closure,
    /// Derivative of the section map of that return.
    pub jacobian: Matrix3<f64>,
    /// `|P(z) - z|`, largest component.
    pub residual: f64,
}

impl PeriodicOrbit {
    #[must_use]
    pub fn angular_frequency(&self) -> f64 {
        std::f64::consts::TAU / self.period
    }

    /// `x1` at the reversal: the amplitude of mass 1, for an orbit with one reversal at f = +1.
    #[must_use]
    pub fn amplitude(&self) -> f64 {
        self.section[0]
    }

    /// Eigenvalues of the derivative of the section map, largest modulus first.
    #[must_use]
    pub fn section_multipliers(&self) -> [Complex<f64>; 3] {
        let mut values = self.jacobian.complex_eigenvalues();
        values.as_mut_slice().sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
        [values[0], values[1], values[2]]
    }

    /// Whether all multipliers lie inside the unit circle.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.section_multipliers()[0].norm() < 1.0
    }

    /// The state at the reversal, `y = (x1, x2, 0, v2, 1)`.
    #[must_use]
    pub fn reversal(&self) -> State {
        let [x1, x2, v2] = self.section.into();
        State::two_mass([x1, x2, 0.0, v2, 1.0])
    }

    pub(super) fn closed(section: ReversalPoint, closure: Closure, back: &HalfReturn) -> Self {
        let returns = match closure {
            Closure::HalfPeriod => 2.0,
            Closure::FullPeriod { .. } => 1.0,
        };
        Self {
            section,
            period: returns * back.duration,
            closure,
            jacobian: back.jacobian,
            residual: (back.image - section).amax(),
        }
    }
}

/// A symmetric orbit, by Newton's method from `guess`.
///
/// # Errors
/// [`OrbitError::Map`] if the map fails on the way, [`OrbitError::NoConvergence`] with the last point and residual otherwise.
pub fn shoot<M: HalfPeriodMap>(map: &M, guess: ReversalPoint) -> Result<PeriodicOrbit, OrbitError> {
    newton(guess, Closure::HalfPeriod, |point| map.half_return(point))
}

/// An orbit with the given closure, by Newton's method from `guess`. With [`Closure::FullPeriod`] the orbit found may also
/// be a symmetric one, or one of a shorter period run through several times.
///
/// # Errors
/// As [`shoot`].
pub fn shoot_section<M: SectionMap>(
    map: &M,
    guess: ReversalPoint,
    closure: Closure,
) -> Result<PeriodicOrbit, OrbitError> {
    newton(guess, closure, |point| {
        let SectionReturn { image, duration, jacobian, .. } = map.section_return(point, closure, &[])?;
        Ok::<_, M::Error>(HalfReturn { image, duration, jacobian })
    })
}

fn newton<E: std::error::Error + Send + Sync + 'static>(
    guess: ReversalPoint,
    closure: Closure,
    map: impl Fn(ReversalPoint) -> Result<HalfReturn, E>,
) -> Result<PeriodicOrbit, OrbitError> {
    let mut section = guess;
    let mut residual = f64::INFINITY;
    for _ in 0..MAX_STEPS {
        let back = map(section).map_err(|source| OrbitError::Map { at: section.into(), source: Box::new(source) })?;
        let defect = back.image - section;
        residual = defect.amax();
        if residual <= tolerance(&section) {
            return Ok(PeriodicOrbit::closed(section, closure, &back));
        }
        let step = (Matrix3::identity() - back.jacobian)
            .lu()
            .solve(&defect)
            .filter(|step| step.iter().all(|c| c.is_finite()))
            .ok_or_else(|| OrbitError::singular(section.as_slice(), residual))?;
        section += step * (LONGEST_STEP / step.norm()).min(1.0);
    }
    Err(OrbitError::no_convergence(section.as_slice(), residual, MAX_STEPS))
}
