use crate::model::ParameterError;
use thiserror::Error;

/// Why no periodic orbit was found.
#[derive(Debug, Error)]
pub enum OrbitError {
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error("no limit cycle to start from at xi1 = {xi1}, kappa = {kappa}: it needs xi1 < 0 and kappa > 0")]
    NoGuess { xi1: f64, kappa: f64 },
    #[error("the half-period map failed at (x1, x2, v2) = {at:?}: {source}. Start closer to the orbit")]
    Map { at: [f64; 3], source: Box<dyn std::error::Error + Send + Sync> },
    #[error(
        "Newton's method met a singular derivative at (x1, x2, v2) = {at:?}, residual {residual:e}: a fold may be near"
    )]
    Singular { at: [f64; 3], residual: f64 },
    #[error(
        "Newton's method did not converge in {steps} steps: at (x1, x2, v2) = {at:?} the residual is still {residual:e}. Start closer to the orbit"
    )]
    NoConvergence { at: [f64; 3], residual: f64, steps: usize },
    #[error(
        "the limit cycle could be followed only to xi1 = {reached}, not to {wanted}: a fold lies between ({source})"
    )]
    Stuck { reached: f64, wanted: f64, source: Box<OrbitError> },
}
