//! Maxima and frequency of an oscillation, found between samples by the cubic through positions and velocities:
//!
//! ```text
//! x(s) = x_0 (1 - s)^2 (1 + 2 s) + x_1 s^2 (3 - 2 s) + dt v_0 s (1 - s)^2 - dt v_1 s^2 (1 - s),   0 <= s <= 1,
//! ```
//!
//! whose error is `dt^4 |x''''|/384` between events and `dt^3` times the jump of x''' over about 100 where one lies between the
//! samples; two motions with the same sample times share most of it.

use crate::dynamics::{Sample, Trajectory};
use std::f64::consts::TAU;

/// A maximum of a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Maximum {
    pub time: f64,
    pub value: f64,
}

/// Maxima and upward zeros of the position of one oscillator.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cycles {
    pub maxima: Vec<Maximum>,
    pub upward_zeros: Vec<f64>,
}

impl Cycles {
    /// Of the given oscillator, numbered from 0; empty if there is none of that number.
    #[must_use]
    pub fn of(trajectory: &Trajectory, oscillator: usize) -> Self {
        let mut cycles = Self::default();
        for pair in trajectory.samples.windows(2) {
            let Some(cubic) = Cubic::between(&pair[0], &pair[1], oscillator) else { continue };
            if cubic.slopes.0 > 0.0 && cubic.slopes.1 <= 0.0 {
                let s = bisect(|s| cubic.slope(s));
                cycles.maxima.push(Maximum { time: cubic.time(s), value: cubic.value(s) });
            }
            if cubic.ends.0 < 0.0 && cubic.ends.1 >= 0.0 {
                cycles.upward_zeros.push(cubic.time(bisect(|s| -cubic.value(s))));
            }
        }
        cycles
    }

    /// `2 pi (n - 1)/(t_n - t_1)` over the upward zeros; `None` if there are fewer than two.
    #[must_use]
    pub fn angular_frequency(&self) -> Option<f64> {
        match self.upward_zeros.as_slice() {
            [first, .., last] => Some(TAU * (self.upward_zeros.len() - 1) as f64 / (last - first)),
            _ => None,
        }
    }

    /// Mean value of the maxima; `None` if there are none.
    #[must_use]
    pub fn mean_maximum(&self) -> Option<f64> {
        let sum: f64 = self.maxima.iter().map(|maximum| maximum.value).sum();
        (!self.maxima.is_empty()).then(|| sum / self.maxima.len() as f64)
    }

    /// Angular frequency of the rise and fall of the maxima, by the times at which they rise through their mean, interpolated; `None` with
    /// fewer than three such times, which make two periods.
    #[must_use]
    pub fn modulation_frequency(&self) -> Option<f64> {
        let mean = self.mean_maximum()?;
        let rising = self.maxima.windows(2).filter(|pair| pair[0].value < mean && pair[1].value >= mean);
        let times: Vec<f64> = rising
            .map(|pair| {
                let part = (mean - pair[0].value) / (pair[1].value - pair[0].value);
                pair[0].time + part * (pair[1].time - pair[0].time)
            })
            .collect();
        match times.as_slice() {
            [first, _, .., last] => Some(TAU * (times.len() - 1) as f64 / (last - first)),
            _ => None,
        }
    }

    /// Without what lies within one sample of the ends of the record, where the other motion may just have no partner for it.
    #[must_use]
    pub fn inner(&self, record: &Trajectory) -> Self {
        let times: Vec<f64> = record.samples.iter().map(|sample| sample.time).collect();
        let [_, second, .., last_but_one, _] = times.as_slice() else { return Self::default() };
        let inside = |time: f64| time >= *second && time <= *last_but_one;
        Self {
            maxima: self.maxima.iter().copied().filter(|maximum| inside(maximum.time)).collect(),
            upward_zeros: self.upward_zeros.iter().copied().filter(|&time| inside(time)).collect(),
        }
    }

    /// Largest difference between a maximum here and the one nearest in time of `other`; `None` if either has none.
    #[must_use]
    pub fn amplitude_error(&self, other: &Self) -> Option<f64> {
        let times: Vec<f64> = other.maxima.iter().map(|maximum| maximum.time).collect();
        let errors: Option<Vec<f64>> = self
            .maxima
            .iter()
            .map(|maximum| Some((maximum.value - other.maxima[nearest(&times, maximum.time)?].value).abs()))
            .collect();
        errors?.into_iter().reduce(f64::max)
    }

    /// Difference of the angular frequencies between the first and the last upward zero here and those nearest in time of `other`;
    /// `None` if either has fewer than two.
    #[must_use]
    pub fn frequency_error(&self, other: &Self) -> Option<f64> {
        let [first, .., last] = self.upward_zeros.as_slice() else { return None };
        let (i, j) = (nearest(&other.upward_zeros, *first)?, nearest(&other.upward_zeros, *last)?);
        let theirs = Self { upward_zeros: other.upward_zeros[i..=j].to_vec(), ..Self::default() };
        Some((self.angular_frequency()? - theirs.angular_frequency()?).abs())
    }

    /// Standard error of the mean of the maxima by the spread of the means of ten consecutive batches, which allows for
    /// the correlation of maxima that are close in time. `None` with fewer than two maxima a batch.
    #[must_use]
    pub fn standard_error_of_mean(&self) -> Option<f64> {
        let values: Vec<f64> = self.maxima.iter().map(|maximum| maximum.value).collect();
        standard_error(&values)
    }

