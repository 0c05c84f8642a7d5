//! What the samples of a Monte Carlo say together.
//!
//! For k of n samples, probabilities have the 95 % interval of Wilson, J. Am. Stat. Assoc. 22 (1927) 209-212, with z = 1.96 and p = k/n,
//!
//! ```text
//! (p + z^2/(2 n) +- z sqrt(p (1 - p)/n + z^2/(4 n^2))) / (1 + z^2/n)
//! ```
//!
//! which has a width at p = 0 and 1 as well. It is of the drawing of samples alone, mistuning and starts together.

use super::monte_carlo::{Fate, Sample, SampleRow};
use crate::model::Stability;
use serde::{Deserialize, Serialize};

/// 97.5 % quantile of the normal distribution.
const Z: f64 = 1.959_963_984_540_054;

/// How many samples met each fate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct FateCounts {
    pub stable: usize,
    /// Settled ones.
    pub flutter: usize,
    /// Bounded so far, but not settled within the longest time: growing still, or beating.
    pub unsettled: usize,
    pub diverged: usize,
}

/// How many samples the eigenvalues of the stuck disk put in each class.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct LinearCounts {
    pub stable: usize,
    pub neutral: usize,
    pub flutter: usize,
    pub divergence: usize,
}

/// What the samples say together. All shares are of those that were followed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    pub fates: FateCounts,
    pub linear: LinearCounts,
    /// Samples that could not be followed.
    pub failed: usize,
    /// Samples that flutter linearly, those that diverge statically not counted, over all samples, its standard error (which says nothing at 0 and 1), and the interval for it.
    pub probability_of_linear_flutter: f64,
    pub standard_error: f64,
    pub linear_flutter_interval: [f64; 2],
    /// Samples whose settled flutter is held by friction over all samples, and the interval for it. Those not settled count as not held.
    pub probability_of_held_flutter: f64,
    pub held_flutter_interval: [f64; 2],
    /// 5, 25, 50, 75, 95 % quantiles of the amplitude of settled samples that flutter; empty if none does.
    pub amplitude_quantiles: Vec<f64>,
    /// Samples by the number of periods after which they had settled, diverged or were given up: periods and count.
    pub lengths: Vec<(f64, usize)>,
}

impl Summary {
    /// Of at least one sample; all zero for none, with intervals from 0 to 1.
    #[must_use]
    pub fn of(samples: &[Sample]) -> Self {
        let rows: Vec<SampleRow> = samples.iter().filter_map(Sample::row).copied().collect();
        let rows = &rows[..];
        let count = |fate, settled| rows.iter().filter(|row| row.fate == fate && row.settled == settled).count();
        let all = rows.len().max(1) as f64;
        let said = |stability| rows.iter().filter(|row| row.linear == stability).count();
        let linear = said(Stability::Flutter);
        let held = count(Fate::Flutter, true);
        let p = linear as f64 / all;
        let fluttering = rows.iter().filter(|row| row.fate == Fate::Flutter && row.settled);
        let mut amplitudes: Vec<f64> = fluttering.map(|row| row.amplitude).collect();
        amplitudes.sort_by(f64::total_cmp);
        let quantile = |q: f64| amplitudes[(q * (amplitudes.len() - 1) as f64).round() as usize];
        let quantiles = [0.05, 0.25, 0.5, 0.75, 0.95];
        Self {
            fates: FateCounts {
                stable: count(Fate::Stable, true),
                flutter: held,
                unsettled: count(Fate::Flutter, false),
                diverged: count(Fate::Diverged, true),
            },
            linear: LinearCounts {
                stable: said(Stability::Stable),
                neutral: said(Stability::Neutral),
                flutter: linear,
                divergence: said(Stability::Divergence),
            },
            failed: samples.len() - rows.len(),
            probability_of_linear_flutter: p,
            standard_error: (p * (1.0 - p) / all).sqrt(),
            linear_flutter_interval: wilson(linear, rows.len()),
            probability_of_held_flutter: held as f64 / all,
            held_flutter_interval: wilson(held, rows.len()),
            amplitude_quantiles: if amplitudes.is_empty() { vec![] } else { quantiles.map(quantile).to_vec() },
            lengths: lengths(rows),
        }
    }
}

/// Rows by the number of periods followed, in rising order.
fn lengths(rows: &[SampleRow]) -> Vec<(f64, usize)> {
    let mut periods: Vec<f64> = rows.iter().map(|row| row.periods).collect();
    periods.sort_by(f64::total_cmp);
    periods.chunk_by(|a, b| a == b).map(|equal| (equal[0], equal.len())).collect()
}

/// Of `count` among `all`.
fn wilson(count: usize, all: usize) -> [f64; 2] {
    if all == 0 {
        return [0.0, 1.0];
    }
    let (n, p) = (all as f64, count as f64 / all as f64);
    let middle = p + Z * Z / (2.0 * n);
    let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    [middle - half, middle + half].map(|end| (end / (1.0 + Z * Z / n)).clamp(0.0, 1.0))
}
