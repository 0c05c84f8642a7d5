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

impl LinearMode {
    /// The eigenvalues the mode stands for: a conjugate pair, or one that is real.
    pub fn eigenvalues(&self) -> impl Iterator<Item = Complex<f64>> {
        let upper = Complex::new(-0.5 * self.damping, self.angular_frequency);
        let lower = self.oscillates().then(|| upper.conj());
        std::iter::once(upper).chain(lower)
    }

    /// Whether it oscillates at all, however strongly it is damped; otherwise its eigenvalue is real.
    #[must_use]
    pub fn oscillates(&self) -> bool {
        self.angular_frequency > 0.0
    }

    fn size(&self) -> f64 {
        self.angular_frequency.hypot(0.5 * self.damping)
    }
}

/// Part of the largest eigenvalue below which a damping is rounding. The iteration is backward stable: eigenvalues are off by some roundings
/// 2e-16 of the norm of the matrix, times a factor that grows slowly with its size; 1e-12 holds for hundreds of oscillators, and a growth that slow
/// is beyond any model. Coinciding zeros of rigid-body modes are off by more.
pub(super) const NEUTRAL: f64 = 1e-12;

/// What the eigenvalue with the largest real part says. All 2N count, those that do not oscillate as well: a disk can diverge without swinging.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stability {
    Stable,
    /// Real part zero to rounding, `1e-12` of the largest eigenvalue.
    Neutral,
    /// A pair grows.
    Flutter,
    /// A real eigenvalue grows: static divergence, or a node so strongly fed that it no longer swings.
    Divergence,
}

impl Stability {
    /// Of all modes of a chain, those that do not oscillate among them; neutral without any.
    #[must_use]
    pub fn of(modes: &[LinearMode]) -> Self {
        let largest = modes.iter().map(LinearMode::size).fold(0.0, f64::max);
        let leading = modes.iter().min_by(|a, b| a.damping.total_cmp(&b.damping));
        match leading {
            Some(mode) if 0.5 * mode.damping > NEUTRAL * largest => Self::Stable,
            Some(mode) if 0.5 * mode.damping < -NEUTRAL * largest => {
                if mode.angular_frequency > NEUTRAL * largest {
                    Self::Flutter
                } else {
                    Self::Divergence
                }
            }
            _ => Self::Neutral,
        }
    }

    /// Whether small motions grow.
    #[must_use]
    pub fn is_unstable(self) -> bool {
        matches!(self, Self::Flutter | Self::Divergence)
    }

    /// The word for it, as in JSON documents.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Neutral => "neutral",
            Self::Flutter => "flutter",
            Self::Divergence => "divergence",
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

    /// Linear modes in order of angular frequency; a complex pair is one mode, a real eigenvalue is one of its own: 2N eigenvalues in all.
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
    use super::{LinearMode, Stability};
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

    fn modes_at(xi1: f64) -> Vec<LinearMode> {
        let p = RigParameters { xi1, ..Default::default() };
        TwoMassRig::new(p).unwrap().chain().linear_modes(&[true]).unwrap()
    }

    #[test]
    fn a_node_that_does_not_swing_is_seen() {
        // In phase s^2 + xi1 s + 1 = 0: at xi1 = -3 the roots (3 +- sqrt 5)/2, at 3 their negatives; the other mode is damped with xi2.
        let root = |sign: f64| 0.5 * (3.0 + sign * 5.0_f64.sqrt());
        let modes = modes_at(-3.0);
        let mut found: Vec<f64> = modes.iter().flat_map(LinearMode::eigenvalues).map(|s| s.re).collect();
        found.sort_by(f64::total_cmp);
        let expected = [-0.0055, -0.0055, root(-1.0), root(1.0)];
        // Rounding of the QR iteration on numbers of order 3.
        assert!(found.len() == 4 && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-13), "{found:?}");
        assert_eq!(modes.iter().filter(|mode| !mode.oscillates()).count(), 2);
        assert_eq!(Stability::of(&modes), Stability::Divergence);
        assert_eq!(Stability::of(&modes_at(3.0)), Stability::Stable);
        // Negative controls: a pair that grows, and none.
        assert_eq!(
            (Stability::of(&modes_at(-0.1)), Stability::of(&modes_at(0.1))),
            (Stability::Flutter, Stability::Stable)
        );
        assert_eq!(Stability::of(&modes_at(0.0)), Stability::Neutral);
    }
}
