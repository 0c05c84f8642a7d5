//! `paper`: every figure and the table of the paper into a directory, with data, pictures, checks and a page.

use super::Verdict;
use super::common::{Common, Document, print};
use super::streams::tell;
use crate::model::RigParameters;
use crate::paper::{Case, Effort, ITEMS, ItemResult, News, PaperItem, run as run_items, select, stored, write_index};
use crate::store::{Existing, Origin, OutputDir};
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Every figure and the table of the paper: data (CSV), pictures (SVG and PNG), checks, and a page, index.html.
///
/// Finished items are not computed again. With other parameters, checks bound to the nominal ones do not apply. Exit status 1 if a
/// check failed.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  stickslip paper\n  stickslip paper --only fig5,fig9 -o figures\n  stickslip paper --gamma 0.7 -o gamma"
)]
pub struct PaperArgs {
    /// Only these items, such as fig1,fig6.
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    only: Vec<String>,
    /// Fewer points and shorter motions, to see that everything works.
    #[arg(long)]
    quick: bool,
    /// Damping of the out-of-phase mode.
    #[arg(long, allow_hyphen_values = true)]
    xi2: Option<f64>,
    /// Coupling stiffness.
    #[arg(long, allow_hyphen_values = true)]
    kappa: Option<f64>,
    /// Friction intensity, greater than 0 and at most 1.
    #[arg(long, allow_hyphen_values = true)]
    gamma: Option<f64>,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &PaperArgs) -> anyhow::Result<Verdict> {
    let items = select(&args.only)?;
    let nominal = RigParameters::default();
    let parameters = RigParameters {
        xi2: args.xi2.unwrap_or(nominal.xi2),
        kappa: args.kappa.unwrap_or(nominal.kappa),
        gamma: args.gamma.unwrap_or(nominal.gamma),
        ..nominal
    }
    .validated()?;
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    let case = Case { parameters, effort };
    let decided =
        json!({"xi2": parameters.xi2, "kappa": parameters.kappa, "gamma": parameters.gamma, "effort": effort});
    let folder = args.common.output.clone().unwrap_or_else(|| PathBuf::from("renders/paper"));
    let existing = if args.common.force { Existing::Replace } else { Existing::Resume };
    let dir = OutputDir::open(&folder, &Origin::new("paper", decided.clone()), existing)?;
    let results = run_items(&items, &case, &dir, |news| say(args, news))?;
    write_index(&on_page(&items, &results, &dir), &case, &dir)?;
    let passed = results.iter().all(|result| result.passed);
    report(args, decided, &results, &folder)?;
    Ok(if passed { Verdict::Done } else { Verdict::Failed })
}

fn say(args: &PaperArgs, news: News<'_>) {
    if args.common.quiet {
        return;
    }
    let state = if news.reused { "kept" } else { "done" };
    let failed = if news.result.passed { "" } else { ", a check FAILED" };
    tell(&format!("paper: {} {state} ({} of {}){failed}", news.result.id, news.done, news.all));
}

/// What was asked for, and what earlier runs left.
fn on_page(
    items: &[&'static PaperItem],
    results: &[ItemResult],
    dir: &OutputDir,
) -> Vec<(&'static PaperItem, ItemResult)> {
    let new = |item: &PaperItem| items.iter().position(|i| i.id == item.id).map(|n| results[n].clone());
    ITEMS.iter().filter_map(|item| Some((item, new(item).or_else(|| stored(item, dir))?))).collect()
}

fn report(args: &PaperArgs, parameters: Value, results: &[ItemResult], folder: &Path) -> anyhow::Result<()> {
    if args.common.json {
        let items: Vec<Value> = results
            .iter()
            .map(|r| json!({"id": r.id, "passed": r.passed, "verdict": r.verdict, "checks": r.checks, "numbers": r.numbers, "files": r.files}))
            .collect();
        let document = Document::new("paper", parameters)
            .with("items", json!(items))
            .with("page", json!(folder.join("index.html")));
        return print(&document.text()?);
    }
    for result in results {
        let (all, failed) = (result.checks.len(), result.checks.iter().filter(|c| c.passed == Some(false)).count());
        let verdict = if failed == 0 { format!("{all} checks") } else { format!("{failed} of {all} checks FAILED") };
        print(&format!("{:<12} {verdict}: {}", result.id, result.verdict))?;
        for check in result.checks.iter().filter(|check| check.passed == Some(false)) {
            print(&format!("  failed: {}: expected {:?}, found {:?}", check.name, check.expected, check.found))?;
        }
    }
    print(&format!("page: {}", folder.join("index.html").display()))
}
