//! `conformance`: how wrong the engine is, and what changed since an earlier run.

use super::Verdict;
use super::common::{Common, print};
use super::exchange::{ExportArgs, JudgeArgs, export, judge};
use super::progress::Heartbeat;
use crate::conformance::{
    Archive, Baseline, Change, Changes, Depth, Rapier, Report, Row, Timing, about, compute, costs, found_and_expected,
    html, markdown, registry,
};
use crate::store::{Existing, Origin, OutputDir, sha256_hex, write_atomically};
use anyhow::{Context, ensure};
use clap::{Args, Subcommand};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

const DEFAULT_DIRECTORY: &str = "reports/conformance";
/// Lines of each kind that are printed; all are in the files.
const LINES: usize = 20;

/// How wrong the engine is, measured: report.html, report.md, report.json.
///
/// Finished cases are saved as they come; an interrupted run goes on where it was. Exit status 1 if a number is not what the theory of its
/// configuration predicts. With --compare, exit status 1 only if something got worse, so that a known failure passes.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "What --compare compares: rows are paired by scenario, variant, configuration, steps per period and quantity. A row got worse if its \
                  verdict did (passed < not run < failed), or its physics (right < not judged < wrong), or if its number is gone. Rows that are gone \
                  count as worse, and so do new rows that failed; other new rows are told. Numbers that moved by more than the row's tolerance, and \
                  other reasons where there is no number, are told and decide nothing: between processors numbers differ in rounding.\n\n\
                  Examples:\n  stickslip conformance --quick -o reports/quick\n  stickslip conformance --compare old/report.json\n  \
                  stickslip conformance --quick --compare assets/conformance-baseline.json\n  \
                  stickslip conformance --quick --write-baseline assets/conformance-baseline.json\n  \
                  stickslip conformance export -o setups\n  stickslip conformance judge mine/limit_cycle.csv"
)]
pub struct ConformanceArgs {
    #[command(subcommand)]
    task: Option<Task>,
    /// A selection of configurations and steps; the rest is marked as not run.
    #[arg(long)]
    quick: bool,
    /// Say what changed since this report.json or baseline of the same depth; exit status 1 only if something got worse.
    #[arg(long, value_name = "OLD.json")]
    compare: Option<PathBuf>,
    /// Also write what later runs are to be compared with: identity, verdict, physics and number of every row.
    #[arg(long, value_name = "FILE")]
    write_baseline: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
}

#[derive(Debug, Subcommand)]
enum Task {
    Export(ExportArgs),
    Judge(JudgeArgs),
}

pub fn run(args: &ConformanceArgs) -> anyhow::Result<Verdict> {
    match &args.task {
        Some(Task::Export(args)) => export(args),
        Some(Task::Judge(args)) => judge(args),
        None => report(args),
    }
}

fn report(args: &ConformanceArgs) -> anyhow::Result<Verdict> {
    let depth = if args.quick { Depth::Quick } else { Depth::Full };
    let old = args.compare.as_deref().map(|path| baseline(path, depth)).transpose()?;
    let root = args.common.output.clone().unwrap_or_else(|| PathBuf::from(DEFAULT_DIRECTORY));
    let existing = if args.common.force { Existing::Replace } else { Existing::Resume };
    let directory = OutputDir::open(&root, &Origin::new("conformance", json!({"depth": depth})), existing)?;
    let program = fingerprint()?;
    let heartbeat = Heartbeat::new(args.common.quiet, "conformance", "cases");
    let scenarios = registry();
    let begun = Instant::now();
    let archive = Archive { directory: &directory, program: &program };
    let rows = compute(&scenarios, depth, Some(archive), &Rapier, &|done, all| heartbeat.at(done, all))?;
    let seconds = begun.elapsed().as_secs_f64();
    let timing = Timing { seconds, costs: costs(&rows, &Rapier)? };
    let report = Report::new(&scenarios, depth, rows, Some(timing));
    let new = Baseline::of(&report);
    let changes = old.map(|old| Changes::between(&old, &new));
    write_files(&directory, &report, changes.as_ref())?;
    if let Some(path) = &args.write_baseline {
        write_atomically(path, |writer| writer.write_all(new.text().as_bytes()))?;
    }
    if args.common.json {
        print(&serde_json::to_string_pretty(&report).context("the report could not be written as JSON")?)?;
    } else {
        say(&report, changes.as_ref(), &root)?;
    }
    let good = changes.map_or(report.tally.failed == 0, |changes| changes.acceptable());
    Ok(if good { Verdict::Done } else { Verdict::Failed })
}

