//! `run`: the main job. The rig in Rapier, the exact solution beside it, their agreement, and a film of the engine's motion.

use super::case_args::SceneArgs;
use super::common::{Common, Document, print};
use super::film::{self, DrawArgs, Made, Shown};
use super::progress::Progress;
use super::trajectory_table::{Provenance, to_table};
use super::{Verdict, motions};
use crate::compare::{Agreement, compare};
use crate::dynamics::Trajectory;
use crate::engine::{EngineSettings, Recording};
use crate::scene::Case;
use crate::store::{Existing, Origin, OutputDir, TableFormat};
use anyhow::Context;
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Simulate the rig in Rapier, check it against the exact solution, and film it.
///
/// Writes frames, film.mp4, both trajectories and run.json. A second run resumes: finished frames are not drawn again.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  stickslip run\n  stickslip run scenes/chaos.toml -o renders/chaos\n  \
    stickslip run --xi1 -0.1 --t-end 400 -o renders/stronger\n\n\
    Exit status 1: engine and exact solution disagree; the films and numbers are there all the same.")]
pub struct RunArgs {
    #[command(flatten)]
    input: SceneArgs,
    #[command(flatten)]
    draw: DrawArgs,
    #[command(flatten)]
    common: Common,
}

/// `renders/` and the name of the input with a suffix.
pub fn default_directory(input: Option<&Path>, suffix: &str) -> PathBuf {
    let name = input.and_then(Path::file_stem).map_or("limit_torus".into(), |stem| stem.to_string_lossy());
    Path::new("renders").join(format!("{name}{suffix}"))
}

pub fn run(args: &RunArgs) -> anyhow::Result<Verdict> {
    let mut progress = Progress::new(args.common.quiet);
    let case = args.input.case()?;
    args.draw.check(case.frame_count())?;
    let sampling = motions::film_sampling(&case);
    let settings = motions::engine_settings(&case, sampling);
    let parameters = json!({ "case": case, "engine": settings, "sampling": sampling });
    let directory = args.common.output.clone().unwrap_or_else(|| default_directory(args.input.scene.as_deref(), ""));
    let existing = if args.common.force { Existing::Replace } else { Existing::Resume };
    let output = OutputDir::open(&directory, &Origin::new("run", parameters.clone()), existing)?;

    let start = motions::start(&case)?;
    let recording = motions::in_engine(&case, &start, sampling)?;
    let exact = motions::exactly(&case, &start, sampling)?;
    let expected = motions::expectation(&case, &settings, &recording)?;
    let agreement = compare(&exact, &recording.trajectory, &expected)?;
    progress.say(&verdict_line(&settings, &recording, &agreement));
    let solver = motions::engine_info(&settings).to_string();
    write_trajectory(&output, "engine.csv", &recording.trajectory, &case, &solver, &parameters)?;
    write_trajectory(&output, "exact.csv", &exact, &case, "exact", &parameters)?;

    let shown = Shown::of_engine(&recording)?.beside(&exact);
    let made = film::make(&case, shown, &args.draw, &output, &mut progress)?;
    let document = document(parameters, &settings, &recording, &agreement, &made, &output)?;
    let text = document.text()?;
    output.write("run.json", "", |writer| writeln!(writer, "{text}"))?;
    if args.common.json {
        print(&text)?;
    } else {
        print(&conclusion(&agreement, &made, &directory))?;
    }
    Ok(if agreement.passed { Verdict::Done } else { Verdict::Failed })
}

fn write_trajectory(
    output: &OutputDir,
    name: &str,
    trajectory: &Trajectory,
    case: &Case,
    solver: &str,
    parameters: &Value,
) -> anyhow::Result<()> {
    let table = to_table(trajectory, &Provenance { case, solver, parameters: parameters.clone() }, &case.scales)?;
    output.write(name, "", |writer| table.write_to(TableFormat::Csv, writer))?;
    Ok(())
}

fn document(
    parameters: Value,
    settings: &EngineSettings,
    recording: &Recording,
    agreement: &Agreement,
    made: &Made,
    output: &OutputDir,
) -> anyhow::Result<Document> {
    let info = motions::engine_info(settings);
    let engine = json!({
        "name": info.name, "version": info.version, "precision": settings.precision.word(), "joints": settings.joints.word(),
        "scheme": settings.scheme, "substeps": settings.substeps, "dt": settings.step, "steps": recording.steps,
        "joint_drift": recording.drift, "outcome": recording.trajectory.outcome,
        "trajectory_sha256": crate::engine::trajectory_hash(&recording.trajectory),
    });
    let mut files = output.files();
    let own = output.path().join("run.json");
    if !files.contains(&own) {
        files.push(own);
    }
    files.sort();
    Ok(Document::new("run", parameters)
        .with("engine", engine)
        .with("agreement", serde_json::to_value(agreement).context("agreement")?)
        .with("frames", made.frames_json())
        .with("files", json!(files)))
}

fn verdict_line(settings: &EngineSettings, recording: &Recording, agreement: &Agreement) -> String {
    format!(
        "{}: {} steps of {:.3e}, agreement with the exact solution {}",
        motions::engine_info(settings),
        recording.steps,
        settings.step,
        if agreement.passed { "passed" } else { "FAILED" }
    )
}

/// The checks as a small table, and where the film is.
fn conclusion(agreement: &Agreement, made: &Made, directory: &Path) -> String {
    let mut lines: Vec<String> = agreement
        .checks
        .iter()
        .map(|check| {
            let mark = if check.passed { "ok  " } else { "FAIL" };
            format!("{mark} {:18} {:.2e} (at most {:.2e}: {})", check.name, check.found, check.tolerance, check.reason)
        })
        .collect();
    lines.push(format!("states compared up to t = {}", agreement.horizon));
    lines.push(made.report.film.as_deref().unwrap_or(directory).display().to_string());
    lines.join("\n")
}
