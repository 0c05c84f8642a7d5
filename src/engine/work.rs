//! Works of the elements from one instant to the next, force times displacement by the trapezoidal rule:
//!
//! ```text
//! W_damping = -1/2 (D v_0 + D v_1) . dx,   likewise S and skew(K) x,   W_drive = 1/2 (F_0 + F_1) dx_0,
//! W_friction = -sum_j R_j f_j s_j,   s_j = du_j - (R_j/k_j) df_j  the way the slider went, where f_j ended at its limit.
//! ```
//!
//! The residual of the ledger is of second order in the step for the second-order scheme: the quadrature, the recorded velocities and the
//! stored energy all are. It measures the solver together with this quadrature.

use super::instant::Instant;
use crate::model::{OscillatorChain, SparseMatrix, Works};

/// Computes works; keeps the matrices and room for the forces.
#[derive(Debug, Clone)]
pub(super) struct WorkMeter {
    chain: OscillatorChain,
    damping: SparseMatrix,
    self_excitation: SparseMatrix,
    skew_stiffness: SparseMatrix,
    forces: Vec<f64>,
}

impl WorkMeter {
    pub fn new(chain: &OscillatorChain) -> Self {
        let skew_stiffness = 0.5 * (chain.stiffness() - chain.stiffness().transpose());
        let [damping, self_excitation, skew_stiffness] =
            [chain.damping(), chain.self_excitation(), &skew_stiffness].map(SparseMatrix::of);
        let forces = vec![0.0; chain.oscillators()];
        Self { chain: chain.clone(), damping, self_excitation, skew_stiffness, forces }
    }

    pub fn between(&mut self, from: &Instant, to: &Instant) -> Works {
        let (a, b) = (&from.state, &to.state);
        let dx = |i: usize| b.positions[i] - a.positions[i];
        let mut trapezoid = |matrix: &SparseMatrix, first: &[f64], second: &[f64]| {
            self.forces.fill(0.0);
            matrix.subtract_product(first, &mut self.forces);
            matrix.subtract_product(second, &mut self.forces);
            0.5 * self.forces.iter().enumerate().map(|(i, force)| force * dx(i)).sum::<f64>()
        };
        Works {
            damping: trapezoid(&self.damping, &a.velocities, &b.velocities),
            self_excitation: trapezoid(&self.self_excitation, &a.velocities, &b.velocities),
            circulatory: trapezoid(&self.skew_stiffness, &a.positions, &b.positions),
            friction: self.friction(from, to),
            drive: 0.5 * (from.drive_force + to.drive_force) * dx(0),
        }
    }

    fn friction(&self, from: &Instant, to: &Instant) -> f64 {
        let (a, b) = (&from.state, &to.state);
        let mut work = 0.0;
        for (j, element) in self.chain.jenkins().iter().enumerate() {
            let f = b.slider_forces[j];
            if f.abs() >= 1.0 {
                let du = element.attachment.elongation(&b.positions) - element.attachment.elongation(&a.positions);
                let slid = du - (f - a.slider_forces[j]) / element.normalised_stiffness();
                work -= element.slip_force * f * slid;
            }
        }
        work
    }
}
