//! Perturbation results for weak coupling and damping, equations (25)-(30): `kappa = O(e)`, `xi1, xi2 = O(e^2)`, `gamma = O(1)`,
//!
//! ```text
//! tau  = pi - u,    u = sqrt(-2 pi xi1/g)                                                       + O(e^3)   (25)
//! rho  = a2/a1 = 1 + (xi1^2 - xi1 xi2)/(2 k^2) - (2/(3 k)) sqrt(-2 pi xi1^3/g)                 + O(e^4)   (26)
//! Dth  = theta1 - theta2 = xi1/k                                                              + O(e^3)   (27)
//! w    = 1                                                                                    + O(e^3)   (28)
//! l1   = -2 g/pi - [ (9 xi1 + xi2) g - pi k^2 + 2 k sqrt(-2 pi g xi1) ]/(4 g)                   + O(e^3)   (29)
//! l2,3 = +- i k/sqrt 2 - [ -(xi1 - 3 xi2) g + pi k^2 - 2 k sqrt(-2 pi g xi1) ]/(8 g)             + O(e^3)   (30)
//! ```
//!
//! The square roots in (29) and (30) have the opposite sign in the paper's text, with which (30) would allow no secondary Hopf point; (31), the
//! zero of the real part of (30), is right there. The real part of (30) is good to O(e^4) while w is held, and to O(e^3) with w(E).

use crate::model::RigParameters;
use nalgebra::Complex;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// The limit cycle and its eigenvalues in the slow flow, by perturbation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PerturbedLimitCycle {
    /// Sticking angle tau, rad.
    pub sticking_angle: f64,
    /// a2/a1
    pub amplitude_ratio: f64,
    /// theta1 - theta2, rad.
    pub phase_difference: f64,
    pub angular_frequency: f64,
    /// Of the amplitude, real.
    pub first_eigenvalue: f64,
    /// Of the pair, the one with positive imaginary part.
    pub pair_eigenvalue: Complex<f64>,
}

impl PerturbedLimitCycle {
    /// `None` where there is no limit cycle to expand around: `xi1 >= 0` or no coupling.
    #[must_use]
    pub fn of(parameters: &RigParameters) -> Option<Self> {
        let RigParameters { xi1, xi2, kappa: k, gamma: g } = *parameters;
        if !(xi1 < 0.0 && k > 0.0) {
            return None;
        }
        let root = 2.0 * k * (-2.0 * PI * g * xi1).sqrt();
        Some(Self {
            sticking_angle: PI - (-2.0 * PI * xi1 / g).sqrt(),
            amplitude_ratio: 1.0 + (xi1 * xi1 - xi1 * xi2) / (2.0 * k * k)
                - 2.0 / (3.0 * k) * (-2.0 * PI * xi1.powi(3) / g).sqrt(),
            phase_difference: xi1 / k,
            angular_frequency: 1.0,
            first_eigenvalue: -2.0 * g / PI - ((9.0 * xi1 + xi2) * g - PI * k * k + root) / (4.0 * g),
            pair_eigenvalue: Complex::new(-(-(xi1 - 3.0 * xi2) * g + PI * k * k - root) / (8.0 * g), k * FRAC_1_SQRT_2),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pair_is_neutral_where_equation_31_says() {
        let nominal = RigParameters::default();
        let hopf = nominal.analytic_hopf().unwrap();
        for xi1 in [hopf.start, hopf.end] {
            let found = PerturbedLimitCycle::of(&RigParameters { xi1, ..nominal }).unwrap();
            // Roundings of terms of order 0.01.
            assert!(found.pair_eigenvalue.re.abs() < 1e-16, "{xi1} {found:?}");
        }
    }

    #[test]
    fn the_printed_sign_would_allow_no_hopf_point() {
        let nominal = RigParameters::default();
        for n in 1..1000 {
            let xi1 = -1e-3 * f64::from(n);
            let p = RigParameters { xi1, ..nominal };
            let root = 2.0 * p.kappa * (-2.0 * PI * p.gamma * xi1).sqrt();
            let corrected = PerturbedLimitCycle::of(&p).unwrap().pair_eigenvalue.re;
            // The square root enters with +root/(8 gamma); printed: with -root/(8 gamma).
            assert!(corrected - 2.0 * root / (8.0 * p.gamma) < 0.0, "{xi1}");
        }
    }
}
