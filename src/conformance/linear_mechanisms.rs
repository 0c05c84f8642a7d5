//! Numerical damping and frequency of one oscillator, `m x'' + c x' + k x = 0`, with its spring and damper realised by each of Rapier's
//! mechanisms, beside closed forms.
//!
//! The closed forms are those of the linear step map that each mechanism amounts to. With `w0^2 = k/m`, `xi = c/m` and, for Rapier's own
//! springs, the substep `d = h/n`:
//!
//! ```text
//! hook       w+ = w - h (w0^2 x + xi w),  x+ = x + h w - h^2 b (w0^2 x + xi w),   b = (n + 1)/(2 n)
//!            det = 1 + w0^2 h^2 (1 - b) - xi h
//! native     w+ = w - d (w0^2 (x + d w+) + xi w+),  x+ = x + d w+                 (backward Euler), n times
//!            det = 1/(1 + xi d + w0^2 d^2)
//!
//! xi_num = -ln(det)/h,   w_num = arccos(trace/(2 sqrt(det)))/h     (for one substep: ln(det)/d, .../d)
//! ```
//!
//! and to leading order in the step
//!
//! ```text
//! hook       xi_num - xi = -w0^2 h (1 - b) + xi^2 h/2,     w_num/w0 - 1 = w0^2 h^2 (1/24 - 3 (1 - b)^2/8 - b (1 - b)/4)   (xi = 0)
//! native     xi_num - xi = +w0^2 h/n - xi^2 h/(2 n),       w_num/w0 - 1 = -w0^2 h^2/(3 n^2)                               (xi = 0)
//! ```

use super::ConformanceError;
use super::oscillation::Oscillation;
use super::scenario::Bench;
use crate::engine::EngineSettings;
use crate::engine::mechanism::{GroundSpring, LinearMechanism, MechanismRig, MechanismSample};
use crate::model::ChainBuilder;

/// The oscillator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillator {
    pub mass: f64,
    pub stiffness: f64,
    /// Force per speed; may be negative.
    pub damping: f64,
}

impl Oscillator {
    /// Unit mass and stiffness, no damping.
    #[must_use]
    pub fn unit() -> Self {
        Self { mass: 1.0, stiffness: 1.0, damping: 0.0 }
    }

    fn squared_frequency(self) -> f64 {
        self.stiffness / self.mass
    }

    fn xi(self) -> f64 {
        self.damping / self.mass
    }

    /// Damping and damped frequency of the true motion.
    #[must_use]
    pub fn exact(self) -> Oscillation {
        let xi = self.xi();
        Oscillation { damping: xi, angular_frequency: (self.squared_frequency() - 0.25 * xi * xi).sqrt() }
    }
}

/// Closed form of the step map's damping and frequency.
#[must_use]
pub fn step_map(mechanism: LinearMechanism, oscillator: Oscillator, step: f64, substeps: usize) -> Oscillation {
    let (w2, xi) = (oscillator.squared_frequency(), oscillator.xi());
    // `det - 1`, and the parts of the eigenvalue `trace/2 + i root`, `root^2 = det - trace^2/4`, each expanded so that nothing cancels: at fine
    // steps the logarithm of det and the arc cosine of trace/(2 sqrt(det)) would know nothing but rounding.
    let (log_det, real, imaginary, time) = match mechanism {
        LinearMechanism::Hook => {
            let b = weight(substeps);
            let z = b * w2 * step;
            let root = 0.5 * step * (4.0 * w2 - xi * xi - z * z - 2.0 * xi * z).sqrt();
            let log_det = (w2 * step * step * (1.0 - b) - xi * step).ln_1p();
            (log_det, 1.0 - 0.5 * step * (xi + z), root, step)
        }
        _ => {
            let d = step / substeps as f64;
            // Both parts over det, which leaves the angle as it is.
            let log_det = -(xi * d + w2 * d * d).ln_1p();
            (log_det, 1.0 + 0.5 * xi * d, d * (w2 - 0.25 * xi * xi).sqrt(), d)
        }
    };
    Oscillation { damping: -log_det / time, angular_frequency: imaginary.atan2(real) / time }
}

/// Leading order of `xi_num - xi`.
#[must_use]
pub fn damping_error(mechanism: LinearMechanism, oscillator: Oscillator, step: f64, substeps: usize) -> f64 {
    let (w2, xi) = (oscillator.squared_frequency(), oscillator.xi());
    match mechanism {
        LinearMechanism::Hook => -w2 * step * (1.0 - weight(substeps)) + 0.5 * xi * xi * step,
        _ => (w2 - 0.5 * xi * xi) * step / substeps as f64,
    }
}

/// Leading order of `w_num/w0 - 1` without damping.
#[must_use]
pub fn frequency_shift(mechanism: LinearMechanism, oscillator: Oscillator, step: f64, substeps: usize) -> f64 {
    let z2 = oscillator.squared_frequency() * step * step;
    match mechanism {
        LinearMechanism::Hook => {
            let b = weight(substeps);
            z2 * (1.0 / 24.0 - 0.375 * (1.0 - b).powi(2) - 0.25 * b * (1.0 - b))
        }
        _ => -z2 / (3.0 * (substeps * substeps) as f64),
    }
}

/// `(n + 1)/(2 n)`.
fn weight(substeps: usize) -> f64 {
    (substeps as f64 + 1.0) / (2.0 * substeps as f64)
}

/// Damping and frequency that the engine's motion shows over `duration`, started at rest at 0.5: a growing
/// motion must stay within the rest length of spring joints, which know no sign.
///
/// # Errors
/// [`EngineError::Unavailable`](crate::engine::EngineError::Unavailable) where Rapier does not have the mechanism, and whatever stops the
/// engine.
pub fn measure(
    bench: &dyn Bench,
    mechanism: LinearMechanism,
    oscillator: Oscillator,
    settings: EngineSettings,
    duration: f64,
) -> Result<Option<Oscillation>, ConformanceError> {
    let chain = ChainBuilder::new(vec![oscillator.mass]).build()?;
    let Oscillator { stiffness, damping, .. } = oscillator;
    let rig = MechanismRig {
        springs: vec![GroundSpring { carriage: 0, stiffness, damping, mechanism }],
        ..MechanismRig::of(chain)
    };
    let steps = (duration / settings.step).round() as u64;
    let motion = bench.native(rig, settings)?.run(&MechanismSample::single(0.5, 0.0), steps, 1)?;
    let positions: Vec<f64> = motion.samples.iter().map(|sample| sample.positions[0]).collect();
    Ok(Oscillation::of(&positions, settings.step))
}
