//! Limit cycles of disks that need not be tuned, closed by shooting: on settled motions, and from the travelling waves of the tuned disk by growing
//! the mistuning step by step, which finds unstable cycles as well.
//!
//! Contacts that never slip on the cycle keep whatever force they were left with: `f_j - (k_j/R_j) b_j^T x` is constant, so cycles come in families and
//! each such contact adds a multiplier 1. Those, and the one along the motion, say nothing about stability and are left out.

use super::error::DiskError;
use super::one_sector::TravellingWave;
use super::ring::blade_amplitudes;
use crate::dynamics::{EventKind, Sampling, State};
use crate::exact::{ExactError, SparseFlow};
use crate::model::{BladedDisk, Mistuning, NodalDiameter};
use crate::orbit::{FlowOrbit, SpatialClosure, shoot_flow};
use nalgebra::DVector;
use std::f64::consts::TAU;

/// Time over which the period of a settled motion is measured, and between two samples of it.
const MEASURED: f64 = 40.0 * TAU;
const SAMPLE: f64 = TAU / 64.0;
/// Harmonics of the wave from which Newton's method starts.
const FOLLOWED_HARMONICS: usize = 64;

/// A limit cycle of a disk.
#[derive(Debug, Clone)]
pub struct DiskCycle {
    pub orbit: FlowOrbit,
    /// Of each blade, half the way between its least and its largest displacement: what stuck contacts hold it off its rest is left out.
    pub amplitudes: Vec<f64>,
    /// Contacts that never slip.
    pub stuck_contacts: usize,
    /// Largest modulus of the multipliers over a period, neutral ones left out.
    pub leading_multiplier: f64,
}

impl DiskCycle {
    #[must_use]
    pub fn stable(&self) -> bool {
        self.leading_multiplier < 1.0
    }

    /// [`participation`] of the amplitudes: how far the motion is spread over the blades.
    #[must_use]
    pub fn participation(&self) -> f64 {
        participation(&self.amplitudes)
    }
}

/// `(sum a_j^2)^2 / (N sum a_j^4)`: 1 where all blades move alike, 1/N where one moves alone.
#[must_use]
pub fn participation(amplitudes: &[f64]) -> f64 {
    let power = |k: i32| amplitudes.iter().map(|a| a.powi(k)).sum::<f64>();
    let spread = power(4) * amplitudes.len() as f64;
    if spread > 0.0 { power(2).powi(2) / spread } else { 1.0 }
}

/// The cycle near a state and a period.
///
/// # Errors
/// [`DiskError::Orbit`] if Newton's method finds none, [`DiskError::Flow`].
pub fn cycle_near(flow: &SparseFlow, blades: usize, guess: &State, period: f64) -> Result<DiskCycle, DiskError> {
    let guess = DVector::from_iterator(guess.components().count(), guess.components());
    let forces = 2 * flow.chain().oscillators();
    let admit = |y: &mut DVector<f64>| y.iter_mut().skip(forces).for_each(|f| *f = f.clamp(-1.0, 1.0));
    let orbit = shoot_flow(flow, &guess, period, &SpatialClosure::full_period(guess.len()), admit)?;
    let on_orbit = State::from_components(orbit.state.as_slice(), flow.chain()).map_err(ExactError::from)?;
    let motion = flow.solve(&on_orbit, orbit.period)?;
    let slips = |j: usize| motion.events().iter().any(|e| e.element == j && e.kind == EventKind::StickToSlip);
    let stuck_contacts = (0..flow.chain().sliders()).filter(|j| !slips(*j)).count();
    Ok(DiskCycle {
        amplitudes: blade_amplitudes(flow, &orbit, blades)?,
        stuck_contacts,
        leading_multiplier: orbit.leading_multiplier(1 + stuck_contacts)?,
        orbit,
    })
}

/// The cycle on which the motion from `start` has settled after the time `settle`.
///
/// # Errors
/// [`DiskError::NoOscillation`] if the motion comes to rest, [`DiskError::Orbit`] if it is no cycle that Newton's method finds (it may be
/// quasi-periodic, or still settling), [`DiskError::Flow`].
pub fn settled_cycle(flow: &SparseFlow, blades: usize, start: &State, settle: f64) -> Result<DiskCycle, DiskError> {
    let settled = flow.advance(start, settle)?.state;
    let period = mean_period(flow, blades, &settled)?;
    cycle_near(flow, blades, &settled, period)
}

/// The cycle that the travelling wave of the tuned disk becomes as the mistuning grows to its own size in `steps` equal steps.
///
/// # Errors
/// As [`TravellingWave::of`] for the wave, and [`DiskError::Lost`] where the cycle cannot be followed: with stronger mistuning it may end in a fold.
pub fn mistuned_wave(disk: &BladedDisk, wave: NodalDiameter, steps: usize) -> Result<DiskCycle, DiskError> {
    let estimate = TravellingWave::of(disk, wave, FOLLOWED_HARMONICS)?;
    let (mut state, mut period) = (estimate.state(), estimate.period());
    let deviations = disk.deviations()?;
    let steps = steps.max(1);
    for step in 0..=steps {
        let part = step as f64 / steps as f64;
        let deviations = deviations.iter().map(|deviation| part * deviation).collect();
        let here = BladedDisk { mistuning: Some(Mistuning::Pattern { deviations }), ..disk.clone() };
        let flow = SparseFlow::new(&here.chain()?);
        let cycle = cycle_near(&flow, disk.sectors, &state, period).map_err(|error| match error {
            DiskError::Orbit(source) => DiskError::Lost { wave: wave.signed(), part, source },
            other => other,
        })?;
        if step == steps {
            return Ok(cycle);
        }
        state = State::from_components(cycle.orbit.state.as_slice(), flow.chain()).map_err(ExactError::from)?;
        period = cycle.orbit.period;
    }
    Err(DiskError::NoOscillation { time: 0.0 })
}

/// Mean time between upward zeros of the velocity of the blade that moves most.
fn mean_period(flow: &SparseFlow, blades: usize, from: &State) -> Result<f64, DiskError> {
    let mut velocities: Vec<Vec<f64>> = Vec::new();
    flow.observe(from, Sampling { interval: SAMPLE, t_end: MEASURED }, |_, state, _| {
        velocities.push(state.velocities[..blades].to_vec());
    })?;
    let size = |j: usize| velocities.iter().map(|v| v[j].abs()).fold(0.0, f64::max);
    let most = (0..blades).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or(0);
    let zeros: Vec<f64> = velocities
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0][most] < 0.0 && pair[1][most] >= 0.0)
        .map(|(n, pair)| SAMPLE * (n as f64 + pair[0][most] / (pair[0][most] - pair[1][most])))
        .collect();
    match zeros[..] {
        [first, .., last] => Ok((last - first) / (zeros.len() - 1) as f64),
        _ => Err(DiskError::NoOscillation { time: MEASURED }),
    }
}
