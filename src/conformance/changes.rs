//! What changed from one report to another: how an upgrade of the engine is judged.

use super::document::Report;
use super::row::{Physics, Row, Verdict};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Differences of two reports.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Changes {
    /// Engines of the old report that are not those of the new one.
    pub engines: Vec<String>,
    /// Rows whose verdict or physics got worse: these decide.
    pub worse: Vec<Change>,
    pub better: Vec<Change>,
    /// Same judgements, but a number moved by more than its tolerance.
    pub moved: Vec<Change>,
    /// Rows only the new report has.
    pub added: usize,
    /// Rows only the old report has.
    pub gone: Vec<String>,
    /// Trajectories that are no longer the same bit by bit.
    pub other_trajectories: usize,
    /// Rows in both.
    pub common: usize,
}

/// A row in both reports.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Change {
    pub row: String,
    pub old: Option<f64>,
    pub new: Option<f64>,
    pub old_verdict: Verdict,
    pub new_verdict: Verdict,
    pub old_physics: Physics,
    pub new_physics: Physics,
}

impl Changes {
    /// From the old report to the new one. A row of the old report that is gone counts as worse if it had a number.
    #[must_use]
    pub fn between(old: &Report, new: &Report) -> Self {
        let index = |report: &Report| -> BTreeMap<String, Row> {
            report.rows.iter().map(|row| (row.identity(), row.clone())).collect()
        };
        let (before, after) = (index(old), index(new));
        let mut changes = Self {
            engines: old.engines.iter().filter(|engine| !new.engines.contains(engine)).cloned().collect(),
            added: after.keys().filter(|name| !before.contains_key(*name)).count(),
            ..Self::default()
        };
        for (name, a) in &before {
            let Some(b) = after.get(name) else {
                changes.gone.push(name.clone());
                continue;
            };
            changes.common += 1;
            changes.other_trajectories += usize::from(a.trajectory != b.trajectory);
            let change = Change {
                row: name.clone(),
                old: a.found,
                new: b.found,
                old_verdict: a.verdict,
                new_verdict: b.verdict,
                old_physics: a.physics,
                new_physics: b.physics,
            };
            match (badness(b) > badness(a), badness(b) < badness(a)) {
                (true, _) => changes.worse.push(change),
                (_, true) => changes.better.push(change),
                _ if moved(a, b) => changes.moved.push(change),
                _ => {}
            }
        }
        changes
    }

    /// Whether the new report is no worse than the old one in what both have, and misses nothing.
    #[must_use]
    pub fn acceptable(&self) -> bool {
        self.worse.is_empty() && self.gone.is_empty()
    }
}

/// Passed is better than not run, which is better than failed; then right is better than wrong.
fn badness(row: &Row) -> (u8, u8) {
    let verdict = match row.verdict {
        Verdict::Passed => 0,
        Verdict::NotRun => 1,
        Verdict::Failed => 2,
    };
    (verdict, u8::from(row.physics == Physics::Wrong))
}

fn moved(a: &Row, b: &Row) -> bool {
    match (a.found, b.found) {
        (Some(x), Some(y)) => (x - y).abs() > a.tolerance.unwrap_or(0.0).max(1e-12 * x.abs()),
        (None, None) => false,
        _ => true,
    }
}
