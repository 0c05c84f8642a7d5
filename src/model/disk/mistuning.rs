//! Mistuning: relative deviations of the blade stiffnesses, `1 + delta_j` in place of 1.
//!
//! Random patterns are functions of their seed alone: ChaCha8, numbers `u = (53 high bits + 1/2) 2^-53` in (0, 1), two for each blade in order of
//! number; normal deviates by Box and Muller, `sqrt(-2 ln u1) cos(2 pi u2)`.

use crate::model::{ParameterError, Range};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// `amplitude cos(2 pi order j/N + phase)` on blade j.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Waves round the ring, 0 to N/2; N/2 makes blades alternate.
    #[schemars(range(min = 0))]
    pub order: i64,
    pub amplitude: f64,
    /// Rad.
    #[serde(default)]
    pub phase: f64,
}

/// How blade stiffnesses deviate from 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Mistuning {
    /// One deviation per blade.
    Pattern { deviations: Vec<f64> },
    /// A sum of harmonics round the ring.
    Harmonics { harmonics: Vec<Harmonic> },
    /// Independent normal deviates of mean 0.
    Normal { standard_deviation: f64, seed: u64 },
    /// Independent deviates, uniform from `-half_width` to `half_width`.
    Uniform { half_width: f64, seed: u64 },
}

impl Mistuning {
    /// The deviations of `sectors` blades.
    ///
    /// # Errors
    /// [`ParameterError`] for a pattern of another length and numbers that are not finite, or negative where they are widths.
    pub fn deviations(&self, sectors: usize) -> Result<Vec<f64>, ParameterError> {
        match self {
            Self::Pattern { deviations } => pattern(deviations, sectors),
            Self::Harmonics { harmonics } => {
                for (number, harmonic) in harmonics.iter().enumerate() {
                    check_order(number, harmonic.order, sectors)?;
                    Range::Finite.check("mistuning.harmonics.amplitude", harmonic.amplitude)?;
                    Range::Finite.check("mistuning.harmonics.phase", harmonic.phase)?;
                }
                let at = |j: usize, h: &Harmonic| {
                    let turns = (h.order * j as i64) % sectors as i64;
                    h.amplitude * (TAU * turns as f64 / sectors as f64 + h.phase).cos()
                };
                Ok((0..sectors).map(|j| harmonics.iter().map(|h| at(j, h)).sum()).collect())
            }
            Self::Normal { standard_deviation, seed } => {
                let s = Range::NonNegative.check("mistuning.standard_deviation", *standard_deviation)?;
                Ok(draws(sectors, *seed, |u1, u2| s * (-2.0 * u1.ln()).sqrt() * (TAU * u2).cos()))
            }
            Self::Uniform { half_width, seed } => {
                let w = Range::NonNegative.check("mistuning.half_width", *half_width)?;
                Ok(draws(sectors, *seed, |u1, _| w * (2.0 * u1 - 1.0)))
            }
        }
    }

    /// The same distribution with another seed; patterns that are not random are unchanged.
    #[must_use]
    pub fn with_seed(&self, seed: u64) -> Self {
        match self.clone() {
            Self::Normal { standard_deviation, .. } => Self::Normal { standard_deviation, seed },
            Self::Uniform { half_width, .. } => Self::Uniform { half_width, seed },
            fixed => fixed,
        }
    }

    #[must_use]
    pub fn is_random(&self) -> bool {
        matches!(self, Self::Normal { .. } | Self::Uniform { .. })
    }
}

fn check_order(number: usize, found: i64, sectors: usize) -> Result<(), ParameterError> {
    let most = sectors as i64 / 2;
    if (0..=most).contains(&found) {
        return Ok(());
    }
    let field = format!("mistuning.harmonics[{number}].order");
    Err(ParameterError::NoSuchWave { field, found, least: 0, most })
}

fn pattern(deviations: &[f64], sectors: usize) -> Result<Vec<f64>, ParameterError> {
    if deviations.len() != sectors {
        return Err(ParameterError::WrongLength {
            field: "mistuning.deviations".to_owned(),
            found: deviations.len(),
            expected: sectors,
            per: "blade",
        });
    }
    deviations.iter().enumerate().map(|(j, &d)| Range::Finite.check(format!("mistuning.deviations[{j}]"), d)).collect()
}

fn draws(count: usize, seed: u64, deviate: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut unit = || ((generator.next_u64() >> 11) as f64 + 0.5) / 2.0_f64.powi(53);
    (0..count)
        .map(|_| {
            let (u1, u2) = (unit(), unit());
            deviate(u1, u2)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(values: &[f64]) -> (f64, f64) {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt())
    }

    #[test]
    fn random_patterns_have_the_moments_of_their_law_and_depend_on_the_seed_alone() {
        let count = 100_000;
        let normal = Mistuning::Normal { standard_deviation: 0.02, seed: 3 };
        let values = normal.deviations(count).unwrap();
        let (mean, deviation) = moments(&values);
        // Standard errors 0.02/sqrt(1e5) = 6.3e-5 of the mean and 4.5e-5 of the deviation: four of them.
        assert!(mean.abs() < 2.6e-4 && (deviation - 0.02).abs() < 1.8e-4, "{mean} {deviation}");
        // A normal law has 4.55 % beyond two deviations, standard error 0.066 %; a uniform law would have none.
        let beyond = values.iter().filter(|v| v.abs() > 0.04).count() as f64 / count as f64;
        assert!((beyond - 0.0455).abs() < 0.0027, "{beyond}");
        let (mean, deviation) = moments(&Mistuning::Uniform { half_width: 0.03, seed: 4 }.deviations(count).unwrap());
        assert!(mean.abs() < 2.2e-4 && (deviation - 0.03 / 3.0_f64.sqrt()).abs() < 1.5e-4, "{mean} {deviation}");
        assert_eq!(normal.deviations(5).unwrap(), values[..5]);
        assert_ne!(normal.with_seed(4).deviations(5).unwrap(), values[..5]);
    }

    #[test]
    fn the_harmonic_of_order_half_alternates() {
        let harmonics = vec![Harmonic { order: 3, amplitude: 0.5, phase: 0.0 }];
        let found = Mistuning::Harmonics { harmonics }.deviations(6).unwrap();
        // Rounding of a cosine.
        assert!(found.iter().zip([0.5, -0.5, 0.5, -0.5, 0.5, -0.5]).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        assert!(Mistuning::Pattern { deviations: vec![0.1; 5] }.deviations(6).is_err());
    }

    #[test]
    fn orders_that_a_ring_does_not_have_are_refused_by_name() {
        for order in [-1, 4] {
            let sound = Harmonic { order: 3, amplitude: 0.5, phase: 0.0 };
            let harmonics = vec![sound, Harmonic { order, ..sound }];
            let message = Mistuning::Harmonics { harmonics }.deviations(6).unwrap_err().to_string();
            let expected = format!("mistuning.harmonics[1].order = {order} is not allowed: ");
            assert!(
                message.starts_with(&expected) && message.contains("from 0 to 3, half the number of sectors"),
                "{message}"
            );
        }
    }
}
