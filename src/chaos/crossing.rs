//! Times at which a function of the state passes through zero.
//!
//! The function is sampled every [`SCAN_STEP`] and each change of sign is closed in to rounding. Two crossings within one step
//! are missed; with the fastest angular frequency of the rig near 1 this takes a function that all but touches zero, where
//! the pair of crossings is about to be born or to vanish.

use crate::dynamics::{Motion, State};

/// About 12 samples per oscillation of the rig.
const SCAN_STEP: f64 = 0.5;
/// Steps of the search below this many roundings of the time end it.
const ROUNDINGS: f64 = 4.0;
/// False-position steps; about 8 are needed, and halving alone would take 44.
const MOST_STEPS: usize = 60;

/// Sense of a crossing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sense {
    Upwards,
    Either,
}

/// A crossing: where, and the state there.
#[derive(Debug, Clone)]
pub(super) struct Crossing {
    pub(super) time: f64,
    pub(super) state: State,
    /// Whether the function grows through zero.
    pub(super) upwards: bool,
}

/// All crossings from `from` to the end of the motion.
pub(super) fn crossings<M: Motion>(
    motion: &M,
    from: f64,
    sense: Sense,
    function: impl Fn(&State) -> f64,
) -> Result<Vec<Crossing>, M::Error> {
    let end = motion.end();
    let mut found = Vec::new();
    if end <= from {
        return Ok(found);
    }
    let steps = ((end - from) / SCAN_STEP).ceil() as u64;
    let mut before = (from, function(&motion.state(from)?));
    for n in 1..=steps {
        let time = (from + n as f64 * SCAN_STEP).min(end);
        let after = (time, function(&motion.state(time)?));
        // Zero belongs to the side it is reached at, so that no crossing counts twice.
        let upwards = before.1 < 0.0 && after.1 >= 0.0;
        let downwards = before.1 > 0.0 && after.1 <= 0.0;
        if upwards || (downwards && sense == Sense::Either) {
            let time = closed_in(before, after, |time| motion.state(time).map(|state| function(&state)))?;
            found.push(Crossing { time, state: motion.state(time)?, upwards });
        }
        // A sample of exactly zero stands for the far side: the crossing is counted.
        before = if after.1 == 0.0 && before.1 != 0.0 { (after.0, -before.1) } else { after };
    }
    Ok(found)
}

/// False position with the Illinois rule: the end kept twice has its value halved.
fn closed_in<E>(mut a: (f64, f64), mut b: (f64, f64), mut value: impl FnMut(f64) -> Result<f64, E>) -> Result<f64, E> {
    for _ in 0..MOST_STEPS {
        let step = -b.1 * (b.0 - a.0) / (b.1 - a.1);
        if b.1 == 0.0 || step.abs() <= ROUNDINGS * f64::EPSILON * b.0 {
            break;
        }
        let c = (b.0 + step, value(b.0 + step)?);
        if c.1 * b.1 < 0.0 {
            a = b;
        } else {
            a.1 *= 0.5;
        }
        b = c;
    }
    Ok(b.0)
}
