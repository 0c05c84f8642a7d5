//! The energy ledger of a sampled motion, for the difference equation: what its residual must be in the engine.
//!
//! ```text
//! residual = E(t) - E(0) - W,   W += -1/2 (C v_0 + C v_1) . dx - sum_j R_j f_j s_j,   s_j = du_j - (R_j/k_j) df_j  where f_j ended at its limit
//! ```
//!
//! C all damping, the trapezoidal rule from step to step. Of order h^2 where the motion is, and together with what holding forces over
//! substeps pumps in. Assumes a symmetric stiffness, whose forces do no work around a loop.

use crate::dynamics::{Sample, Trajectory};
use crate::model::OscillatorChain;

/// Largest residual over every `stride`-th sample of a motion of which every step is a sample.
#[must_use]
pub fn energy_residual(chain: &OscillatorChain, motion: &Trajectory, stride: usize) -> f64 {
    let damping = chain.total_damping();
    let stored = |sample: &Sample| {
        let state = &sample.state;
        chain.stored_energy(&state.positions, &state.velocities, &state.slider_forces)
    };
    let Some(first) = motion.samples.first().map(stored) else { return 0.0 };
    let (mut work, mut largest) = (0.0, 0.0f64);
    for (k, pair) in motion.samples.windows(2).enumerate() {
        let (a, b) = (&pair[0].state, &pair[1].state);
        for i in 0..chain.oscillators() {
            let dx = b.positions[i] - a.positions[i];
            work -= (0..chain.oscillators())
                .map(|j| 0.5 * damping[(i, j)] * (a.velocities[j] + b.velocities[j]) * dx)
                .sum::<f64>();
        }
        for (j, element) in chain.jenkins().iter().enumerate() {
            let (before, after) = (a.slider_forces[j], b.slider_forces[j]);
            if after.abs() >= 1.0 {
                let at = |positions: &[f64]| element.attachment.elongation(positions);
                let slid = at(&b.positions) - at(&a.positions) - (after - before) / element.normalised_stiffness();
                work -= element.slip_force * after * slid;
            }
        }
        if (k + 1) % stride == 0 {
            largest = largest.max((stored(&pair[1]) - first - work).abs());
        }
    }
    largest
}
