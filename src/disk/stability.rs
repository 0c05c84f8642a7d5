//! Stability of an orbit by its Floquet multipliers.

use serde::{Deserialize, Serialize};

/// Multipliers this near to 1 in modulus are neutral: orbits close to some 1e-12, and their multipliers to about a thousand times that.
pub const NEUTRAL_MULTIPLIER: f64 = 1e-9;

/// What the largest multiplier says, that of the motion itself left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OrbitStability {
    Stable,
    /// 1 in modulus to 1e-9: nothing is known of what motions nearby do in the end.
    Neutral,
    Unstable,
}

impl OrbitStability {
    #[must_use]
    pub fn of(largest_multiplier: f64) -> Self {
        match largest_multiplier - 1.0 {
            d if d < -NEUTRAL_MULTIPLIER => Self::Stable,
            d if d > NEUTRAL_MULTIPLIER => Self::Unstable,
            _ => Self::Neutral,
        }
    }

    /// The word for it, as in JSON documents.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Neutral => "neutral",
            Self::Unstable => "unstable",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::OrbitStability::{self, Neutral, Stable, Unstable};

    #[test]
    fn a_multiplier_of_one_to_rounding_is_neutral() {
        assert_eq!([1.0 + 1e-13, 1.0 - 1e-13].map(OrbitStability::of), [Neutral, Neutral]);
        assert_eq!([1.0 + 1e-8, 1.0 - 1e-8].map(OrbitStability::of), [Unstable, Stable]);
    }
}
