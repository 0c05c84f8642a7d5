//! Averaged mechanical energy, equation (15), with `B = A2 e^(-i theta1)`:
//!
//! ```text
//! E = 1/4 (1-g+k) a1^2 + 1/4 (1+k) |B|^2 - 1/2 k a1 Re B + U(a1) + 1/4 w^2 (a1^2 + |B|^2)
//! ```
//!
//! The paper leaves open what U, the averaged potential energy in the Jenkins spring, is. Neither definition here gives its Table 1
//! to the printed digits; both come near.

use super::describing::DescribingFunction;
use crate::model::RigParameters;
use serde::{Deserialize, Serialize};

/// What is taken for the averaged energy of the Jenkins spring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EnergyDefinition {
    /// The mean over a cycle of what the spring holds, `U = (g/2) <f^2>`.
    #[default]
    MeanPotential,
    /// The mean of what the equivalent linear spring would hold, `U = (g/4) keq a1^2`.
    EquivalentStiffness,
}

impl EnergyDefinition {
    /// U and its slope over a1.
    fn spring(self, gamma: f64, d: &DescribingFunction) -> (f64, f64) {
        match self {
            Self::MeanPotential => {
                let (square, slope) = d.mean_square_force();
                (0.5 * gamma * square, 0.5 * gamma * slope)
            }
            Self::EquivalentStiffness => {
                let a = d.amplitude;
                let slope = d.stiffness_slope * a * a + 2.0 * d.stiffness * a;
                (0.25 * gamma * d.stiffness * a * a, 0.25 * gamma * slope)
            }
        }
    }
}

/// `E = potential + w^2 inertia` at one slow state, and the gradients of both over `(a1, Re B, Im B)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MechanicalEnergy {
    pub(super) potential: f64,
    pub(super) potential_gradient: [f64; 3],
    pub(super) inertia: f64,
    pub(super) inertia_gradient: [f64; 3],
}

impl MechanicalEnergy {
    pub(super) fn of(
        definition: EnergyDefinition,
        parameters: &RigParameters,
        d: &DescribingFunction,
        [re, im]: [f64; 2],
    ) -> Self {
        let (g, k, a) = (parameters.gamma, parameters.kappa, d.amplitude);
        let (spring, spring_slope) = definition.spring(g, d);
        let second = re * re + im * im;
        Self {
            potential: 0.25 * (1.0 - g + k) * a * a + 0.25 * (1.0 + k) * second - 0.5 * k * a * re + spring,
            potential_gradient: [
                0.5 * (1.0 - g + k) * a - 0.5 * k * re + spring_slope,
                0.5 * (1.0 + k) * re - 0.5 * k * a,
                0.5 * (1.0 + k) * im,
            ],
            inertia: 0.25 * (a * a + second),
            inertia_gradient: [0.5 * a, 0.5 * re, 0.5 * im],
        }
    }

    pub(super) fn at_frequency(&self, w: f64) -> f64 {
        self.potential + w * w * self.inertia
    }
}
