//! The slow flow, equations (10)-(12) with (16), in complex amplitudes `A_j = a_j e^(i theta_j)`, `x_j ~ Re(A_j e^(i phi))`, `phi' = w`:
//!
//! ```text
//! 2 i w A1' = c1 A1 + c A2,      2 i w A2' = c2 A2 + c A1,      w = w(E(A1, A2, w))
//! ```
//!
//! with c1, c2, c of [`super::limit_cycles`]. This form is regular also where a2 passes through 0, where (12) breaks down. A common
//! phase of both amplitudes is of no effect, so that with `B = A2 e^(-i theta1)` three real states remain, `(a1, Re B, Im B)`:
//!
//! ```text
//! a1' + i a1 theta1' = (c1 a1 + c B)/(2 i w),      B' = (c2 B + c a1)/(2 i w) - i theta1' B
//! ```
//!
//! regular for a1 > 0. Derivatives are exact, those of w through the energy included. The field is continuous; its derivative jumps at a1 = 1.

use super::describing::DescribingFunction;
use super::energy::MechanicalEnergy;
use super::energy_frequency::EnergyFrequency;
use super::error::AveragingError;
use super::limit_cycles::Coefficients;
use crate::model::RigParameters;
use nalgebra::{Complex, Matrix3, Vector3};
use std::sync::Arc;

const I: Complex<f64> = Complex::new(0.0, 1.0);

/// The slow flow for one parameter set.
#[derive(Debug, Clone)]
pub struct SlowFlow {
    parameters: RigParameters,
    frequency: Arc<EnergyFrequency>,
}

/// The reduced field at one slow state `(a1, Re B, Im B)` with its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlowRate {
    pub rate: Vector3<f64>,
    /// `d rate/d (a1, Re B, Im B)`
    pub jacobian: Matrix3<f64>,
    /// `d rate/d xi1`; w(E) does not depend on xi1.
    pub xi1_derivative: Vector3<f64>,
    /// Rate of the phase theta1 of mass 1, relative to the phase integral of w.
    pub phase_rate: f64,
    pub angular_frequency: f64,
}

impl SlowFlow {
    /// `frequency` must be that of the same xi2, kappa and gamma.
    ///
    /// # Errors
    /// [`AveragingError::Parameter`] and [`AveragingError::NoCoupling`].
    pub fn new(parameters: RigParameters, frequency: Arc<EnergyFrequency>) -> Result<Self, AveragingError> {
        let parameters = parameters.validated()?;
        if parameters.kappa <= 0.0 {
            return Err(AveragingError::NoCoupling { kappa: parameters.kappa });
        }
        Ok(Self { parameters, frequency })
    }

    #[must_use]
    pub fn parameters(&self) -> RigParameters {
        self.parameters
    }

    #[must_use]
    pub fn frequency(&self) -> &Arc<EnergyFrequency> {
        &self.frequency
    }

    /// The same with another self-excitation; w(E) stays.
    ///
    /// # Errors
    /// [`AveragingError::Parameter`].
    pub fn with_xi1(&self, xi1: f64) -> Result<Self, AveragingError> {
        Self::new(RigParameters { xi1, ..self.parameters }, Arc::clone(&self.frequency))
    }

    pub(super) fn energy(&self, d: &DescribingFunction, b: [f64; 2]) -> MechanicalEnergy {
        MechanicalEnergy::of(self.frequency.definition(), &self.parameters, d, b)
    }

    /// Averaged mechanical energy and frequency at a slow state.
    #[must_use]
    pub fn energy_and_frequency(&self, slow: &Vector3<f64>) -> (f64, f64) {
        let energy = self.energy(&DescribingFunction::at(slow[0]), [slow[1], slow[2]]);
        let (w, _) = self.frequency.implicit(&energy);
        (energy.at_frequency(w), w)
    }

    /// Distances from the kinks of the field: of the amplitude from 1, and of the energy from the sticking limit.
    pub(super) fn kinks(&self, slow: &Vector3<f64>) -> [f64; 2] {
        let energy = self.energy(&DescribingFunction::at(slow[0]), [slow[1], slow[2]]);
        [slow[0] - 1.0, energy.at_frequency(1.0) - self.frequency.sticking_energy()]
    }

    /// The field and its derivatives at a slow state with `a1 > 0`. Beyond the energies of w(E) the last frequency is held.
    #[must_use]
    pub fn slow_rate(&self, slow: &Vector3<f64>) -> SlowRate {
        self.rate_with(slow, |gain| gain)
    }

    /// As [`Self::slow_rate`], with the derivatives taken while w is held at its value.
    #[must_use]
    pub fn slow_rate_at_held_frequency(&self, slow: &Vector3<f64>) -> SlowRate {
        self.rate_with(slow, |_| 0.0)
    }

    /// `weigh` acts on dw/dE.
    fn rate_with(&self, slow: &Vector3<f64>, weigh: impl Fn(f64) -> f64) -> SlowRate {
        let (a, b) = (slow[0], Complex::new(slow[1], slow[2]));
        let (p, d) = (&self.parameters, DescribingFunction::at(a));
        let energy = self.energy(&d, [b.re, b.im]);
        let (w, gain) = self.frequency.implicit(&energy);
        let gain = weigh(gain);
        let c = Coefficients::new(p, &d, w);
        let scale = -I / (2.0 * w);
        let (g1, g2) = (scale * (c.first * a + c.coupling * b), scale * (c.second * b + c.coupling * a));
        let turn = g1.im / a;
        let b_rate = g2 - I * turn * b;

        let (d1, d2) = (0.5 * (p.xi1 + p.xi2), 0.5 * (p.xi1 - p.xi2));
        let (diagonal_slope, coupling_slope) = (Complex::new(2.0 * w, -d1), Complex::new(0.0, -d2));
        let first_slope = -p.gamma * Complex::new(d.stiffness_slope, d.damping_slope);
        // Derivatives over w at fixed amplitudes.
        let g1_w = scale * (diagonal_slope * a + coupling_slope * b) - g1 / w;
        let g2_w = scale * (diagonal_slope * b + coupling_slope * a) - g2 / w;
        let mut jacobian = Matrix3::zeros();
        let directions = [(1.0, Complex::new(0.0, 0.0)), (0.0, Complex::new(1.0, 0.0)), (0.0, I)];
        for (column, (da, db)) in directions.into_iter().enumerate() {
            let dw = gain * (energy.potential_gradient[column] + w * w * energy.inertia_gradient[column]);
            let dg1 = scale * (first_slope * da * a + c.first * da + c.coupling * db) + g1_w * dw;
            let dg2 = scale * (c.second * db + c.coupling * da) + g2_w * dw;
            let dturn = (dg1.im - turn * da) / a;
            let db_rate = dg2 - I * (dturn * b + turn * db);
            jacobian.set_column(column, &Vector3::new(dg1.re, db_rate.re, db_rate.im));
        }
        // c1, c2 and c all change by -i w/2.
        let g_xi1 = -0.25 * (a + b);
        let b_xi1 = g_xi1 - I * (g_xi1.im / a) * b;
        SlowRate {
            rate: Vector3::new(g1.re, b_rate.re, b_rate.im),
            jacobian,
            xi1_derivative: Vector3::new(g_xi1.re, b_xi1.re, b_xi1.im),
            phase_rate: turn,
            angular_frequency: w,
        }
    }
}
