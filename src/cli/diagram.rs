//! `diagram`: largest and smallest amplitude of the steady motion over xi1, and what kind of motion it is (Figs. 5 and 10).

use super::analysis::{RigInput, exact_flow, window};
use super::common::{Common, Document, print};
use super::plot::PlotArgs;
use super::progress::Heartbeat;
use super::{Verdict, motions};
use crate::chaos::{DiagramPlan, DiagramRow, MotionClass, amplitude_diagram, divergence_edge};
use crate::dynamics::State;
use crate::exact::TwoMassFlow;
use crate::model::RigParameters;
use crate::orbit::OrbitError;
use crate::report::{Chart, Series, Style, Tint};
use crate::store::{Column, ColumnData, Table, read_whole, write_atomically, write_table};
use anyhow::{Context, ensure};
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

const MOST_VALUES: usize = 1_000_000;
/// Finished rows are saved this often.
const SAVE_EVERY: Duration = Duration::from_secs(2);
/// Start where there is no limit cycle: beyond the slip limit, as its orbits are.
const ELSEWHERE: [f64; 5] = [1.2, 0.9, 0.0, -0.5, 1.0];

/// Amplitude diagram over xi1 of the exact motion.
///
/// Each motion starts on the limit cycle with x2 moved by 0.001; where there is no cycle, at 1.2,0.9,0,-0.5,1. With -o, finished rows are
/// saved as they come, and an interrupted diagram goes on where it was.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip diagram --from 0 --to -0.2 --count 200 -o diagram.csv")]
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
    #[command(flatten)]
    rig: RigInput,
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
    let p = args.rig.parameters()?;
    let plan = DiagramPlan { window: window(args.transient, args.t_end)?, ..DiagramPlan::default() };
    let parameters = json!({
        "xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma, "from": args.from, "to": args.to, "count": args.count,
        "plan": plan, "with": "exact",
    });
    if let Some(path) = &args.common.output {
        super::simulate::refuse_to_overwrite(path, &parameters, args.common.force)?;
    }
    let rows = rows(args, p, &plan, &parameters)?;
    if let Some(path) = &args.common.output {
        write_table(path, &table(&rows, &parameters))?;
    }
    args.plot.draw(|| Ok(chart(&rows)))?;
    let edge = divergence_edge(&rows);
    if args.common.json {
        let rows: Vec<Value> = rows
            .iter()
            .map(|row| json!({"xi1": row.value, "a1_max": row.a1_max, "a1_min": row.a1_min, "outcome": row.outcome, "evidence": row.evidence}))
            .collect();
        let document = Document::new("diagram", parameters).with("rows", json!(rows)).with("divergence", json!(edge));
        return print(&document.text()?).map(|()| Verdict::Done);
    }
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.6}"));
    print("xi1          a1_max       a1_min       outcome")?;
    for row in &rows {
        print(&format!("{:<12.6} {:<12} {:<12} {}", row.value, number(row.a1_max), number(row.a1_min), word(row)))?;
    }
    Ok(Verdict::Done)
}

fn word(row: &DiagramRow) -> String {
    json!(row.outcome).as_str().unwrap_or_default().to_owned()
}

fn rows(
    args: &DiagramArgs,
    p: RigParameters,
    plan: &DiagramPlan,
    parameters: &Value,
) -> anyhow::Result<Vec<DiagramRow>> {
    let part = |n: usize| n as f64 / (args.count - 1) as f64;
    let values: Vec<f64> = (0..args.count).map(|n| args.from + (args.to - args.from) * part(n)).collect();
    let saved = args.common.output.as_deref().map(|path| Saved::open(path, parameters)).transpose()?;
    let finished = saved.as_ref().map(|saved| saved.rows.clone()).unwrap_or_default();
    let heartbeat = Heartbeat::new(args.common.quiet, "diagram", "values");
    let recorder = Mutex::new((saved, Instant::now()));
    let rows = amplitude_diagram(
        &values,
        plan,
        &finished,
        |xi1| prepare(RigParameters { xi1, ..p }),
        |row, done, all| {
            heartbeat.at(done, all);
            let mut recorder = recorder.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            let (Some(saved), last) = &mut *recorder else { return };
            saved.rows.push(*row);
            if last.elapsed() >= SAVE_EVERY {
                // A record that cannot be written costs a repetition, not the result.
                if let Err(error) = saved.write() {
                    tracing::warn!("finished rows were not saved: {error:#}");
                }
                *last = Instant::now();
            }
        },
    )?;
    let saved = recorder.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).0;
    if let Some(saved) = saved {
        saved.discard();
    }
    Ok(rows)
}

