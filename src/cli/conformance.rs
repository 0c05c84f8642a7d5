//! `conformance`: how wrong the engine is; with `export` and `judge`, how wrong another engine is.

use super::Verdict;
use super::common::{Common, Document, print};
use super::progress::Heartbeat;
use crate::conformance::{
    Archive, Changes, Depth, Rapier, Report, Score, Setup, Timing, compute, costs, html, markdown, registry,
};
use crate::store::{Existing, Origin, OutputDir, sha256_hex};
use anyhow::{Context, ensure};
use clap::{Args, Subcommand};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

const DEFAULT_DIRECTORY: &str = "reports/conformance";

/// How wrong the engine is, measured: report.html, report.md, report.json.
///
/// Finished cases are saved as they come; an interrupted run goes on where it was. Exit status 1 if a number is not what the theory of its
/// configuration predicts, or got worse than in the report given with --compare.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "Examples:\n  stickslip conformance --quick -o reports/quick\n  stickslip conformance --compare old/report.json\n  \
                  stickslip conformance export -o setups\n  stickslip conformance judge mine/limit_cycle.csv"
)]
pub struct ConformanceArgs {
    #[command(subcommand)]
    task: Option<Task>,
    /// A selection of configurations and steps; the rest is marked as not run.
    #[arg(long)]
    quick: bool,
    /// Say what changed since this report.json.
    #[arg(long, value_name = "OLD.json")]
    compare: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
}

#[derive(Debug, Subcommand)]
enum Task {
    Export(ExportArgs),
    Judge(JudgeArgs),
}

/// Write set-ups (JSON) and exact references (CSV) of the scenarios, for other engines.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip conformance export -o setups")]
struct ExportArgs {
    #[command(flatten)]
    common: Common,
}

/// Score trajectories of another engine. A file NAME.csv is judged by the set-up NAME; columns t, x1, ..., v1, ... at the reference's times.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip conformance judge mine/limit_cycle.csv mine/friction_decay.csv")]
struct JudgeArgs {
    #[arg(required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &ConformanceArgs) -> anyhow::Result<Verdict> {
    match &args.task {
        Some(Task::Export(args)) => export(args),
        Some(Task::Judge(args)) => judge(args),
        None => report(args),
    }
}

fn report(args: &ConformanceArgs) -> anyhow::Result<Verdict> {
    let old = args.compare.as_deref().map(Report::read).transpose()?;
    let depth = if args.quick { Depth::Quick } else { Depth::Full };
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
    let changes = old.map(|old| Changes::between(&old, &report));
    write_files(&directory, &report, changes.as_ref())?;
    if args.common.json {
        print(&serde_json::to_string_pretty(&report).context("the report could not be written as JSON")?)?;
    } else {
        say(&report, changes.as_ref(), &root)?;
    }
    let worse = changes.is_some_and(|changes| !changes.acceptable());
    Ok(if report.tally.failed > 0 || worse { Verdict::Failed } else { Verdict::Done })
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
    for row in report.rows.iter().filter(|row| row.verdict == crate::conformance::Verdict::Failed).take(20) {
        print(&format!("failed: {}: {}", row.identity(), row.reason))?;
    }
    if let Some(changes) = changes {
        let Changes { worse, better, moved, gone, .. } = changes;
        let (worse_count, better, moved, gone) = (worse.len(), better.len(), moved.len(), gone.len());
        print(&format!("changes: {worse_count} worse, {better} better, {moved} moved, {gone} gone"))?;
        worse.iter().take(20).try_for_each(|change| print(&format!("worse: {}", change.row)))?;
    }
    print(&format!("{}", root.join("report.html").display()))
}

fn setups() -> anyhow::Result<Vec<Setup>> {
    let mut all = Vec::new();
    for scenario in registry() {
        all.extend(scenario.setups()?);
    }
    Ok(all)
}

fn export(args: &ExportArgs) -> anyhow::Result<Verdict> {
    let root = args.common.output.clone().context("export needs -o DIR")?;
    let mut files = Vec::new();
    for setup in setups()? {
        let taken = root.join(format!("{}.csv", setup.name));
        ensure!(
            args.common.force || !taken.exists(),
            "{} is there already: choose another directory, or --force",
            taken.display()
        );
        files.extend(setup.write(&root)?);
    }
    if args.common.json {
        let document = Document::new("conformance export", json!({})).with("files", json!(files));
        return print(&document.text()?).map(|()| Verdict::Done);
    }
    files.iter().try_for_each(|file| print(&file.display().to_string()))?;
    Ok(Verdict::Done)
}

fn judge(args: &JudgeArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("conformance judge")?;
    let setups = setups()?;
    let mut scores: Vec<Score> = Vec::new();
    for file in &args.files {
        let stem = file.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        let names = || setups.iter().map(|setup| setup.name.as_str()).collect::<Vec<_>>().join(", ");
        let setup = setups.iter().find(|setup| setup.name == stem);
        let setup = setup.with_context(|| {
            format!("{}: no set-up is named {stem:?}, name the file after one of: {}", file.display(), names())
        })?;
        scores.push(setup.judge(file)?);
    }
    let right = scores.iter().all(|score| score.right);
    if args.common.json {
        let document = Document::new("conformance judge", json!({"files": args.files})).with("scores", json!(scores));
        print(&document.text()?)?;
    } else {
        for score in &scores {
            for check in &score.checks {
                let found = check.found.map_or("none".to_owned(), |found| format!("{found:.3e}"));
                let word = if check.right { "right" } else { "wrong" };
                print(&format!("{}: {} {found}, limit {:.3e}: {word}", score.file, check.quantity, check.limit))?;
            }
        }
    }
    Ok(if right { Verdict::Done } else { Verdict::Failed })
}
