//! `disk simulate`: the motion of a disk as amplitudes of its waves over time.

use super::super::common::{Common, Document, print};
use super::super::plot::PlotArgs;
use super::super::progress::Heartbeat;
use super::super::simulate::refuse_to_overwrite;
use super::super::{Verdict, case_args::EngineArgs, motions};
use super::solver::{Motion, Seen, Solver};
use crate::disk::{LONGEST_MOTION, strongest};
use crate::dynamics::{Outcome, Sampling, State};
use crate::model::{Mistuning, NodalDiameter, OscillatorChain, Range, Topology};
use crate::report::{Chart, Series, Style, Tint};
use crate::scene::DiskCase;
use crate::store::{Column, ColumnData, Table, write_table};
use anyhow::ensure;
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;

const MOST_SAMPLES: f64 = 1e7;
/// Series of a chart: as many as there are colours.
const TINTS: [Tint; 5] = [Tint::Blue, Tint::Orange, Tint::Green, Tint::Vermillion, Tint::Purple];

/// The motion of the disk: amplitude of every wave over time, by nodal diameter (of a chain, by blade).
///
/// Waves are seen at their own frequencies with stuck contacts: amplitudes of the exact motion and of the engine are off by half the part by
/// which slip lowers the frequency. What contacts that stick hold the blades off their rest stands in the amplitudes as well: a wave
/// that does not swing can have one.
///
/// With slow-flow all waves are averaged on one carrier frequency: where their frequencies lie apart it is off. The secondary
/// Hopf point of the two-mass rig comes out 7 % off with it.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  stickslip disk simulate scenes/disk_competition.toml -o waves.csv --plot waves.svg\n  \
    stickslip disk simulate scenes/disk_competition.toml --with slow-flow --t-end 20000 --sample 10 --json"
)]
pub struct MotionArgs {
    scene: PathBuf,
    /// How to move the disk.
    #[arg(long = "with", value_enum, default_value_t = Solver::Exact)]
    solver: Solver,
    /// Length of the motion, at most 1e8; that of the scene without it.
    #[arg(long, allow_hyphen_values = true)]
    t_end: Option<f64>,
    /// Time between two samples.
    #[arg(long, value_name = "DT", default_value_t = 1.0, allow_hyphen_values = true)]
    sample: f64,
    #[command(flatten)]
    engine: EngineArgs,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &MotionArgs) -> anyhow::Result<Verdict> {
    ensure!(
        args.solver == Solver::Rapier || !args.engine.is_given(),
        "options of the engine decide about the engine alone: add --with rapier or leave them out"
    );
    args.plot.check(args.common.force)?;
    let (whole, case) = super::load_case(&args.scene, Some(&args.engine))?;
    let sampling = Sampling {
        interval: Range::Positive.check("--sample", args.sample)?,
        t_end: Range::NonNegative.check("--t-end", args.t_end.unwrap_or(whole.duration))?,
    };
    ensure!(
        sampling.t_end <= LONGEST_MOTION,
        "--t-end {:e} is too long, allowed are {LONGEST_MOTION:e}: even a small disk takes minutes for that",
        sampling.t_end
    );
    let samples = sampling.t_end / sampling.interval * case.disk.sectors as f64;
    ensure!(
        samples <= MOST_SAMPLES,
        "--sample {} gives {samples:e} numbers, allowed are {MOST_SAMPLES:e}: take a longer one",
        args.sample
    );
    let engine = motions::engine_settings(&whole, sampling);
    let mut parameters = json!({
        "disk": case.disk, "start": case.start, "sampling": sampling, "with": args.solver.word(),
        "amplitude_bound": whole.amplitude_bound,
    });
    if args.solver == Solver::Rapier {
        parameters["engine"] = json!(engine);
    }
    if let Some(path) = &args.common.output {
        refuse_to_overwrite(path, &parameters, args.common.force)?;
    }
    let ring = case.disk.topology == Topology::Ring;
    let from = start(&case, &case.disk.chain()?, whole.amplitude_bound)?;
    let heartbeat = Heartbeat::new(args.common.quiet, "motion", "% of the time");
    let motion = Motion { disk: &case.disk, start: &from, sampling, amplitude_bound: whole.amplitude_bound };
    let seen = motion.observe(args.solver, engine, |t| heartbeat.at((100.0 * t / sampling.t_end) as usize, 100))?;
    if let Some(path) = &args.common.output {
        write_table(path, &table(&seen.times, &seen.rows, ring, &parameters))?;
    }
    args.plot.draw(|| Ok(chart(&seen.times, &seen.rows, ring)))?;
    if args.common.json {
        return print(&document(&seen, parameters, ring).text()?).map(|()| Verdict::Done);
    }
    let end = if seen.outcome == Outcome::Completed { "completed" } else { "diverged" };
    let switches = seen.switches.map_or(String::new(), |count| format!(", {count} changes of contact state"));
    print(&format!("{end}{switches}"))?;
    if let Some(last) = seen.rows.last().filter(|_| ring) {
        print(&format!("strongest wave at the end: nodal diameter {}", strongest(last).signed()))?;
    }
    Ok(Verdict::Done)
}

