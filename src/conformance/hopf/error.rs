use crate::conformance::ConformanceError;
use crate::engine::EngineError;
use crate::model::ParameterError;
use crate::orbit::OrbitError;
use thiserror::Error;

/// Why no periodic orbit or secondary Hopf point of the engine was found.
#[derive(Debug, Error)]
pub enum HopfError {
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The engine could not be built as asked.
    #[error(transparent)]
    Bench(Box<ConformanceError>),
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The exact orbit, from which Newton's method starts.
    #[error("no exact limit cycle to start from: {0}")]
    Guess(#[from] OrbitError),
    #[error("{steps} steps per period is not allowed with the half-period map: choose an even number of at least 8")]
    Steps { steps: u64 },
    #[error("phase {phase} is not allowed: choose one in [0, 1)")]
    Phase { phase: f64 },
    #[error("Newton's method met a singular derivative at step length {step}, xi1 = {xi1}: choose another phase")]
    Singular { step: f64, xi1: f64 },
    #[error(
        "Newton's method did not converge in {iterations} iterations at xi1 = {xi1}: the residual is still {residual:e}, allowed is {allowed:e}. Choose more steps per period, or xi1 nearer to the guess"
    )]
    NoOrbit { xi1: f64, iterations: usize, residual: f64, allowed: f64 },
    #[error(
        "the orbit at xi1 = {xi1} does not end in slip at f = -1 but at f = {found}: it is not one of one stick and one slip phase per half period"
    )]
    NotSlipping { xi1: f64, found: f64 },
    #[error(
        "at xi1 = {xi1} a switch between stick and slip lies on a grid time, within {difference:e} of the state: the map has no derivative there. Choose another phase"
    )]
    SwitchOnGrid { xi1: f64, difference: f64 },
    #[error("no complex pair among the multipliers at xi1 = {xi1}")]
    NoPair { xi1: f64 },
    #[error(
        "no secondary Hopf point near: after {iterations} secant steps xi1 = {xi1}, |mu| - 1 = {excess:e}. The modulus may jump across 1 where a switch crosses a grid time"
    )]
    NoHopf { xi1: f64, excess: f64, iterations: usize },
    #[error("the step {step} lies outside the steps {range:?} of the orbits with {counts:?} steps per period")]
    StepNotBracketed { step: f64, range: [f64; 2], counts: [u64; 2] },
}
