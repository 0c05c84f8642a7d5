//! Piecewise Chebyshev interpolation of a smooth function on `[0, end]`, to rounding where the panels are short enough.
//!
//! Panels are graded, edges at `end (j/P)^2`, because the functions here vary fastest near 0.

use std::f64::consts::PI;

/// Points of a panel; degree plus one.
const POINTS: usize = 12;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Panels {
    end: f64,
    panels: Vec<Panel>,
}

#[derive(Debug, Clone, PartialEq)]
struct Panel {
    middle: f64,
    half_width: f64,
    value: [f64; POINTS],
    slope: [f64; POINTS],
}

impl Panels {
    /// Interpolates `function`, called from 0 to `end` in order.
    pub(super) fn through<E>(
        end: f64,
        count: usize,
        mut function: impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<Self, E> {
        let edge = |j: usize| end * (j as f64 / count as f64).powi(2);
        let panels = (0..count)
            .map(|j| {
                let (middle, half_width) = (0.5 * (edge(j) + edge(j + 1)), 0.5 * (edge(j + 1) - edge(j)));
                let mut samples = [0.0; POINTS];
                for (k, sample) in samples.iter_mut().enumerate() {
                    // Chebyshev points of the first kind, from left to right.
                    let angle = PI * (k as f64 + 0.5) / POINTS as f64;
                    *sample = function(middle - half_width * angle.cos())?;
                }
                let value = coefficients(&samples);
                Ok(Panel { middle, half_width, value, slope: differentiated(&value, half_width) })
            })
            .collect::<Result<_, E>>()?;
        Ok(Self { end, panels })
    }

    /// Value and slope at `x` in `[0, end]`.
    pub(super) fn evaluate(&self, x: f64) -> (f64, f64) {
        let position = (x / self.end).sqrt() * self.panels.len() as f64;
        // One of the two panels at an edge, whichever rounding takes.
        let panel = &self.panels[(position as usize).min(self.panels.len() - 1)];
        let t = (x - panel.middle) / panel.half_width;
        (clenshaw(&panel.value, t), clenshaw(&panel.slope, t))
    }
}

/// Chebyshev coefficients from values at `-cos(pi (k + 1/2)/n)`.
fn coefficients(samples: &[f64; POINTS]) -> [f64; POINTS] {
    let n = POINTS as f64;
    std::array::from_fn(|j| {
        let term = |(k, sample): (usize, &f64)| sample * (j as f64 * PI * (1.0 - (k as f64 + 0.5) / n)).cos();
        let sum: f64 = samples.iter().enumerate().map(term).sum();
        sum * if j == 0 { 1.0 } else { 2.0 } / n
    })
}

/// Coefficients of the derivative: `b_(j-1) = b_(j+1) + 2 j a_j`, with `b_0` halved.
fn differentiated(a: &[f64; POINTS], half_width: f64) -> [f64; POINTS] {
    let mut b = [0.0; POINTS + 1];
    for j in (1..POINTS).rev() {
        b[j - 1] = b[j + 1] + 2.0 * j as f64 * a[j];
    }
    b[0] *= 0.5;
    std::array::from_fn(|j| b[j] / half_width)
}

fn clenshaw(coefficients: &[f64; POINTS], t: f64) -> f64 {
    let (mut next, mut after) = (0.0, 0.0);
    for c in coefficients[1..].iter().rev() {
        (next, after) = (c + 2.0 * t * next - after, next);
    }
    coefficients[0] + t * next - after
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_function_and_its_slope_are_interpolated_to_rounding() {
        let function = |x: f64| (3.0 * x).sin() / (1.0 + x);
        let slope = |x: f64| 3.0 * (3.0 * x).cos() / (1.0 + x) - (3.0 * x).sin() / (1.0 + x).powi(2);
        let found = Panels::through::<()>(5.0, 60, |x| Ok(function(x))).unwrap();
        for n in 0..=1000 {
            let x = 0.005 * f64::from(n);
            let (value, rate) = found.evaluate(x);
            // Roundings of numbers of order 1; those of the slope are divided by the half width, 1e-3 at the least.
            assert!((value - function(x)).abs() < 1e-14, "{x}");
            assert!((rate - slope(x)).abs() < 1e-11, "{x}");
        }
    }
}
