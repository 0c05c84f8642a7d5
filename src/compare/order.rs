//! Observed order of convergence, p in `error ~ C step^p`.

use super::CompareError;

/// Orders over a ladder of steps.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ObservedOrder {
    /// Least-squares slope of log(error) over log(step).
    pub slope: f64,
    /// Slope between each step and the next finer one, coarse to fine.
    pub pairwise: Vec<f64>,
}

/// The order of `(step, error)` pairs, in any sequence.
///
/// # Errors
/// [`CompareError::OutOfRange`] unless all steps and errors are finite and positive; [`CompareError::ShortLadder`] with fewer than two
/// different steps. An error of exactly zero has no order: the ladder reached the floor of rounding.
pub fn observed_order(ladder: &[(f64, f64)]) -> Result<ObservedOrder, CompareError> {
    for &(step, error) in ladder {
        for (field, found) in [("step", step), ("error", error)] {
            if !(found.is_finite() && found > 0.0) {
                return Err(CompareError::OutOfRange { field, found, allowed: "finite and greater than 0" });
            }
        }
    }
    let mut logs: Vec<(f64, f64)> = ladder.iter().map(|(step, error)| (step.ln(), error.ln())).collect();
    logs.sort_by(|a, b| b.0.total_cmp(&a.0));
    let distinct = logs.windows(2).filter(|pair| pair[0].0 != pair[1].0).count() + usize::from(!logs.is_empty());
    if distinct < 2 || distinct < logs.len() {
        return Err(CompareError::ShortLadder { found: distinct, needed: logs.len().max(2) });
    }
    let count = logs.len() as f64;
    let mean = logs.iter().fold((0.0, 0.0), |sum, log| (sum.0 + log.0 / count, sum.1 + log.1 / count));
    let covariance: f64 = logs.iter().map(|log| (log.0 - mean.0) * (log.1 - mean.1)).sum();
    let variance: f64 = logs.iter().map(|log| (log.0 - mean.0).powi(2)).sum();
    let pairwise = logs.windows(2).map(|pair| (pair[0].1 - pair[1].1) / (pair[0].0 - pair[1].0)).collect();
    Ok(ObservedOrder { slope: covariance / variance, pairwise })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_gives_its_exponent() {
        let ladder: Vec<_> = [0.5f64, 0.1, 0.25, 0.01].iter().map(|&h| (h, 3.0 * h.powf(1.5))).collect();
        let order = observed_order(&ladder).unwrap();
        // Rounding of logarithms.
        assert!((order.slope - 1.5).abs() < 1e-12);
        assert_eq!(order.pairwise.len(), 3);
        assert!(order.pairwise.iter().all(|p| (p - 1.5).abs() < 1e-12));
    }

    #[test]
    fn zero_errors_and_single_steps_have_no_order() {
        assert!(observed_order(&[(0.1, 0.0), (0.2, 1.0)]).is_err());
        assert!(observed_order(&[(0.1, f64::NAN), (0.2, 1.0)]).is_err());
        assert!(observed_order(&[(0.1, 1.0)]).is_err());
        assert!(observed_order(&[(0.1, 1.0), (0.1, 2.0)]).is_err());
        assert!(observed_order(&[]).is_err());
    }
}
