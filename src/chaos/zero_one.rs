//! The 0-1 test for chaos: G. A. Gottwald, I. Melbourne, *On the implementation of the 0-1 test for chaos*, SIAM Journal on
//! Applied Dynamical Systems 8 (2009) 129-145.
//!
//! A series `s_1, ..., s_N` drives the translations
//!
//! ```text
//! p_c(n) = sum_{j<=n} s_j cos(j c),   q_c(n) = sum_{j<=n} s_j sin(j c),
//! M_c(n) = mean over j <= N - n0 of [p(j+n) - p(j)]^2 + [q(j+n) - q(j)]^2,   n <= n0 = N/10
//! D_c(n) = M_c(n) - (mean s)^2 (1 - cos(n c))/(1 - cos c)
//! ```
//!
//! which stay bounded for regular motions and diffuse for chaotic ones. `K_c` is the correlation of `D_c` with `n`, and `K` the
//! median over [`FREQUENCIES`] values of c between pi/5 and 4 pi/5, spread by the golden ratio: no random numbers. K is near 0 for
//! regular and near 1 for chaotic motion. The series must not be oversampled: take returns on the slow section, not the
//! motion itself.

use super::error::ChaosError;

const FREQUENCIES: usize = 100;
/// Shortest series: n0 = 20 points to correlate.
const SHORTEST: usize = 200;
/// 1/golden ratio: multiples modulo 1 are spread evenly and hit no resonance.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// The indicator K: near 0 for regular, near 1 for chaotic series.
///
/// # Errors
/// [`ChaosError::TooShort`] for fewer than 200 values.
pub fn zero_one_test(series: &[f64]) -> Result<f64, ChaosError> {
    if series.len() < SHORTEST {
        let (quantity, of) = ("the 0-1 test", "values");
        return Err(ChaosError::TooShort { quantity, of, needed: SHORTEST, found: series.len() });
    }
    let mut indicators: Vec<f64> = (1..=FREQUENCIES)
        .map(|i| std::f64::consts::PI * (0.2 + 0.6 * (i as f64 * GOLDEN).fract()))
        .map(|c| correlation_with_time(&displacements(series, c)))
        .collect();
    indicators.sort_by(f64::total_cmp);
    Ok(0.5 * (indicators[FREQUENCIES / 2 - 1] + indicators[FREQUENCIES / 2]))
}

/// `D_c(n)` for n = 1, ..., n0.
fn displacements(series: &[f64], c: f64) -> Vec<f64> {
    let mut path = Vec::with_capacity(series.len());
    let (mut p, mut q) = (0.0, 0.0);
    for (j, s) in (1_u32..).zip(series) {
        let (sine, cosine) = (f64::from(j) * c).sin_cos();
        p += s * cosine;
        q += s * sine;
        path.push((p, q));
    }
    let longest = series.len() / 10;
    let kept = series.len() - longest;
    let mean = series.iter().sum::<f64>() / series.len() as f64;
    (1..=longest)
        .map(|n| {
            let pairs = path[..kept].iter().zip(&path[n..]);
            let squares: f64 = pairs.map(|(a, b)| (b.0 - a.0).powi(2) + (b.1 - a.1).powi(2)).sum();
            squares / kept as f64 - mean * mean * (1.0 - (n as f64 * c).cos()) / (1.0 - c.cos())
        })
        .collect()
}

/// Correlation coefficient of the values with 1, 2, 3, ...; a constant series has none, and is regular: 0.
fn correlation_with_time(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let (mean_n, mean) = (0.5 * (count + 1.0), values.iter().sum::<f64>() / count);
    let (mut covariance, mut variance_n, mut variance) = (0.0, 0.0, 0.0);
    for (n, value) in (1_u32..).zip(values) {
        let (dn, dv) = (f64::from(n) - mean_n, value - mean);
        covariance += dn * dv;
        variance_n += dn * dn;
        variance += dv * dv;
    }
    if variance > 0.0 { covariance / (variance_n * variance).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn logistic(parameter: f64) -> Vec<f64> {
        let orbit = std::iter::successors(Some(0.3), |x| Some(parameter * x * (1.0 - x)));
        orbit.skip(500).take(2000).collect()
    }

    #[test]
    fn the_logistic_map_is_told_apart_by_its_parameter() {
        // Gottwald & Melbourne, Fig. 1-2: regular at 3.55, chaotic at 3.97; their threshold between is about 0.5.
        assert!(zero_one_test(&logistic(3.55)).unwrap().abs() < 0.1);
        assert!(zero_one_test(&logistic(3.97)).unwrap() > 0.95);
    }

    #[test]
    fn a_quasi_periodic_series_is_regular() {
        let series: Vec<f64> =
            (0..2000).map(f64::from).map(|n| (0.7 * n).cos() + 0.4 * (1.9 * n + 1.0).cos()).collect();
        assert!(zero_one_test(&series).unwrap().abs() < 0.1);
    }

    #[test]
    fn a_short_series_is_refused() {
        assert!(matches!(zero_one_test(&[1.0; 199]), Err(ChaosError::TooShort { found: 199, .. })));
    }
}
