use crate::chaos::ChaosError;
use crate::orbit::OrbitError;
use crate::report::ReportError;
use crate::store::StoreError;
use thiserror::Error;

/// Why the paper, or one of its items, could not be reproduced.
#[derive(Debug, Error)]
pub enum PaperError {
    #[error("there is no item {id:?}; the items are: {known}")]
    UnknownItem { id: String, known: String },
    #[error("{id} could not be computed: {source}")]
    Item { id: &'static str, source: Box<PaperError> },
    #[error(transparent)]
    Orbit(#[from] OrbitError),
    #[error(transparent)]
    Chaos(#[from] ChaosError),
    #[error(transparent)]
    Parameter(#[from] crate::model::ParameterError),
    #[error(transparent)]
    Exact(#[from] crate::exact::ExactError),
    #[error(transparent)]
    Engine(#[from] crate::engine::EngineError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error("{what} was not found for xi2 = {xi2}, kappa = {kappa}, gamma = {gamma}: these parameters have no {what}")]
    Missing { what: &'static str, xi2: f64, kappa: f64, gamma: f64 },
}

impl PaperError {
    /// Something that not every parameter set has.
    #[must_use]
    pub fn missing(what: &'static str, p: crate::model::RigParameters) -> Self {
        Self::Missing { what, xi2: p.xi2, kappa: p.kappa, gamma: p.gamma }
    }
}
