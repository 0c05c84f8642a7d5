//! Limit cycles of disks that need not be tuned, closed by shooting: on settled motions ([`super::settled`]), and from the travelling waves of the
//! tuned disk by growing the mistuning step by step, which finds unstable cycles as well.
//!
//! Contacts that never slip on the cycle keep whatever force they were left with: `f_j - (k_j/R_j) b_j^T x` is constant, so cycles come in families and
//! each such contact adds a multiplier 1. Those, and the one along the motion, say nothing about stability and are left out.

use super::error::DiskError;
use super::one_sector::TravellingWave;
use super::ring::blade_amplitudes;
use super::stability::OrbitStability;
use crate::dynamics::{EventKind, State};
use crate::exact::{ExactError, SparseFlow};
use crate::model::{BladedDisk, Mistuning, NodalDiameter};
use crate::orbit::{FlowOrbit, SpatialClosure, shoot_flow};
use nalgebra::DVector;

/// Harmonics of the wave from which Newton's method starts.
const FOLLOWED_HARMONICS: usize = 64;
/// Steps in which mistuning may grow.
const MOST_STEPS: usize = 10_000;
/// A cycle whose amplitudes change by more than this part in one step is another one, on which Newton's method has fallen.
const JUMP: f64 = 0.5;

/// A limit cycle of a disk.
#[derive(Debug, Clone)]
pub struct DiskCycle {
    pub orbit: FlowOrbit,
    /// Of each blade, half the way between its least and its largest displacement: what stuck contacts hold it off its rest is left out.
    pub amplitudes: Vec<f64>,
    /// Contacts that never slip.
    pub stuck_contacts: usize,
    /// Largest modulus of the multipliers over a period, those left out of which the module head speaks.
    pub leading_multiplier: f64,
}

impl DiskCycle {
    #[must_use]
    pub fn stability(&self) -> OrbitStability {
        OrbitStability::of(self.leading_multiplier)
    }

    #[must_use]
    pub fn stable(&self) -> bool {
        self.stability() == OrbitStability::Stable
    }

    /// [`participation`] of the amplitudes: how far the motion is spread over the blades.
    #[must_use]
    pub fn participation(&self) -> f64 {
        participation(&self.amplitudes)
    }

    /// The largest amplitude of a blade.
    #[must_use]
    pub fn amplitude(&self) -> f64 {
        self.amplitudes.iter().fold(0.0, |largest, a| a.max(largest))
    }
}

/// `(sum a_j^2)^2 / (N sum a_j^4)`: 1 where all blades move alike, 1/N where one moves alone.
#[must_use]
pub fn participation(amplitudes: &[f64]) -> f64 {
    let power = |k: i32| amplitudes.iter().map(|a| a.powi(k)).sum::<f64>();
    let spread = power(4) * amplitudes.len() as f64;
    if spread > 0.0 { power(2).powi(2) / spread } else { 1.0 }
}

/// The cycle near a state and a period. It may be rest, which closes after any time: [`DiskCycle::amplitude`] and [`DiskCycle::stuck_contacts`] tell.
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

/// The cycle that the travelling wave of the tuned disk becomes as the mistuning grows to its own size in `steps` equal steps.
///
/// # Errors
/// As [`TravellingWave::of`] for the wave, [`DiskError::TooMany`] for more than 10 000 steps, [`DiskError::Lost`] where the cycle cannot be followed: with
/// stronger mistuning it may end in a fold, and [`DiskError::Jumped`] where Newton's method leaves it for another orbit or for rest.
pub fn mistuned_wave(disk: &BladedDisk, wave: NodalDiameter, steps: usize) -> Result<DiskCycle, DiskError> {
    if steps > MOST_STEPS {
        return Err(DiskError::TooMany { what: "steps", found: steps as f64, allowed: MOST_STEPS as f64 });
    }
    let estimate = TravellingWave::of(disk, wave, FOLLOWED_HARMONICS)?;
    let (mut state, mut period) = (estimate.state(), estimate.period());
    let mut amplitudes = vec![estimate.amplitude; disk.sectors];
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
        let change = cycle.amplitudes.iter().zip(&amplitudes).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let largest = amplitudes.iter().fold(0.0_f64, |largest, a| largest.max(*a));
        if change > JUMP * largest || cycle.stuck_contacts == flow.chain().sliders() {
            return Err(DiskError::Jumped { wave: wave.signed(), part, from: largest, to: cycle.amplitude() });
        }
        if step == steps {
            return Ok(cycle);
        }
        state = State::from_components(cycle.orbit.state.as_slice(), flow.chain()).map_err(ExactError::from)?;
        (period, amplitudes) = (cycle.orbit.period, cycle.amplitudes);
    }
    Err(DiskError::NoOscillation { time: 0.0 })
}
