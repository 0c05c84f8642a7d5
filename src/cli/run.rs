//! `run`: the main job. The rig or a bladed disk in Rapier, the exact solution beside it, their agreement, and a film of the engine's motion.

use super::case_args::SceneArgs;
use super::common::{Common, Document, print};
use super::disk::filmed;
use super::draw_args::DrawArgs;
use super::film::{self, Made};
use super::progress::Progress;
use super::shown::Shown;
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

/// Simulate the rig or a bladed disk in Rapier, check it against the exact solution, and film it.
///
/// Writes frames, film.mp4, both trajectories and run.json. A second run resumes: finished frames are not drawn again.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  stickslip run\n  stickslip run scenes/chaos.toml -o renders/chaos\n  \
    stickslip run --xi1 -0.1 --t-end 400 -o renders/stronger\n  stickslip run --story\n\n\
    Exit status 1: engine and exact solution disagree; the films and numbers are there all the same.")]
pub struct RunArgs {
    #[command(flatten)]
    pub input: SceneArgs,
    /// Film the scenes of a story one after the other; the built-in one, about a minute long, without a file.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "xi1", "xi2", "kappa", "gamma", "precision", "joints", "scheme", "substeps", "steps_per_period", "dt", "t_end", "speed"])]
    pub story: Option<Option<PathBuf>>,
    #[command(flatten)]
    pub draw: DrawArgs,
    #[command(flatten)]
    pub common: Common,
}

/// Where a command writes its JSON document.
pub const DOCUMENT: &str = "run.json";
/// The trajectories of a scene: the engine's and the exact one.
const TABLES: [&str; 2] = ["engine.csv", "exact.csv"];

/// `renders/` and the name of the input with a suffix.
pub fn default_directory(input: Option<&Path>, suffix: &str) -> PathBuf {
    let name = input.and_then(Path::file_stem).map_or("limit_torus".into(), |stem| stem.to_string_lossy());
    Path::new("renders").join(format!("{name}{suffix}"))
}

/// A case simulated in the engine and compared with the exact solution.
pub struct Checked {
    settings: EngineSettings,
    recording: Recording,
    exact: Trajectory,
    pub agreement: Agreement,
}

impl Checked {
    /// All that decides the result.
    pub fn parameters(case: &Case) -> Value {
        let sampling = motions::film_sampling(case);
        json!({ "case": case, "engine": motions::engine_settings(case, sampling), "sampling": sampling })
    }

    pub fn new(case: &Case) -> anyhow::Result<Self> {
        let sampling = motions::film_sampling(case);
        let settings = motions::engine_settings(case, sampling);
        let start = motions::start(case)?;
        let recording = motions::in_engine(case, &start, sampling)?;
        let exact = motions::exactly(case, &start, sampling)?;
        let expected = motions::expectation(case, &settings, &recording)?;
        let agreement = compare(&exact, &recording.trajectory, &expected)?;
        Ok(Self { settings, recording, exact, agreement })
    }

    /// The engine's motion, the exact one beside it.
    pub fn shown(&self, case: &Case) -> anyhow::Result<Shown> {
        Shown::of_engine(case, &self.recording)?.beside(case, &self.exact)
    }

    /// Names of the trajectories, after `prefix`.
    pub fn table_names(prefix: &str) -> [String; 2] {
        TABLES.map(|name| format!("{prefix}{name}"))
    }

    /// The trajectories under [`Checked::table_names`].
    pub fn write_trajectories(&self, case: &Case, output: &OutputDir, prefix: &str) -> anyhow::Result<()> {
        let solver = motions::engine_info(&self.settings).to_string();
        let trajectories = [(&self.recording.trajectory, solver.as_str()), (&self.exact, "exact")];
        for (name, (trajectory, solver)) in Self::table_names(prefix).iter().zip(trajectories) {
            let provenance = Provenance { case, solver, parameters: Self::parameters(case) };
            let table = match &case.disk {
                Some(disk) => filmed::table(disk, trajectory, provenance.metadata(trajectory, &case.scales)?),
                None => to_table(trajectory, &provenance, &case.scales)?,
            };
            output.write(name, "", |writer| table.write_to(TableFormat::Csv, writer))?;
        }
        Ok(())
    }

    pub fn engine_json(&self) -> Value {
        let (settings, recording) = (&self.settings, &self.recording);
        let info = motions::engine_info(settings);
        json!({
            "name": info.name, "version": info.version, "precision": settings.precision.word(), "joints": settings.joints.word(),
            "scheme": settings.scheme, "substeps": settings.substeps, "dt": settings.step, "steps": recording.steps,
            "joint_drift": recording.drift, "outcome": recording.trajectory.outcome,
            "trajectory_sha256": crate::engine::trajectory_hash(&recording.trajectory),
        })
    }

    pub fn verdict_line(&self) -> String {
        format!(
            "{}: {} steps of {:.3e}, agreement with the exact solution {}",
            motions::engine_info(&self.settings),
            self.recording.steps,
            self.settings.step,
            if self.agreement.passed { "passed" } else { "FAILED" }
        )
    }
}

pub fn run(args: &RunArgs) -> anyhow::Result<Verdict> {
    if let Some(story) = &args.story {
        return super::story::run(args, story.as_deref());
    }
    let mut progress = Progress::new(args.common.quiet);
    let case = args.input.case()?;
    args.draw.check(case.frame_count())?;
    let parameters = Checked::parameters(&case);
    let directory = args.common.output.clone().unwrap_or_else(|| default_directory(args.input.scene.as_deref(), ""));
    let existing = if args.common.force { Existing::Replace } else { Existing::Resume };
    let mut names = film::file_names(&case.film, &args.draw, case.frame_count());
    names.extend(Checked::table_names("").into_iter().chain([DOCUMENT.to_owned()]));
    let mut renderer = film::renderer(&args.draw.picture, &progress)?;
    let output = OutputDir::open_for(&directory, &Origin::new("run", parameters.clone()), existing, &names)?;

    let checked = Checked::new(&case)?;
    progress.say(&checked.verdict_line());
    checked.write_trajectories(&case, &output, "")?;
    let stage = checked.shown(&case)?.stage(&case, args.draw.picture.supersample, &progress)?;
    let made = film::make(vec![stage], &case.film, &args.draw, &output, renderer.as_mut(), &mut progress)?;
    let document = Document::new("run", parameters)
        .with("engine", checked.engine_json())
        .with("agreement", serde_json::to_value(&checked.agreement).context("agreement")?)
        .with("frames", made.frames_json())
        .with("files", json!(files_with(&output, DOCUMENT)));
    let text = document.text()?;
    output.write(DOCUMENT, "", |writer| writeln!(writer, "{text}"))?;
    if args.common.json {
        print(&text)?;
    } else {
        print(&conclusion(&checked.agreement, &made, &directory))?;
    }
    Ok(if checked.agreement.passed { Verdict::Done } else { Verdict::Failed })
}

/// The finished files of the directory, and one more that is about to be written.
pub fn files_with(output: &OutputDir, name: &str) -> Vec<PathBuf> {
    let mut files = output.files();
    let own = output.path().join(name);
    if !files.contains(&own) {
        files.push(own);
    }
    files.sort();
    files
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
