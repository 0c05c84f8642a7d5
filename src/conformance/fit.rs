//! Frequencies and dampings of a sampled linear motion, from positions alone, by least squares:
//!
//! ```text
//! x(t) = sum_k exp(-d_k t/2) (A_k cos w_k t + B_k sin w_k t)
//! ```
//!
//! Gauss-Newton steps over windows that double, from two periods on, so that a wrong first guess of the frequency does not leave the
//! valley. No interpolation between samples enters: what is fitted is exact for a linear difference equation.

use crate::model::LinearMode;
use nalgebra::{DMatrix, DVector};

/// Gauss-Newton steps per window: convergence is quadratic, since the model fits.
const STEPS: usize = 12;

/// Modes of positions `x` at times `n dt`, starting from the guesses; `None` if the fit does not converge.
#[must_use]
pub fn fit_modes(x: &[f64], dt: f64, guess: &[LinearMode]) -> Option<Vec<LinearMode>> {
    let slowest = guess.iter().map(|mode| mode.angular_frequency).fold(f64::INFINITY, f64::min);
    let mut window = (2.0 * std::f64::consts::TAU / slowest / dt).ceil() as usize + 1;
    let mut modes = guess.to_vec();
    loop {
        let samples = &x[..window.min(x.len())];
        for _ in 0..STEPS {
            modes = improved(samples, dt, &modes)?;
        }
        if window >= x.len() {
            return Some(modes);
        }
        window *= 2;
    }
}

/// One Gauss-Newton step: amplitudes from the linear fit with the modes given, then all unknowns together.
fn improved(x: &[f64], dt: f64, modes: &[LinearMode]) -> Option<Vec<LinearMode>> {
    let basis = |n: usize, mode: &LinearMode| {
        let t = n as f64 * dt;
        let decay = (-0.5 * mode.damping * t).exp();
        let (sine, cosine) = (mode.angular_frequency * t).sin_cos();
        (t, decay * cosine, decay * sine)
    };
    let linear = DMatrix::from_fn(x.len(), 2 * modes.len(), |n, column| {
        let (_, cosine, sine) = basis(n, &modes[column / 2]);
        if column % 2 == 0 { cosine } else { sine }
    });
    let amplitudes = least_squares(&linear, &DVector::from_column_slice(x))?;
    let residual = DVector::from_column_slice(x) - &linear * &amplitudes;
    let full = DMatrix::from_fn(x.len(), 4 * modes.len(), |n, column| {
        let k = column / 4;
        let (t, cosine, sine) = basis(n, &modes[k]);
        let (a, b) = (amplitudes[2 * k], amplitudes[2 * k + 1]);
        match column % 4 {
            0 => cosine,
            1 => sine,
            2 => -0.5 * t * (a * cosine + b * sine),
            _ => t * (b * cosine - a * sine),
        }
    });
    let change = least_squares(&full, &residual)?;
    let modes: Vec<LinearMode> = modes
        .iter()
        .enumerate()
        .map(|(k, mode)| LinearMode {
            damping: mode.damping + change[4 * k + 2],
            angular_frequency: mode.angular_frequency + change[4 * k + 3],
        })
        .collect();
    modes.iter().all(|mode| mode.damping.is_finite() && mode.angular_frequency.is_finite()).then_some(modes)
}

/// By QR, which does not square the condition number.
fn least_squares(matrix: &DMatrix<f64>, values: &DVector<f64>) -> Option<DVector<f64>> {
    let (columns, qr) = (matrix.ncols(), matrix.clone().qr());
    let projected = qr.q().tr_mul(values);
    qr.r().view((0, 0), (columns, columns)).solve_upper_triangular(&projected.rows(0, columns))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_close_modes_are_separated_to_rounding() {
        let truth = [(1.0, 0.011, 1.1), (-0.06, 1.0, 0.9)];
        let (w, d) = ([1.0, 1.0954], [-0.06, 0.011]);
        let x: Vec<f64> = (0..1500)
            .map(|n| {
                let t = 0.1 * f64::from(n);
                (0..2)
                    .map(|k| (-0.5 * d[k] * t).exp() * (truth[k].0 * (w[k] * t).cos() + truth[k].2 * (w[k] * t).sin()))
                    .sum()
            })
            .collect();
        let guess = [(0.99, 0.0), (1.11, 0.0)].map(|(w, d)| LinearMode { angular_frequency: w, damping: d });
        let found = fit_modes(&x, 0.1, &guess).unwrap();
        for k in 0..2 {
            // Rounding of 1500 values that grow to 90, over 150 time units.
            assert!((found[k].angular_frequency - w[k]).abs() < 1e-12, "{found:?}");
            assert!((found[k].damping - d[k]).abs() < 1e-12, "{found:?}");
        }
    }
}
