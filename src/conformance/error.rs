use super::hopf::HopfError;
use crate::chaos::ChaosError;
use crate::compare::CompareError;
use crate::engine::EngineError;
use crate::exact::ExactError;
use crate::model::{ModesError, ParameterError};
use crate::orbit::OrbitError;
use crate::report::ReportError;
use crate::store::StoreError;
use std::path::PathBuf;
use thiserror::Error;

/// Why a part of the report could not be made.
#[derive(Debug, Error)]
pub enum ConformanceError {
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error("reference: {0}")]
    Exact(#[from] ExactError),
    #[error("reference: {0}")]
    Orbit(#[from] OrbitError),
    #[error("reference: {0}")]
    Modes(#[from] ModesError),
    #[error(transparent)]
    Hopf(#[from] HopfError),
    #[error("reference: {0}")]
    Chaos(#[from] ChaosError),
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error(transparent)]
    Report(#[from] ReportError),
    /// A motion that does not show what was to be measured on it.
    #[error("{scenario}: found {found} {what}, expected at least {expected}: the motion left its kind")]
    TooFew { scenario: &'static str, what: &'static str, found: usize, expected: usize },
    /// A motion that ended early.
    #[error("{scenario}: the motion exceeded {bound} at t = {time}, expected it to stay bounded")]
    Diverged { scenario: &'static str, time: f64, bound: f64 },
    /// A report or trajectory file that is not what it should be.
    #[error("{path}: {reason}")]
    File { path: PathBuf, reason: String },
    /// A configuration that a bench cannot build.
    #[error("this bench has no {mechanism}")]
    NoMechanism { mechanism: &'static str },
    /// A scenario that does not exist.
    #[error("there is no scenario {found:?}, expected one of: {known}")]
    UnknownScenario { found: String, known: String },
}
