//! First-harmonic estimate of the limit cycle, equations (13)-(14), (25)-(27).
//!
//! For `x1 = a cos(w t)` the element slips for the angle `tau = arccos(1 - 2/a)` after each reversal until slip, and its
//! equivalent damping balances the self-excitation at leading order when
//!
//! ```text
//! tau* = pi - sqrt(-2 pi xi1/gamma),   a2/a1 ~ 1,   theta1 - theta2 ~ xi1/kappa.
//! ```
//!
//! Good for small `|xi1|`; used to start Newton's method there, never as a result.

use super::rig::RigParameters;

/// Amplitudes and phase of the first-harmonic limit cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HarmonicEstimate {
    pub amplitude1: f64,
    pub amplitude2: f64,
    /// theta1 - theta2, rad.
    pub phase_difference: f64,
    pub angular_frequency: f64,
}

/// Angle from reversal to slip over `(0, pi]`, equation (14). `pi` where the element never slips.
#[must_use]
pub fn sticking_angle(amplitude: f64) -> f64 {
    if amplitude > 1.0 { (1.0 - 2.0 / amplitude).acos() } else { std::f64::consts::PI }
}

impl RigParameters {
    /// Leading-order limit cycle; `None` where perturbation theory has none (`xi1 >= 0`, or self-excitation too strong, or
    /// no coupling).
    #[must_use]
    pub fn harmonic_estimate(&self) -> Option<HarmonicEstimate> {
        let pi = std::f64::consts::PI;
        if self.xi1 >= 0.0 || self.kappa <= 0.0 {
            return None;
        }
        let tau = pi - (-2.0 * pi * self.xi1 / self.gamma).sqrt();
        if tau <= 0.5 * pi {
            return None;
        }
        let amplitude1 = 2.0 / (1.0 - tau.cos());
        let ratio = 1.0 + (self.xi1 * self.xi1 - self.xi1 * self.xi2) / (2.0 * self.kappa * self.kappa)
            - 2.0 / (3.0 * self.kappa) * (-2.0 * pi * self.xi1.powi(3) / self.gamma).sqrt();
        Some(HarmonicEstimate {
            amplitude1,
            amplitude2: ratio * amplitude1,
            phase_difference: self.xi1 / self.kappa,
            angular_frequency: 1.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_equivalent_damping_of_the_estimate_balances_the_self_excitation() {
        // Work of friction per cycle 4 gamma (a - 1) against pi xi1 (a1^2 + a2^2) of the self-excitation: leading order in u.
        let p = RigParameters { xi1: -0.001, ..Default::default() };
        let e = p.harmonic_estimate().unwrap();
        let friction = 4.0 * p.gamma * (e.amplitude1 - 1.0);
        let excitation = -p.xi1 * std::f64::consts::PI * (e.amplitude1.powi(2) + e.amplitude2.powi(2));
        // Next order in u = sqrt(-2 pi xi1/gamma) = 0.11 is relative u^2 = 1.3 %.
        assert!((friction / excitation - 1.0).abs() < 0.02, "{friction} {excitation}");
    }

    #[test]
    fn the_sticking_angle_is_continuous_at_the_sticking_limit() {
        assert_eq!(sticking_angle(1.0), std::f64::consts::PI);
        assert!((sticking_angle(2.0) - 0.5 * std::f64::consts::PI).abs() < 1e-15);
    }
}
