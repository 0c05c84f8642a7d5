//! What the items take from the exact system: its branch of limit cycles and motions beside it.

use super::error::PaperError;
use super::item::Case;
use crate::chaos::{
    DiagramPlan, DiagramRow, LyapunovPlan, LyapunovSpectrum, Window, amplitude_diagram, lyapunov_spectrum,
};
use crate::dynamics::{Outcome, State};
use crate::exact::TwoMassFlow;
use crate::model::{RigParameter, RigParameters, TwoMassRig};
use crate::orbit::{Bifurcation, Branch, Heading, OrbitError, PseudoArclength, SpecialPoint, limit_cycle};
use rayon::prelude::*;

/// Where a branch without a fold is given up.
const LARGEST_AMPLITUDE: f64 = 50.0;
/// How far x2 is moved off the limit cycle: visible at once, and far inside the basin.
const PERTURBATION: f64 = 0.001;
/// Start where there is no limit cycle: beyond the slip limit, as its orbits are.
const ELSEWHERE: [f64; 5] = [1.2, 0.9, 0.0, -0.5, 1.0];

/// Where the branch starts: the cycle has amplitude 1.007 at most there, and it lies before the secondary Hopf point, which scales as kappa^2.
fn branch_start(parameters: RigParameters) -> RigParameters {
    let xi1 = -(0.001 * parameters.gamma).min(0.05 * parameters.kappa * parameters.kappa);
    RigParameters { xi1, ..parameters }
}

pub(super) fn flow(parameters: RigParameters) -> Result<TwoMassFlow, OrbitError> {
    Ok(TwoMassFlow::new(&TwoMassRig::new(parameters)?))
}

/// The branch of limit cycles over xi1 from a1 = 1 to an amplitude of mass 1, with its special points.
pub(super) fn branch(parameters: RigParameters, amplitude: f64) -> Result<Branch, PaperError> {
    let start = branch_start(parameters);
    let orbit = limit_cycle(start, flow)?;
    let points = PseudoArclength::new(flow, start, &orbit, RigParameter::Xi1, Heading::Decreasing)?;
    Ok(Branch::follow(points.up_to_amplitude(amplitude), |_| false)?)
}

/// The branch up to its first fold.
pub(super) fn branch_to_fold(parameters: RigParameters) -> Result<Branch, PaperError> {
    let start = branch_start(parameters);
    let points = PseudoArclength::new(flow, start, &limit_cycle(start, flow)?, RigParameter::Xi1, Heading::Decreasing)?;
    let points = points.up_to_amplitude(LARGEST_AMPLITUDE);
    Ok(Branch::follow(points, |branch| branch.special_of(Bifurcation::Fold).next().is_some())?)
}

/// The first fold of a branch.
pub(super) fn fold(branch: &Branch) -> Option<&SpecialPoint> {
    branch.special_of(Bifurcation::Fold).next()
}

/// Secondary Hopf points before the first fold, in the order in which they are met: start, end, ...
pub(super) fn secondary_hopf(branch: &Branch) -> Vec<&SpecialPoint> {
    let before_fold = branch.special.iter().take_while(|point| point.kind != Bifurcation::Fold);
    before_fold.filter(|point| point.kind == Bifurcation::NeimarkSacker).collect()
}

/// Flow and a state beside the limit cycle, as the paper starts its simulations; where there is no cycle, one beyond the slip limit.
pub(super) fn beside_the_cycle(parameters: RigParameters) -> Result<(TwoMassFlow, State), OrbitError> {
    let start = match limit_cycle(parameters, flow) {
        Ok(orbit) => {
            let mut state = orbit.reversal();
            state.positions[1] += PERTURBATION;
            state
        }
        Err(OrbitError::NoGuess { .. } | OrbitError::BeyondFold { .. } | OrbitError::Unbounded { .. }) => {
            State::two_mass(ELSEWHERE)
        }
        Err(error) => return Err(error),
    };
    Ok((flow(parameters)?, start))
}

/// Time after which a motion beside the limit cycle has settled: 15 e-folds of the slowest multiplier, within bounds. The slow growth next
/// to a secondary Hopf point would otherwise be taken for the steady amplitude.
fn settling_time(parameters: RigParameters, [shortest, longest]: [f64; 2]) -> f64 {
    let rate = limit_cycle(parameters, flow).ok().map(|orbit| {
        let half_period = 0.5 * orbit.period;
        orbit.section_multipliers()[0].norm().ln().abs() / half_period
    });
    rate.map_or(shortest, |rate| (15.0 / rate).clamp(shortest, longest))
}

/// What is looked at of a motion beside the limit cycle: `length` after it has settled.
pub(super) fn settled(case: &Case, parameters: RigParameters, length: f64) -> Window {
    let bounds = [3000.0, case.choose(60_000.0, 10_000.0)];
    Window { transient: settling_time(parameters, bounds), length }
}

/// Equally spaced values, ends included.
pub(super) fn values(from: f64, to: f64, count: usize) -> Vec<f64> {
    let last = (count.max(2) - 1) as f64;
    (0..count).map(|n| from + (to - from) * n as f64 / last).collect()
}

/// Amplitude diagram of motions beside the limit cycle over xi1; `parameters` gives the others.
pub(super) fn diagram(case: &Case, parameters: RigParameters, xi1: &[f64]) -> Result<Vec<DiagramRow>, PaperError> {
    let row = |&xi1: &f64| {
        let at = RigParameters { xi1, ..parameters };
        let window = settled(case, at, 8000.0);
        let plan = DiagramPlan { window, ..DiagramPlan::default() };
        let rows = amplitude_diagram(&[xi1], &plan, &[], |_| beside_the_cycle(at), |_, _, _| {})?;
        Ok(rows)
    };
    let rows: Vec<Result<Vec<DiagramRow>, PaperError>> = xi1.par_iter().map(row).collect();
    Ok(rows.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

/// Time for which motions are watched for divergence.
pub(super) const WATCHED: f64 = 6500.0;

/// The first value of xi1, going down in steps, at which the motion beside the limit cycle diverges within [`WATCHED`].
pub(super) fn divergence(parameters: RigParameters, step: f64, lowest: f64) -> Result<Option<f64>, PaperError> {
    let mut n = 1.0;
    while -step * n >= lowest {
        let xi1 = -step * n;
        let (flow, start) = beside_the_cycle(RigParameters { xi1, ..parameters })?;
        if matches!(flow.advance(&start, WATCHED)?.outcome, Outcome::Diverged { .. }) {
            return Ok(Some(xi1));
        }
        n += 1.0;
    }
    Ok(None)
}

/// Lyapunov spectrum of the motion beside the limit cycle; `None` where it diverges.
pub(super) fn spectrum(case: &Case, parameters: RigParameters) -> Result<Option<LyapunovSpectrum>, PaperError> {
    let (flow, start) = beside_the_cycle(parameters)?;
    let plan = LyapunovPlan::new(settled(case, parameters, 30_000.0));
    Ok(lyapunov_spectrum(&flow, &start, plan)?.spectrum().cloned())
}
