use crate::store::StoreError;
use std::path::PathBuf;
use thiserror::Error;

/// Why a picture or page could not be made.
#[derive(Debug, Error)]
pub enum ReportError {
    #[error("{path} is not a picture this program can write: name a file ending in .svg or .png")]
    UnknownFormat { path: PathBuf },
    #[error("the chart {title:?} has no finite points to draw")]
    Empty { title: String },
    #[error("the axis {label:?} cannot run from {low} to {high}: give finite ends in ascending order{hint}")]
    BadRange { label: String, low: f64, high: f64, hint: &'static str },
    #[error("the chart {title:?} could not be drawn: {reason}")]
    Drawing { title: String, reason: String },
    #[error(transparent)]
    Store(#[from] StoreError),
}
