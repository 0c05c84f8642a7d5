//! A motion watched over some periods: its period, its amplitudes, whether contacts slip.

use super::error::DiskError;
use super::spectrum::wave_amplitudes;
use crate::dynamics::{Outcome, Sampling, State};
use crate::exact::SparseFlow;
use std::f64::consts::TAU;

/// Shortest watch, and time between two samples of it.
pub(super) const LEAST_WATCH: f64 = 40.0 * TAU;
const SAMPLE: f64 = TAU / 64.0;
/// Upward zeros of a velocity that a period is measured from at least; slower motions are watched for longer.
const FEWEST_ZEROS: usize = 5;
const LENGTHENING: f64 = 4.0;
const LONGEST_WATCH: f64 = 64.0 * LEAST_WATCH;
/// States kept of a watch, for the means of wave amplitudes.
const STATES: f64 = 256.0;

/// What is seen of a motion.
#[derive(Debug, Clone)]
pub(super) struct Watch {
    pub(super) length: f64,
    pub(super) outcome: Outcome,
    /// Whether any contact slips.
    pub(super) slips: bool,
    /// Mean time between upward zeros of the velocity of the blade that moves most; none where it does not swing.
    pub(super) period: Option<f64>,
    /// Of each blade, half its range of displacements, in either half of the watch.
    halves: [Vec<f64>; 2],
    /// Some states on the way, and the last.
    states: Vec<State>,
    pub(super) end: State,
}

impl Watch {
    /// As long as it takes to see some periods.
    pub(super) fn of(flow: &SparseFlow, blades: usize, from: &State) -> Result<Self, DiskError> {
        let mut length = LEAST_WATCH;
        loop {
            let watch = Self::over(flow, blades, from, length)?;
            let enough = watch.period.is_some_and(|period| length >= FEWEST_ZEROS as f64 * period);
            if enough || length >= LONGEST_WATCH || watch.outcome != Outcome::Completed {
                return Ok(watch);
            }
            length *= LENGTHENING;
        }
    }

    pub(super) fn over(flow: &SparseFlow, blades: usize, from: &State, length: f64) -> Result<Self, DiskError> {
        let mut blade_motions = vec![Seen::default(); blades];
        let (mut samples, mut slips) = (0, false);
        // Odd, so that the states fall on all parts of a period.
        let stride = (length / SAMPLE / STATES) as usize | 1;
        let mut states: Vec<State> = Vec::new();
        let sampling = Sampling { interval: SAMPLE, t_end: length };
        let arrival = flow.observe(from, sampling, |t, state, contacts| {
            let half = usize::from(t > 0.5 * length);
            for (seen, (x, v)) in blade_motions.iter_mut().zip(state.positions.iter().zip(&state.velocities)) {
                seen.see(t, *x, *v, half);
            }
            slips |= contacts.iter().any(|contact| !contact.is_stick());
            if samples % stride == 0 {
                states.push(state.clone());
            }
            samples += 1;
        })?;
        let most = blade_motions.iter().max_by(|a, b| a.fastest.total_cmp(&b.fastest));
        let period = most.and_then(Seen::period);
        let halves = [0, 1].map(|half| blade_motions.iter().map(|seen| seen.amplitude(half)).collect());
        Ok(Self {
            length,
            outcome: arrival.outcome,
            slips: slips || arrival.switches > 0,
            period,
            halves,
            states,
            end: arrival.state,
        })
    }

    /// Mean amplitudes of the waves of a ring, seen at the frequency of the watch.
    pub(super) fn waves(&self) -> Vec<f64> {
        let blades = self.halves[0].len();
        let w = TAU / self.period.unwrap_or(TAU);
        let mut sums = vec![0.0; blades];
        for state in &self.states {
            sums.iter_mut().zip(wave_amplitudes(state, blades, w)).for_each(|(sum, a)| *sum += a);
        }
        sums.iter().map(|sum| sum / self.states.len().max(1) as f64).collect()
    }

    /// Largest amplitude of any blade in the second half.
    pub(super) fn largest(&self) -> f64 {
        self.halves[1].iter().fold(0.0, |largest, a| a.max(largest))
    }

    /// Largest change of the amplitude of a blade between the halves, of the largest amplitude.
    pub(super) fn change(&self) -> f64 {
        let changes = self.halves[0].iter().zip(&self.halves[1]).map(|(a, b)| (a - b).abs());
        changes.fold(0.0, f64::max) / self.largest().max(f64::MIN_POSITIVE)
    }
}

/// One blade.
#[derive(Debug, Clone, Default)]
struct Seen {
    fastest: f64,
    /// Least and largest displacement in either half.
    ranges: [Option<(f64, f64)>; 2],
    /// Time and velocity of the last sample; first and last upward zero of the velocity, and their number.
    last: Option<(f64, f64)>,
    zeros: (f64, f64, usize),
}

impl Seen {
    fn see(&mut self, t: f64, x: f64, v: f64, half: usize) {
        self.fastest = self.fastest.max(v.abs());
        let (low, high) = self.ranges[half].unwrap_or((x, x));
        self.ranges[half] = Some((low.min(x), high.max(x)));
        if let Some((before, slower)) = self.last.filter(|(_, slower)| *slower < 0.0 && v >= 0.0) {
            let zero = before + (t - before) * slower / (slower - v);
            let first = if self.zeros.2 == 0 { zero } else { self.zeros.0 };
            self.zeros = (first, zero, self.zeros.2 + 1);
        }
        self.last = Some((t, v));
    }

    fn period(&self) -> Option<f64> {
        let (first, last, count) = self.zeros;
        (count > 1).then(|| (last - first) / (count - 1) as f64)
    }

    fn amplitude(&self, half: usize) -> f64 {
        self.ranges[half].map_or(0.0, |(low, high)| 0.5 * (high - low))
    }
}
