//! Rows as they come, saved so that an interrupted diagram goes on where it was.

use super::super::progress::Heartbeat;
use super::DiagramArgs;
use super::motion::Unprepared;
use crate::chaos::{ChaosError, DiagramPlan, DiagramRow, KnownCycle, every_row};
use crate::dynamics::{DenseFlow, State};
use crate::store::{read_whole, write_atomically};
use anyhow::Context;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Finished rows are saved this often.
const SAVE_EVERY: Duration = Duration::from_secs(2);
pub fn rows<F: DenseFlow>(
    args: &DiagramArgs,
    plan: &DiagramPlan,
    parameters: &Value,
    prepare: impl Fn(f64) -> Result<(F, State), Unprepared> + Sync,
    cycle: impl Fn(f64) -> Option<KnownCycle> + Sync,
) -> anyhow::Result<Vec<(f64, Result<DiagramRow, ChaosError>)>> {
    let part = |n: usize| n as f64 / (args.count - 1) as f64;
    let values: Vec<f64> = (0..args.count).map(|n| args.from + (args.to - args.from) * part(n)).collect();
    let saved = args.common.output.as_deref().map(|path| Saved::open(path, parameters)).transpose()?;
    let finished = saved.as_ref().map(|saved| saved.rows.clone()).unwrap_or_default();
    let heartbeat = Heartbeat::new(args.common.quiet, "diagram", "values");
    let recorder = Mutex::new((saved, Instant::now()));
    let rows = every_row(&values, plan, &finished, prepare, cycle, |row, done, all| {
        heartbeat.at(done, all);
        let mut recorder = recorder.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let (Some(saved), last) = &mut *recorder else { return };
        saved.rows.push(*row);
        if last.elapsed() >= SAVE_EVERY {
            // A record that cannot be written costs a repetition, not the result.
            if let Err(error) = saved.write() {
                tracing::warn!("finished rows were not saved: {error:#}");
            }
            *last = Instant::now();
        }
    });
    let saved = recorder.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).0;
    if let Some(saved) = saved {
        saved.discard();
    }
    Ok(values.into_iter().zip(rows).collect())
}

/// Rows of an unfinished diagram, beside its output.
struct Saved {
    path: PathBuf,
    parameters: Value,
    rows: Vec<DiagramRow>,
}

impl Saved {
    /// Rows of the same parameters are taken over, others are left aside.
    fn open(output: &Path, parameters: &Value) -> anyhow::Result<Self> {
        let mut name = output.file_name().context("-o needs a file name")?.to_owned();
        name.push(".partial.json");
        let path = output.with_file_name(name);
        let mut rows = Vec::new();
        if path.exists() {
            let stored: Value = serde_json::from_slice(&read_whole(&path)?).unwrap_or_default();
            if stored["parameters"] == *parameters {
                rows = serde_json::from_value(stored["rows"].clone()).unwrap_or_default();
            }
        }
        Ok(Self { path, parameters: parameters.clone(), rows })
    }

    fn write(&self) -> anyhow::Result<()> {
        let document = json!({"parameters": self.parameters, "rows": self.rows});
        Ok(write_atomically(&self.path, |writer| Ok(serde_json::to_writer(writer, &document)?))?)
    }

    fn discard(self) {
        if self.path.exists()
            && let Err(error) = std::fs::remove_file(&self.path)
        {
            tracing::warn!("{} is no longer needed but could not be removed: {error}", self.path.display());
        }
    }
}
