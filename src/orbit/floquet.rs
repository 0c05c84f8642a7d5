//! Floquet multipliers over the full period from the monodromy matrix M (5x5) of the extended state.
//!
//! M carries the vector field F at the orbit into itself, so one multiplier is 1 (trivial). At a fold a second multiplier joins
//! it in a Jordan block, where eigenvalues are known to half the digits only; F is therefore split off first: in an orthonormal
//! basis that starts with F, `M = [[1, *], [0, M']]`, and the other four multipliers are the eigenvalues of M'. One of
//! these is exactly zero as soon as the element slips: entering slip wipes out a perturbation of its force.

use super::error::OrbitError;
use super::shooting::PeriodicOrbit;
use crate::dynamics::TangentFlow;
use nalgebra::{Complex, DMatrix, DVector, Matrix4, Matrix5, Vector5};

/// The five multipliers of a periodic orbit of the two-mass rig that slips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloquetMultipliers {
    /// `|M F - F| / |F|`: how far the trivial multiplier is from 1. A self-check of orbit and monodromy.
    pub trivial_error: f64,
    /// The one that is zero in theory.
    pub zero: Complex<f64>,
    /// The other three, largest modulus first.
    pub others: [Complex<f64>; 3],
}

impl FloquetMultipliers {
    /// # Errors
    /// [`OrbitError::Flow`] if the flow fails along the orbit.
    pub fn of<T: TangentFlow>(flow: &T, orbit: &PeriodicOrbit) -> Result<Self, OrbitError> {
        let failed = |source: T::Error| OrbitError::Flow { period: orbit.period, source: Box::new(source) };
        let mut state = DVector::from_iterator(5, orbit.reversal().components());
        let field = flow.vector_field(&state).map_err(failed)?;
        let mut monodromy = DMatrix::identity(5, 5);
        flow.carry(&mut state, &mut monodromy, orbit.period).map_err(failed)?;
        let monodromy = Matrix5::from_column_slice(monodromy.as_slice());
        Ok(Self::from_monodromy(&monodromy, &Vector5::from_column_slice(field.as_slice())))
    }

    /// From the derivative of the flow over one period and the vector field at its start.
    #[must_use]
    pub fn from_monodromy(monodromy: &Matrix5<f64>, field: &Vector5<f64>) -> Self {
        let mut values: Vec<Complex<f64>> =
            transverse(monodromy, field).complex_eigenvalues().iter().copied().collect();
        values.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
        Self {
            trivial_error: (monodromy * field - field).norm() / field.norm(),
            zero: values[3],
            others: [values[0], values[1], values[2]],
        }
    }

    /// Whether all but the trivial one lie inside the unit circle.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.others[0].norm() < 1.0
    }
}

/// The block of the monodromy across the vector field: Householder's reflection that maps F to a multiple of the first axis.
fn transverse(monodromy: &Matrix5<f64>, field: &Vector5<f64>) -> Matrix4<f64> {
    let mut axis = field.normalize();
    axis[0] += axis[0].signum();
    let reflection = Matrix5::identity() - axis * axis.transpose() * (2.0 / axis.norm_squared());
    (reflection * monodromy * reflection).fixed_view::<4, 4>(1, 1).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multipliers_are_identified_also_where_one_meets_the_trivial_one() {
        // Upper triangular, a Jordan block at 1; the field is the first axis, turned by an orthogonal matrix.
        let mut m = Matrix5::from_diagonal(&Vector5::new(1.0, 1.0, -0.5, 0.25, 0.0));
        (m[(0, 1)], m[(2, 4)]) = (3.0, 0.7);
        let turn = Matrix5::from_fn(|i, j| 1.0 / (1.0 + i as f64 + 2.0 * j as f64)) + Matrix5::identity();
        let q = turn.qr().q();
        let found = FloquetMultipliers::from_monodromy(&(q * m * q.transpose()), &(q.column(0) * 2.0));
        assert!(found.trivial_error < 1e-15);
        assert!(found.zero.norm() < 1e-15);
        for (value, expected) in found.others.iter().zip([1.0, -0.5, 0.25]) {
            assert!((value - expected).norm() < 1e-14, "{value} {expected}");
        }
    }

    #[test]
    fn a_field_that_is_not_carried_into_itself_shows() {
        let found = FloquetMultipliers::from_monodromy(&(Matrix5::identity() * 0.5), &Vector5::x());
        assert_eq!(found.trivial_error, 0.5);
    }
}
