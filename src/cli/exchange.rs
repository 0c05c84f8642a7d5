//! `conformance export` and `conformance judge`: how wrong another engine is.

use super::Verdict;
use super::common::{Common, Document, print};
use super::streams::{legible, tell};
use crate::conformance::{Score, Setup, setups};
use anyhow::{Context, bail, ensure};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Write set-ups (JSON) and exact references (CSV) of the scenarios, for other engines.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip conformance export -o setups")]
pub struct ExportArgs {
    #[command(flatten)]
    common: Common,
}

/// Score trajectories of another engine. A file NAME.csv is judged by the set-up NAME; columns t, x1, ..., v1, ..., f1, ... at the reference's times.
///
/// Velocities and slider forces may be left out; what needs them is then not judged, which is said. All files that can be scored are;
/// exit status 1 if one is wrong, 2 if one could not be scored.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  stickslip conformance judge mine/limit_cycle.csv mine/friction_decay.csv\n  \
                  stickslip conformance judge --setups setups mine/limit_cycle.csv")]
pub struct JudgeArgs {
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Take set-up and reference from NAME.json and NAME.csv in this directory instead of the built-in ones.
    #[arg(long, value_name = "DIR")]
    setups: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
}

pub fn export(args: &ExportArgs) -> anyhow::Result<Verdict> {
    let root = args.common.output.clone().context("export needs -o DIR")?;
    let all = setups()?;
    // Before anything is written, so that no half of an export is left.
    for setup in &all {
        for taken in ["json", "csv"].map(|extension| root.join(format!("{}.{extension}", setup.name))) {
            ensure!(
                args.common.force || !taken.exists(),
                "{} is there already: choose another directory, or --force",
                taken.display()
            );
        }
    }
    let mut files = Vec::new();
    for setup in &all {
        files.extend(setup.write(&root)?);
    }
    if args.common.json {
        let document = Document::new("conformance export", json!({})).with("files", json!(files));
        return print(&document.text()?).map(|()| Verdict::Done);
    }
    files.iter().try_for_each(|file| print(&file.display().to_string()))?;
    Ok(Verdict::Done)
}

pub fn judge(args: &JudgeArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("conformance judge")?;
    let source = match &args.setups {
        Some(directory) => Source::Directory(directory),
        None => Source::BuiltIn(setups()?),
    };
    let (mut scores, mut failures): (Vec<Score>, Vec<String>) = (Vec::new(), Vec::new());
    for file in &args.files {
        match source.score(file) {
            Ok(score) => scores.push(score),
            Err(error) => failures.push(error.to_string()),
        }
    }
    if args.common.json {
        let parameters = json!({"files": args.files, "setups": args.setups});
        let document = Document::new("conformance judge", parameters);
        print(&document.with("scores", json!(scores)).with("not_scored", json!(failures)).text()?)?;
    } else {
        scores.iter().try_for_each(say)?;
    }
    if !failures.is_empty() {
        // A line each, as one message for all would be cut.
        failures.iter().for_each(|failure| tell(&legible(failure)));
        bail!("{} of {} files could not be scored", failures.len(), args.files.len());
    }
    let right = scores.iter().all(|score| score.right);
    Ok(if right { Verdict::Done } else { Verdict::Failed })
}

fn say(score: &Score) -> anyhow::Result<()> {
    for check in &score.checks {
        let found = check.error.map_or("there is none".to_owned(), |error| format!("off by {error:.3e}"));
        let word = if check.right { "right" } else { "wrong" };
        print(&format!("{}: {}: {found}, limit {:.3e}: {word}", score.file, check.quantity, check.limit))?;
    }
    score.not_judged.iter().try_for_each(|what| print(&format!("{}: {what}: not judged", score.file)))
}

enum Source<'a> {
    BuiltIn(Vec<Setup>),
    Directory(&'a Path),
}

impl Source<'_> {
    /// By the set-up that has the file's name.
    fn score(&self, file: &Path) -> anyhow::Result<Score> {
        let name = file.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        match self {
            Self::Directory(directory) => Ok(Setup::read(directory, name)?.judge(file)?),
            Self::BuiltIn(setups) => {
                let names = || setups.iter().map(|setup| setup.name.as_str()).collect::<Vec<_>>().join(", ");
                let setup = setups.iter().find(|setup| setup.name == name);
                let setup = setup.with_context(|| {
                    format!("{}: no set-up is named {name:?}, name the file after one of: {}", file.display(), names())
                })?;
                Ok(setup.judge(file)?)
            }
        }
    }
}
