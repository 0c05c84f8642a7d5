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
    #[error("conformance: {0}")]
    Engine(#[from] EngineError),
    #[error("conformance: reference: {0}")]
    Exact(#[from] ExactError),
    #[error("conformance: reference: {0}")]
    Orbit(#[from] OrbitError),
    #[error("conformance: reference: {0}")]
    Modes(#[from] ModesError),
    #[error("conformance: {0}")]
    Hopf(#[from] HopfError),
    #[error("conformance: reference: {0}")]
    Chaos(#[from] ChaosError),
    #[error("conformance: {0}")]
    Parameter(#[from] ParameterError),
    #[error("conformance: {0}")]
    Compare(#[from] CompareError),
    #[error("conformance: {0}")]
    Store(#[from] StoreError),
    #[error("conformance: {0}")]
    Report(#[from] ReportError),
    /// A motion that does not show what was to be measured on it.
    #[error("conformance: {scenario}: found {found} {what}, expected at least {expected}: the motion left its kind")]
    TooFew { scenario: &'static str, what: &'static str, found: usize, expected: usize },
    /// A motion that ended early.
    #[error("conformance: {scenario}: the motion exceeded {bound} at t = {time}, expected it to stay bounded")]
    Diverged { scenario: &'static str, time: f64, bound: f64 },
    /// A report or trajectory file that is not what it should be.
    #[error("conformance: {path}: {reason}")]
    File { path: PathBuf, reason: String },
    /// A configuration that a bench cannot build.
    #[error("conformance: this bench has no {mechanism}")]
    NoMechanism { mechanism: &'static str },
    /// A scenario that does not exist.
    #[error("conformance: there is no scenario {found:?}, expected one of: {known}")]
    UnknownScenario { found: String, known: String },
}
