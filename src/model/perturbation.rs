//! Closed-form critical damping of the secondary Hopf bifurcation, equations (31)-(32):
//!
//! ```text
//! xi1 = 3 xi2 ( 1 - nu (1 -+ (2 sqrt 2/3) sqrt(1 - 3/nu)) ),   nu = pi kappa^2/(gamma xi2)
//! ```
//!
//! for kappa = O(e), xi = O(e^2), gamma = O(1). The upper sign is the point where the limit cycle loses stability, the lower the one where it
//! regains it; both exist for nu >= 3 and meet in a cusp at nu = 3.

use super::rig::RigParameters;

/// The two critical values of xi1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnalyticHopf {
    pub start: f64,
    pub end: f64,
}

impl RigParameters {
    /// Equation (31); `None` where it has no solution (`nu < 3`, or `xi2 <= 0`).
    #[must_use]
    pub fn analytic_hopf(&self) -> Option<AnalyticHopf> {
        let nu = std::f64::consts::PI * self.kappa * self.kappa / (self.gamma * self.xi2);
        if !(self.xi2 > 0.0 && nu >= 3.0) {
            return None;
        }
        let root = 2.0 * std::f64::consts::SQRT_2 / 3.0 * (1.0 - 3.0 / nu).sqrt();
        let at = |sign: f64| 3.0 * self.xi2 * (1.0 - nu * (1.0 - sign * root));
        Some(AnalyticHopf { start: at(1.0), end: at(-1.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nominal_set_has_the_published_critical_damping() {
        // Evaluated outside this project to the digits given.
        let found = RigParameters::default().analytic_hopf().unwrap();
        assert!((found.start - -0.033_040_98).abs() < 5e-9 && (found.end - -0.277_950_14).abs() < 5e-9, "{found:?}");
    }

    #[test]
    fn the_two_meet_at_nu_three_and_vanish_below() {
        let at = |nu: f64| {
            let kappa = (nu * 0.5 * 0.011 / std::f64::consts::PI).sqrt();
            RigParameters { kappa, ..Default::default() }.analytic_hopf()
        };
        assert_eq!(at(2.999), None);
        let cusp = at(3.0 + 1e-12).unwrap();
        // They part as the square root of the distance to the cusp: 1e-6 times 0.2.
        assert!((cusp.start - cusp.end).abs() < 1e-6);
        assert!((cusp.start - 3.0 * 0.011 * (1.0 - 3.0)).abs() < 1e-6);
    }
}
