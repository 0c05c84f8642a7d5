use thiserror::Error;

/// Why a motion could not be analysed.
#[derive(Debug, Error)]
pub enum ChaosError {
    #[error("{field} = {found} is not allowed: it must be {allowed}")]
    OutOfRange { field: &'static str, found: f64, allowed: &'static str },
    #[error("the flow `{flow}` failed: {source}")]
    Flow { flow: String, source: Box<dyn std::error::Error + Send + Sync> },
    #[error("the motion at parameter {value} could not be set up: {source}")]
    Preparation { value: f64, source: Box<dyn std::error::Error + Send + Sync> },
    #[error("{quantity} needs at least {needed} {of}, found {found}: observe the motion for longer")]
    TooShort { quantity: &'static str, of: &'static str, needed: usize, found: usize },
    #[error(
        "the motion diverged at time {time}, before {quantity} could be found: {quantity} exists for bounded motions only"
    )]
    Diverged { quantity: &'static str, time: f64 },
    #[error(
        "the {returns} returns wind {turns:.3} times around their mean: they lie on no closed curve around it, so there is no rotation number; check that the motion is a torus"
    )]
    NotWinding { returns: usize, turns: f64 },
}

impl ChaosError {
    pub(super) fn flow(name: String, source: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Flow { flow: name, source: Box::new(source) }
    }

    /// # Errors
    /// [`Self::OutOfRange`] unless `found` is finite and greater than 0.
    pub(super) fn require_positive(field: &'static str, found: f64) -> Result<(), Self> {
        if found.is_finite() && found > 0.0 {
            return Ok(());
        }
        Err(Self::OutOfRange { field, found, allowed: "finite and greater than 0" })
    }

    /// # Errors
    /// [`Self::OutOfRange`] unless `found` is finite and not negative.
    pub(super) fn require_non_negative(field: &'static str, found: f64) -> Result<(), Self> {
        if found.is_finite() && found >= 0.0 {
            return Ok(());
        }
        Err(Self::OutOfRange { field, found, allowed: "finite and not negative" })
    }
}
