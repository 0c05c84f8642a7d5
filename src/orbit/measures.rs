//! What an orbit is like over its period: largest displacements and mean energy.
//!
//! `a1` and `a2` are the largest |x1| and |x2| on the orbit; the energy is that of the ledger, averaged over a period by the
//! trapezoidal rule, whose error for a periodic function with continuous first derivative is of third order in the sample interval.

use super::error::OrbitError;
use super::shooting::PeriodicOrbit;
use crate::dynamics::{Flow, Sample, Sampling};

/// Samples a period: extremes between two of them are found by Hermite interpolation, to about (2 pi/400)^4/384 = 2e-10.
const SAMPLES: f64 = 400.0;

/// Amplitudes and mean energy of a periodic orbit of the two-mass rig.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitMeasures {
    pub amplitude1: f64,
    pub amplitude2: f64,
    pub mean_energy: f64,
}

impl PeriodicOrbit {
    /// # Errors
    /// [`OrbitError::Flow`] if the flow fails along the orbit.
    pub fn measures<F: Flow>(&self, flow: &F) -> Result<OrbitMeasures, OrbitError> {
        let sampling = Sampling { interval: self.period / SAMPLES, t_end: self.period };
        let samples = flow
            .trajectory(&self.reversal(), sampling)
            .map_err(|source| OrbitError::Flow { period: self.period, source: Box::new(source) })?
            .samples;
        let energy: f64 = samples.windows(2).map(|w| 0.5 * (w[0].ledger.stored + w[1].ledger.stored)).sum();
        Ok(OrbitMeasures {
            amplitude1: largest(&samples, 0),
            amplitude2: largest(&samples, 1),
            mean_energy: energy / (samples.len() as f64 - 1.0),
        })
    }
}

/// Largest |x| of one mass over the samples and the extremes between them.
fn largest(samples: &[Sample], mass: usize) -> f64 {
    let at_samples = samples.iter().map(|s| s.state.positions[mass].abs());
    let between = samples.windows(2).filter_map(|w| extreme(&w[0], &w[1], mass)).map(f64::abs);
    at_samples.chain(between).fold(0.0, f64::max)
}

/// Value of the cubic through two samples where its slope vanishes, by the secant through the two velocities and one Newton step
/// less than would matter: the value at an extreme is insensitive to its place.
fn extreme(left: &Sample, right: &Sample, mass: usize) -> Option<f64> {
    let (v0, v1) = (left.state.velocities[mass], right.state.velocities[mass]);
    if v0 * v1 >= 0.0 {
        return None;
    }
    let (h, s) = (right.time - left.time, v0 / (v0 - v1));
    let (x0, x1, r) = (left.state.positions[mass], right.state.positions[mass], 1.0 - s);
    Some(r * r * ((1.0 + 2.0 * s) * x0 + s * h * v0) + s * s * ((3.0 - 2.0 * s) * x1 - r * h * v1))
}
