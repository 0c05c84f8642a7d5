//! What can go wrong in the analysis of a bladed disk.

use crate::model::{ModesError, ParameterError};
use thiserror::Error;

#[derive(Debug, Error)]
pub enum DiskError {
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error(transparent)]
    Modes(#[from] ModesError),
    #[error(
        "travelling waves need a ring with exactly one group of contacts, on all sectors: change [[disk.friction]]"
    )]
    NotOneGroup,
    #[error(
        "multipliers by nodal diameter need a ring of equal sectors: take the disk without its mistuning, with contacts on all sectors"
    )]
    NotCyclic,
    #[error(
        "the wave of nodal diameter {wave} has no limit cycle that slips up to amplitude {amplitude}: the air damps it, or feeds it more than friction takes; choose another one"
    )]
    NoWave { wave: i64, amplitude: f64 },
    #[error(
        "the contacts of the wave of nodal diameter {wave} no longer slip at elongation {amplitude}: no limit cycle near the estimate"
    )]
    NoSlip { wave: i64, amplitude: f64 },
    #[error(
        "contacts of the wave of nodal diameter {wave} reverse more than twice in a period, which this method does not allow: shoot the full ring"
    )]
    ManyReversals { wave: i64 },
    #[error(
        "the wave of nodal diameter {wave} did not converge, residual {residual:e}: take fewer harmonics or weaker air"
    )]
    NoConvergence { wave: i64, residual: f64 },
    #[error("the motion has come to rest: no blade swings within {time} after it has settled")]
    NoOscillation { time: f64 },
    #[error(
        "the cycle of the wave of nodal diameter {wave} was lost at {part} times the mistuning: {source}. Take more steps; or it has ended in a fold"
    )]
    Lost { wave: i64, part: f64, source: crate::orbit::OrbitError },
    #[error("orbit of the ring: {0}")]
    Orbit(#[from] crate::orbit::OrbitError),
    #[error("motion of the disk: {0}")]
    Flow(#[from] crate::exact::ExactError),
    #[error("the disk of seed {seed}: {source}. Begin after it with --seed, or take a smaller scatter")]
    Sample { seed: u64, source: Box<DiskError> },
    #[error("{samples} samples from seed {first} on reach beyond the last seed {}: take an earlier one", u64::MAX)]
    Seeds { first: u64, samples: usize },
    #[error(transparent)]
    Store(#[from] crate::store::StoreError),
    #[error("the record {name} cannot be read back: {reason}. Remove it, or start over with --force")]
    Record { name: String, reason: String },
}
