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

/// # Errors
/// Those of the solver.
pub fn observe(
    solver: Solver,
    disk: &BladedDisk,
    start: &State,
    sampling: Sampling,
    engine: EngineSettings,
) -> anyhow::Result<Seen> {
    let chain = disk.chain()?;
    let ring = disk.topology == Topology::Ring;
    let frequencies = if ring { wave_frequencies(disk)? } else { vec![1.0; disk.sectors] };
    let (mut times, mut rows) = (Vec::new(), Vec::new());
    let of = |state: &State| match ring {
        true => wave_amplitudes_at(state, &frequencies),
        false => (0..disk.sectors).map(|j| state.positions[j].hypot(state.velocities[j])).collect(),
    };
    let (outcome, switches, work) = match solver {
        Solver::Exact => {
            let arrival = SparseFlow::new(&chain).observe(start, sampling, |t, state, _| {
                times.push(t);
                rows.push(of(state));
            })?;
            (arrival.outcome, Some(arrival.switches), Value::Null)
        }
        Solver::Rapier => {
            let flow = DiskFlow::new(disk, engine)?;
            let arrival = flow.observe(start, sampling, |t, state, _| {
                times.push(t);
                rows.push(of(state));
            })?;
            (arrival.outcome, Some(arrival.switches), json!({"engine": flow.engine(), "steps": arrival.steps}))
        }
        Solver::SlowFlow => {
            let flow = ChainSlowFlow::new(&chain);
            let slow = |z: &[Complex<f64>]| match ring {
                true => slow_wave_amplitudes(&z[..disk.sectors]),
                false => z[..disk.sectors].iter().map(|z| z.norm()).collect(),
            };
            let arrival = flow.follow(&flow.slow_state(start)?, sampling, |t, state| {
                times.push(t);
                rows.push(slow(&state.amplitudes));
            })?;
            (arrival.outcome, None, json!({"steps": arrival.steps, "evaluations": arrival.evaluations}))
        }
    };
    Ok(Seen { times, rows, outcome, switches, work })
}
