//! What is known of a run: the judgements of its rows, small enough to be committed, for later runs to be compared with.

use super::ConformanceError;
use super::advice::ALL_QUANTITIES;
use super::document::{Parameters, Report};
use super::row::{Physics, Row, Verdict};
use crate::store::read_whole;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

const COMMAND: &str = "conformance baseline";
/// Digits of numbers in the file: what differs in later ones is rounding, which differs between processors.
const DIGITS: usize = 9;

/// Judgements by case (scenario, variant, configuration) and by step and quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    pub stickslip: String,
    pub command: String,
    pub parameters: Parameters,
    pub engines: Vec<String>,
    pub rows: BTreeMap<String, BTreeMap<String, Known>>,
}

/// What is known of a row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Known {
    pub verdict: Verdict,
    #[serde(default = "not_judged", skip_serializing_if = "is_not_judged")]
    pub physics: Physics,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub found: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Where there is no number: why.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// SHA-256 of the trajectory; left out of files, for it differs between processors.
    #[serde(skip)]
    pub trajectory: Option<String>,
}

fn not_judged() -> Physics {
    Physics::NotJudged
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands in a reference")]
fn is_not_judged(physics: &Physics) -> bool {
    *physics == Physics::NotJudged
}

impl Known {
    fn of(row: &Row) -> Self {
        Self {
            verdict: row.verdict,
            physics: row.physics,
            found: row.found,
            tolerance: row.tolerance,
            reason: row.found.is_none().then(|| row.reason.clone()),
            trajectory: row.trajectory.clone(),
        }
    }

    fn rounded(&self) -> Self {
        let round = |value: f64, digits: usize| format!("{value:.digits$e}").parse().unwrap_or(value);
        let found = self.found.map(|value| round(value, DIGITS - 1));
        // Of a tolerance the size matters.
        Self { found, tolerance: self.tolerance.map(|value| round(value, 2)), ..self.clone() }
    }
}

impl Baseline {
    /// Of a report. Cases that were not run at its depth are left out.
    #[must_use]
    pub fn of(report: &Report) -> Self {
        let mut rows: BTreeMap<String, BTreeMap<String, Known>> = BTreeMap::new();
        for row in &report.rows {
            if row.verdict == Verdict::NotRun && row.quantity == ALL_QUANTITIES {
                continue;
            }
            let (case, what) = names(row);
            rows.entry(case).or_default().insert(what, Known::of(row));
        }
        Self {
            stickslip: report.stickslip.clone(),
            command: COMMAND.to_owned(),
            parameters: report.parameters.clone(),
            engines: report.engines.clone(),
            rows,
        }
    }

    /// From a `report.json` or a file of [`Self::text`].
    ///
    /// # Errors
    /// [`ConformanceError::File`] if it is neither, [`ConformanceError::Store`] if it cannot be read.
    pub fn read(path: &Path) -> Result<Self, ConformanceError> {
        let bytes = read_whole(path)?;
        let bad = |error: serde_json::Error| ConformanceError::File {
            path: path.to_owned(),
            reason: format!(
                "is neither a report.json of this program nor a baseline ({error}): make one with `stickslip conformance`"
            ),
        };
        let value: serde_json::Value = serde_json::from_slice(&bytes).map_err(bad)?;
        if value["command"] == COMMAND {
            return serde_json::from_value(value).map_err(bad);
        }
        serde_json::from_value::<Report>(value).map_err(bad).map(|report| Self::of(&report))
    }

    /// The file: JSON with a row per line, so that version control shows which ones changed.
    #[must_use]
    pub fn text(&self) -> String {
        // Strings, numbers and maps of them have no way not to be JSON.
        fn json(value: &impl Serialize) -> String {
            serde_json::to_string(value).unwrap_or_default()
        }
        let case = |(name, rows): (&String, &BTreeMap<String, Known>)| {
            let rows: Vec<String> =
                rows.iter().map(|(what, known)| format!("  {}: {}", json(what), json(&known.rounded()))).collect();
            format!(" {}: {{\n{}\n }}", json(name), rows.join(",\n"))
        };
        let rows: Vec<String> = self.rows.iter().map(case).collect();
        format!(
            "{{\n\"stickslip\": {},\n\"command\": {},\n\"parameters\": {},\n\"engines\": {},\n\"rows\": {{\n{}\n}}\n}}\n",
            json(&self.stickslip),
            json(&self.command),
            json(&self.parameters),
            json(&self.engines),
            rows.join(",\n")
        )
    }

    /// All rows with what identifies them, as [`Row::identity`].
    pub fn named_rows(&self) -> impl Iterator<Item = (String, &Known)> {
        self.rows
            .iter()
            .flat_map(|(case, rows)| rows.iter().map(move |(what, known)| (format!("{case} | {what}"), known)))
    }
}

/// The two halves of [`Row::identity`]: the case, and step with quantity.
fn names(row: &Row) -> (String, String) {
    let steps = row.steps_per_period.map_or_else(|| "ladder".to_owned(), |steps| steps.to_string());
    (format!("{} | {} | {}", row.scenario, row.variant, row.configuration), format!("{steps} | {}", row.quantity))
}
