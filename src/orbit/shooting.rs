//! Symmetric limit cycles by shooting: Newton's method on `P(z) - z = 0`, with `P` the half-period map from one reversal of
//! mass 1 to the mirror image of the next and `z = (x1, x2, v2)` (a fixed point of `P` is a symmetric periodic orbit).
//!
//! Its derivative comes exactly from the map, so convergence is quadratic. The multipliers of the half-period map are the
//! eigenvalues of that derivative at the fixed point; those over the full period are their squares.

use super::error::OrbitError;
use crate::dynamics::{HalfPeriodMap, HalfReturn, ReversalPoint, State};
use nalgebra::{Complex, Matrix3};

/// Newton steps before giving up; quadratic convergence needs 4 to 6 from any useful guess.
const MAX_STEPS: usize = 30;
/// Largest residual of a converged orbit: about a hundred roundings of a state of order 1 carried round.
const RESIDUAL: f64 = 2e-13;
/// A step longer than this leaves the region in which the linearisation means anything.
const LONGEST_STEP: f64 = 0.5;

/// A symmetric limit cycle of the two-mass rig.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodicOrbit {
    /// `(x1, x2, v2)` at `v1 = 0`, `f = +1`.
    pub section: ReversalPoint,
    pub period: f64,
    /// Derivative of the half-period map.
    pub jacobian: Matrix3<f64>,
    /// `|P(z) - z|`, largest component.
    pub residual: f64,
}

impl PeriodicOrbit {
    #[must_use]
    pub fn angular_frequency(&self) -> f64 {
        std::f64::consts::TAU / self.period
    }

    /// Eigenvalues of the derivative of the half-period map, largest modulus first.
    #[must_use]
    pub fn half_period_multipliers(&self) -> [Complex<f64>; 3] {
        let mut values = self.jacobian.complex_eigenvalues();
        values.as_mut_slice().sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
        [values[0], values[1], values[2]]
    }

    /// Whether all multipliers lie inside the unit circle.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.half_period_multipliers()[0].norm() < 1.0
    }

    /// The state at the reversal, `y = (x1, x2, 0, v2, 1)`.
    #[must_use]
    pub fn reversal(&self) -> State {
        let [x1, x2, v2] = self.section.into();
        State::two_mass([x1, x2, 0.0, v2, 1.0])
    }
}

/// Newton's method from `guess`.
///
/// # Errors
/// [`OrbitError::Map`] if the map fails on the way, [`OrbitError::NoConvergence`] with the last point and residual otherwise.
pub fn shoot<M: HalfPeriodMap>(map: &M, guess: ReversalPoint) -> Result<PeriodicOrbit, OrbitError> {
    let mut section = guess;
    let mut residual = f64::INFINITY;
    for _ in 0..MAX_STEPS {
        let HalfReturn { image, duration, jacobian } = map
            .half_return(section)
            .map_err(|source| OrbitError::Map { at: section.into(), source: Box::new(source) })?;
        let defect = image - section;
        residual = defect.amax();
        if residual <= RESIDUAL {
            return Ok(PeriodicOrbit { section, period: 2.0 * duration, jacobian, residual });
        }
        let step = (Matrix3::identity() - jacobian)
            .lu()
            .solve(&defect)
            .filter(|step| step.iter().all(|c| c.is_finite()))
            .ok_or(OrbitError::Singular { at: section.into(), residual })?;
        section += step * (LONGEST_STEP / step.norm()).min(1.0);
    }
    Err(OrbitError::NoConvergence { at: section.into(), residual, steps: MAX_STEPS })
}
