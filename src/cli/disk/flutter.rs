//! `disk flutter`: probability of flutter and amplitudes under random mistuning.

use super::super::Verdict;
use super::super::common::{Common, Document, print};
use super::super::plot::PlotArgs;
use super::super::progress::{Heartbeat, duration};
use super::super::streams::tell;
use crate::disk::{Fate, MonteCarlo, Sample, SampleRow, Summary};
use crate::report::{Chart, Series, Style, Tint};
use crate::store::{Existing, Origin, OutputDir};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Work of so many seconds is announced.
const LONG: f64 = 5.0;

/// Monte Carlo over the random mistuning of a scene: linear flutter margins, fates and amplitudes of the exact motions.
///
/// Displacements at the start are random as well (--start): shares and amplitudes are over mistuning and starts together, and where a stable disk has
/// flutter beside its rest they depend on how far starts reach. Amplitudes are half the range of displacements of a blade. Flutter is held by friction
/// where contacts slip and amplitudes have settled to 1 %. Linear classes come from all eigenvalues of the stuck disk: a growing pair is flutter, a
/// growing real one static divergence. A draw that is no disk, or whose motion fails, is a row with its reason and makes the exit status 1.
///
/// With -o DIR finished samples are kept as they come: an interrupted run, killed ones included, goes on where it was and ends with the
/// same files.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip disk flutter scenes/disk_mistuned.toml --samples 1000 -o flutter")]
pub struct FlutterArgs {
    scene: PathBuf,
    /// Number of disks, at most a million.
    #[arg(long, default_value_t = 1000)]
    samples: usize,
    /// Seed of the first sample; the others follow by one.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Length of each motion in periods 2 pi of a blade, at least 20 and at most 1.5e7; motions that have not settled to 1 % go on.
    #[arg(long, default_value_t = 400.0, allow_hyphen_values = true)]
    periods: f64,
    /// Length up to which they go on, in steps of four times; those not settled by then are counted apart. 16 times --periods without it.
    #[arg(long, allow_hyphen_values = true)]
    longest: Option<f64>,
    /// Displacements at the start are uniform from minus this to this: part of what is drawn.
    #[arg(long, default_value_t = 0.5, allow_hyphen_values = true)]
    start: f64,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &FlutterArgs) -> anyhow::Result<Verdict> {
    args.plot.check(args.common.force)?;
    let disk = super::load(&args.scene)?.disk;
    let plan = MonteCarlo {
        disk,
        samples: args.samples,
        first_seed: args.seed,
        periods: args.periods,
        longest: args.longest.unwrap_or(16.0 * args.periods),
        start: args.start,
    };
    let parameters = json!(plan);
    let existing = if args.common.force { Existing::Replace } else { Existing::Resume };
    let origin = Origin::new("disk flutter", parameters.clone());
    let record = args.common.output.as_deref().map(|path| OutputDir::open(path, &origin, existing)).transpose()?;
    if !args.common.quiet {
        announce(&plan)?;
    }
    let heartbeat = Heartbeat::new(args.common.quiet, "flutter", "disks");
    let samples = plan.run(record.as_ref(), |done, all| heartbeat.at(done, all))?;
    let summary = Summary::of(&samples);
    let rows: Vec<SampleRow> = samples.iter().filter_map(Sample::row).copied().collect();
    let failed: Vec<&Sample> = samples.iter().filter(|sample| sample.row().is_none()).collect();
    let verdict = if failed.is_empty() { Verdict::Done } else { Verdict::Failed };
    if let Some(directory) = &record {
        directory.write("samples.json", "", |file| {
            serde_json::to_writer(&mut *file, &samples)?;
            writeln!(file)
        })?;
    }
    args.plot.draw(|| Ok(chart(&rows)))?;
    if args.common.json {
        let files = record.as_ref().map(OutputDir::files).unwrap_or_default();
        let document = Document::new("disk flutter", parameters)
            .with("summary", json!(summary))
            .with("failed", json!(failed))
            .with("files", json!(files));
        return print(&document.text()?).map(|()| verdict);
    }
    let fates = &summary.fates;
    let of = |p: f64, [low, high]: [f64; 2]| {
        format!("{:.1} %, Wilson 95 % interval {:.1} to {:.1} %", 100.0 * p, 100.0 * low, 100.0 * high)
    };
    print(&format!("of {} disks", rows.len()))?;
    let linear = of(summary.probability_of_linear_flutter, summary.linear_flutter_interval);
    print(&format!("linear flutter: {linear}"))?;
    if summary.linear.divergence > 0 {
        print(&format!("static divergence with stuck contacts: {} disks", summary.linear.divergence))?;
    }
    let held = of(summary.probability_of_held_flutter, summary.held_flutter_interval);
    print(&format!("settled flutter held by friction: {held}"))?;
    print(&format!(
        "stable {}, flutter held by friction {}, not settled {}, diverged {}",
        fates.stable, fates.flutter, fates.unsettled, fates.diverged
    ))?;
    if let [low, _, median, _, high] = summary.amplitude_quantiles[..] {
        print(&format!(
            "largest amplitude of a blade in settled flutter: median {median:.4}, 5 to 95 %: {low:.4} to {high:.4}"
        ))?;
    }
    let lengths: Vec<String> = summary.lengths.iter().map(|(periods, count)| format!("{count} to {periods}")).collect();
    print(&format!("disks followed over periods: {}", lengths.join(", ")))?;
    for sample in failed {
        if let Sample::Failed { seed, reason } = sample {
            print(&format!("not followed: the disk of seed {seed}: {reason}"))?;
        }
    }
    Ok(verdict)
}

/// Says beforehand how long work beyond some seconds may take, by the pace of the first disk.
fn announce(plan: &MonteCarlo) -> anyhow::Result<()> {
    let Some(seconds) = plan.estimate()? else { return Ok(()) };
    let [least, most] = seconds.map(|seconds| seconds / rayon::current_num_threads() as f64);
    if most > LONG {
        tell(&format!("flutter: {} disks take about {} to {}", plan.samples, duration(least), duration(most)));
    }
    Ok(())
}

/// Distribution functions of the largest and the mean amplitude of fluttering disks.
fn chart(rows: &[SampleRow]) -> Chart {
    let distribution = |label: &str, of: fn(&SampleRow) -> f64, tint| {
        let mut values: Vec<f64> = rows.iter().filter(|row| row.fate == Fate::Flutter && row.settled).map(of).collect();
        values.sort_by(f64::total_cmp);
        let count = values.len() as f64;
        let points = values.iter().enumerate().map(|(i, v)| (*v, (i + 1) as f64 / count)).collect();
        Series { label: label.to_owned(), points, style: Style::Line, tint }
    };
    Chart {
        title: "Flutter amplitudes under random mistuning".to_owned(),
        x_label: "amplitude".to_owned(),
        y_label: "part of the settled fluttering disks below".to_owned(),
        series: vec![
            distribution("largest of all blades", |row| row.amplitude, Tint::Vermillion),
            distribution("mean over the blades", |row| row.mean_amplitude, Tint::Blue),
        ],
    }
}
