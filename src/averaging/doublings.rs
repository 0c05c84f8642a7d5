//! The cascade of period doublings of the torus that is born at the secondary Hopf point: Table 1 of the paper.

use super::error::AveragingError;
use super::fixed_points::SlowHopf;
use super::slow_flow::SlowFlow;
use super::torus::SlowTorus;
use super::torus_branch::TorusBranch;

/// Cycles along one branch: 30 are typical between two doublings.
const MOST_CYCLES: usize = 2000;
/// Where the first doubled cycle is looked for, relative to the amplitude; later ones closer by the factor [`CLOSER`].
const FIRST_AMPLITUDE: f64 = 0.02;
const CLOSER: f64 = 0.4;

/// A doubling and the cycles on its way.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodDoubling {
    /// The cycle whose multiplier is -1.
    pub torus: SlowTorus,
}

/// The first `count` doublings, following the doubled cycle each time.
///
/// # Errors
/// [`AveragingError::TorusLost`] if a branch ends before it doubles, and what shooting returns.
pub fn period_doublings(flow: &SlowFlow, hopf: &SlowHopf, count: usize) -> Result<Vec<PeriodDoubling>, AveragingError> {
    let mut found: Vec<PeriodDoubling> = Vec::new();
    let mut branch = TorusBranch::from_hopf(flow, hopf)?;
    while found.len() < count {
        let torus = next_doubling(&mut branch)?;
        found.push(PeriodDoubling { torus });
        if found.len() < count {
            let first = FIRST_AMPLITUDE * CLOSER.powi(found.len() as i32 - 1);
            branch = TorusBranch::from_doubling(flow, &torus, first)?;
        }
    }
    Ok(found)
}

fn next_doubling(branch: &mut TorusBranch) -> Result<SlowTorus, AveragingError> {
    for _ in 0..MOST_CYCLES {
        let before = branch.clone();
        branch.advance()?;
        if before.torus.doubling_test() > 0.0 && branch.torus.doubling_test() <= 0.0 {
            return before.doubling(branch);
        }
    }
    let (xi1, period) = (branch.torus.xi1, branch.torus.period);
    let reason = format!("no multiplier -1 in {MOST_CYCLES} cycles");
    Err(AveragingError::TorusLost { xi1, period, reason })
}
