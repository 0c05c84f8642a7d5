//! Linear modes of a chain with every Jenkins element in a given contact state.
//!
//! Eigenvalues `s` of the first-order form of `M x'' + (D + S) x' + K x = 0`:
//! `s = -zeta + i w` with decay rate `zeta` (negative: growing) and damped angular frequency `w`.

use super::chain::OscillatorChain;
use super::quantity::ParameterError;
use nalgebra::{Complex, DMatrix};
use serde::{Deserialize, Serialize};
use thiserror::Error;

#[derive(Debug, Clone, PartialEq, Error)]
pub enum ModesError {
    #[error(
        "the eigenvalues of the {size} x {size} system matrix did not converge: its entries differ by many orders of magnitude, or too many eigenvalues coincide, as without coupling"
    )]
    NoConvergence { size: usize },
    #[error("sticking has {found} entries, expected {expected}: give one per Jenkins element")]
    WrongPattern { found: usize, expected: usize },
    #[error(
        "waves are modes of a ring with equal sectors only: this disk is an open chain or has contacts on some sectors; ask for its mode shapes"
    )]
    NotCyclic,
    #[error(
        "no shape was found for the mode at angular frequency {angular_frequency}: check for stiffnesses that differ by many orders of magnitude"
    )]
    NoShape { angular_frequency: f64 },
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}

/// One linear mode. Rates in 1/time, angles in rad.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LinearMode {
    /// Imaginary part of the eigenvalue; 0 for an overdamped mode.
    pub angular_frequency: f64,
    /// Damping: minus twice the real part, so that a unit mass has `x'' + damping x' + ...`.
    pub damping: f64,
}

/// Part of the largest eigenvalue below which a damping is rounding. The iteration is backward stable: eigenvalues are off by some roundings
/// 2e-16 of the norm of the matrix, times a factor that grows slowly with its size; 1e-12 holds for hundreds of oscillators, and a growth that slow
/// is beyond any model. Coinciding zeros of rigid-body modes are off by more.
const NEUTRAL: f64 = 1e-12;

/// What the least damping of all modes says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stability {
    Stable,
    /// Zero to rounding, `1e-12` of the largest frequency.
    Neutral,
    Flutter,
}

impl Stability {
    /// Of all modes of a chain.
    #[must_use]
    pub fn of(modes: &[LinearMode]) -> Self {
        let largest = modes.iter().map(|mode| mode.angular_frequency.hypot(0.5 * mode.damping)).fold(0.0, f64::max);
        let least = modes.iter().map(|mode| mode.damping).fold(f64::INFINITY, f64::min);
        match least {
            d if d > NEUTRAL * largest => Self::Stable,
            d if d < -NEUTRAL * largest => Self::Flutter,
            _ => Self::Neutral,
        }
    }
}

impl OscillatorChain {
    /// First-order system matrix of `(x, v)`, 2N x 2N, with the elements marked in `sticking` holding.
    #[must_use]
    pub fn system_matrix(&self, sticking: &[bool]) -> DMatrix<f64> {
        let n = self.oscillators();
        let (stiffness, damping) = (self.stiffness_with(sticking), self.total_damping());
        DMatrix::from_fn(2 * n, 2 * n, |row, column| match (row < n, column < n) {
            (true, true) => 0.0,
            (true, false) => f64::from(u8::from(column - n == row)),
            (false, true) => -stiffness[(row - n, column)] / self.mass()[row - n],
            (false, false) => -damping[(row - n, column - n)] / self.mass()[row - n],
        })
    }

    /// Linear modes in order of angular frequency; a complex pair is one mode, a real eigenvalue is one of its own.
    ///
    /// # Errors
    /// [`ModesError::WrongPattern`] if `sticking` has not one entry per element, [`ModesError::NoConvergence`] if the
    /// eigenvalue iteration fails.
    pub fn linear_modes(&self, sticking: &[bool]) -> Result<Vec<LinearMode>, ModesError> {
        if sticking.len() != self.sliders() {
            return Err(ModesError::WrongPattern { found: sticking.len(), expected: self.sliders() });
        }
        let matrix = self.system_matrix(sticking);
        let size = matrix.nrows();
        let eigenvalues = nalgebra::linalg::Schur::try_new(matrix, f64::EPSILON, 10_000)
            .ok_or(ModesError::NoConvergence { size })?
            .complex_eigenvalues();
        let mut modes: Vec<LinearMode> = eigenvalues
            .iter()
            .filter(|s| s.im >= 0.0)
            .map(|s: &Complex<f64>| LinearMode { angular_frequency: s.im, damping: -2.0 * s.re })
            .collect();
        modes.sort_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency).then(a.damping.total_cmp(&b.damping)));
        Ok(modes)
    }
}

#[cfg(test)]
mod tests {
    use crate::model::{RigParameters, TwoMassRig};

    #[test]
    fn sticking_frequencies_are_one_and_sqrt_of_one_plus_two_kappa() {
        let p = RigParameters { xi1: 0.0, xi2: 0.0, ..Default::default() };
        let modes = TwoMassRig::new(p).unwrap().chain().linear_modes(&[true]).unwrap();
        let expected = [1.0, (1.0 + 2.0 * p.kappa).sqrt()];
        for (mode, expected) in modes.iter().zip(expected) {
            // Backward error of the QR iteration, a few units in the last place.
            assert!((mode.angular_frequency - expected).abs() < 1e-14);
            assert!(mode.damping.abs() < 1e-14);
        }
        assert_eq!(modes.len(), 2);
    }

    #[test]
    fn the_in_phase_mode_has_damping_xi1_and_the_other_xi2() {
        let p = RigParameters::default();
        let modes = TwoMassRig::new(p).unwrap().chain().linear_modes(&[true]).unwrap();
        assert!((modes[0].damping - p.xi1).abs() < 1e-14);
        assert!((modes[1].damping - p.xi2).abs() < 1e-14);
    }
}
