//! Runs items in parallel into an output directory, and takes over what is there already.

use super::check::Check;
use super::error::PaperError;
use super::item::{Case, Findings, Number, PARAMETERS, PaperItem, described};
use crate::store::{OutputDir, StoreError, Table, TableFormat, read_whole};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicUsize, Ordering};

/// What is kept of an item, and what the page shows of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ItemResult {
    pub id: String,
    /// No check failed.
    pub passed: bool,
    pub verdict: String,
    pub checks: Vec<Check>,
    pub numbers: Vec<Number>,
    /// Width and height of the picture in CSS pixels, where there is one.
    pub picture: Option<(u32, u32)>,
    /// Names in the output directory.
    pub files: Vec<String>,
}

/// News of a run.
#[derive(Debug, Clone, Copy)]
pub struct News<'a> {
    pub result: &'a ItemResult,
    /// Taken over from an earlier run.
    pub reused: bool,
    pub done: usize,
    pub all: usize,
}

/// Computes the items that `dir` does not hold yet and writes their files; results come in the order of `items`.
///
/// # Errors
/// The first [`PaperError::Store`] in that order. An item that cannot be computed is a result that has not passed and says why; it is
/// not kept, and neither it nor an error of the store keeps others from being computed.
pub fn run(
    items: &[&PaperItem],
    case: &Case,
    dir: &OutputDir,
    progress: impl Fn(News<'_>) + Sync,
) -> Result<Vec<ItemResult>, PaperError> {
    let done = AtomicUsize::new(0);
    let results: Vec<Result<ItemResult, PaperError>> = items
        .par_iter()
        // One at a time per thread: items differ in length by a factor of a hundred.
        .with_max_len(1)
        .map(|item| {
            let (result, reused) = match stored(item, dir) {
                Some(result) => (result, true),
                None => (attempted(item, case, dir)?, false),
            };
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress(News { result: &result, reused, done, all: items.len() });
            Ok(result)
        })
        .collect();
    results.into_iter().collect()
}

/// Decides whether stored files may be used.
fn key(item: &PaperItem) -> String {
    format!("{}, revision {}", item.id, item.revision)
}

fn record_name(item: &PaperItem) -> String {
    format!("{}.json", item.id)
}

/// The result of an earlier run, if all its files are as they were written.
#[must_use]
pub fn stored(item: &PaperItem, dir: &OutputDir) -> Option<ItemResult> {
    let (name, key) = (record_name(item), key(item));
    dir.trusted(&name, &key)?;
    let result: ItemResult = serde_json::from_slice(&read_whole(&dir.path().join(name)).ok()?).ok()?;
    result.files.iter().all(|file| dir.trusted(file, &key).is_some()).then_some(result)
}

fn attempted(item: &PaperItem, case: &Case, dir: &OutputDir) -> Result<ItemResult, PaperError> {
    match computed(item, case, dir) {
        Err(PaperError::Store(error)) => Err(error.into()),
        Err(error) => Ok(failed(item, &error)),
        done => done,
    }
}

/// What stands for an item that could not be computed.
fn failed(item: &PaperItem, error: &PaperError) -> ItemResult {
    let check = Check::holds("computed", "a result", error.to_string(), false, "without a result nothing is checked");
    ItemResult {
        id: item.id.to_owned(),
        passed: false,
        verdict: format!("Failed: {error}."),
        checks: vec![check],
        numbers: Vec::new(),
        picture: None,
        files: Vec::new(),
    }
}

fn computed(item: &PaperItem, case: &Case, dir: &OutputDir) -> Result<ItemResult, PaperError> {
    let findings = match (item.compute)(case) {
        // Other parameters need not have what the figure shows.
        Err(missing @ PaperError::Missing { .. }) if !case.is_nominal() => {
            Findings { verdict: format!("Not applicable: {missing}."), ..Findings::default() }
        }
        other => other.map_err(|source| PaperError::Item { id: item.id, source: Box::new(source) })?,
    };
    let key = key(item);
    let mut files = Vec::new();
    let mut write = |name: String, bytes: &[u8]| -> Result<(), StoreError> {
        dir.write(&name, &key, |writer| writer.write_all(bytes))?;
        files.push(name);
        Ok(())
    };
    for (n, (name, table)) in findings.tables.into_iter().enumerate() {
        let file = if n == 0 { format!("{}.csv", item.id) } else { format!("{}-{name}.csv", item.id) };
        let mut bytes = Vec::new();
        labelled(table, item, &name, case)
            .write_to(TableFormat::Csv, &mut bytes)
            .map_err(|source| StoreError::Write { path: dir.path().join(&file), source })?;
        write(file, &bytes)?;
    }
    let mut picture = None;
    if let Some(figure) = findings.figure {
        write(format!("{}.svg", item.id), figure.svg()?.as_bytes())?;
        write(format!("{}.png", item.id), &figure.png()?)?;
        picture = Some(figure.size);
    }
    let result = ItemResult {
        id: item.id.to_owned(),
        passed: findings.checks.iter().all(|check| check.passed != Some(false)),
        verdict: findings.verdict,
        checks: findings.checks,
        numbers: findings.numbers,
        picture,
        files,
    };
    dir.write(&record_name(item), &key, |writer| Ok(serde_json::to_writer_pretty(writer, &result)?))?;
    Ok(result)
}

/// The table with what decided it in its header; parameters of its own go before those of the run.
fn labelled(table: Table, item: &PaperItem, name: &str, case: &Case) -> Table {
    let mut metadata = vec![
        ("stickslip".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("item".to_owned(), item.id.to_owned()),
        ("content".to_owned(), name.to_owned()),
        ("units".to_owned(), "non-dimensional: time 1/omega0, length R/kt, force R".to_owned()),
    ];
    if !table.metadata.iter().any(|(key, _)| key == PARAMETERS) {
        metadata.push((PARAMETERS.to_owned(), described(case.parameters)));
    }
    metadata.extend(table.metadata);
    Table { metadata, ..table }
}
