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
        "the wave of nodal diameter {wave} has no limit cycle that slips: the describing function, searched from 1 to {elongations} slip elongations in every mode, has none; choose another one"
    )]
    NoWave { wave: i64, elongations: f64 },
    #[error(
        "the wave of nodal diameter {wave}, expected near amplitude {expected}, led to another orbit, of amplitude {found}: it may have no limit cycle there"
    )]
    AnotherOrbit { wave: i64, expected: f64, found: f64 },
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
    #[error("no blade swings within {time} after the time to settle: the motion is at rest, held by its contacts")]
    NoOscillation { time: f64 },
    #[error(
        "the motion is at rest or on the way there: no contact slips any more, the largest amplitude of a blade within {time} is {amplitude:.3e}, and with stuck contacts every mode is damped. There is no cycle to close: start with a larger amplitude"
    )]
    AtRest { amplitude: f64, time: f64 },
    #[error(
        "the motion diverges: a displacement passes {bound} at time {time:.6}. There is no cycle to settle on from this start: start smaller, or weaken the air"
    )]
    Diverges { time: f64, bound: f64 },
    #[error(
        "the motion still grows, at the rate {rate:.3e} and so far without slip, with an amplitude of {amplitude:.3e}: lengthen the time to settle"
    )]
    StillGrowing { amplitude: f64, rate: f64 },
    #[error(
        "the motion is neutral: no contact slips, with stuck contacts no mode grows or decays, and the motion, of amplitude {amplitude:.3e}, is a sum of several modes that does not close. There is no limit cycle"
    )]
    NeutralMotion { amplitude: f64 },
    #[error(
        "the motion keeps its size, largest amplitude of a blade {amplitude:.4}, but is on no cycle{waves}: it does not close after a period, as on a torus or on a cycle of several periods; {distance}"
    )]
    NotPeriodic { amplitude: f64, waves: String, distance: String },
    #[error(
        "the motion has not settled: an amplitude still changes by {percent:.1} % from one half of the watch to the other; {distance}. Lengthen the time to settle"
    )]
    NotSettled { percent: f64, distance: String },
    #[error("{found:e} {what} are too many, allowed are at most {allowed:e}")]
    TooMany { what: &'static str, found: f64, allowed: f64 },
    #[error(
        "the cycle of the wave of nodal diameter {wave} was lost at {part} times the mistuning: from amplitude {from} Newton's method fell on another orbit or on rest, of amplitude {to}. Take more steps; or it has ended in a fold"
    )]
    Jumped { wave: i64, part: f64, from: f64, to: f64 },
    #[error(
        "random mistuning is to be drawn, but the disk has {found}: add a [disk.mistuning] table with kind = \"normal\" and standard_deviation, or kind = \"uniform\" and half_width, and a seed"
    )]
    NotRandom { found: &'static str },
    #[error(
        "the cycle of the wave of nodal diameter {wave} was lost at {part} times the mistuning: {source}. Take more steps; or it has ended in a fold"
    )]
    Lost { wave: i64, part: f64, source: crate::orbit::OrbitError },
    #[error("orbit of the ring: {0}")]
    Orbit(#[from] crate::orbit::OrbitError),
    #[error("motion of the disk: {0}")]
    Flow(#[from] crate::exact::ExactError),
    #[error("{samples} samples from seed {first} on reach beyond the last seed {}: take an earlier one", u64::MAX)]
    Seeds { first: u64, samples: usize },
    #[error(transparent)]
    Store(#[from] crate::store::StoreError),
    #[error("the record {name} cannot be read back: {reason}. Remove it, or start over with --force")]
    Record { name: String, reason: String },
}
