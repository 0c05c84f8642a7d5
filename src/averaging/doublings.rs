//! The cascade of period doublings of the torus that is born at the secondary Hopf point: Table 1 of the paper.

use super::error::AveragingError;
use super::fixed_points::SlowHopf;
use super::slow_flow::SlowFlow;
use super::torus::SlowTorus;
use super::torus_branch::TorusBranch;

/// Cycles along one branch: some 30 are typical between two doublings.
const MOST_CYCLES: usize = 300;
/// Where the first doubled cycle is looked for, relative to the amplitude; later ones closer by the factor [`CLOSER`].
const FIRST_AMPLITUDE: f64 = 0.02;
const CLOSER: f64 = 0.4;

/// A doubling and the cycles on its way.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodDoubling {
    /// The cycle whose multiplier is -1.
    pub torus: SlowTorus,
}

/// The doublings up to where the cascade ends or the wanted number is reached.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DoublingCascade {
    pub doublings: Vec<PeriodDoubling>,
    /// Why there are fewer than wanted: mostly [`AveragingError::TorusLost`], where a branch ends before it doubles.
    pub ended: Option<AveragingError>,
}

/// Up to `count` doublings, following the doubled cycle each time. Not every parameter set has any: the torus may shrink back to the
/// limit cycle it was born from.
#[must_use]
pub fn doubling_cascade(flow: &SlowFlow, hopf: &SlowHopf, count: usize) -> DoublingCascade {
    let mut cascade = DoublingCascade::default();
    cascade.ended = follow(flow, hopf, count, &mut cascade.doublings).err();
    cascade
}

/// The first `count` doublings, following the doubled cycle each time.
///
/// # Errors
/// [`AveragingError::TorusLost`] if a branch ends before it doubles, and what shooting returns.
pub fn period_doublings(flow: &SlowFlow, hopf: &SlowHopf, count: usize) -> Result<Vec<PeriodDoubling>, AveragingError> {
    let cascade = doubling_cascade(flow, hopf, count);
    cascade.ended.map_or(Ok(cascade.doublings), Err)
}

fn follow(
    flow: &SlowFlow,
    hopf: &SlowHopf,
    count: usize,
    found: &mut Vec<PeriodDoubling>,
) -> Result<(), AveragingError> {
    let mut branch = TorusBranch::from_hopf(flow, hopf)?;
    while found.len() < count {
        let torus = next_doubling(&mut branch)?;
        found.push(PeriodDoubling { torus });
        if found.len() < count {
            let first = FIRST_AMPLITUDE * CLOSER.powi(found.len() as i32 - 1);
            branch = TorusBranch::from_doubling(flow, &torus, first)?;
        }
    }
    Ok(())
}

fn next_doubling(branch: &mut TorusBranch) -> Result<SlowTorus, AveragingError> {
    for _ in 0..MOST_CYCLES {
        let before = branch.clone();
        branch.advance()?;
        if before.torus.doubling_test() > 0.0 && branch.torus.doubling_test() <= 0.0 {
            return before.doubling(branch);
        }
        if branch.reversed_since(&before) {
            return Err(lost(branch, "it shrinks back to a fixed point without a multiplier -1".to_owned()));
        }
    }
    Err(lost(branch, format!("no multiplier -1 in {MOST_CYCLES} cycles")))
}

fn lost(branch: &TorusBranch, reason: String) -> AveragingError {
    AveragingError::TorusLost { xi1: branch.torus.xi1, period: branch.torus.period, reason }
}
