//! What is to be computed, and how: cases in parallel, each saved when it is done, so that a killed run goes on where it was.

use super::ConformanceError;
use super::registry::registry;
use super::row::Row;
use super::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::store::{OutputDir, read_whole, sha256_hex};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Called with the number of finished cases and of all.
pub type Progress<'a> = dyn Fn(usize, usize) + Sync + 'a;

/// Where finished cases are kept.
#[derive(Debug, Clone, Copy)]
pub struct Archive<'a> {
    pub directory: &'a OutputDir,
    /// Fingerprint of the program: rows that another build computed are stale, and computed again.
    pub program: &'a str,
}

/// All rows at a depth, in the order of the registry, whatever the number of threads. Cases beyond the depth are rows marked as not run;
/// a case that cannot be computed is a failed row with the reason.
///
/// # Errors
/// [`ConformanceError::Store`] if finished rows cannot be saved.
pub fn compute(
    scenarios: &[Box<dyn Scenario>],
    depth: Depth,
    archive: Option<Archive<'_>>,
    bench: &dyn Bench,
    progress: &Progress<'_>,
) -> Result<Vec<Row>, ConformanceError> {
    let cases: Vec<(&dyn Scenario, Case)> = scenarios
        .iter()
        .flat_map(|scenario| scenario.cases(depth).into_iter().map(move |case| (scenario.as_ref(), case)))
        .collect();
    let (all, done) = (cases.iter().filter(|(_, case)| case.depth <= depth).count(), AtomicUsize::new(0));
    let rows = cases
        .par_iter()
        // One case at a time: neighbours cost the same, and chunks of costly ones would leave other threads idle.
        .with_max_len(1)
        .map(|(scenario, case)| {
            if case.depth > depth {
                let reason = "only in the full run";
                return Ok(vec![subject(*scenario, case).not_run("all quantities", reason)]);
            }
            let mut rows = rows_of(*scenario, case, archive, bench)?;
            rows.extend(steps_left_out(*scenario, case, &cases));
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, all);
            Ok(rows)
        })
        .collect::<Result<Vec<Vec<Row>>, ConformanceError>>()?;
    Ok(rows.into_iter().flatten().collect())
}

/// A row about the steps that other configurations of the same variant run, and this one does not.
fn steps_left_out(scenario: &dyn Scenario, case: &Case, all: &[(&dyn Scenario, Case)]) -> Option<Row> {
    let kin = all.iter().map(|(_, other)| other).filter(|other| {
        other.scenario == case.scenario
            && other.variant == case.variant
            && other.configuration.mechanism == case.configuration.mechanism
    });
    let steps: BTreeSet<u32> = kin.flat_map(|other| &other.steps).copied().collect();
    let missing: Vec<String> = steps.into_iter().filter(|n| !case.steps.contains(n)).map(|n| n.to_string()).collect();
    let reason = format!(
        "not run at {} steps per period in this configuration: costly, and shown by the configurations that tell most",
        missing.join(", ")
    );
    (!missing.is_empty()).then(|| subject(scenario, case).not_run("other steps", &reason))
}

fn rows_of(
    scenario: &dyn Scenario,
    case: &Case,
    archive: Option<Archive<'_>>,
    bench: &dyn Bench,
) -> Result<Vec<Row>, ConformanceError> {
    let Some(Archive { directory, program }) = archive else { return Ok(computed(scenario, case, bench)) };
    let fingerprint =
        sha256_hex(serde_json::to_string(case).map_err(std::io::Error::other).unwrap_or_default().as_bytes());
    let name = format!("cases/{}_{}.json", case.scenario, &fingerprint[..12]);
    let key = format!("{program} {fingerprint}");
    let saved = directory.trusted(&name, &key).and_then(|_| read_whole(&directory.path().join(&name)).ok());
    if let Some(rows) = saved.and_then(|bytes| serde_json::from_slice(&bytes).ok()) {
        return Ok(rows);
    }
    let rows = computed(scenario, case, bench);
    directory.write(&name, &key, |writer| Ok(serde_json::to_writer(writer, &rows)?))?;
    Ok(rows)
}

fn computed(scenario: &dyn Scenario, case: &Case, bench: &dyn Bench) -> Vec<Row> {
    scenario
        .run(case, bench)
        .unwrap_or_else(|error| vec![subject(scenario, case).failed("all quantities", &error.to_string())])
}

/// The scenario of that name.
///
/// # Errors
/// [`ConformanceError::UnknownScenario`].
pub fn scenario_named(name: &str) -> Result<Box<dyn Scenario>, ConformanceError> {
    let known = || registry().iter().map(|scenario| scenario.id()).collect::<Vec<_>>().join(", ");
    let found = registry().into_iter().find(|scenario| scenario.id() == name);
    found.ok_or_else(|| ConformanceError::UnknownScenario { found: name.to_owned(), known: known() })
}
