//! Averages of a motion that does not repeat, and their statistical errors by means over batches:
//!
//! ```text
//! error = s/sqrt(B),   s the standard deviation of the averages over B successive parts of the record
//! ```
//!
//! Parts must be longer than the motion remembers; then their averages are independent.

use crate::compare::Cycles;
use crate::dynamics::Trajectory;
use crate::model::OscillatorChain;
use std::f64::consts::TAU;

/// Parts of a record: enough to know the standard deviation to 14 %.
pub(super) const BATCHES: usize = 25;
/// Fewest values in a part.
const FEWEST: usize = 20;

/// An average with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Estimate {
    pub value: f64,
    pub error: f64,
}

/// What is averaged, in this order.
pub(super) const QUANTITIES: [&str; 7] = [
    "mean_maximum",
    "tenth_percentile_of_maxima",
    "median_of_maxima",
    "ninetieth_percentile_of_maxima",
    "angular_frequency",
    "share_of_sticking",
    "mean_energy",
];

impl Estimate {
    /// `average` of all values and over batches; `None` for fewer than 20 values a batch.
    pub fn of(values: &[f64], average: &dyn Fn(&[f64]) -> f64) -> Option<Self> {
        let length = values.len() / BATCHES;
        if length < FEWEST {
            return None;
        }
        let parts: Vec<f64> = values.chunks_exact(length).take(BATCHES).map(average).collect();
        let count = parts.len() as f64;
        let centre = mean(&parts);
        let variance = parts.iter().map(|part| (part - centre).powi(2)).sum::<f64>() / (count - 1.0);
        Some(Self { value: average(values), error: (variance / count).sqrt() })
    }
}

/// [`QUANTITIES`] of a motion; `None` if the record is too short.
pub(super) fn invariants(chain: &OscillatorChain, motion: &Trajectory) -> Option<[Estimate; 7]> {
    let cycles = Cycles::of(motion, 0);
    let maxima: Vec<f64> = cycles.maxima.iter().map(|maximum| maximum.value).collect();
    let periods: Vec<f64> = cycles.upward_zeros.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let states = || motion.samples.iter().map(|sample| &sample.state);
    // Slider forces at the limit are exactly 1 on either side.
    let sticks: Vec<f64> = states().map(|state| f64::from(u8::from(state.slider_forces[0].abs() < 1.0))).collect();
    let energies: Vec<f64> =
        states().map(|s| chain.stored_energy(&s.positions, &s.velocities, &s.slider_forces)).collect();
    let frequency = |periods: &[f64]| TAU / mean(periods);
    Some([
        Estimate::of(&maxima, &mean)?,
        Estimate::of(&maxima, &|values| quantile(values, 0.1))?,
        Estimate::of(&maxima, &|values| quantile(values, 0.5))?,
        Estimate::of(&maxima, &|values| quantile(values, 0.9))?,
        Estimate::of(&periods, &frequency)?,
        Estimate::of(&sticks, &mean)?,
        Estimate::of(&energies, &mean)?,
    ])
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Linear between the order statistics.
fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = part * (sorted.len() - 1) as f64;
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    sorted[below] + (place - place.floor()) * (sorted[above] - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_those_of_independent_values() {
        // Multiples of an irrational number squared, modulo 1: uniform and hardly correlated. Variance 1/12.
        let values: Vec<f64> = (0..100_000u32).map(|n| (f64::from(n).powi(2) * 0.5 * 2f64.sqrt()).fract()).collect();
        let found = Estimate::of(&values, &mean).unwrap();
        let expected = (1.0 / 12.0f64 / 100_000.0).sqrt();
        // 25 batches know it to 14 %: three and a half of these.
        assert!((found.error / expected - 1.0).abs() < 0.5, "{found:?} {expected:e}");
        assert!((found.value - 0.5).abs() < 5.0 * expected);
        assert!((Estimate::of(&values, &|v| quantile(v, 0.9)).unwrap().value - 0.9).abs() < 0.01);
        assert!(Estimate::of(&values[..300], &mean).is_none());
    }
}
