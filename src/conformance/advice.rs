//! What to use: per configuration the fewest steps per period from which on amplitude, frequency and secondary Hopf point are right to
//! 1 %, at that step and all finer ones that were run.

use super::configuration::Configuration;
use super::row::{Physics, Row};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Quantity of rows about the engine's own secondary Hopf point.
pub const HOPF_QUANTITY: &str = "secondary_hopf_xi1";

/// What a row about a step asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Fewest {
    /// Right from this many steps per period on.
    Steps(u32),
    /// Wrong at the finest step that was run.
    Never,
    /// No rows: nothing is known.
    NotRun,
}

/// Advice about one configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Advice {
    pub configuration: Configuration,
    /// Mean maximum of the settled limit cycle, and its maxima equal to 1 %: a torus in its place is wrong.
    pub amplitude: Fewest,
    pub frequency: Fewest,
    /// The engine's own secondary Hopf point.
    pub hopf: Fewest,
    /// All three; those that were not run leave it not run.
    pub all: Fewest,
}

/// Advice for every configuration that has numbers about the limit cycle, in their order.
#[must_use]
pub fn advice(rows: &[Row]) -> Vec<Advice> {
    let mut configurations: Vec<Configuration> = Vec::new();
    let about = |row: &&Row| row.scenario == "limit_cycle" || row.quantity == HOPF_QUANTITY;
    for row in rows.iter().filter(about).filter(|row| row.found.is_some()) {
        if !configurations.contains(&row.configuration) {
            configurations.push(row.configuration);
        }
    }
    configurations.into_iter().map(|configuration| of(rows, configuration)).collect()
}

fn of(rows: &[Row], configuration: Configuration) -> Advice {
    let fewest = |quantities: &[&str]| {
        let settled = |row: &&Row| row.variant.starts_with("settled") || row.quantity == HOPF_QUANTITY;
        let wanted = |row: &&Row| row.configuration == configuration && quantities.contains(&row.quantity.as_str());
        let found = rows.iter().filter(settled).filter(wanted);
        fewest_steps(found.filter_map(|row| Some((row.steps_per_period?, row.physics))).collect())
    };
    let amplitude = fewest(&["bounded", "amplitude", "spread_of_maxima"]);
    let frequency = fewest(&["bounded", "angular_frequency"]);
    let hopf = fewest(&[HOPF_QUANTITY]);
    let all = [amplitude, frequency, hopf].into_iter().fold(Fewest::Steps(0), worse);
    Advice { configuration, amplitude, frequency, hopf, all }
}

/// From the finest step up, as long as everything is right.
fn fewest_steps(mut found: Vec<(u32, Physics)>) -> Fewest {
    found.retain(|(_, physics)| *physics != Physics::NotJudged);
    if found.is_empty() {
        return Fewest::NotRun;
    }
    let wrong = found.iter().filter(|(_, physics)| *physics == Physics::Wrong).map(|(steps, _)| *steps).max();
    let right = found.iter().map(|(steps, _)| *steps).filter(|steps| wrong.is_none_or(|wrong| *steps > wrong)).min();
    right.map_or(Fewest::Never, Fewest::Steps)
}

fn worse(a: Fewest, b: Fewest) -> Fewest {
    match (a, b) {
        (Fewest::Steps(a), Fewest::Steps(b)) => Fewest::Steps(a.max(b)),
        (Fewest::Never, _) | (_, Fewest::Never) => Fewest::Never,
        _ => Fewest::NotRun,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_counts_only_if_all_finer_ones_are_right_too() {
        use Physics::{NotJudged, Right, Wrong};
        assert_eq!(fewest_steps(vec![(64, Right), (128, Wrong), (256, Right), (512, Right)]), Fewest::Steps(256));
        assert_eq!(fewest_steps(vec![(64, Right), (128, Wrong)]), Fewest::Never);
        assert_eq!(fewest_steps(vec![(64, NotJudged)]), Fewest::NotRun);
        assert_eq!(worse(Fewest::Steps(64), Fewest::NotRun), Fewest::NotRun);
        assert_eq!(worse(Fewest::Never, Fewest::NotRun), Fewest::Never);
    }
}
