//! Turning points and envelopes: what remains of a motion when its fast oscillation is taken out.
//!
//! At a turning point of mass j, `v_j = 0`. The sequence of `|x_j|` there is the envelope `a_j(t)`; both maxima and minima
//! count, because the mirrored motion is a motion too, so there are two samples per oscillation. In between, `a_j` is the
//! cubic through the four nearest samples.

use super::crossing::{Crossing, Sense, crossings};
use crate::dynamics::{Motion, State};

/// A state at which mass 1 turns, mirrored where needed so that it turns back from its positive side.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TurningPoint {
    pub(super) time: f64,
    pub(super) state: State,
}

pub(super) fn turning_points<M: Motion>(motion: &M, from: f64) -> Result<Vec<TurningPoint>, M::Error> {
    let found = crossings(motion, from, Sense::Either, |state| state.velocities[0])?;
    let mirrored = |Crossing { time, state, upwards }| TurningPoint {
        time,
        state: if upwards { state.mirrored() } else { state },
    };
    Ok(found.into_iter().map(mirrored).collect())
}

/// Samples `(time, |x_j|)` at the turning points of one mass.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Envelope {
    times: Vec<f64>,
    amplitudes: Vec<f64>,
}

impl Envelope {
    pub(super) fn of_mass<M: Motion>(motion: &M, from: f64, mass: usize) -> Result<Self, M::Error> {
        let found = crossings(motion, from, Sense::Either, |state| state.velocities[mass])?;
        let (times, amplitudes) = found.iter().map(|c| (c.time, c.state.positions[mass].abs())).unzip();
        Ok(Self { times, amplitudes })
    }

    pub(super) fn len(&self) -> usize {
        self.times.len()
    }

    /// Samples in order of time.
    pub(super) fn samples(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.times.iter().copied().zip(self.amplitudes.iter().copied())
    }

    /// Mean over the time covered, by the trapezoidal rule.
    pub(super) fn mean(&self) -> f64 {
        let samples: Vec<_> = self.samples().collect();
        let (mut area, mut span) = (0.0, 0.0);
        for pair in samples.windows(2) {
            let width = pair[1].0 - pair[0].0;
            area += 0.5 * width * (pair[0].1 + pair[1].1);
            span += width;
        }
        if span > 0.0 { area / span } else { samples.first().map_or(0.0, |sample| sample.1) }
    }

    /// Amplitude and its rate by the cubic through the four nearest samples; `None` outside the inner samples.
    pub(super) fn at(&self, time: f64) -> Option<(f64, f64)> {
        let next = self.times.partition_point(|t| *t <= time);
        let first = next.checked_sub(2)?;
        let (times, values) = (self.times.get(first..first + 4)?, self.amplitudes.get(first..first + 4)?);
        Some(cubic(times, values, time))
    }
}

/// Newton's form of the interpolating polynomial and its derivative.
fn cubic(times: &[f64], values: &[f64], time: f64) -> (f64, f64) {
    let mut differences: Vec<f64> = values.to_vec();
    for order in 1..times.len() {
        for i in (order..times.len()).rev() {
            differences[i] = (differences[i] - differences[i - 1]) / (times[i] - times[i - order]);
        }
    }
    let (mut value, mut rate) = (0.0, 0.0);
    for (difference, t) in differences.iter().zip(times).rev() {
        rate = rate * (time - t) + value;
        value = value * (time - t) + difference;
    }
    (value, rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_envelope_reproduces_a_cubic_and_its_rate() {
        let function = |t: f64| 1.0 + t * (0.5 - t * (0.25 - 0.125 * t));
        let rate = |t: f64| 0.5 - 0.5 * t + 0.375 * t * t;
        let times = vec![0.0, 0.9, 2.2, 3.0, 4.1];
        let envelope = Envelope { amplitudes: times.iter().map(|t| function(*t)).collect(), times };
        let (value, slope) = envelope.at(2.5).unwrap();
        // A cubic through four points is that cubic: a few roundings of numbers of order 5.
        assert!((value - function(2.5)).abs() < 1e-14 && (slope - rate(2.5)).abs() < 1e-13);
        assert!(envelope.at(0.5).is_none() && envelope.at(3.5).is_none());
    }
}
