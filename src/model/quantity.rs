//! Checks that a number may be used as a physical parameter.
//!
//! Every parameter is finite; beyond that each has a range. The messages name the field, the value found and the range
//! allowed, so that whoever wrote the value can mend it.

use thiserror::Error;

/// A parameter that cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ParameterError {
    /// A number outside the range of its field, infinities and NaN included.
    #[error("{field} = {found} is not allowed: it must be {allowed}")]
    OutOfRange { field: String, found: f64, allowed: &'static str },
    /// A wave number that a ring or row does not have.
    #[error(
        "{field} = {found} is not allowed: it must be a whole number from {least} to {most}, half the number of sectors"
    )]
    NoSuchWave { field: String, found: i64, least: i64, most: i64 },
    /// A vector or matrix of the wrong size.
    #[error("{field} has {found} entries, expected {expected}: give one per {per}")]
    WrongLength { field: String, found: usize, expected: usize, per: &'static str },
    /// A chain without masses.
    #[error("oscillators = 0 is not allowed: a chain has at least 1 oscillator")]
    NoOscillators,
    /// An element attached to an oscillator that is not there.
    #[error(
        "{field} refers to oscillator {found}, but the chain has {count} (numbered from 0): choose one below {count}"
    )]
    NoSuchOscillator { field: String, found: usize, count: usize },
    /// An element whose two ends are the same oscillator.
    #[error("{field} joins oscillator {found} to itself: give two different oscillators")]
    SelfAttached { field: String, found: usize },
}

/// The ranges a field may demand of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Range {
    Finite,
    NonNegative,
    Positive,
    /// Non-dimensional damping: beyond it the rig is so stiff that neither solution is of use.
    Damping,
    /// Non-dimensional coupling stiffness.
    Coupling,
    /// The open-closed interval (0, 1], the range of the friction intensity gamma.
    UnitInterval,
}

impl Range {
    fn holds(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Finite => true,
                Self::NonNegative => value >= 0.0,
                Self::Positive => value > 0.0,
                Self::Damping => value.abs() <= 100.0,
                Self::Coupling => (0.0..=1e4).contains(&value),
                Self::UnitInterval => value > 0.0 && value <= 1.0,
            }
    }

    fn describe(self) -> &'static str {
        match self {
            Self::Finite => "a finite number",
            Self::NonNegative => "finite and not negative",
            Self::Positive => "finite and greater than 0",
            Self::Damping => "from -100 to 100",
            Self::Coupling => "from 0 to 10000",
            Self::UnitInterval => "greater than 0 and at most 1",
        }
    }

    /// Passes `value` through if it lies in the range.
    ///
    /// # Errors
    /// [`ParameterError::OutOfRange`] naming `field` otherwise.
    pub fn check(self, field: impl Into<String>, value: f64) -> Result<f64, ParameterError> {
        if self.holds(value) {
            return Ok(value);
        }
        Err(ParameterError::OutOfRange { field: field.into(), found: value, allowed: self.describe() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_and_infinity_are_outside_every_range() {
        for range in [Range::Finite, Range::NonNegative, Range::Positive, Range::UnitInterval] {
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert!(range.check("mass", value).is_err(), "{range:?} let {value} pass");
            }
        }
    }

    #[test]
    fn the_unit_interval_is_open_below_and_closed_above() {
        assert!(Range::UnitInterval.check("gamma", 0.0).is_err());
        assert!(Range::UnitInterval.check("gamma", 1.0).is_ok());
        let message = Range::UnitInterval.check("gamma", 1.5).unwrap_err().to_string();
        assert_eq!(message, "gamma = 1.5 is not allowed: it must be greater than 0 and at most 1");
    }
}
