//! The limit cycle that a motion has settled on, and the evidence that it has.
//!
//! The motion is followed for the time to settle, then watched over some forty periods. What is no cycle is told by name: divergence, rest, growth
//! below slip, neutral motion of stuck contacts, a motion that keeps its size but does not close (a torus, or a longer period), one that has not settled.
//!
//! Newton's method may leave the motion for another attractor, or find an unstable cycle that the motion goes round. So the orbit is held
//! against the motion: the distance is the largest difference of any displacement or velocity from the nearest state of the orbit. The motion is on
//! the orbit where that is below 1e-6 of the amplitude at the end of the watch, or where the orbit is stable, the distance below 1 %, and
//! shrinking at least half as fast as the multipliers say.

use super::cycle::{DiskCycle, cycle_near};
use super::error::DiskError;
use super::stability::OrbitStability;
use super::watch::{LEAST_WATCH, Watch};
use crate::dynamics::{Outcome, State};
use crate::exact::{ExactError, ExactTrajectory, SparseFlow};
use crate::model::{BladedDisk, NodalDiameter, Stability, Topology};

/// Longest motion of a disk that is followed: hours of computing.
pub const LONGEST_MOTION: f64 = 1e8;
/// Time in which a motion is followed at once; between two of these it is told how far it has come.
const PIECE: f64 = 1000.0;
/// Distance from the orbit, of the amplitude, at which the motion is on it, and at which it may be called near.
const ON: f64 = 1e-6;
const NEAR: f64 = 1e-2;
/// Share of the expected decay that the distance must show: modes of decay beat.
const DECAY: f64 = 0.5;
/// Largest relative change of amplitudes between the halves of a watch over which a motion keeps its size.
const KEPT: f64 = 0.02;
/// A motion that does not close is watched over this part of the time to settle, to see whether it keeps its size.
const LONG_WATCH: f64 = 0.2;
/// Waves shown of a motion on several: those above this part of the largest.
const SHOWN: f64 = 0.1;
/// Instants on an orbit among which the nearest is sought, and steps of the refinement.
const INSTANTS: usize = 256;
const GOLDEN_STEPS: usize = 60;

/// A cycle and how near the motion is to it.
#[derive(Debug, Clone)]
pub struct SettledCycle {
    pub cycle: DiskCycle,
    /// Largest difference of any displacement or velocity from the orbit, at the start and at the end of the watch.
    pub distances: [f64; 2],
}

/// The cycle on which the motion from `start` has settled after the time `settle`; `progress` hears of the part of it that is done.
///
/// # Errors
/// [`DiskError::TooMany`] for times beyond 1e8; [`DiskError::Diverges`], [`DiskError::AtRest`], [`DiskError::StillGrowing`], [`DiskError::NeutralMotion`],
/// [`DiskError::NotPeriodic`] and [`DiskError::NotSettled`] for motions that are on no cycle; [`DiskError::Flow`].
pub fn settled_cycle(
    disk: &BladedDisk,
    flow: &SparseFlow,
    start: &State,
    settle: f64,
    progress: impl Fn(usize, usize),
) -> Result<SettledCycle, DiskError> {
    let settled = follow(flow, start, settle, progress)?;
    let watch = Watch::of(flow, disk.sectors, &settled)?;
    if let Outcome::Diverged { time, bound } = watch.outcome {
        return Err(DiskError::Diverges { time: settle + time, bound });
    }
    let linear = if watch.slips { None } else { Some(refuse_linear(flow, &watch)?) };
    let period = watch.period.ok_or(DiskError::NoOscillation { time: watch.length })?;
    let not_closed = |distance: Option<f64>| {
        if linear.is_some() {
            return Ok(DiskError::NeutralMotion { amplitude: watch.largest() });
        }
        named(disk, flow, &watch, settle, distance)
    };
    let cycle = match cycle_near(flow, disk.sectors, &settled, period) {
        Ok(cycle) => cycle,
        Err(DiskError::Orbit(_)) => return Err(not_closed(None)?),
        Err(other) => return Err(other),
    };
    let orbit = Orbit::of(flow, &cycle)?;
    let distances = [orbit.distance(&settled)?, orbit.distance(&watch.end)?];
    if is_on(&cycle, distances, watch.length) {
        return Ok(SettledCycle { cycle, distances });
    }
    Err(not_closed(Some(distances[1]))?)
}

/// The state after the time to settle.
fn follow(flow: &SparseFlow, start: &State, settle: f64, progress: impl Fn(usize, usize)) -> Result<State, DiskError> {
    if settle > LONGEST_MOTION {
        return Err(DiskError::TooMany { what: "units of time to settle", found: settle, allowed: LONGEST_MOTION });
    }
    let pieces = (settle / PIECE).ceil().max(1.0) as usize;
    let length = settle / pieces as f64;
    let mut state = start.clone();
    for piece in 0..pieces {
        let arrival = flow.advance(&state, length)?;
        if let Outcome::Diverged { time, bound } = arrival.outcome {
            return Err(DiskError::Diverges { time: piece as f64 * length + time, bound });
        }
        state = arrival.state;
        progress(piece + 1, pieces);
    }
    Ok(state)
}

