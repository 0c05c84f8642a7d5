//! `simulate`: one trajectory, exact, in the engine, or of the slow flow.

use super::case_args::{EngineArgs, RigArgs, check, load, parse_initial};
use super::common::{Common, Document, print};
use super::slow_flow::Energy;
use super::trajectory_table::{Provenance, events_table, to_table};
use super::{Verdict, motions};
use crate::dynamics::{Sampling, State, Trajectory};
use crate::model::{Range, Scales};
use crate::scene::{Case, Initial, Simulation};
use crate::store::{Table, read_table, write_table};
use anyhow::{Context, bail, ensure};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Samples a trajectory may have: some 10 GB of them.
const MOST_SAMPLES: f64 = 5e7;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Solver {
    /// The closed-form solution.
    Exact,
    /// The rig in the Rapier engine.
    Rapier,
    /// Amplitudes and phases from the averaged equations, the fast oscillation restored. Starts on the exact limit cycle too, so that the
    /// solvers can be compared; its energy residual is the error of averaging.
    SlowFlow,
}

impl Solver {
    fn word(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Rapier => "rapier",
            Self::SlowFlow => "slow-flow",
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Units {
    Nondimensional,
    /// Needs a scene with [rig_si].
    Si,
}

/// Compute one trajectory.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  stickslip simulate --xi1 -0.06 --t-end 2000 -o torus.csv\n  \
    stickslip simulate --with rapier --scene scenes/chaos.toml --sample 0.05 -o chaos.parquet --json")]
pub struct SimulateArgs {
    /// Scene file; its film is ignored.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// How to solve the equations of motion.
    #[arg(long = "with", value_enum, default_value_t = Solver::Exact)]
    solver: Solver,
    /// For the slow flow: definition of the averaged energy of the Jenkins spring, on which its frequency depends.
    #[arg(long, value_enum)]
    energy: Option<Energy>,
    /// End of the trajectory, in the units of the scene; 200 without a scene.
    #[arg(long, allow_hyphen_values = true)]
    t_end: Option<f64>,
    /// State at time 0, in the units of the scene. Without it: on the limit cycle at a reversal of mass 1, x2 moved by 0.001.
    /// An element with |f| = 1 starts slipping if v1 (where v1 = 0, its first nonzero derivative) has the sign of f.
    #[arg(long, value_name = "x1,x2,v1,v2,f", allow_hyphen_values = true, value_parser = parse_initial)]
    initial: Option<Initial>,
    /// Time between two rows, in the units of the scene.
    #[arg(long, value_name = "DT", default_value_t = 0.1, allow_hyphen_values = true)]
    sample: f64,
    /// Units of the file written; the JSON document is non-dimensional.
    #[arg(long, value_enum, default_value_t = Units::Nondimensional)]
    units: Units,
    /// Also write the switching events to this file.
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    #[command(flatten)]
    rig: RigArgs,
    #[command(flatten)]
    engine: EngineArgs,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &SimulateArgs) -> anyhow::Result<Verdict> {
    ensure!(
        args.solver == Solver::Rapier || !args.engine.is_given(),
        "options of the engine decide about the engine alone: add --with rapier or leave them out"
    );
    ensure!(
        args.solver == Solver::SlowFlow || args.energy.is_none(),
        "--energy decides about the slow flow alone: add --with slow-flow or leave it out"
    );
    ensure!(args.events.is_none() || args.events != args.common.output, "-o and --events name the same file: give two");
    let case = args.case()?;
    let scales = args.file_scales(&case)?;
    let sampling = args.sampling(&case)?;
    let parameters = args.parameters(&case, &sampling);
    for path in [&args.common.output, &args.events].into_iter().flatten() {
        refuse_to_overwrite(path, &parameters, args.common.force)?;
    }
    let start = motions::start(&case)?;
    let (solver, trajectory) = solve(args, &case, &start, sampling)?;
    let provenance = Provenance { case: &case, solver: &solver, parameters: parameters.clone() };
    if let Some(path) = &args.common.output {
        write_table(path, &to_table(&trajectory, &provenance, &scales)?)?;
    }
    if let Some(path) = &args.events {
        write_table(path, &events_table(&trajectory.events, &parameters))?;
    }
    report(args, &trajectory, parameters)?;
    Ok(Verdict::Done)
}

fn solve(args: &SimulateArgs, case: &Case, start: &State, sampling: Sampling) -> anyhow::Result<(String, Trajectory)> {
    Ok(match args.solver {
        Solver::Exact => ("exact".to_owned(), motions::exactly(case, start, sampling)?),
        Solver::SlowFlow => {
            let energy = args.energy.unwrap_or_default();
            ("slow-flow".to_owned(), motions::by_slow_flow(case, energy.definition(), start, sampling)?)
        }
        Solver::Rapier => {
            let info = motions::engine_info(&motions::engine_settings(case, sampling));
            (info.to_string(), motions::in_engine(case, start, sampling)?.trajectory)
        }
    })
}

impl SimulateArgs {
    fn case(&self) -> anyhow::Result<Case> {
        let mut scene = load(self.scene.as_deref())?;
        if self.scene.is_none() {
            // Of the built-in scene only the nominal rig is taken.
            scene.title = "Self-excited rig with dry friction".to_owned();
            scene.caption.clear();
            scene.initial = Initial::default();
            scene.simulation = Simulation { duration: 200.0, ..Simulation::default() };
        }
        scene.film = crate::scene::Film::default();
        scene.simulation.duration = self.t_end.unwrap_or(scene.simulation.duration);
        // A film at the default speed is not made: it must not limit the length of a trajectory.
        scene.film.speed = scene.simulation.duration.abs().max(f64::MIN_POSITIVE);
        scene.initial = self.initial.unwrap_or(scene.initial);
        self.rig.apply(&mut scene)?;
        self.engine.apply(&mut scene);
        check(&scene, self.scene.as_deref())
    }

    fn file_scales(&self, case: &Case) -> anyhow::Result<Scales> {
        match self.units {
            Units::Nondimensional => Ok(Scales::UNITY),
            Units::Si if case.scales == Scales::UNITY => {
                bail!("--units si needs a rig in SI units: give a scene with [rig_si]")
            }
            Units::Si => Ok(case.scales),
        }
    }

    fn sampling(&self, case: &Case) -> anyhow::Result<Sampling> {
        let interval = Range::Positive.check("--sample", self.sample)? / case.scales.time;
        let samples = case.duration / interval;
        ensure!(
            samples <= MOST_SAMPLES,
            "{samples:.0} samples are too many, at most {MOST_SAMPLES:.0}: lengthen --sample or shorten --t-end"
        );
        Ok(Sampling { interval, t_end: case.duration })
    }

    /// All that decides the trajectory. The engine's settings do only where the engine is used.
    fn parameters(&self, case: &Case, sampling: &Sampling) -> Value {
        let p = case.parameters;
        let mut parameters = json!({
            "xi1": p.xi1, "xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma,
            "initial": case.initial, "prescribed": case.prescribed, "amplitude_bound": case.amplitude_bound,
            "t_end": case.duration, "sample": sampling.interval,
            "with": self.solver.word(),
            "units": if self.units == Units::Si { "si" } else { "nondimensional" },
        });
        if self.solver == Solver::Rapier {
            parameters["engine"] = json!(motions::engine_settings(case, *sampling));
        }
        if self.solver == Solver::SlowFlow {
            parameters["energy"] = json!(self.energy.unwrap_or_default().definition());
        }
        parameters
    }
}

/// An existing file is replaced only if it says that it holds the same result.
pub fn refuse_to_overwrite(path: &Path, parameters: &Value, force: bool) -> anyhow::Result<()> {
    ensure!(!path.is_dir(), "{} is a directory: name a file, ending in .csv or .parquet", path.display());
    if force || !path.exists() {
        return Ok(());
    }
    let made_by = |table: &Table| table.metadata("parameters").map(str::to_owned);
    let old = read_table(path).with_context(|| format!("{} is in the way; --force replaces it", path.display()))?;
    ensure!(
        made_by(&old) == Some(parameters.to_string()),
        "{} exists and was made with other parameters: choose another file, or replace it with --force",
        path.display()
    );
    Ok(())
}

fn report(args: &SimulateArgs, trajectory: &Trajectory, parameters: Value) -> anyhow::Result<()> {
    let last = trajectory.last().context("the trajectory is empty")?;
    let [x1, x2] = [last.state.positions[0], last.state.positions[1]];
    let [v1, v2] = [last.state.velocities[0], last.state.velocities[1]];
    let (f, contact) = (last.state.slider_forces[0], last.contacts[0].word());
    if args.common.json {
        let document = Document::new("simulate", parameters)
            .with("final", json!({"t": last.time, "x1": x1, "x2": x2, "v1": v1, "v2": v2, "f": f, "contact": contact}))
            .with("events", json!(trajectory.switches()))
            .with("diverged", json!(trajectory.diverged()))
            .with("energy_residual", json!(trajectory.energy_residual()))
            .with("files", json!([&args.common.output, &args.events].into_iter().flatten().collect::<Vec<_>>()));
        return print(&document.text()?);
    }
    let ending = if trajectory.diverged() { "diverged" } else { "completed" };
    print(&format!(
        "{ending}: {} events, energy residual {:.1e}\nt = {}  x1 = {x1:.12}  x2 = {x2:.12}  v1 = {v1:.12}  v2 = {v2:.12}  f = {f:.12}  {contact}",
        trajectory.switches(),
        trajectory.energy_residual(),
        last.time,
    ))
}
