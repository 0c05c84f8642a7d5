//! Energy ledger: what is stored, and what each kind of element put in.
//!
//! ```text
//! E = 1/2 v^T M v + 1/2 x^T sym(K) x + sum_j R_j^2 f_j^2 / (2 k_j)
//! E(t) - E(0) = W_damping + W_self_excitation + W_circulatory + W_friction + W_drive
//! dW_damping = -v^T D v dt,  dW_self_excitation = -v^T S v dt,  dW_circulatory = -v^T skew(K) x dt,
//! dW_friction = -sum_j R_j |u_j'| dt over the slip phases,  dW_drive = F v dt where a force F prescribes a motion
//! ```
//!
//! All works are done *on* the system: self-excitation is positive, friction negative. The difference of the two sides is
//! the residual, which measures the error of a solver without a reference.

use super::chain::OscillatorChain;
use nalgebra::DVector;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Work done on the system since the start, by kind of element, in units of energy.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Works {
    /// Passive damping, not positive.
    pub damping: f64,
    /// Negative damping, positive where it feeds the motion.
    pub self_excitation: f64,
    /// The antisymmetric part of the stiffness.
    pub circulatory: f64,
    /// Sliding friction, not positive.
    pub friction: f64,
    /// Whoever prescribes a motion, either sign; zero for a free system.
    #[serde(default)]
    pub drive: f64,
}

impl Works {
    #[must_use]
    pub fn total(&self) -> f64 {
        self.damping + self.self_excitation + self.circulatory + self.friction + self.drive
    }
}

impl AddAssign for Works {
    fn add_assign(&mut self, other: Self) {
        self.damping += other.damping;
        self.self_excitation += other.self_excitation;
        self.circulatory += other.circulatory;
        self.friction += other.friction;
        self.drive += other.drive;
    }
}

/// Stored energy and the works since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct EnergyLedger {
    pub stored: f64,
    pub stored_at_start: f64,
    pub works: Works,
}

impl EnergyLedger {
    #[must_use]
    pub fn opened_with(stored: f64) -> Self {
        Self { stored, stored_at_start: stored, works: Works::default() }
    }

    /// `E(t) - E(0) - W`: zero for an exact solution.
    #[must_use]
    pub fn residual(&self) -> f64 {
        self.stored - self.stored_at_start - self.works.total()
    }
}

impl OscillatorChain {
    /// Stored energy for given positions, velocities (length N) and slider forces (one per element).
    #[must_use]
    pub fn stored_energy(&self, positions: &[f64], velocities: &[f64], slider_forces: &[f64]) -> f64 {
        let x = DVector::from_column_slice(positions);
        let kinetic: f64 = self.mass().iter().zip(velocities).map(|(m, v)| 0.5 * m * v * v).sum();
        let elastic = 0.5 * x.dot(&(self.stiffness() * &x));
        let sliders: f64 = self.jenkins().iter().zip(slider_forces).map(|(element, &f)| element.stored_energy(f)).sum();
        kinetic + elastic + sliders
    }

    /// `v^T (K - K^T)/2 x` pair by pair: exactly zero for a symmetric stiffness, and without a matrix of its own.
    fn circulatory_power(&self, x: &[f64], v: &[f64]) -> f64 {
        let (n, k) = (self.oscillators(), self.stiffness());
        let pair = |i: usize, j: usize| (k[(i, j)] - k[(j, i)]) * (v[i] * x[j] - v[j] * x[i]);
        (0..n).map(|i| (0..i).map(|j| 0.5 * pair(i, j)).sum::<f64>()).sum()
    }

    /// Power fed in by damping, self-excitation and circulatory stiffness (friction and drive are left at zero: the one acts by slip, the other from outside).
    #[must_use]
    pub fn powers(&self, positions: &[f64], velocities: &[f64]) -> Works {
        let v = DVector::from_column_slice(velocities);
        Works {
            damping: -v.dot(&(self.damping() * &v)),
            self_excitation: -v.dot(&(self.self_excitation() * &v)),
            circulatory: -self.circulatory_power(positions, velocities),
            friction: 0.0,
            drive: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::model::{RigParameters, TwoMassRig};

    #[test]
    fn the_two_mass_energy_is_the_one_of_the_paper() {
        let p = RigParameters::default();
        let rig = TwoMassRig::new(p).unwrap();
        let ([x1, x2], [v1, v2], f) = ([1.2, -0.7], [0.3, 0.9], 0.6);
        let expected = 0.5 * (v1 * v1 + v2 * v2)
            + 0.5 * ((1.0 - p.gamma + p.kappa) * x1 * x1 - 2.0 * p.kappa * x1 * x2 + (1.0 + p.kappa) * x2 * x2)
            + 0.5 * p.gamma * f * f;
        let found = rig.chain().stored_energy(&[x1, x2], &[v1, v2], &[f]);
        // Rounding of a sum of six terms below 1.
        assert!((found - expected).abs() < 1e-15);
    }

    #[test]
    fn in_phase_motion_is_fed_by_xi1_alone() {
        let p = RigParameters::default();
        let powers = TwoMassRig::new(p).unwrap().chain().powers(&[0.0, 0.0], &[2.0, 2.0]);
        assert_eq!(powers.damping, 0.0);
        assert_eq!(powers.self_excitation, -p.xi1 * 8.0);
    }
}
