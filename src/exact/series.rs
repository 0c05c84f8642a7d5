//! A function on one cell `[0, span]` as its Taylor polynomial,
//!
//! ```text
//! e(t) = sum_k q_k t^k,   |e''| <= M2 = sum_k k (k-1) |q_k| span^(k-2),   |e'''| <= M3 likewise.
//! ```
//!
//! Assumption: the fastest rate of the system times `span` is at most 1/2, so that the first term left out is below
//! (1/2)^17/17! = 2e-20 of the motion's scale: the polynomial is the function to rounding, and the bounds are those of the
//! function.

/// Highest power kept.
pub(super) const ORDER: usize = 16;

/// Values below this many roundings of the function's scale cannot be told from zero.
const ROUNDINGS: f64 = 16.0;

#[derive(Debug, Clone, Copy)]
pub(super) struct Series {
    coefficients: [f64; ORDER + 1],
    pub(super) span: f64,
    /// Bound on the second derivative over the cell.
    pub(super) curvature_bound: f64,
    /// Bound on the third derivative over the cell.
    pub(super) jerk_bound: f64,
    /// What counts as zero.
    pub(super) tolerance: f64,
    /// What counts as zero among the terms of the motion alone, without the constant it starts from.
    motion_tolerance: f64,
}

/// Value and first two derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) slope: f64,
    pub(super) curvature: f64,
}

impl Series {
    /// `scale`: size of the terms from which the function is computed, which sets its rounding error.
    pub(super) fn new(coefficients: [f64; ORDER + 1], span: f64, scale: f64) -> Self {
        let (mut curvature_bound, mut jerk_bound) = (0.0, 0.0);
        for k in (2..=ORDER).rev() {
            let factor = (k * (k - 1)) as f64;
            curvature_bound = curvature_bound * span + factor * coefficients[k].abs();
            if k > 2 {
                jerk_bound = jerk_bound * span + factor * (k - 2) as f64 * coefficients[k].abs();
            }
        }
        let tolerance = ROUNDINGS * f64::EPSILON * scale;
        Self { coefficients, span, curvature_bound, jerk_bound, tolerance, motion_tolerance: tolerance }
    }

    /// The same function, of a motion whose terms are of another size than `scale` of [`Self::new`]: their rounding decides
    /// which derivatives of a function that starts at zero are zero.
    pub(super) fn of_motion(self, scale: f64) -> Self {
        Self { motion_tolerance: ROUNDINGS * f64::EPSILON * scale, ..self }
    }

    /// For a function that is exactly zero at the start: the function over `t^n`, n the order of its first derivative there
    /// that rounding lets tell from zero. It crosses zero where the function does, and its value at the start has the sign the
    /// function takes next. `None` where the function does not start at zero; the zero function where no derivative is left.
    pub(super) fn deflated(&self) -> Option<Self> {
        if self.coefficients[0] != 0.0 {
            return None;
        }
        let mut power = 1.0;
        let mut order = 0;
        while order < ORDER && self.coefficients[order].abs() * power <= self.motion_tolerance {
            power *= self.span;
            order += 1;
        }
        let mut coefficients = [0.0; ORDER + 1];
        coefficients[..=ORDER - order].copy_from_slice(&self.coefficients[order..]);
        let scale = self.motion_tolerance / (ROUNDINGS * f64::EPSILON) / power;
        Some(Self::new(coefficients, self.span, scale))
    }

    pub(super) fn at(&self, t: f64) -> Jet {
        let (mut value, mut slope, mut half_curvature) = (0.0, 0.0, 0.0);
        for &q in self.coefficients.iter().rev() {
            half_curvature = half_curvature * t + slope;
            slope = slope * t + value;
            value = value * t + q;
        }
        Jet { value, slope, curvature: 2.0 * half_curvature }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_of_the_sine_has_its_values_derivatives_and_bounds() {
        let mut coefficients = [0.0; ORDER + 1];
        let mut term = 1.0;
        for k in 1..=ORDER {
            term /= k as f64;
            coefficients[k] = [0.0, term, 0.0, -term][k % 4];
        }
        let series = Series::new(coefficients, 0.5, 1.0);
        for t in [0.0, 0.1, 0.37, 0.5_f64] {
            let jet = series.at(t);
            // Rounding of a sum of terms below 1.
            assert!((jet.value - t.sin()).abs() < 1e-16);
            assert!((jet.slope - t.cos()).abs() < 3e-16);
            assert!((jet.curvature + t.sin()).abs() < 3e-16);
        }
        assert!(series.curvature_bound >= 0.5_f64.sin() && series.curvature_bound < 0.6);
        assert!(series.jerk_bound >= 1.0 && series.jerk_bound < 1.2);
    }
}
