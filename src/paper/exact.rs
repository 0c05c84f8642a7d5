//! What the items take from the exact system: its branch of limit cycles and motions beside it.

use super::error::PaperError;
use super::item::Case;
use crate::chaos::{DiagramPlan, DiagramRow, Window, amplitude_diagram};
use crate::dynamics::State;
use crate::exact::TwoMassFlow;
use crate::model::{RigParameter, RigParameters, TwoMassRig};
use crate::orbit::{Bifurcation, Branch, Heading, OrbitError, PseudoArclength, SpecialPoint, limit_cycle};

/// Where the branch starts, in units of gamma: the cycle has amplitude 1.007 there.
const BRANCH_START: f64 = -0.001;
/// How far x2 is moved off the limit cycle: visible at once, and far inside the basin.
const PERTURBATION: f64 = 0.001;
/// Start where there is no limit cycle: beyond the slip limit, as its orbits are.
const ELSEWHERE: [f64; 5] = [1.2, 0.9, 0.0, -0.5, 1.0];

pub(super) fn flow(parameters: RigParameters) -> Result<TwoMassFlow, OrbitError> {
    Ok(TwoMassFlow::new(&TwoMassRig::new(parameters)?))
}

/// The branch of limit cycles over xi1 from a1 = 1 to an amplitude of mass 1, with its special points.
pub(super) fn branch(parameters: RigParameters, amplitude: f64) -> Result<Branch, PaperError> {
    let start = RigParameters { xi1: BRANCH_START * parameters.gamma, ..parameters };
    let orbit = limit_cycle(start, flow)?;
    let points = PseudoArclength::new(flow, start, &orbit, RigParameter::Xi1, Heading::Decreasing)?;
    Ok(Branch::follow(points.up_to_amplitude(amplitude), |_| false)?)
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
        Err(OrbitError::NoGuess { .. } | OrbitError::BeyondFold { .. }) => State::two_mass(ELSEWHERE),
        Err(error) => return Err(error),
    };
    Ok((flow(parameters)?, start))
}

/// Amplitude diagram of motions beside the limit cycle at `count` values of xi1.
pub(super) fn diagram(case: &Case, from: f64, to: f64, count: usize) -> Result<Vec<DiagramRow>, PaperError> {
    let window =
        case.choose(Window { transient: 3000.0, length: 3500.0 }, Window { transient: 1000.0, length: 1000.0 });
    let plan = DiagramPlan { window, ..DiagramPlan::default() };
    let values: Vec<f64> = (0..count).map(|n| from + (to - from) * n as f64 / (count - 1) as f64).collect();
    Ok(amplitude_diagram(&values, &plan, &[], |xi1| beside_the_cycle(case.at(xi1)), |_, _, _| {})?)
}
