//! Functions `sum_h Re U_h exp(i h theta)` over odd h = 1, 3, 5, ..., given by their amplitudes `U_h`.

use nalgebra::Complex;
use std::f64::consts::PI;

pub(super) type C = Complex<f64>;

/// The function at theta.
pub(super) fn value(u: &[C], theta: f64) -> f64 {
    let (mut turn, step) = (C::from_polar(1.0, theta), C::from_polar(1.0, 2.0 * theta));
    let mut sum = 0.0;
    for c in u {
        sum += (c * turn).re;
        turn *= step;
    }
    sum
}

/// Largest value of a function with odd harmonics: the best of a grid, then Newton's method on the derivative.
pub(super) fn largest(x: &[C]) -> f64 {
    let nodes = 64;
    let grid = (0..nodes).map(|n| 2.0 * PI * f64::from(n) / f64::from(nodes));
    let mut theta = grid.max_by(|a, b| value(x, *a).total_cmp(&value(x, *b))).unwrap_or(0.0);
    let derivative = |times: u32| -> Vec<C> {
        x.iter().enumerate().map(|(k, c)| c * (C::i() * (2 * k + 1) as f64).powu(times)).collect()
    };
    let (slope, curvature) = (derivative(1), derivative(2));
    for _ in 0..20 {
        let step = value(&slope, theta) / value(&curvature, theta);
        // A grid point beside the maximum lies within half a node of it; NaN ends the search too.
        if step.abs() >= 0.2 || step.is_nan() {
            break;
        }
        theta -= step;
    }
    value(x, theta)
}
