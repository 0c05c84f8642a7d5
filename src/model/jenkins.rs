//! The Jenkins element: a linear spring in series with a dry-friction slider.
//!
//! With `u` the elongation of the element, `k` its stiffness and `R` its slip force, the force `F` it exerts against the
//! elongation obeys
//!
//! ```text
//! dF = k du  while |F| < R or F du < 0  (stick),   dF = 0  while |F| = R and F du > 0  (slip).
//! ```
//!
//! The state of the slider is carried as `f = F/R`, |f| <= 1. This file holds the definition alone; how `f` evolves is
//! the business of the solvers, each in its own way.

use super::quantity::{ParameterError, Range};
use serde::{Deserialize, Serialize};

/// Where the two ends of an element are held. Oscillators are numbered from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Attachment {
    /// Between oscillator and ground: elongation `x_i`.
    Ground(usize),
    /// Between two oscillators: elongation `x_i - x_j`.
    Between(usize, usize),
}

impl Attachment {
    /// Elongation rate or elongation of the element, given one number per oscillator.
    #[must_use]
    pub fn elongation(self, values: &[f64]) -> f64 {
        match self {
            Self::Ground(i) => values[i],
            Self::Between(i, j) => values[i] - values[j],
        }
    }

    /// Adds `weight` times the direction of the element (`b` with elongation `b^T x`) to `target`.
    pub fn scatter(self, weight: f64, target: &mut [f64]) {
        match self {
            Self::Ground(i) => target[i] += weight,
            Self::Between(i, j) => {
                target[i] += weight;
                target[j] -= weight;
            }
        }
    }

    /// The entries of the direction `b` that are not zero: oscillator and sign.
    pub fn direction(self) -> impl Iterator<Item = (usize, f64)> {
        let (first, second) = match self {
            Self::Ground(i) => ((i, 1.0), None),
            Self::Between(i, j) => ((i, 1.0), Some((j, -1.0))),
        };
        std::iter::once(first).chain(second)
    }

    pub(super) fn validate(self, field: &str, count: usize) -> Result<(), ParameterError> {
        let (i, j) = match self {
            Self::Ground(i) => (i, None),
            Self::Between(i, j) => (i, Some(j)),
        };
        if let Some(found) = [Some(i), j].into_iter().flatten().find(|&index| index >= count) {
            return Err(ParameterError::NoSuchOscillator { field: field.to_owned(), found, count });
        }
        if j == Some(i) {
            return Err(ParameterError::SelfAttached { field: field.to_owned(), found: i });
        }
        Ok(())
    }
}

/// A Jenkins element. Stiffness in force per length, slip force in force.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct JenkinsElement {
    pub attachment: Attachment,
    pub stiffness: f64,
    pub slip_force: f64,
}

impl JenkinsElement {
    /// Rate of the normalised slider force per elongation while sticking, `df/du = k/R`.
    #[must_use]
    pub fn normalised_stiffness(&self) -> f64 {
        self.stiffness / self.slip_force
    }

    /// Energy stored in the spring, `R^2 f^2 / (2 k)`, in units of force times length.
    #[must_use]
    pub fn stored_energy(&self, slider_force: f64) -> f64 {
        0.5 * (self.slip_force * slider_force).powi(2) / self.stiffness
    }

    pub(super) fn validate(&self, index: usize, count: usize) -> Result<(), ParameterError> {
        self.attachment.validate(&format!("jenkins[{index}].attachment"), count)?;
        Range::Positive.check(format!("jenkins[{index}].stiffness"), self.stiffness)?;
        Range::Positive.check(format!("jenkins[{index}].slip_force"), self.slip_force)?;
        Ok(())
    }
}

/// Sense in which a slider moves: the sign of the elongation rate, which is that of the slider force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    Positive,
    Negative,
}

impl Direction {
    /// +1 or -1.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }

    /// The direction of a number, `None` for zero and NaN.
    #[must_use]
    pub fn of(value: f64) -> Option<Self> {
        match value {
            v if v > 0.0 => Some(Self::Positive),
            v if v < 0.0 => Some(Self::Negative),
            _ => None,
        }
    }

    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Positive => Self::Negative,
            Self::Negative => Self::Positive,
        }
    }
}

/// Contact state of a Jenkins element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactState {
    Stick,
    Slip(Direction),
}

impl ContactState {
    #[must_use]
    pub fn is_stick(self) -> bool {
        self == Self::Stick
    }

    /// One word for tables: `stick`, `slip+` or `slip-`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::Slip(Direction::Positive) => "slip+",
            Self::Slip(Direction::Negative) => "slip-",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_between_two_oscillators_sees_their_difference() {
        let element = Attachment::Between(2, 0);
        assert_eq!(element.elongation(&[1.0, 5.0, 4.0]), 3.0);
        let mut force = [0.0; 3];
        element.scatter(2.0, &mut force);
        assert_eq!(force, [-2.0, 0.0, 2.0]);
    }

    #[test]
    fn the_spring_holds_half_of_force_squared_over_stiffness() {
        let element = JenkinsElement { attachment: Attachment::Ground(0), stiffness: 4.0, slip_force: 2.0 };
        // F = R f = 1, so F^2/(2 k) = 1/8.
        assert_eq!(element.stored_energy(0.5), 0.125);
    }
}
