//! `diagram`: largest and smallest amplitude of the steady motion over xi1, and what kind of motion it is (Figs. 5 and 10).

mod motion;
mod picture;
mod saved;

use super::analysis::window;
use super::case_args::{EngineArgs, RigArgs, check, load};
use super::common::{Common, Document, print};
use super::plot::PlotArgs;
use super::slow_flow::Energy;
use super::{Verdict, motions};
use crate::averaging::{EnergyFrequency, Interpolation};
use crate::chaos::{ChaosError, DiagramPlan, DiagramRow, divergence_edge};
use crate::dynamics::Sampling;
use crate::engine::EngineSettings;
use crate::model::RigParameters;
use crate::scene::Case;
use crate::store::{Column, ColumnData, Table, write_table};
use anyhow::ensure;
use clap::Args;
pub use motion::prepare;
use motion::{ENGINE_STEPS, Solver, in_engine, known_cycle, slow_flow, start};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;

const MOST_VALUES: usize = 1_000_000;
/// How often an exact motion that has not settled is followed further, twice as long each time: 80 000 time units in place of 5000.
const EXTENSIONS: usize = 4;

/// Amplitude diagram over xi1.
///
/// Each motion starts on the limit cycle with x2 moved by 0.001; where there is no cycle, at 1.2,0.9,0,-0.5,1. With -o, finished rows are
/// saved as they come, and an interrupted diagram goes on where it was.
///
/// An exact motion that still changes at the end is followed further, up to 16 times as long; one that has not settled then says so
/// (not_settled). Near a limit cycle that attracts by its multipliers the motion is a limit cycle. Without slip a motion that neither grows nor
/// decays is neutral. A value that fails is a row that says why (not_computed), and the exit status is 1. Motions of the slow flow and the engine
/// are not followed further: their classes hold for the time looked at.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  stickslip diagram --from 0 --to -0.2 --count 200 -o diagram.csv\n  \
    stickslip diagram --with slow-flow --from 0 --to -0.17 --count 341 --plot slow.svg\n  \
    stickslip diagram --with rapier --count 41 --plot engine.svg")]
pub struct DiagramArgs {
    #[arg(long, allow_hyphen_values = true, default_value_t = 0.0)]
    from: f64,
    #[arg(long, allow_hyphen_values = true, default_value_t = -0.2)]
    to: f64,
    /// Number of values, ends included.
    #[arg(long, default_value_t = 201)]
    count: usize,
    /// End of each motion.
    #[arg(long, default_value_t = 5000.0, allow_hyphen_values = true)]
    t_end: f64,
    /// Length of its beginning that is not looked at.
    #[arg(long, default_value_t = 1500.0, allow_hyphen_values = true)]
    transient: f64,
    /// How to solve the equations of motion; rapier takes 256 steps a period unless told otherwise.
    #[arg(long = "with", value_enum, default_value_t = Solver::Exact)]
    solver: Solver,
    /// For the slow flow: definition of the averaged energy of the Jenkins spring, on which its frequency depends.
    #[arg(long, value_enum)]
    energy: Option<Energy>,
    /// Take the rig, and for rapier the engine's settings, of this scene.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    rig: RigArgs,
    #[command(flatten)]
    engine: EngineArgs,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &DiagramArgs) -> anyhow::Result<Verdict> {
    args.plot.check(args.common.force)?;
    ensure!(
        (2..=MOST_VALUES).contains(&args.count) && args.from.is_finite() && args.to.is_finite() && args.from != args.to,
        "--from {} --to {} --count {} is no range: give two different numbers and a count from 2 to {MOST_VALUES}",
        args.from,
        args.to,
        args.count
    );
    ensure!(
        args.solver == Solver::Rapier || !args.engine.is_given(),
        "options of the engine decide about the engine alone: add --with rapier or leave them out"
    );
    ensure!(
        args.solver == Solver::SlowFlow || args.energy.is_none(),
        "--energy decides about the slow flow alone: add --with slow-flow or leave it out"
    );
    let case = args.case()?;
    let p = case.parameters;
    let engine = args.engine_settings(&case);
    let plan = DiagramPlan {
        window: window(args.transient, args.t_end)?,
        criteria: args.solver.criteria(&engine),
        extensions: if args.solver == Solver::Exact { EXTENSIONS } else { 0 },
    };
    let mut parameters = json!({
        "xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma, "from": args.from, "to": args.to, "count": args.count,
        "plan": plan, "with": args.solver.word(),
    });
    if args.solver == Solver::Rapier {
        parameters["engine"] = json!(engine);
    }
    if args.solver == Solver::SlowFlow {
        parameters["energy"] = json!(args.energy.unwrap_or_default().definition());
    }
    if let Some(path) = &args.common.output {
        super::simulate::refuse_to_overwrite(path, &parameters, args.common.force)?;
    }
    let at = |xi1| RigParameters { xi1, ..p };
    let rows = match args.solver {
        Solver::Exact => saved::rows(args, &plan, &parameters, |xi1| prepare(at(xi1)), |xi1| known_cycle(at(xi1))),
        Solver::SlowFlow => {
            let energy = args.energy.unwrap_or_default().definition();
            let frequency = Arc::new(EnergyFrequency::new(p, energy, Interpolation::Converged)?);
            saved::rows(args, &plan, &parameters, |xi1| Ok(slow_flow(at(xi1), &frequency)?), |_| None)
        }
        Solver::Rapier => {
            saved::rows(args, &plan, &parameters, |xi1| Ok((in_engine(at(xi1), engine)?, start(at(xi1))?)), |_| None)
        }
    }?;
    let done: Vec<DiagramRow> = rows.iter().filter_map(|(_, row)| row.as_ref().ok().copied()).collect();
    let verdict = if done.len() < rows.len() { Verdict::Failed } else { Verdict::Done };
    if let Some(path) = &args.common.output {
        write_table(path, &table(&rows, &parameters))?;
    }
    args.plot.draw(|| Ok(picture::chart(&done)))?;
    if args.common.json {
        let edge = divergence_edge(&done);
        let rows: Vec<Value> = rows.iter().map(json_of).collect();
        let document = Document::new("diagram", parameters).with("rows", json!(rows)).with("divergence", json!(edge));
        return print(&document.text()?).map(|()| verdict);
    }
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.6}"));
    print("xi1          a1_max       a1_min       outcome")?;
    for (value, row) in &rows {
        let range = row.as_ref().map_or((None, None), |row| (row.a1_max, row.a1_min));
        let reason = row.as_ref().err().map_or_else(String::new, |error| format!(": {error}"));
        print(&format!("{value:<12.6} {:<12} {:<12} {}{reason}", number(range.0), number(range.1), word(row)))?;
    }
    Ok(verdict)
}

