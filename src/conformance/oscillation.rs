//! Damping and frequency of a sampled free oscillation, from positions alone, since engines disagree about the time their velocities
//! belong to.
//!
//! ```text
//! peaks     parabola through three samples:   ln(peak_j) = c - (xi/2) t_j        least squares, x'' + xi x' + w0^2 x = 0
//! zeros     cubic through four samples:       w = 2 pi (n - 1)/(t_n - t_1)       upward zeros, the damped frequency
//! ```

use std::f64::consts::TAU;

/// Damping `xi` and angular frequency of an oscillation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillation {
    pub damping: f64,
    pub angular_frequency: f64,
}

impl Oscillation {
    /// Of equidistant samples; `None` with fewer than three maxima or upward zeros.
    #[must_use]
    pub fn of(positions: &[f64], step: f64) -> Option<Self> {
        let zeros = upward_zeros(positions, step);
        let [first, _, .., last] = zeros.as_slice() else { return None };
        let peaks: Vec<(f64, f64)> = maxima(positions, step).into_iter().map(|(t, value)| (t, value.ln())).collect();
        if peaks.len() < 3 {
            return None;
        }
        let angular_frequency = TAU * (zeros.len() - 1) as f64 / (last - first);
        Some(Self { damping: -2.0 * slope(&peaks), angular_frequency })
    }
}

/// Times and values of the positive maxima.
#[must_use]
pub fn maxima(positions: &[f64], step: f64) -> Vec<(f64, f64)> {
    let triples = positions.windows(3).enumerate();
    triples
        .filter(|(_, x)| x[1] > 0.0 && x[1] > x[0] && x[1] >= x[2])
        .map(|(n, x)| {
            let (rise, bend) = (0.5 * (x[2] - x[0]), x[0] - 2.0 * x[1] + x[2]);
            let s = -rise / bend;
            ((n as f64 + 1.0 + s) * step, x[1] + 0.5 * rise * s)
        })
        .collect()
}

/// Times of the upward zeros.
#[must_use]
pub fn upward_zeros(positions: &[f64], step: f64) -> Vec<f64> {
    let quadruples = positions.windows(4).enumerate();
    quadruples
        .filter(|(_, x)| x[1] < 0.0 && x[2] >= 0.0)
        .map(|(n, x)| (n as f64 + 1.0 + zero_of_cubic([x[0], x[1], x[2], x[3]])) * step)
        .collect()
}

/// Zero in [0, 1] of the cubic with the given values at -1, 0, 1, 2.
fn zero_of_cubic([a, b, c, d]: [f64; 4]) -> f64 {
    let value = |s: f64| {
        let lagrange = -s * (s - 1.0) * (s - 2.0) / 6.0 * a + (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0 * b;
        lagrange - (s + 1.0) * s * (s - 2.0) / 2.0 * c + (s + 1.0) * s * (s - 1.0) / 6.0 * d
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if value(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Least-squares slope.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let covariance: f64 = points.iter().map(|p| (p.0 - mean.0) * (p.1 - mean.1)).sum();
    covariance / points.iter().map(|p| (p.0 - mean.0).powi(2)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damping_and_frequency_of_a_decaying_cosine_are_found() {
        let (xi, w, step) = (0.003, 1.02, 1.0 / 60.0);
        let x: Vec<f64> = (0..6000).map(|n| n as f64 * step).map(|t| (-0.5 * xi * t).exp() * (w * t).cos()).collect();
        let found = Oscillation::of(&x, step).unwrap();
        // Parabola: step^4/384 = 2e-10 of a peak, over a decay of 0.15; cubic: smaller still.
        assert!((found.damping - xi).abs() < 1e-8, "{found:?}");
        assert!((found.angular_frequency - w).abs() < 1e-9, "{found:?}");
        assert_eq!(Oscillation::of(&x[..300], step), None);
    }
}
