use thiserror::Error;

/// Why two motions cannot be compared.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CompareError {
    #[error("samples {index} are at t = {reference} and t = {tested}: sample both motions at the same times")]
    DifferentTimes { index: usize, reference: f64, tested: f64 },
    #[error(
        "the motions have {reference} and {tested} samples though neither diverged: sample both over the same time span"
    )]
    DifferentLengths { reference: usize, tested: usize },
    #[error("the states have {reference} and {tested} components: compare motions of one rig")]
    DifferentRigs { reference: usize, tested: usize },
    #[error("a motion without samples cannot be compared: give at least one sample")]
    Empty,
    #[error("horizon = {found} is not allowed: it must be greater than 0 and at most {last}, the last sample")]
    Horizon { found: f64, last: f64 },
    #[error("{field} = {found} is not allowed: it must be {allowed}")]
    OutOfRange { field: &'static str, found: f64, allowed: &'static str },
    #[error("an order needs at least {needed} different steps, found {found}: lengthen the ladder")]
    ShortLadder { found: usize, needed: usize },
    #[error("a flow failed during the comparison: {flow}: {reason}")]
    Flow { flow: String, reason: String },
}