fn document(seen: &Seen, parameters: Value, ring: bool) -> Document {
    let last = seen.rows.last().cloned().unwrap_or_default();
    let winner = ring.then(|| strongest(&last).signed());
    Document::new("disk simulate", parameters)
        .with("final", json!({"t": seen.times.last(), "amplitudes": last, "strongest_nodal_diameter": winner}))
        .with("events", json!(seen.switches))
        .with("work", seen.work.clone())
        .with("diverged", json!(seen.outcome != Outcome::Completed))
}

/// The state a disk starts from, within the amplitude bound.
pub fn start(case: &DiskCase, chain: &OscillatorChain, amplitude_bound: f64) -> anyhow::Result<State> {
    let n = case.disk.sectors;
    let mut state = State::rest(chain);
    if case.start.noise > 0.0 {
        let noise = Mistuning::Uniform { half_width: case.start.noise, seed: case.start.seed };
        state.positions[..n].copy_from_slice(&noise.deviations(n)?);
    }
    for wave in &case.start.waves {
        let number = NodalDiameter::new(wave.nodal_diameter, n);
        for j in 0..n {
            let angle = wave.phase - number.multiple(j as i64);
            state.positions[j] += wave.amplitude * angle.cos();
            state.velocities[j] -= wave.amplitude * angle.sin();
        }
    }
    // Not only where a solver would mind: all of them start from the same state. NaN, from infinite parts that cancel, lies beyond too.
    let largest =
        state.positions.iter().chain(&state.velocities).map(|x| x.abs()).max_by(f64::total_cmp).unwrap_or(0.0);
    ensure!(
        largest <= amplitude_bound,
        "[disk_start] moves a blade by {largest:e}, beyond the amplitude bound {amplitude_bound}: start smaller, or raise amplitude_bound in [simulation]"
    );
    Ok(state)
}

/// Columns in the order of wave number, forward and backward in turn; of a chain in the order of blades.
fn order(count: usize, ring: bool) -> Vec<(usize, String)> {
    match ring {
        true => NodalDiameter::all(count).map(|wave| (wave.index(), format!("wave {:+}", wave.signed()))).collect(),
        false => (0..count).map(|j| (j, format!("amplitude of blade {j}"))).collect(),
    }
}

fn table(times: &[f64], rows: &[Vec<f64>], ring: bool, parameters: &Value) -> Table {
    let column = |name: &str, values| Column { name: name.to_owned(), unit: "1".to_owned(), values };
    let of = |i: usize| ColumnData::F64(rows.iter().map(|row| row[i]).collect());
    let count = rows.first().map_or(0, Vec::len);
    let mut columns = vec![column("t", ColumnData::F64(times.to_vec()))];
    columns.extend(order(count, ring).into_iter().map(|(i, name)| column(&name, of(i))));
    Table {
        metadata: vec![
            ("stickslip".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("parameters".to_owned(), parameters.to_string()),
        ],
        columns,
    }
}

/// The waves or blades that reach the largest amplitudes.
fn chart(times: &[f64], rows: &[Vec<f64>], ring: bool) -> Chart {
    let count = rows.first().map_or(0, Vec::len);
    let largest = |i: usize| rows.iter().map(|row| row[i]).fold(0.0, f64::max);
    let mut shown = order(count, ring);
    shown.sort_by(|a, b| largest(b.0).total_cmp(&largest(a.0)));
    let series = shown.into_iter().zip(TINTS).map(|((i, label), tint)| Series {
        label,
        points: times.iter().zip(rows).map(|(t, row)| (*t, row[i])).collect(),
        style: Style::Line,
        tint,
    });
    Chart {
        title: if ring { "Amplitudes of the waves" } else { "Amplitudes of the blades" }.to_owned(),
        x_label: "time".to_owned(),
        y_label: "amplitude".to_owned(),
        series: series.collect(),
    }
}
