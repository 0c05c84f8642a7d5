//! A chain of N oscillators with any number of Jenkins elements:
//!
//! ```text
//! M x'' + (D + S) x' + K x + sum_j R_j f_j b_j = 0,     |f_j| <= 1
//! ```
//!
//! with `M` diagonal, `D` the passive damping, `S` the self-excitation (negative damping), `K` the linear stiffness without the
//! Jenkins springs, and `b_j` the direction of element j. `D`, `S` and `K` may be non-symmetric: aerodynamic
//! influence coefficients are. Units are free but must agree; the paper's non-dimensional ones come from [`super::TwoMassRig`].

use super::jenkins::JenkinsElement;
use nalgebra::{DMatrix, DVector};

/// The system every solver is handed. Built by [`super::ChainBuilder`], valid by construction.
#[derive(Debug, Clone, PartialEq)]
pub struct OscillatorChain {
    pub(super) mass: DVector<f64>,
    pub(super) stiffness: DMatrix<f64>,
    pub(super) damping: DMatrix<f64>,
    pub(super) self_excitation: DMatrix<f64>,
    pub(super) jenkins: Vec<JenkinsElement>,
}

impl OscillatorChain {
    /// Number N of oscillators.
    #[must_use]
    pub fn oscillators(&self) -> usize {
        self.mass.len()
    }

    /// Number of Jenkins elements.
    #[must_use]
    pub fn sliders(&self) -> usize {
        self.jenkins.len()
    }

    /// Masses, length N.
    #[must_use]
    pub fn mass(&self) -> &DVector<f64> {
        &self.mass
    }

    /// Linear stiffness without the Jenkins springs, N x N.
    #[must_use]
    pub fn stiffness(&self) -> &DMatrix<f64> {
        &self.stiffness
    }

    /// Passive damping, N x N.
    #[must_use]
    pub fn damping(&self) -> &DMatrix<f64> {
        &self.damping
    }

    /// Self-excitation: the part of the damping that feeds energy in, N x N, negative where it excites.
    #[must_use]
    pub fn self_excitation(&self) -> &DMatrix<f64> {
        &self.self_excitation
    }

    /// All that is proportional to velocity, `D + S`.
    #[must_use]
    pub fn total_damping(&self) -> DMatrix<f64> {
        &self.damping + &self.self_excitation
    }

    #[must_use]
    pub fn jenkins(&self) -> &[JenkinsElement] {
        &self.jenkins
    }

    /// Stiffness with the springs of the elements marked in `sticking` (one entry per element) added, N x N.
    #[must_use]
    pub fn stiffness_with(&self, sticking: &[bool]) -> DMatrix<f64> {
        let mut total = self.stiffness.clone();
        for (element, _) in self.jenkins.iter().zip(sticking).filter(|(_, stuck)| **stuck) {
            // k b b^T: of the few entries of b, not of all.
            for (i, bi) in element.attachment.direction() {
                for (j, bj) in element.attachment.direction() {
                    total[(i, j)] += element.stiffness * bi * bj;
                }
            }
        }
        total
    }

    /// Accelerations for given positions, velocities (length N) and slider forces (one per element).
    #[must_use]
    pub fn acceleration(&self, positions: &[f64], velocities: &[f64], slider_forces: &[f64]) -> Vec<f64> {
        let x = DVector::from_column_slice(positions);
        let v = DVector::from_column_slice(velocities);
        let mut force = -(&self.stiffness * x + self.total_damping() * v);
        for (element, f) in self.jenkins.iter().zip(slider_forces) {
            element.attachment.scatter(-element.slip_force * f, force.as_mut_slice());
        }
        force.component_div(&self.mass).as_slice().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use crate::model::{Attachment, ChainBuilder, JenkinsElement};

    #[test]
    fn acceleration_follows_the_equation_of_motion() {
        let chain = ChainBuilder::new(vec![2.0, 1.0])
            .ground_spring(0, 3.0)
            .coupling_spring(0, 1, 5.0)
            .self_excited(1, -0.5)
            .coupling_damper(0, 1, 0.25)
            .jenkins(JenkinsElement { attachment: Attachment::Between(1, 0), stiffness: 1.0, slip_force: 4.0 })
            .build()
            .unwrap();
        // Forces on the masses by hand: x = (1, 2), v = (3, 4), f = 0.5.
        let first = -3.0 * 1.0 - 5.0 * (1.0 - 2.0) - 0.25 * (3.0 - 4.0) + 4.0 * 0.5;
        let second = -5.0 * (2.0 - 1.0) + 0.5 * 4.0 - 0.25 * (4.0 - 3.0) - 4.0 * 0.5;
        assert_eq!(chain.acceleration(&[1.0, 2.0], &[3.0, 4.0], &[0.5]), vec![first / 2.0, second]);
    }
}
