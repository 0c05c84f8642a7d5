//! How a film looks at its motion: panels.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A live panel of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Panel {
    /// Displacements of both masses over time.
    Series,
    /// Slider force over the displacement of mass 1.
    Hysteresis,
    /// Velocity over displacement of mass 1, with the points of a Poincare section.
    Phase,
    /// Amplitude of mass 2 over that of mass 1.
    Amplitudes,
    /// Energy put in and taken out in the last period.
    Energy,
    /// Where the scene stands in the amplitude-damping diagram.
    Map,
}

impl Panel {
    /// All of them, in the order in which they stand where a scene does not say.
    pub const ALL: [Self; 6] = [Self::Series, Self::Hysteresis, Self::Phase, Self::Amplitudes, Self::Energy, Self::Map];
}

/// How the motion is shown.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Direction {
    /// Panels, at most six: the first three beside the scene, the others below it. All of them without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub panels: Option<Vec<Panel>>,
}

impl Direction {
    /// The panels asked for, or all.
    #[must_use]
    pub fn panels(&self) -> &[Panel] {
        self.panels.as_deref().unwrap_or(&Panel::ALL)
    }
}
