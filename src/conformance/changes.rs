//! What changed from one run to another: how an upgrade of the engine is judged.
//!
//! ```text
//! verdict   passed < not run < failed          physics   right < not judged < wrong
//! ```
//!
//! A row got worse if either rose, or if it lost its number. Numbers alone decide nothing: between processors they differ in rounding.

use super::baseline::{Baseline, Known};
use super::row::{Physics, Verdict};
use super::words::short;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Differences of two runs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Changes {
    /// Engines of the old run that are not those of the new one.
    pub engines: Vec<String>,
    /// Rows whose verdict or physics got worse, or whose number is gone.
    pub worse: Vec<Change>,
    /// Rows only the old run has. They count as worse.
    pub gone: Vec<String>,
    /// Rows only the new run has, and which failed. They count as worse: nobody knew of them.
    pub added_failed: Vec<String>,
    pub better: Vec<Change>,
    /// Same judgements, but a number moved by more than its tolerance.
    pub moved: Vec<Change>,
    /// Same judgements and no number in either, for another reason.
    pub other_reasons: Vec<Change>,
    /// All rows only the new run has.
    pub added: Vec<String>,
    /// Trajectories that are no longer the same bit by bit, of those whose hashes both runs have.
    pub other_trajectories: usize,
    /// Rows in both.
    pub common: usize,
}

/// A row in both runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Change {
    pub row: String,
    pub old: Option<f64>,
    pub new: Option<f64>,
    pub old_verdict: Verdict,
    pub new_verdict: Verdict,
    pub old_physics: Physics,
    pub new_physics: Physics,
    /// Why there is no number.
    pub old_reason: Option<String>,
    pub new_reason: Option<String>,
}

impl Changes {
    /// From the old run to the new one.
    #[must_use]
    pub fn between(old: &Baseline, new: &Baseline) -> Self {
        let before: BTreeMap<String, &Known> = old.named_rows().collect();
        let after: BTreeMap<String, &Known> = new.named_rows().collect();
        let added = |failed: bool| {
            let only_new = after.iter().filter(|(name, _)| !before.contains_key(*name));
            let wanted = only_new.filter(|(_, row)| !failed || row.verdict == Verdict::Failed);
            wanted.map(|(name, _)| name.clone()).collect()
        };
        let mut changes = Self {
            engines: old.engines.iter().filter(|engine| !new.engines.contains(engine)).cloned().collect(),
            gone: before.keys().filter(|name| !after.contains_key(*name)).cloned().collect(),
            added: added(false),
            added_failed: added(true),
            ..Self::default()
        };
        for (name, a) in &before {
            if let Some(b) = after.get(name) {
                changes.compare(name, a, b);
            }
        }
        changes
    }

    fn compare(&mut self, name: &str, a: &Known, b: &Known) {
        self.common += 1;
        self.other_trajectories +=
            usize::from(a.trajectory.is_some() && b.trajectory.is_some() && a.trajectory != b.trajectory);
        let list = match kind(a, b) {
            Kind::Worse => &mut self.worse,
            Kind::Better => &mut self.better,
            Kind::Moved => &mut self.moved,
            Kind::OtherReason => &mut self.other_reasons,
            Kind::Same => return,
        };
        list.push(Change {
            row: name.to_owned(),
            old: a.found,
            new: b.found,
            old_verdict: a.verdict,
            new_verdict: b.verdict,
            old_physics: a.physics,
            new_physics: b.physics,
            old_reason: a.reason.clone(),
            new_reason: b.reason.clone(),
        });
    }

    /// Whether the new run is no worse than the old one in anything the old one has, and fails in nothing new.
    #[must_use]
    pub fn acceptable(&self) -> bool {
        self.worse.is_empty() && self.gone.is_empty() && self.added_failed.is_empty()
    }
}

