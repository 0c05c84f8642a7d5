//! What the items take from the slow flow.

use super::error::PaperError;
use super::exact::{settled, values};
use super::item::Case;
use crate::averaging::{
    AveragingError, EnergyDefinition, EnergyFrequency, Interpolation, PerturbedLimitCycle, RestoredSlowFlow, SlowFlow,
    SlowHopf, fixed_point, hopf_points,
};
use crate::chaos::{DiagramPlan, DiagramRow, amplitude_diagram};
use crate::dynamics::State;
use crate::model::RigParameters;
use rayon::prelude::*;
use std::sync::Arc;

/// How far x2 is moved off the limit cycle, as for the exact motions.
const PERTURBATION: f64 = 0.001;
/// Start where there is no limit cycle.
const ELSEWHERE: [f64; 5] = [1.2, 0.9, 0.0, -0.5, 1.0];

/// The converged relation with the mean potential energy of the Jenkins spring, taken wherever the paper's items do not vary it.
pub(super) fn frequency(parameters: RigParameters) -> Result<Arc<EnergyFrequency>, AveragingError> {
    let definition = EnergyDefinition::MeanPotential;
    Ok(Arc::new(EnergyFrequency::new(parameters, definition, Interpolation::Converged)?))
}

/// Flow and a state beside the slow flow's own limit cycle.
pub(super) fn beside_the_cycle(
    parameters: RigParameters,
    frequency: &Arc<EnergyFrequency>,
) -> Result<(RestoredSlowFlow, State), AveragingError> {
    let flow = RestoredSlowFlow::at(parameters, frequency)?;
    match flow.limit_cycle() {
        Ok(mut state) => {
            state.positions[1] += PERTURBATION;
            Ok((flow, state))
        }
        Err(AveragingError::NoLimitCycle { .. }) => Ok((flow, State::two_mass(ELSEWHERE))),
        Err(error) => Err(error),
    }
}

/// Amplitude diagram of the slow flow in equal steps from `end/count` to `end`.
pub(super) fn diagram(case: &Case, end: f64, count: usize) -> Result<Vec<DiagramRow>, PaperError> {
    let frequency = frequency(case.parameters)?;
    let row = |xi1: f64| {
        let at = case.at(xi1);
        let plan = DiagramPlan { window: settled(case, at, case.choose(3500.0, 1000.0)), ..DiagramPlan::default() };
        Ok(amplitude_diagram(&[xi1], &plan, &[], |_| beside_the_cycle(at, &frequency), |_, _, _| {})?)
    };
    let rows: Vec<Result<Vec<DiagramRow>, PaperError>> =
        values(end / count as f64, end, count).into_par_iter().map(row).collect();
    Ok(rows.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

/// The secondary Hopf point at which the limit cycle loses its stability, before the fold.
pub(super) fn first_hopf(flow: &SlowFlow) -> Result<SlowHopf, PaperError> {
    let found = hopf_points(flow)?.into_iter().find(|point| !point.beyond_fold);
    found.ok_or_else(|| PaperError::missing("secondary Hopf point of the slow flow", flow.parameters()))
}

/// Observed orders of the errors of (29) and of the real part of (30) against the slow flow's own eigenvalues, when the small parameter
/// e of the expansion, `kappa ~ e`, `xi1, xi2 ~ e^2`, is halved from 1/64 to 1/128; e = 1 is the nominal set with xi1 = -0.06.
pub(super) fn orders_of_29_and_30() -> Result<[f64; 2], PaperError> {
    let [coarse, fine] = [1.0 / 64.0, 1.0 / 128.0].map(errors_of_29_and_30);
    let (coarse, fine) = (coarse?, fine?);
    Ok(std::array::from_fn(|i| (coarse[i] / fine[i]).abs().log2()))
}

fn errors_of_29_and_30(e: f64) -> Result<[f64; 2], PaperError> {
    let nominal = RigParameters::default();
    let parameters =
        RigParameters { xi1: -0.06 * e * e, xi2: nominal.xi2 * e * e, kappa: nominal.kappa * e, ..nominal };
    let none = || PaperError::missing("limit cycle to expand around", parameters);
    let expansion = PerturbedLimitCycle::of(&parameters).ok_or_else(none)?;
    let eigenvalues = fixed_point(&SlowFlow::new(parameters, frequency(parameters)?)?)?.eigenvalues();
    let real = eigenvalues.iter().min_by(|a, b| a.im.abs().total_cmp(&b.im.abs())).ok_or_else(none)?;
    let pair = eigenvalues.iter().max_by(|a, b| a.im.total_cmp(&b.im)).ok_or_else(none)?;
    Ok([real.re - expansion.first_eigenvalue, pair.re - expansion.pair_eigenvalue.re])
}
