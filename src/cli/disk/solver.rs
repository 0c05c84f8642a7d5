//! The ways of moving a disk, each seen as amplitudes of waves (of a chain: of blades) over time.

use crate::averaging::ChainSlowFlow;
use crate::disk::{slow_wave_amplitudes, wave_amplitudes_at, wave_frequencies};
use crate::dynamics::{Outcome, Sampling, State};
use crate::engine::{DiskFlow, EngineSettings};
use crate::exact::SparseFlow;
use crate::model::{BladedDisk, Topology};
use clap::ValueEnum;
use nalgebra::Complex;
use serde_json::{Value, json};

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Solver {
    /// The closed-form solution between changes of contact.
    Exact,
    /// N blades round a hub in the Rapier engine.
    Rapier,
    /// Averaged amplitudes and phases on one carrier frequency; fast, and right where all waves have nearly the same frequency.
    SlowFlow,
}

impl Solver {
    pub fn word(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Rapier => "rapier",
            Self::SlowFlow => "slow-flow",
        }
    }
}

/// Amplitudes over time, and how the motion ended.
#[derive(Debug)]
pub struct Seen {
    pub times: Vec<f64>,
    /// By wave number, of a chain by blade.
    pub rows: Vec<Vec<f64>>,
    pub outcome: Outcome,
    /// Changes of contact state; averaging knows none.
    pub switches: Option<usize>,
    /// What the solver says of its work.
    pub work: Value,
}

/// What is moved, and how it is looked at.
pub struct Motion<'a> {
    pub disk: &'a BladedDisk,
    pub start: &'a State,
    pub sampling: Sampling,
    pub amplitude_bound: f64,
}

/// Longest time between two calls of `progress`, but for the slow flow, whose steps follow its samples.
const PIECE: f64 = 500.0;

/// `sampling` with an interval a power of two shorter, so that no sample moves, and the number of its instants to a sample.
fn refined(sampling: Sampling) -> (Sampling, u64) {
    let mut parts = 1;
    while sampling.interval / parts as f64 > PIECE && sampling.t_end > PIECE {
        parts *= 2;
    }
    (Sampling { interval: sampling.interval / parts as f64, ..sampling }, parts)
}

impl Motion<'_> {
    /// `progress` hears of the time reached.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn observe(&self, solver: Solver, engine: EngineSettings, progress: impl Fn(f64)) -> anyhow::Result<Seen> {
        let Self { disk, start, sampling, amplitude_bound } = *self;
        let chain = disk.chain()?;
        let ring = disk.topology == Topology::Ring;
        let frequencies = if ring { wave_frequencies(disk)? } else { vec![1.0; disk.sectors] };
        let (mut times, mut rows) = (Vec::new(), Vec::new());
        let of = |state: &State| match ring {
            true => wave_amplitudes_at(state, &frequencies),
            false => (0..disk.sectors).map(|j| state.positions[j].hypot(state.velocities[j])).collect(),
        };
        let (fine, parts) = refined(sampling);
        let mut instant = 0;
        let mut see = |t: f64, state: &State| {
            progress(t);
            if instant % parts == 0 || t >= sampling.t_end {
                times.push(t);
                rows.push(of(state));
            }
            instant += 1;
        };
        let (outcome, switches, work) = match solver {
            Solver::Exact => {
                let flow = SparseFlow::new(&chain).with_amplitude_bound(amplitude_bound)?;
                let arrival = flow.observe(start, fine, |t, state, _| see(t, state))?;
                (arrival.outcome, Some(arrival.switches), Value::Null)
            }
            Solver::Rapier => {
                let flow = DiskFlow::new(disk, engine)?.with_amplitude_bound(amplitude_bound)?;
                let arrival = flow.observe(start, fine, |t, state, _| see(t, state))?;
                (arrival.outcome, Some(arrival.switches), json!({"engine": flow.engine(), "steps": arrival.steps}))
            }
            Solver::SlowFlow => {
                let flow = ChainSlowFlow::new(&chain).with_amplitude_bound(amplitude_bound)?;
                let slow = |z: &[Complex<f64>]| match ring {
                    true => slow_wave_amplitudes(&z[..disk.sectors]),
                    false => z[..disk.sectors].iter().map(|z| z.norm()).collect(),
                };
                let arrival = flow.follow(&flow.slow_state(start)?, sampling, |t, state| {
                    progress(t);
                    times.push(t);
                    rows.push(slow(&state.amplitudes));
                })?;
                (arrival.outcome, None, json!({"steps": arrival.steps, "evaluations": arrival.evaluations}))
            }
        };
        Ok(Seen { times, rows, outcome, switches, work })
    }
}
