//! What to use: per configuration the fewest steps per period from which on amplitude, frequency and secondary Hopf point are right to
//! 1 %, at that step and all finer ones that were run.

use super::configuration::Configuration;
use super::row::{Physics, Row, Verdict};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Quantity of rows about the engine's own secondary Hopf point: the mean over the phases of the steps.
pub const HOPF_QUANTITY: &str = "secondary_hopf_xi1";
/// Quantity of rows about the phase at which that point is farthest off.
pub const HOPF_WORST: &str = "secondary_hopf_worst_error";

/// Quantity of the one row of a case that could not be computed, or was not.
pub(super) const ALL_QUANTITIES: &str = "all quantities";
const LIMIT_CYCLE: &str = "limit_cycle";
const HOPF: &str = "secondary_hopf";

/// From how many steps per period on a number is right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Fewest {
    /// Right from this many on; the next coarser step that was run is wrong.
    Steps(u32),
    /// Right at the coarsest step that was run: fewer may do.
    AtMost(u32),
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
    /// The engine's own secondary Hopf point, at every phase of the steps.
    pub hopf: Fewest,
    /// All three; those that were not run leave it not run.
    pub all: Fewest,
    /// The state, over ten periods beside the limit cycle: the motion itself, not only what it settles to.
    pub motion: Fewest,
}

/// Advice for every configuration that was tried on the limit cycle, the default first, then in their order.
#[must_use]
pub fn advice(rows: &[Row]) -> Vec<Advice> {
    let mut configurations: Vec<Configuration> = Vec::new();
    let about = |row: &&Row| row.scenario == LIMIT_CYCLE || row.scenario == HOPF;
    for row in rows.iter().filter(about).filter(|row| row.found.is_some() || row.verdict == Verdict::Failed) {
        if !configurations.contains(&row.configuration) {
            configurations.push(row.configuration);
        }
    }
    configurations.sort_by_key(|configuration| *configuration != Configuration::AVERAGED_FRICTION);
    configurations.into_iter().map(|configuration| of(rows, configuration)).collect()
}

fn of(rows: &[Row], configuration: Configuration) -> Advice {
    let fewest = |scenario: &str, variant: &str, quantities: &[&str]| {
        let wanted = |row: &&Row| {
            row.configuration == configuration
                && row.scenario == scenario
                && row.variant.starts_with(variant)
                && (row.quantity == ALL_QUANTITIES || quantities.contains(&row.quantity.as_str()))
        };
        fewest_steps(rows.iter().filter(wanted).filter_map(judged).collect())
    };
    let amplitude = fewest(LIMIT_CYCLE, "settled", &["bounded", "amplitude", "spread_of_maxima"]);
    let frequency = fewest(LIMIT_CYCLE, "settled", &["bounded", "angular_frequency"]);
    let hopf = fewest(HOPF, "", &[HOPF_QUANTITY, HOPF_WORST]);
    let motion = fewest(LIMIT_CYCLE, "ten periods", &["state_error"]);
    let all = [amplitude, frequency, hopf].into_iter().fold(Fewest::AtMost(0), worse);
    Advice { configuration, amplitude, frequency, hopf, all, motion }
}

/// Whether a row is right, and at which step. A failure without a number is wrong; one of a whole case is wrong at every step.
fn judged(row: &Row) -> Option<(u32, bool)> {
    match (row.physics, row.verdict, row.steps_per_period) {
        (Physics::Right, _, Some(steps)) => Some((steps, true)),
        (Physics::Wrong, _, Some(steps)) => Some((steps, false)),
        (Physics::NotJudged, Verdict::Failed, Some(steps)) => Some((steps, false)),
        (_, Verdict::Failed, None) if row.quantity == ALL_QUANTITIES => Some((u32::MAX, false)),
        _ => None,
    }
}

/// From the finest step up, as long as everything is right.
fn fewest_steps(found: Vec<(u32, bool)>) -> Fewest {
    let Some(coarsest) = found.iter().map(|(steps, _)| *steps).min() else { return Fewest::NotRun };
    let wrong = found.iter().filter(|(_, right)| !right).map(|(steps, _)| *steps).max();
    let right = found.iter().map(|(steps, _)| *steps).filter(|steps| wrong.is_none_or(|wrong| *steps > wrong)).min();
    match right {
        Some(steps) if steps == coarsest => Fewest::AtMost(steps),
        Some(steps) => Fewest::Steps(steps),
        None => Fewest::Never,
    }
}

impl Fewest {
    /// The number of steps that is known to be enough.
    #[must_use]
    pub fn enough(self) -> Option<u32> {
        match self {
            Self::Steps(steps) | Self::AtMost(steps) => Some(steps),
            Self::Never | Self::NotRun => None,
        }
    }
}

fn worse(a: Fewest, b: Fewest) -> Fewest {
    use Fewest::{AtMost, Never, NotRun, Steps};
    match (a, b) {
        (Never, _) | (_, Never) => Never,
        (NotRun, _) | (_, NotRun) => NotRun,
        (AtMost(a), AtMost(b)) => AtMost(a.max(b)),
        (Steps(a), Steps(b)) => Steps(a.max(b)),
        // A bound that is not larger than a known number leaves it.
        (Steps(known), AtMost(bound)) | (AtMost(bound), Steps(known)) => {
            if bound > known {
                AtMost(bound)
            } else {
                Steps(known)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::row::Subject;
    use super::*;

    #[test]
    fn a_step_counts_only_if_all_finer_ones_are_right_too() {
        let found = vec![(64, true), (128, false), (256, true), (512, true)];
        assert_eq!(fewest_steps(found), Fewest::Steps(256));
        assert_eq!(fewest_steps(vec![(64, true), (128, false)]), Fewest::Never);
        assert_eq!(fewest_steps(vec![(128, true), (64, true)]), Fewest::AtMost(64), "fewer were not tried");
        assert_eq!(fewest_steps(vec![]), Fewest::NotRun);
    }

    #[test]
    fn of_two_bounds_the_larger_counts_and_what_is_not_known_stays_so() {
        use Fewest::{AtMost, Never, NotRun, Steps};
        assert_eq!(worse(Steps(64), NotRun), NotRun);
        assert_eq!(worse(Never, NotRun), Never);
        assert_eq!(worse(Steps(64), AtMost(256)), AtMost(256));
        assert_eq!(worse(AtMost(64), Steps(256)), Steps(256));
    }

    #[test]
    fn a_failure_without_a_number_is_wrong_and_what_was_not_run_is_nothing() {
        let subject = |steps| Subject {
            scenario: LIMIT_CYCLE.to_owned(),
            variant: "settled".to_owned(),
            configuration: Configuration::SAMPLED_FRICTION,
            reference: String::new(),
            steps_per_period: steps,
            dt: None,
        };
        assert_eq!(judged(&subject(Some(64)).failed("amplitude", "no maxima")), Some((64, false)));
        assert_eq!(judged(&subject(Some(64)).not_run("amplitude", "")), None);
        let whole = subject(None).failed(ALL_QUANTITIES, "the engine refused");
        assert_eq!(advice(&[whole])[0].amplitude, Fewest::Never);
        assert!(advice(&[subject(None).not_run(ALL_QUANTITIES, "")]).is_empty());
    }
}