/// What is known of an earlier run. Another depth has other rows, and there would be nothing to compare.
fn baseline(path: &Path, depth: Depth) -> anyhow::Result<Baseline> {
    let old = Baseline::read(path)?;
    let word = |depth| if depth == Depth::Quick { "with --quick" } else { "in full" };
    ensure!(
        old.parameters.depth == depth,
        "{}: was run {}, this run is {}: compare runs of the same depth",
        path.display(),
        word(old.parameters.depth),
        word(depth)
    );
    Ok(old)
}

/// Of the running program, so that rows of another build are not taken over.
fn fingerprint() -> anyhow::Result<String> {
    let path = std::env::current_exe().context("the path of this program")?;
    Ok(sha256_hex(&std::fs::read(&path).with_context(|| format!("{}", path.display()))?))
}

fn write_files(directory: &OutputDir, report: &Report, changes: Option<&Changes>) -> anyhow::Result<()> {
    directory.write("report.json", "", |writer| Ok(serde_json::to_writer_pretty(writer, report)?))?;
    directory.write("report.md", "", |writer| writer.write_all(markdown(report, changes).as_bytes()))?;
    let page = html(report, changes)?;
    directory.write("report.html", "", |writer| writer.write_all(page.as_bytes()))?;
    if let Some(changes) = changes {
        directory.write("changes.json", "", |writer| Ok(serde_json::to_writer_pretty(writer, changes)?))?;
    }
    Ok(())
}

fn say(report: &Report, changes: Option<&Changes>, root: &Path) -> anyhow::Result<()> {
    let tally = report.tally;
    print(&format!(
        "as predicted: {} passed, {} failed, {} not run; physics: {} right, {} wrong",
        tally.passed, tally.failed, tally.not_run, tally.right, tally.wrong
    ))?;
    let failed: Vec<&Row> =
        report.rows.iter().filter(|row| row.verdict == crate::conformance::Verdict::Failed).collect();
    lines("failed", &failed, |row| format!("{}: {}", about(row), found_and_expected(row)))?;
    if let Some(changes) = changes {
        say_changes(changes)?;
    }
    print(&format!("{}", root.join("report.html").display()))
}

fn say_changes(changes: &Changes) -> anyhow::Result<()> {
    let Changes { engines, worse, gone, added_failed, better, moved, other_reasons, added, common, .. } = changes;
    if !engines.is_empty() {
        print(&format!("the older run was made with {}", engines.join(", ")))?;
    }
    print(&format!(
        "compared by verdict and physics, {common} rows: {} worse, {} gone, {} new of which {} failed, {} better; told only: {} numbers moved beyond \
         their tolerance, {} other reasons",
        worse.len(),
        gone.len(),
        added.len(),
        added_failed.len(),
        better.len(),
        moved.len(),
        other_reasons.len()
    ))?;
    lines("worse", worse, told)?;
    lines("gone", gone, Clone::clone)?;
    lines("new and failed", added_failed, Clone::clone)?;
    lines("better", better, told)?;
    let good: Vec<&String> = added.iter().filter(|name| !added_failed.contains(name)).collect();
    lines("new", &good, |name| (*name).clone())?;
    lines("moved", moved, told)?;
    lines("other reason", other_reasons, told)
}

fn told(change: &Change) -> String {
    format!("{}: {}", change.row, change.in_words())
}

/// The first few, and how many there are beyond.
fn lines<T>(word: &str, items: &[T], text: impl Fn(&T) -> String) -> anyhow::Result<()> {
    items.iter().take(LINES).try_for_each(|item| print(&format!("{word}: {}", text(item))))?;
    if items.len() > LINES { print(&format!("{word}: and {} more", items.len() - LINES)) } else { Ok(()) }
}