    /// Standard error of the angular frequency, by batches of periods as for the mean of the maxima.
    #[must_use]
    pub fn standard_error_of_frequency(&self) -> Option<f64> {
        let frequencies: Vec<f64> = self.upward_zeros.windows(2).map(|pair| TAU / (pair[1] - pair[0])).collect();
        standard_error(&frequencies)
    }
}

/// Index of the entry nearest to `time`.
fn nearest(times: &[f64], time: f64) -> Option<usize> {
    let distance = |i: &usize| (times[*i] - time).abs();
    (0..times.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

fn standard_error(values: &[f64]) -> Option<f64> {
    let size = values.len() / BATCHES;
    if size < 2 {
        return None;
    }
    let means: Vec<f64> =
        values.chunks_exact(size).take(BATCHES).map(|batch| batch.iter().sum::<f64>() / size as f64).collect();
    let mean = means.iter().sum::<f64>() / BATCHES as f64;
    let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (BATCHES - 1) as f64;
    Some((variance / BATCHES as f64).sqrt())
}

const BATCHES: usize = 10;

/// The cubic between two samples; slopes are per unit of s.
struct Cubic {
    start: f64,
    step: f64,
    ends: (f64, f64),
    slopes: (f64, f64),
}

impl Cubic {
    fn between(a: &Sample, b: &Sample, i: usize) -> Option<Self> {
        let step = b.time - a.time;
        let slope = |sample: &Sample| sample.state.velocities.get(i).map(|v| step * v);
        let ends = (*a.state.positions.get(i)?, *b.state.positions.get(i)?);
        Some(Self { start: a.time, step, ends, slopes: (slope(a)?, slope(b)?) })
    }

    fn time(&self, s: f64) -> f64 {
        self.start + s * self.step
    }

    fn value(&self, s: f64) -> f64 {
        let r = 1.0 - s;
        let (a, b) = self.ends;
        let (slope_a, slope_b) = self.slopes;
        a * r * r * (1.0 + 2.0 * s) + b * s * s * (1.0 + 2.0 * r) + slope_a * s * r * r - slope_b * s * s * r
    }

    fn slope(&self, s: f64) -> f64 {
        let r = 1.0 - s;
        let rise = 6.0 * s * r * (self.ends.1 - self.ends.0);
        rise + self.slopes.0 * r * (1.0 - 3.0 * s) + self.slopes.1 * s * (3.0 * s - 2.0)
    }
}

/// Root in [0, 1] of a function that falls from positive to not positive, to the last digit.
fn bisect(falling: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if falling(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Outcome, State};
    use crate::model::EnergyLedger;

    fn sine(amplitude: f64, w: f64, dt: f64, t_end: f64) -> Trajectory {
        let sample = |n: u32| {
            let time = f64::from(n) * dt;
            let state = State {
                positions: vec![amplitude * (w * time).sin()],
                velocities: vec![amplitude * w * (w * time).cos()],
                slider_forces: vec![],
            };
            Sample { time, state, contacts: vec![], ledger: EnergyLedger::default() }
        };
        let samples = (0..=(t_end / dt) as u32).map(sample).collect();
        Trajectory { samples, events: vec![], outcome: Outcome::Completed }
    }

    #[test]
    fn amplitude_and_frequency_of_a_sine_are_found_between_the_samples() {
        let (amplitude, w, dt) = (1.3, 0.98, 0.2);
        let cycles = Cycles::of(&sine(amplitude, w, dt, 100.0), 0);
        // Interpolation error of the cubic: (w dt)^4/384 of the amplitude.
        let tolerance = amplitude * (w * dt).powi(4) / 384.0;
        for value in cycles.maxima.iter().map(|maximum| maximum.value).chain(cycles.mean_maximum()) {
            assert!((value - amplitude).abs() <= tolerance, "{value}");
        }
        // The same error at both ends of 14 periods, as a time: divided by the speed at a zero.
        let error = (cycles.angular_frequency().unwrap() - w).abs();
        assert!(error <= w * 2.0 * tolerance / (amplitude * w) / 80.0, "{error}");
        assert!(cycles.standard_error_of_mean().is_none(), "15 maxima are too few for 10 batches of 2");
    }

    #[test]
    fn two_sines_differ_by_their_amplitudes_and_frequencies() {
        let motion = |amplitude, w| sine(amplitude, w, 0.05, 100.0);
        let (first, second) = (motion(1.0, 1.0), motion(1.01, 1.001));
        let (a, b) = (Cycles::of(&first, 0).inner(&first), Cycles::of(&second, 0));
        // Interpolation, dt^4/384 = 2e-8.
        assert!((a.amplitude_error(&b).unwrap() - 0.01).abs() < 1e-7);
        assert!((a.frequency_error(&b).unwrap() - 0.001).abs() < 1e-7);
        assert_eq!(a.amplitude_error(&Cycles::default()), None);
        assert_eq!(Cycles::default().frequency_error(&b), None);
    }

    #[test]
    fn a_motion_without_cycles_has_no_amplitude() {
        let cycles = Cycles::of(&sine(1.0, 1.0, 0.1, 1.0), 0);
        assert!(cycles.mean_maximum().is_none() && cycles.angular_frequency().is_none());
        assert_eq!(Cycles::of(&sine(1.0, 1.0, 0.1, 10.0), 7), Cycles::default());
    }
}
