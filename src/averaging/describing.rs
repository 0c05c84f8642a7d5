//! Describing function of the Jenkins element, equations (13)-(14).
//!
//! For `x = a cos(psi)` with `a > 1` the element sticks for the angle `tau` after each reversal and slips for the rest of the half cycle;
//! the first harmonic of its force is that of a spring and a damper,
//!
//! ```text
//! tau = arccos(1 - 2/a),   keq = (2 tau - sin 2 tau)/(2 pi),   w deq = sin^2(tau)/pi,
//! ```
//!
//! and for `a <= 1` it is a spring: `tau = pi`. At `a = 1` the damping has a kink; in `tau` everything is smooth. The mean square of the
//! force over a cycle, from which its averaged potential energy follows, is
//!
//! ```text
//! <f^2> = [ (1-a)^2 tau + 2 a (1-a) sin tau + a^2 (tau/2 + sin(2 tau)/4) + pi - tau ] / pi    (a^2/2 for a <= 1).
//! ```

use std::f64::consts::PI;

/// Spring and damper equivalent to the element at one amplitude, with derivatives over the amplitude. All per unit of stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DescribingFunction {
    pub amplitude: f64,
    /// `keq`
    pub stiffness: f64,
    pub stiffness_slope: f64,
    /// `w deq`: damping coefficient times angular frequency.
    pub damping: f64,
    pub damping_slope: f64,
}

impl DescribingFunction {
    /// At an amplitude `a >= 0` of the elongation, in units of the elongation at which slip begins.
    #[must_use]
    pub fn at(amplitude: f64) -> Self {
        if amplitude <= 1.0 {
            return Self { amplitude, stiffness: 1.0, stiffness_slope: 0.0, damping: 0.0, damping_slope: 0.0 };
        }
        let (sine, cosine, tau) = angles(amplitude);
        // d tau/da = -2/(a^2 sin tau)
        Self {
            amplitude,
            stiffness: (tau - sine * cosine) / PI,
            stiffness_slope: -4.0 * sine / (PI * amplitude * amplitude),
            damping: sine * sine / PI,
            damping_slope: -4.0 * cosine / (PI * amplitude * amplitude),
        }
    }

    /// At a sticking angle `tau` over (0, pi].
    #[must_use]
    pub fn at_angle(tau: f64) -> Self {
        if tau >= PI {
            return Self::at(1.0);
        }
        Self::at(amplitude_at(tau))
    }

    /// Mean square of the normalised force and its slope over the amplitude.
    #[must_use]
    pub fn mean_square_force(&self) -> (f64, f64) {
        let a = self.amplitude;
        if a <= 1.0 {
            return (0.5 * a * a, a);
        }
        let (sine, cosine, tau) = angles(a);
        let half = 0.5 * (tau + sine * cosine);
        let square = (1.0 - a).powi(2) * tau + 2.0 * a * (1.0 - a) * sine + a * a * half + PI - tau;
        // The derivative over tau vanishes: f = -1 at tau.
        let slope = -2.0 * (1.0 - a) * tau + (2.0 - 4.0 * a) * sine + 2.0 * a * half;
        (square / PI, slope / PI)
    }
}

/// Amplitude at which the element sticks for the angle `tau` over (0, pi]: `2/(1 - cos tau)`.
pub(super) fn amplitude_at(tau: f64) -> f64 {
    (0.5 * tau).sin().powi(-2)
}

/// Sine, cosine and angle `tau` for `a > 1`, without cancellation near `a = 1`.
fn angles(a: f64) -> (f64, f64, f64) {
    let sine = 2.0 * (a - 1.0).sqrt() / a;
    let cosine = 1.0 - 2.0 / a;
    (sine, cosine, sine.atan2(cosine))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Force of the steady hysteresis at angle psi in [0, pi], from the reversal at f = +1.
    fn force(a: f64, psi: f64) -> f64 {
        if a <= 1.0 { a * psi.cos() } else { (1.0 - a + a * psi.cos()).max(-1.0) }
    }

    /// Trapezoidal rule over half a cycle, the other half being its mirror image.
    fn mean(a: f64, weight: impl Fn(f64) -> f64) -> f64 {
        let n = 200_000;
        let at = |i: usize| PI * i as f64 / n as f64;
        let ends = 0.5 * (weight(0.0) * force(a, 0.0) + weight(PI) * force(a, PI));
        ((1..n).map(|i| weight(at(i)) * force(a, at(i))).sum::<f64>() + ends) / n as f64
    }

    #[test]
    fn the_first_harmonic_of_the_hysteresis_is_the_describing_function() {
        for a in [0.4, 1.0, 1.05, 2.0, 7.0] {
            let found = DescribingFunction::at(a);
            // Trapezoidal rule with one kink: (pi/n)^2 = 2.5e-10.
            assert!((2.0 * mean(a, f64::cos) / a - found.stiffness).abs() < 1e-9, "{a}");
            // The force leads: -sin(psi) is the phase of the velocity.
            assert!((-2.0 * mean(a, f64::sin) / a - found.damping).abs() < 1e-9, "{a}");
            let n = 200_000;
            let square = (0..n).map(|i| force(a, PI * (i as f64 + 0.5) / n as f64).powi(2)).sum::<f64>() / n as f64;
            assert!((square - found.mean_square_force().0).abs() < 1e-9, "{a}");
        }
    }

    #[test]
    fn slopes_agree_with_finite_differences() {
        let step = 1e-5;
        for a in [0.5, 1.2, 2.0, 5.0, 30.0] {
            let (up, down, here) =
                (DescribingFunction::at(a + step), DescribingFunction::at(a - step), DescribingFunction::at(a));
            let slope = |value: fn(&DescribingFunction) -> f64| (value(&up) - value(&down)) / (2.0 * step);
            // Central differences: step^2 and roundings over the step, both near 1e-10.
            assert!((slope(|d| d.stiffness) - here.stiffness_slope).abs() < 1e-8, "{a}");
            assert!((slope(|d| d.damping) - here.damping_slope).abs() < 1e-8, "{a}");
            assert!((slope(|d| d.mean_square_force().0) - here.mean_square_force().1).abs() < 1e-8, "{a}");
        }
    }

    #[test]
    fn the_sticking_angle_is_that_of_equation_14() {
        for a in [1.0001, 1.5, 2.0, 40.0] {
            // The arc cosine loses half the digits near pi.
            assert!((angles(a).2 - crate::model::sticking_angle(a)).abs() < 1e-13, "{a}");
            assert!((amplitude_at(angles(a).2) - a).abs() < 1e-14 * a * a, "{a}");
        }
    }

    #[test]
    fn damping_is_largest_at_the_right_angle() {
        let found = DescribingFunction::at_angle(0.5 * PI);
        // Roundings of numbers of order 1.
        assert!((found.damping - 1.0 / PI).abs() < 1e-15 && (found.stiffness - 0.5).abs() < 1e-15);
        assert!(found.damping_slope.abs() < 1e-15);
    }
}