/// The exact flow, and where its motion starts.
pub fn prepare(p: RigParameters) -> Result<(TwoMassFlow, State), OrbitError> {
    let start = match motions::exact_limit_cycle(p) {
        Ok(orbit) => {
            let mut state = orbit.reversal();
            state.positions[1] += 0.001;
            state
        }
        Err(OrbitError::NoGuess { .. } | OrbitError::BeyondFold { .. }) => State::two_mass(ELSEWHERE),
        Err(error) => return Err(error),
    };
    Ok((exact_flow(p)?, start))
}

/// Rows of an unfinished diagram, beside its output.
struct Saved {
    path: PathBuf,
    parameters: Value,
    rows: Vec<DiagramRow>,
}

impl Saved {
    /// Rows of the same parameters are taken over, others are left aside.
    fn open(output: &Path, parameters: &Value) -> anyhow::Result<Self> {
        let mut name = output.file_name().context("-o needs a file name")?.to_owned();
        name.push(".partial.json");
        let path = output.with_file_name(name);
        let mut rows = Vec::new();
        if path.exists() {
            let stored: Value = serde_json::from_slice(&read_whole(&path)?).unwrap_or_default();
            if stored["parameters"] == *parameters {
                rows = serde_json::from_value(stored["rows"].clone()).unwrap_or_default();
            }
        }
        Ok(Self { path, parameters: parameters.clone(), rows })
    }

    fn write(&self) -> anyhow::Result<()> {
        let document = json!({"parameters": self.parameters, "rows": self.rows});
        Ok(write_atomically(&self.path, |writer| Ok(serde_json::to_writer(writer, &document)?))?)
    }

    fn discard(self) {
        if self.path.exists()
            && let Err(error) = std::fs::remove_file(&self.path)
        {
            tracing::warn!("{} is no longer needed but could not be removed: {error}", self.path.display());
        }
    }
}

fn table(rows: &[DiagramRow], parameters: &Value) -> Table {
    let column = |name: &str, unit: &str, values| Column { name: name.to_owned(), unit: unit.to_owned(), values };
    Table {
        metadata: vec![
            ("stickslip".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("parameters".to_owned(), parameters.to_string()),
        ],
        columns: vec![
            column("xi1", "1", ColumnData::F64(rows.iter().map(|row| row.value).collect())),
            column("a1_max", "1", ColumnData::OptionalF64(rows.iter().map(|row| row.a1_max).collect())),
            column("a1_min", "1", ColumnData::OptionalF64(rows.iter().map(|row| row.a1_min).collect())),
            column("outcome", "", ColumnData::Text(rows.iter().map(word).collect())),
        ],
    }
}

/// Largest and smallest amplitude over xi1, coloured by the kind of motion (Fig. 5).
fn chart(rows: &[DiagramRow]) -> Chart {
    let classes = [
        ("equilibrium", MotionClass::Equilibrium, Tint::Grey),
        ("limit cycle", MotionClass::LimitCycle, Tint::Green),
        ("torus", MotionClass::Torus, Tint::Blue),
        ("chaos", MotionClass::Chaos, Tint::Vermillion),
    ];
    let series = classes.into_iter().filter_map(|(label, class, tint)| {
        let of_class = rows.iter().filter(|row| row.outcome == class);
        let points: Vec<_> =
            of_class.flat_map(|row| [row.a1_max, row.a1_min].into_iter().flatten().map(|a1| (row.value, a1))).collect();
        (!points.is_empty()).then(|| Series { label: label.to_owned(), points, style: Style::Dots, tint })
    });
    Chart {
        title: "Largest and smallest amplitude of mass 1".to_owned(),
        x_label: "ξ₁".to_owned(),
        y_label: "a₁, max and min".to_owned(),
        series: series.collect(),
    }
}
