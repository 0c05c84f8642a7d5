//! `disk waves`: travelling-wave limit cycles over the nodal diameter, and their stability.

use super::super::Verdict;
use super::super::common::{Common, Document, print};
use super::super::plot::PlotArgs;
use crate::disk::{
    DESCRIBING_FUNCTION, DiskError, MANY_HARMONICS, TravellingWave, largest_by_wave, ring_wave, wave_multipliers,
};
use crate::exact::SparseFlow;
use crate::model::{BladedDisk, NodalDiameter};
use crate::report::{Chart, Series, Style, Tint};
use clap::Args;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use std::path::PathBuf;

/// Travelling-wave limit cycles of the tuned ring: amplitude and frequency by nodal diameter, stability against every other wave.
///
/// Amplitudes come from one sector (harmonic balance) and from the whole ring (exact flow, shooting); multipliers from the exact flow. Mistuning
/// of the scene is left out.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip disk waves scenes/disk_forward_wave.toml --plot waves.svg")]
pub struct WavesArgs {
    scene: PathBuf,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

/// A wave that has a limit cycle.
#[derive(Debug, Serialize)]
struct Cycle {
    amplitude: f64,
    amplitude_from_one_sector: f64,
    amplitude_by_describing_function: f64,
    angular_frequency: f64,
    residual: f64,
    stable: bool,
    /// Largest modulus of the multipliers over a period by the wave of the perturbation.
    growth: Vec<Growth>,
}

#[derive(Debug, Serialize)]
struct Growth {
    nodal_diameter: i64,
    multiplier: f64,
}

pub fn run(args: &WavesArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("disk waves")?;
    args.plot.check(args.common.force)?;
    let disk = super::load(&args.scene)?.disk.tuned();
    let flow = SparseFlow::new(&disk.chain()?);
    let waves: Vec<NodalDiameter> = NodalDiameter::all(disk.sectors).collect();
    let found: Vec<(NodalDiameter, Result<Cycle, DiskError>)> =
        waves.into_par_iter().map(|wave| (wave, cycle(&disk, &flow, wave))).collect();
    let mut rows = Vec::new();
    for (wave, cycle) in found {
        match cycle {
            Ok(cycle) => rows.push((wave, Ok(cycle))),
            Err(error @ (DiskError::NoWave { .. } | DiskError::NoSlip { .. } | DiskError::ManyReversals { .. })) => {
                rows.push((wave, Err(error.to_string())));
            }
            Err(error) => return Err(error.into()),
        }
    }
    args.plot.draw(|| Ok(chart(&rows)))?;
    if args.common.json {
        let row = |(wave, cycle): &(NodalDiameter, Result<Cycle, String>)| {
            let (cycle, reason) = (cycle.as_ref().ok(), cycle.as_ref().err());
            json!({"nodal_diameter": wave.signed(), "direction": wave.direction(), "limit_cycle": cycle, "reason": reason})
        };
        let document = Document::new("disk waves", json!({"disk": disk}))
            .with("waves", json!(rows.iter().map(row).collect::<Vec<_>>()));
        return print(&document.text()?).map(|()| Verdict::Done);
    }
    print("nodal diameter  amplitude       angular frequency  stability")?;
    for (wave, cycle) in &rows {
        let n = wave.signed();
        print(&match cycle {
            Ok(c) => format!("{n:>14}  {:<14.10}  {:<17.12}  {}", c.amplitude, c.angular_frequency, stability(c)),
            Err(_) => format!("{n:>14}  no limit cycle"),
        })?;
    }
    Ok(Verdict::Done)
}

fn stability(cycle: &Cycle) -> String {
    let worst = cycle.growth.iter().max_by(|a, b| a.multiplier.total_cmp(&b.multiplier));
    match worst {
        Some(worst) if !cycle.stable => {
            format!("unstable: wave {} grows by {:.6} per period", worst.nodal_diameter, worst.multiplier)
        }
        Some(worst) => format!("stable, largest multiplier {:.6} (wave {})", worst.multiplier, worst.nodal_diameter),
        None => "stable".to_owned(),
    }
}

fn cycle(disk: &BladedDisk, flow: &SparseFlow, wave: NodalDiameter) -> Result<Cycle, DiskError> {
    let estimate = TravellingWave::of(disk, wave, DESCRIBING_FUNCTION)?;
    let one = TravellingWave::of(disk, wave, MANY_HARMONICS)?;
    let whole = ring_wave(flow, &one)?;
    let multipliers = wave_multipliers(flow, disk, wave, &whole.orbit)?;
    let by_wave = largest_by_wave(&multipliers, disk.sectors);
    let seen = |relative: NodalDiameter| NodalDiameter::new(wave.signed() + relative.signed(), disk.sectors).signed();
    let growth: Vec<Growth> = by_wave
        .iter()
        .map(|(relative, multiplier)| Growth { nodal_diameter: seen(*relative), multiplier: *multiplier })
        .collect();
    Ok(Cycle {
        amplitude: whole.amplitude,
        amplitude_from_one_sector: one.amplitude,
        amplitude_by_describing_function: estimate.amplitude,
        angular_frequency: whole.orbit.angular_frequency(),
        residual: whole.orbit.residual,
        stable: growth.iter().all(|g| g.multiplier < 1.0),
        growth,
    })
}

fn chart(rows: &[(NodalDiameter, Result<Cycle, String>)]) -> Chart {
    let series = |label: &str, stable: bool, tint| Series {
        label: label.to_owned(),
        points: rows
            .iter()
            .filter_map(|(wave, cycle)| cycle.as_ref().ok().map(|cycle| (wave, cycle)))
            .filter(|(_, cycle)| cycle.stable == stable)
            .map(|(wave, cycle)| (wave.signed() as f64, cycle.amplitude))
            .collect(),
        style: Style::Markers,
        tint,
    };
    Chart {
        title: "Travelling-wave limit cycles".to_owned(),
        x_label: "nodal diameter (positive: forward wave)".to_owned(),
        y_label: "amplitude of the blades".to_owned(),
        series: vec![series("stable", true, Tint::Blue), series("unstable", false, Tint::Orange)],
    }
}
