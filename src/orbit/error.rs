use super::bifurcation::Bifurcation;
use super::limit_cycle::Mode;
use crate::model::ParameterError;
use thiserror::Error;

type Source = Box<dyn std::error::Error + Send + Sync>;

/// Why no periodic orbit, branch or special point was found. Points are `(x1, x2, v2)`, followed by the parameters that vary.
#[derive(Debug, Error)]
pub enum OrbitError {
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error(
        "no {mode:?} limit cycle to start from at xi1 = {xi1}, xi2 = {xi2}, kappa = {kappa}: it needs kappa > 0 and negative damping of its mode, xi1 for InPhase, xi2 for OutOfPhase"
    )]
    NoGuess { mode: Mode, xi1: f64, xi2: f64, kappa: f64 },
    #[error(
        "there is no limit cycle on the lower branch at {name} = {wanted}: the branch goes to infinity near {name} = {reached}. Choose a weaker {name}"
    )]
    Unbounded { name: &'static str, reached: f64, wanted: f64 },
    #[error("the section map failed at (x1, x2, v2) = {at:?}: {source}. Start closer to the orbit")]
    Map { at: [f64; 3], source: Source },
    #[error("the flow failed along the orbit of period {period}: {source}")]
    Flow { period: f64, source: Source },
    #[error("Newton's method met a singular derivative at {at:?}, residual {residual:e}: a special point may be near")]
    Singular { at: Vec<f64>, residual: f64 },
    #[error(
        "Newton's method did not converge in {steps} steps: at {at:?} the residual is still {residual:e}. Start closer to the orbit"
    )]
    NoConvergence { at: Vec<f64>, residual: f64, steps: usize },
    #[error("the {size} multipliers of an orbit could not be computed: the QR iteration did not converge")]
    NoMultipliers { size: usize },
    #[error(
        "there is no limit cycle on the lower branch at {name} = {wanted}: the branch turns at a fold just beyond {name} = {reached}. Choose a weaker {name}"
    )]
    BeyondFold { name: &'static str, reached: f64, wanted: f64 },
    #[error(
        "the step would turn the tangent by {turn:.3} rad (allowed {allowed_turn:.3}) and lean by {lean:.3} rad (allowed {allowed_lean:.3}): it may lead to another branch; take shorter steps"
    )]
    Jump { turn: f64, allowed_turn: f64, lean: f64, allowed_lean: f64 },
    #[error(
        "the curve could not be followed beyond {at:?} even with step {step:e}: {source}. The orbit may change its phases there, or the parameters leave their range"
    )]
    StepTooSmall { at: Vec<f64>, step: f64, source: Box<OrbitError> },
    #[error(
        "a {kind:?} point has no pair of complex multipliers on the unit circle: criticality is one of Neimark-Sacker points"
    )]
    NoPair { kind: Bifurcation },
    #[error(
        "the normal form is {outer:e} at the larger radius and {inner:e} at the smaller, allowed is a relative difference of {allowed}: a resonance or a change of criticality is near"
    )]
    Undecided { outer: f64, inner: f64, allowed: f64 },
    #[error("no branch of another period or symmetry leaves a {kind:?} point: only those where a multiplier is -1")]
    NoBranchLeaves { kind: Bifurcation },
    #[error("a {kind:?} curve needs two different parameters, not {parameter} twice")]
    SameParameter { kind: Bifurcation, parameter: &'static str },
}

impl OrbitError {
    pub(super) fn singular(at: &[f64], residual: f64) -> Self {
        Self::Singular { at: at.to_vec(), residual }
    }

    pub(super) fn no_convergence(at: &[f64], residual: f64, steps: usize) -> Self {
        Self::NoConvergence { at: at.to_vec(), residual, steps }
    }
}
