//! Distances of two sampled motions.

use super::CompareError;
use crate::dynamics::{Sample, Trajectory};

/// Pairs of samples at the same times. A motion that diverged may end earlier.
///
/// # Errors
/// [`CompareError`] if times, lengths or the sizes of the states differ, or there are no samples. Times may differ by the rounding of
/// `n dt`, taken as 1e-9 of the time or of one, whichever is larger.
pub fn common_samples<'a>(
    reference: &'a Trajectory,
    tested: &'a Trajectory,
) -> Result<Vec<(&'a Sample, &'a Sample)>, CompareError> {
    let lengths = (reference.samples.len(), tested.samples.len());
    if lengths.0 != lengths.1 && !reference.diverged() && !tested.diverged() {
        return Err(CompareError::DifferentLengths { reference: lengths.0, tested: lengths.1 });
    }
    let pairs: Vec<_> = reference.samples.iter().zip(&tested.samples).collect();
    if pairs.is_empty() {
        return Err(CompareError::Empty);
    }
    for (index, (a, b)) in pairs.iter().enumerate() {
        // Written so that NaN counts as different.
        let same = (a.time - b.time).abs() <= 1e-9 * a.time.abs().max(1.0);
        if !same {
            return Err(CompareError::DifferentTimes { index, reference: a.time, tested: b.time });
        }
        let sizes = (a.state.components().count(), b.state.components().count());
        if sizes.0 != sizes.1 {
            return Err(CompareError::DifferentRigs { reference: sizes.0, tested: sizes.1 });
        }
    }
    Ok(pairs)
}

/// Largest difference of any component of the state over all common samples up to `horizon`; fewer than that if a motion diverged.
///
/// # Errors
/// As [`common_samples`], and [`CompareError::Horizon`] if the horizon is not positive or lies beyond the longer record.
pub fn max_state_error(reference: &Trajectory, tested: &Trajectory, horizon: f64) -> Result<f64, CompareError> {
    let pairs = common_samples(reference, tested)?;
    let end = |motion: &Trajectory| motion.last().map_or(0.0, |sample| sample.time);
    let last = end(reference).max(end(tested));
    let slack = 1e-9 * last.max(1.0);
    if !(horizon > 0.0 && horizon <= last + slack) {
        return Err(CompareError::Horizon { found: horizon, last });
    }
    let within = pairs.iter().take_while(|(a, _)| a.time <= horizon + slack);
    Ok(within.map(|(a, b)| a.state.max_difference(&b.state)).fold(0.0, f64::max))
}