/// A row of the document. What could not be computed says why.
fn json_of((value, row): &(f64, Result<DiagramRow, ChaosError>)) -> Value {
    match row {
        Ok(row) => json!({
            "xi1": value, "a1_max": row.a1_max, "a1_min": row.a1_min, "outcome": row.outcome, "evidence": row.evidence,
        }),
        Err(error) => json!({
            "xi1": value, "a1_max": null, "a1_min": null, "outcome": word(row), "error": error.to_string(),
        }),
    }
}

impl DiagramArgs {
    fn case(&self) -> anyhow::Result<Case> {
        let mut scene = load(self.scene.as_deref())?;
        if self.scene.is_none() {
            scene.engine.steps_per_period = ENGINE_STEPS;
        }
        self.rig.apply(&mut scene)?;
        self.engine.apply(&mut scene);
        check(&scene, self.scene.as_deref())
    }

    fn engine_settings(&self, case: &Case) -> EngineSettings {
        let settings = motions::engine_settings(case, Sampling { interval: case.longest_step, t_end: self.t_end });
        EngineSettings { step: case.longest_step, ..settings }
    }
}

fn word(row: &Result<DiagramRow, ChaosError>) -> String {
    match row {
        Ok(row) => json!(row.outcome).as_str().unwrap_or_default().to_owned(),
        Err(_) => "not_computed".to_owned(),
    }
}

fn table(rows: &[(f64, Result<DiagramRow, ChaosError>)], parameters: &Value) -> Table {
    let of = |part: fn(&DiagramRow) -> Option<f64>| {
        ColumnData::OptionalF64(rows.iter().map(|(_, row)| row.as_ref().ok().and_then(part)).collect())
    };
    let column = |name: &str, unit: &str, values| Column { name: name.to_owned(), unit: unit.to_owned(), values };
    Table {
        metadata: vec![
            ("stickslip".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("parameters".to_owned(), parameters.to_string()),
        ],
        columns: vec![
            column("xi1", "1", ColumnData::F64(rows.iter().map(|(value, _)| *value).collect())),
            column("a1_max", "1", of(|row| row.a1_max)),
            column("a1_min", "1", of(|row| row.a1_min)),
            column("outcome", "", ColumnData::Text(rows.iter().map(|(_, row)| word(row)).collect())),
        ],
    }
}