/// Without slip the disk is linear: a motion that does not grow or decay is neutral, all others are refused.
fn refuse_linear(flow: &SparseFlow, watch: &Watch) -> Result<Stability, DiskError> {
    let modes = flow.chain().linear_modes(&vec![true; flow.chain().sliders()])?;
    let least_damping = modes.iter().map(|mode| mode.damping).fold(f64::INFINITY, f64::min);
    let amplitude = watch.largest();
    match Stability::of(&modes) {
        Stability::Stable => Err(DiskError::AtRest { amplitude, time: watch.length }),
        _ if amplitude < f64::MIN_POSITIVE => Err(DiskError::AtRest { amplitude, time: watch.length }),
        Stability::Neutral => Ok(Stability::Neutral),
        Stability::Flutter | Stability::Divergence => {
            Err(DiskError::StillGrowing { amplitude, rate: -0.5 * least_damping })
        }
    }
}

fn is_on(cycle: &DiskCycle, [before, now]: [f64; 2], time: f64) -> bool {
    let amplitude = cycle.amplitude();
    if now <= ON * amplitude {
        return amplitude > 0.0;
    }
    let expected = cycle.leading_multiplier.powf(time / cycle.orbit.period);
    cycle.stability() == OrbitStability::Stable
        && now <= NEAR * amplitude
        && now <= before * (1.0 - DECAY * (1.0 - expected))
}

/// What a motion that is on no cycle is.
fn named(
    disk: &BladedDisk,
    flow: &SparseFlow,
    watch: &Watch,
    settle: f64,
    distance: Option<f64>,
) -> Result<DiskError, DiskError> {
    let longer =
        Watch::over(flow, disk.sectors, &watch.end, (LONG_WATCH * settle).clamp(4.0 * LEAST_WATCH, LONGEST_MOTION))?;
    if let Outcome::Diverged { time, bound } = longer.outcome {
        return Ok(DiskError::Diverges { time: settle + watch.length + time, bound });
    }
    let distance = distance.map_or_else(
        || "Newton's method closes none nearby".to_owned(),
        |distance| format!("the orbit that Newton's method closes lies {distance:.3e} away"),
    );
    let change = longer.change();
    if change > KEPT {
        return Ok(DiskError::NotSettled { percent: 100.0 * change, distance });
    }
    let waves = if disk.topology == Topology::Ring { on_waves(disk, &longer) } else { String::new() };
    Ok(DiskError::NotPeriodic { amplitude: longer.largest(), waves, distance })
}

/// ` (mean amplitudes of its waves, nodal diameter +0: 0.73, +1: 0.45)`
fn on_waves(disk: &BladedDisk, watch: &Watch) -> String {
    let amplitudes = watch.waves();
    let largest = amplitudes.iter().fold(0.0_f64, |m, a| m.max(*a));
    let shown = NodalDiameter::all(disk.sectors).filter(|wave| amplitudes[wave.index()] > SHOWN * largest);
    let names: Vec<String> =
        shown.map(|wave| format!("{:+}: {:.2}", wave.signed(), amplitudes[wave.index()])).collect();
    format!(" (mean amplitudes of its waves, nodal diameter {})", names.join(", "))
}

/// The states of an orbit.
struct Orbit {
    motion: ExactTrajectory,
    period: f64,
}

impl Orbit {
    fn of(flow: &SparseFlow, cycle: &DiskCycle) -> Result<Self, DiskError> {
        let start = State::from_components(cycle.orbit.state.as_slice(), flow.chain()).map_err(ExactError::from)?;
        // Two periods, so that every instant has both neighbours.
        Ok(Self { motion: flow.solve(&start, 2.0 * cycle.orbit.period)?, period: cycle.orbit.period })
    }

    /// Of a state from the orbit: the nearest of some instants, then golden sections beside it.
    fn distance(&self, state: &State) -> Result<f64, DiskError> {
        let at = |time: f64| -> Result<f64, DiskError> {
            let here = self.motion.state_at(time)?.state;
            let differences = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            Ok(differences(&here.positions, &state.positions).max(differences(&here.velocities, &state.velocities)))
        };
        let step = self.period / INSTANTS as f64;
        let mut best = (f64::INFINITY, 1);
        for n in 1..=INSTANTS {
            let distance = at(n as f64 * step)?;
            if distance < best.0 {
                best = (distance, n);
            }
        }
        let [mut low, mut high] = [(best.1 - 1) as f64 * step, (best.1 + 1) as f64 * step];
        let part = 0.5 * (5.0_f64.sqrt() - 1.0);
        let mut least = best.0;
        for _ in 0..GOLDEN_STEPS {
            let [a, b] = [high - part * (high - low), low + part * (high - low)];
            let [fa, fb] = [at(a)?, at(b)?];
            least = least.min(fa).min(fb);
            if fa < fb { high = b } else { low = a }
        }
        Ok(least)
    }
}
