//! The four parameters of the rig by name: what a branch is followed in.

use super::rig::RigParameters;
use serde::{Deserialize, Serialize};

/// One of the rig's parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RigParameter {
    Xi1,
    Xi2,
    Kappa,
    Gamma,
}

impl RigParameter {
    pub const ALL: [Self; 4] = [Self::Xi1, Self::Xi2, Self::Kappa, Self::Gamma];

    /// Name in tables and messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Xi1 => "xi1",
            Self::Xi2 => "xi2",
            Self::Kappa => "kappa",
            Self::Gamma => "gamma",
        }
    }
}

impl RigParameters {
    #[must_use]
    pub fn get(&self, parameter: RigParameter) -> f64 {
        match parameter {
            RigParameter::Xi1 => self.xi1,
            RigParameter::Xi2 => self.xi2,
            RigParameter::Kappa => self.kappa,
            RigParameter::Gamma => self.gamma,
        }
    }

    /// The same with one value replaced; not validated.
    #[must_use]
    pub fn with(self, parameter: RigParameter, value: f64) -> Self {
        match parameter {
            RigParameter::Xi1 => Self { xi1: value, ..self },
            RigParameter::Xi2 => Self { xi2: value, ..self },
            RigParameter::Kappa => Self { kappa: value, ..self },
            RigParameter::Gamma => Self { gamma: value, ..self },
        }
    }
}
