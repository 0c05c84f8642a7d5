//! The part of a motion that is looked at.

use super::error::ChaosError;
use serde::{Deserialize, Serialize};

/// A motion is followed for `transient + length`; what happens in the transient is not looked at.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Window {
    pub transient: f64,
    pub length: f64,
}

impl Window {
    #[must_use]
    pub fn end(self) -> f64 {
        self.transient + self.length
    }

    /// # Errors
    /// [`ChaosError::OutOfRange`] unless the transient is not negative and the length positive.
    pub fn validated(self) -> Result<Self, ChaosError> {
        ChaosError::require_non_negative("transient", self.transient)?;
        ChaosError::require_positive("length", self.length)?;
        Ok(self)
    }
}
