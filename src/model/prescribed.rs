//! Prescribed periodic motion of oscillator 0, `x_0(t) = a sin(w t)`, all others held at rest: the way to trace a
//! hysteresis cycle, initial loading included.

use super::quantity::{ParameterError, Range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `x_0(t) = amplitude sin(angular_frequency t)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PrescribedMotion {
    /// Amplitude of mass 1.
    pub amplitude: f64,
    /// Angular frequency, rad per time unit.
    pub angular_frequency: f64,
}

impl PrescribedMotion {
    /// # Errors
    /// [`ParameterError::OutOfRange`] unless both numbers are finite and positive.
    pub fn validated(self) -> Result<Self, ParameterError> {
        Range::Positive.check("amplitude", self.amplitude)?;
        Range::Positive.check("angular_frequency", self.angular_frequency)?;
        Ok(self)
    }

    #[must_use]
    pub fn position(&self, time: f64) -> f64 {
        self.amplitude * (self.angular_frequency * time).sin()
    }

    #[must_use]
    pub fn velocity(&self, time: f64) -> f64 {
        self.amplitude * self.angular_frequency * (self.angular_frequency * time).cos()
    }
}