impl Change {
    /// `passed and right, 0.5, is now failed and wrong, 0.7`.
    #[must_use]
    pub fn in_words(&self) -> String {
        let side = |verdict: Verdict, physics: Physics, found: Option<f64>, reason: Option<&String>| {
            let number = found.map_or_else(
                || format!("no number ({})", reason.map_or("no reason given", String::as_str)),
                |found| short(Some(found)),
            );
            format!("{} and {}, {number}", verdict.words(), physics.words())
        };
        format!(
            "{} is now {}",
            side(self.old_verdict, self.old_physics, self.old, self.old_reason.as_ref()),
            side(self.new_verdict, self.new_physics, self.new, self.new_reason.as_ref())
        )
    }
}

enum Kind {
    Worse,
    Better,
    Moved,
    OtherReason,
    Same,
}

fn kind(a: &Known, b: &Known) -> Kind {
    let (verdict, physics) = (rank(a).0.cmp(&rank(b).0), rank(a).1.cmp(&rank(b).1));
    let lost = a.found.is_some() && b.found.is_none();
    if lost || verdict.is_lt() || physics.is_lt() {
        Kind::Worse
    } else if verdict.is_gt() || physics.is_gt() {
        Kind::Better
    } else if moved(a, b) {
        Kind::Moved
    } else if a.found.is_none() && a.reason != b.reason {
        Kind::OtherReason
    } else {
        Kind::Same
    }
}

fn rank(row: &Known) -> (u8, u8) {
    let verdict = match row.verdict {
        Verdict::Passed => 0,
        Verdict::NotRun => 1,
        Verdict::Failed => 2,
    };
    let physics = match row.physics {
        Physics::Right => 0,
        Physics::NotJudged => 1,
        Physics::Wrong => 2,
    };
    (verdict, physics)
}

/// Numbers in files have nine digits.
const ROUNDING: f64 = 1e-8;

fn moved(a: &Known, b: &Known) -> bool {
    match (a.found, b.found) {
        (Some(x), Some(y)) => (x - y).abs() > a.tolerance.unwrap_or(0.0).max(ROUNDING * x.abs()),
        (None, None) => false,
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known(verdict: Verdict, physics: Physics, found: Option<f64>) -> Known {
        let reason = found.is_none().then(|| "why".to_owned());
        Known { verdict, physics, found, tolerance: Some(0.1), reason, trajectory: None }
    }

    fn found_kind(a: &Known, b: &Known) -> &'static str {
        match kind(a, b) {
            Kind::Worse => "worse",
            Kind::Better => "better",
            Kind::Moved => "moved",
            Kind::OtherReason => "reason",
            Kind::Same => "same",
        }
    }

    #[test]
    fn judgements_decide_and_numbers_within_their_tolerance_do_not() {
        use Physics::{NotJudged, Right, Wrong};
        use Verdict::{Failed, NotRun, Passed};
        let at = |verdict, physics| known(verdict, physics, Some(1.0));
        for (better, worse) in [
            (at(Passed, Right), at(Passed, NotJudged)),
            (at(Passed, NotJudged), at(Passed, Wrong)),
            (at(Passed, Right), at(NotRun, Right)),
            (at(NotRun, Right), at(Failed, Right)),
        ] {
            assert_eq!((found_kind(&better, &worse), found_kind(&worse, &better)), ("worse", "better"));
        }
        // One better and one worse is worse; a known failure that stays one is not.
        assert_eq!(found_kind(&at(Failed, Right), &at(Passed, Wrong)), "worse");
        assert_eq!(found_kind(&at(Failed, Wrong), &at(Failed, Wrong)), "same");
        let moved_to = |x| Known { found: Some(x), ..at(Passed, Right) };
        assert_eq!(found_kind(&at(Passed, Right), &moved_to(1.09)), "same");
        assert_eq!(found_kind(&at(Passed, Right), &moved_to(1.11)), "moved");
    }

    #[test]
    fn a_lost_number_is_worse_and_another_reason_is_told() {
        let wrong = known(Verdict::Failed, Physics::Wrong, Some(1.0));
        let none = known(Verdict::Failed, Physics::NotJudged, None);
        assert_eq!(found_kind(&wrong, &none), "worse", "though not judged ranks before wrong");
        let other = Known { reason: Some("something else".to_owned()), ..none.clone() };
        assert_eq!((found_kind(&none, &none), found_kind(&none, &other)), ("same", "reason"));
    }
}
