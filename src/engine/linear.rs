//! Linear forces of chains with many oscillators, each coupled to few.

use super::force_law::{ForceLaw, Known};
use crate::model::{OscillatorChain, ParameterError, SparseMatrix};

/// All linear forces of a chain, `-K x - (D + S) v`, at a cost that grows with the number of couplings: what [`super::Springs`],
/// [`super::Dampers`] and [`super::SelfExcitation`] exert together.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearForces {
    stiffness: SparseMatrix,
    damping: SparseMatrix,
}

impl LinearForces {
    #[must_use]
    pub fn of(chain: &OscillatorChain) -> Self {
        Self { stiffness: SparseMatrix::of(chain.stiffness()), damping: SparseMatrix::of(&chain.total_damping()) }
    }
}

impl ForceLaw for LinearForces {
    fn check(&self, chain: &OscillatorChain) -> Result<(), ParameterError> {
        let (found, expected) = (self.stiffness.size(), chain.oscillators());
        if found == expected {
            return Ok(());
        }
        Err(ParameterError::WrongLength { field: "linear forces".to_owned(), found, expected, per: "oscillator" })
    }

    fn add_force(&self, known: &Known<'_>, force: &mut [f64]) {
        self.stiffness.subtract_product(known.positions, force);
        self.damping.subtract_product(known.velocities, force);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::laws_of;
    use crate::model::ChainBuilder;
    use nalgebra::DMatrix;

    #[test]
    fn sparse_forces_are_those_of_the_whole_matrices() {
        let circulant = |first: f64, next: f64| {
            DMatrix::from_fn(5, 5, |i, j| match (j + 5 - i) % 5 {
                0 => first,
                1 => next,
                4 => -0.5 * next,
                _ => 0.0,
            })
        };
        let builder = ChainBuilder::new(vec![1.0, 2.0, 1.0, 1.0, 3.0]).add_stiffness(&circulant(1.2, 0.3));
        let chain = builder.add_damping(&circulant(0.1, 0.02)).self_excited(2, -0.7).build().unwrap();
        let (positions, velocities) = ([0.3, -1.0, 2.0, 0.7, -0.2], [1.0, 0.5, -0.25, 3.0, 0.1]);
        let known = Known { time: 0.0, positions: &positions, velocities: &velocities, slider_forces: &[] };
        let (mut sparse, mut dense) = ([0.0; 5], [0.0; 5]);
        LinearForces::of(&chain).add_force(&known, &mut sparse);
        laws_of(&chain).iter().for_each(|law| law.add_force(&known, &mut dense));
        // Another order of adding six numbers of order 1.
        assert!(sparse.iter().zip(dense).all(|(a, b)| (a - b).abs() < 1e-15), "{sparse:?} {dense:?}");
        assert!(LinearForces::of(&chain).check(&ChainBuilder::new(vec![1.0]).build().unwrap()).is_err());
    }
}
