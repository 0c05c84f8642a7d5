//! Amplitudes of the waves of a ring, or of the standing modes of an open chain, at an instant.
//!
//! With `z_j = x_j - i v_j/w`, which is `q exp(i (w t - j sigma))` in a harmonic wave of angular frequency w, the amplitude of the wave n of
//! a ring and of the mode m of a chain of equal sectors are
//!
//! ```text
//! a_n = |1/N sum_j z_j exp(+i j sigma_n)|,      a_m = |c/N sum_j z_j cos(pi m (j + 1/2)/N)|,   c = 1 for m = 0, else 2
//! ```
//!
//! each seen at a w of its own: exact for harmonic motion at that w, otherwise right up to half the difference between the two, relative.
//! Static displacements, as stuck contacts hold them, are not told from motion and stand in the amplitudes.

use super::bladed_disk::Topology;
use nalgebra::Complex;
use std::f64::consts::TAU;

/// The sums above for a number of blades, their angles computed once.
#[derive(Debug, Clone)]
pub struct Spectrum {
    topology: Topology,
    frequencies: Vec<f64>,
    /// `exp(i 2 pi k/K)` with K = N for a ring, 4 N for a chain.
    circle: Vec<Complex<f64>>,
}

impl Spectrum {
    /// `frequencies` are the w of every wave, by wave number 0 to N - 1, or of every mode.
    #[must_use]
    pub fn new(topology: Topology, frequencies: Vec<f64>) -> Self {
        let blades = frequencies.len();
        let count = match topology {
            Topology::Ring => blades,
            Topology::Chain => 4 * blades,
        };
        let circle = (0..count).map(|k| Complex::from_polar(1.0, TAU * k as f64 / count as f64)).collect();
        Self { topology, frequencies, circle }
    }

    /// Amplitudes by wave number 0 to N - 1 (see [`super::NodalDiameter::index`]) or by mode number 0 to N - 1. Positions and velocities begin
    /// with those of the N blades.
    #[must_use]
    pub fn amplitudes(&self, positions: &[f64], velocities: &[f64]) -> Vec<f64> {
        self.amplitudes_of(|j, w| Complex::new(positions[j], -velocities[j] / w))
    }

    /// The same of complex amplitudes `z(j, w)` of blade j, seen at w.
    #[must_use]
    pub fn amplitudes_of(&self, z: impl Fn(usize, f64) -> Complex<f64>) -> Vec<f64> {
        let count = self.frequencies.len();
        let amplitude = |(n, w): (usize, &f64)| {
            let sum: Complex<f64> = (0..count).map(|j| z(j, *w) * self.weight(n, j)).sum();
            sum.norm() / count as f64
        };
        self.frequencies.iter().enumerate().map(amplitude).collect()
    }

    fn weight(&self, n: usize, j: usize) -> Complex<f64> {
        match self.topology {
            Topology::Ring => self.circle[n * j % self.circle.len()],
            Topology::Chain => {
                let factor = if n == 0 { 1.0 } else { 2.0 };
                Complex::from(factor * self.circle[n * (2 * j + 1) % self.circle.len()].re)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn each_standing_mode_of_a_chain_is_found_with_its_amplitude() {
        let (blades, w) = (7, 1.3);
        for mode in 0..blades {
            let shape = |j: usize| 0.7 * (PI * mode as f64 * (j as f64 + 0.5) / blades as f64).cos();
            // A quarter of the way between largest deflection and largest speed.
            let x: Vec<f64> = (0..blades).map(|j| shape(j) * 0.4_f64.cos()).collect();
            let v: Vec<f64> = (0..blades).map(|j| -w * shape(j) * 0.4_f64.sin()).collect();
            let amplitudes = Spectrum::new(Topology::Chain, vec![w; blades]).amplitudes(&x, &v);
            for (index, amplitude) in amplitudes.iter().enumerate() {
                let expected = if index == mode { 0.7 } else { 0.0 };
                // Rounding of a sum of seven terms.
                assert!((amplitude - expected).abs() < 1e-14, "{mode} {index} {amplitude}");
            }
        }
    }
}
