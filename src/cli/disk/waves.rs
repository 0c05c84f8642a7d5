//! `disk waves`: travelling-wave limit cycles over the nodal diameter, and their stability.

use super::super::Verdict;
use super::super::common::{Common, Document, print};
use super::super::plot::PlotArgs;
use super::super::progress::Heartbeat;
use crate::disk::{DiskError, FailedCandidate, FoundWaves, NEUTRAL_MULTIPLIER, OrbitStability, Searched, WaveCycle};
use crate::model::{BladedDisk, NodalDiameter};
use crate::report::{Chart, Series, Style, Tint};
use clap::Args;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Travelling-wave limit cycles of the tuned ring: amplitude and frequency by nodal diameter, stability against every other wave.
///
/// Every nodal diameter and direction is searched over the amplitude of its contacts, from 1 to 1000 slip elongations, in every mode of the sector,
/// whether the wave is damped at rest or fed. The describing function is computed at 513 amplitudes (neighbours at most 22 % apart, near the slip
/// limit far less), and between them its extremes are sought, so that pairs of cycles close together are found. What it finds is solved for on the whole
/// ring. Not found are cycles that the describing function does not have, and motions that are no travelling waves. A search that sees a cycle beyond the
/// largest amplitude says so (`searched.beyond`). A cycle that could not be solved for is a row with its reason and makes the exit status 1.
///
/// An unstable cycle bounds what the stable ones beside it, or rest, attract: a wave that starts beyond it goes elsewhere.
///
/// A perturbation of relative nodal diameter r comes with -r, as the multipliers are conjugate: the waves n + r and n - r grow together. With --json
/// `growth` lists all waves and `fastest` those that grow most, with their common multiplier over a period. Within 1e-9 of 1 a multiplier is neutral.
/// `limit_cycles` lists all cycles of a wave by family and amplitude, `limit_cycle` is the first of them, `failed` what could not be solved for.
///
/// Amplitudes come from one sector (harmonic balance; null where it does not converge) and from the whole ring (exact flow, shooting); multipliers
/// from the exact flow. Mistuning of the scene is left out.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip disk waves scenes/disk_forward_wave.toml --plot waves.svg")]
pub struct WavesArgs {
    scene: PathBuf,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

/// A limit cycle of a wave.
#[derive(Debug, Serialize)]
struct Cycle {
    /// Number of the mode of the sector by frequency, 0 the lowest.
    family: usize,
    amplitude: f64,
    amplitude_from_one_sector: Option<f64>,
    amplitude_by_describing_function: f64,
    angular_frequency: f64,
    residual: f64,
    /// All multipliers but the one along the motion are less than 1, and not neutral.
    stable: bool,
    stability: OrbitStability,
    fastest: Fastest,
    /// Largest modulus of the multipliers over a period by the wave of the perturbation.
    growth: Vec<Growth>,
}

/// What grows most: n - r and n + r, one wave where they are the same, and more only where their multipliers coincide.
#[derive(Debug, Serialize)]
struct Fastest {
    nodal_diameters: Vec<i64>,
    multiplier: f64,
}

impl Fastest {
    fn of(growth: &[Growth]) -> Self {
        let multiplier = growth.iter().map(|g| g.multiplier).fold(0.0, f64::max);
        let together = growth.iter().filter(|g| g.multiplier >= multiplier * (1.0 - NEUTRAL_MULTIPLIER));
        Self { nodal_diameters: together.map(|g| g.nodal_diameter).collect(), multiplier }
    }

    fn names(&self) -> String {
        let numbers: Vec<String> = self.nodal_diameters.iter().map(i64::to_string).collect();
        match numbers.split_last() {
            Some((last, [])) => format!("wave {last}"),
            Some((last, others)) => format!("waves {} and {last}", others.join(", ")),
            None => "no wave".to_owned(),
        }
    }
}

#[derive(Debug, Serialize)]
struct Growth {
    nodal_diameter: i64,
    multiplier: f64,
}

/// What is known of a wave; an error speaks of it alone.
struct Row {
    wave: NodalDiameter,
    found: Result<Found, DiskError>,
}

struct Found {
    searched: Searched,
    cycles: Vec<Cycle>,
    failed: Vec<FailedCandidate>,
}

impl Row {
    fn of(disk: &BladedDisk, wave: NodalDiameter) -> Self {
        let found = FoundWaves::of(disk, wave).map(|FoundWaves { searched, cycles, failed }| Found {
            searched,
            cycles: cycles.iter().map(|cycle| Cycle::of(cycle, disk.sectors)).collect(),
            failed,
        });
        Self { wave, found }
    }

    fn is_whole(&self) -> bool {
        self.found.as_ref().is_ok_and(|found| found.failed.is_empty())
    }

    /// Why there is no limit cycle.
    fn reason(&self) -> Option<String> {
        match &self.found {
            Err(error) => Some(error.to_string()),
            Ok(found) if !found.cycles.is_empty() => None,
            Ok(found) => Some(match found.failed.first() {
                Some(failed) => failed.error.to_string(),
                None => format!("no limit cycle that slips {}", within(&found.searched)),
            }),
        }
    }

    fn json(&self) -> Value {
        let found = self.found.as_ref().ok();
        let cycles = found.map_or(&[][..], |found| &found.cycles[..]);
        let failed = found.map_or(&[][..], |found| &found.failed[..]);
        let failure = |failed: &FailedCandidate| {
            json!({
                "family": failed.candidate.family, "elongation_by_describing_function": failed.candidate.elongation,
                "angular_frequency": failed.candidate.angular_frequency, "reason": failed.error.to_string(),
            })
        };
        json!({
            "nodal_diameter": self.wave.signed(),
            "direction": self.wave.direction(),
            "limit_cycle": cycles.first(),
            "limit_cycles": cycles,
            "failed": failed.iter().map(failure).collect::<Vec<_>>(),
            "searched": found.map(|found| searched_json(&found.searched)),
            "reason": self.reason(),
        })
    }

    fn lines(&self) -> Vec<String> {
        let n = self.wave.signed();
        let Ok(found) = &self.found else {
            return vec![format!("{n:>14}  not searched: {}", self.reason().unwrap_or_default())];
        };
        let cycle =
            |c: &Cycle| format!("{n:>14}  {:<14.10}  {:<17.12}  {}", c.amplitude, c.angular_frequency, stability(c));
        let failed = |f: &FailedCandidate| format!("{n:>14}  not solved for: {}", f.error);
        let mut lines: Vec<String> = found.cycles.iter().map(cycle).chain(found.failed.iter().map(failed)).collect();
        if lines.is_empty() {
            lines.push(format!("{n:>14}  no limit cycle found"));
        }
        if found.searched.beyond {
            lines.push(format!("{n:>14}  another one beyond the largest amplitude searched"));
        }
        lines
    }
}

fn within(searched: &Searched) -> String {
    let [least, most] = searched.elongations;
    let further = if searched.beyond { ", but one beyond" } else { "" };
    format!("at elongations from {least} to {most}, searched by the describing function in every mode{further}")
}

fn searched_json(searched: &Searched) -> Value {
    json!({
        "elongations": searched.elongations, "amplitudes": searched.amplitudes, "largest_ratio": searched.largest_ratio,
        "eigenvalues": searched.eigenvalues, "beyond": searched.beyond,
    })
}

pub fn run(args: &WavesArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("disk waves")?;
    args.plot.check(args.common.force)?;
    let disk = super::load(&args.scene)?.disk.tuned();
    let waves: Vec<NodalDiameter> = NodalDiameter::all(disk.sectors).collect();
    // A disk without waves is refused whole, before any is searched.
    FoundWaves::check(&disk)?;
    let heartbeat = Heartbeat::new(args.common.quiet, "waves", "nodal diameters");
    let (done, all) = (AtomicUsize::new(0), waves.len());
    let row = |wave| {
        let row = Row::of(&disk, wave);
        heartbeat.at(done.fetch_add(1, Ordering::Relaxed) + 1, all);
        row
    };
    let rows: Vec<Row> = waves.into_par_iter().map(row).collect();
    let verdict = if rows.iter().all(Row::is_whole) { Verdict::Done } else { Verdict::Failed };
    args.plot.draw(|| Ok(chart(&rows)))?;
    if args.common.json {
        let document = Document::new("disk waves", json!({"disk": disk}))
            .with("waves", json!(rows.iter().map(Row::json).collect::<Vec<_>>()));
        return print(&document.text()?).map(|()| verdict);
    }
    print("nodal diameter  amplitude       angular frequency  stability")?;
    for line in rows.iter().flat_map(Row::lines) {
        print(&line)?;
    }
    if let Some(found) = rows.iter().find_map(|row| row.found.as_ref().ok()) {
        let Searched { elongations: [least, most], amplitudes, eigenvalues, .. } = found.searched;
        print(&format!(
            "searched: elongations of the contacts from {least} to {most} at {amplitudes} amplitudes, all {eigenvalues} eigenvalues of a sector, by the describing function"
        ))?;
    }
    Ok(verdict)
}

fn stability(cycle: &Cycle) -> String {
    let Fastest { nodal_diameters, multiplier } = &cycle.fastest;
    let names = cycle.fastest.names();
    match cycle.stability {
        OrbitStability::Stable => format!("stable, largest multiplier {multiplier:.6} ({names})"),
        OrbitStability::Neutral => format!("neutral, largest multiplier 1 to rounding ({names})"),
        OrbitStability::Unstable if nodal_diameters.len() > 1 => {
            format!("unstable: {names} grow together by {multiplier:.6} per period")
        }
        OrbitStability::Unstable => format!("unstable: {names} grows by {multiplier:.6} per period"),
    }
}

impl Cycle {
    fn of(found: &WaveCycle, sectors: usize) -> Self {
        let wave = found.ring.wave.signed();
        let seen = |relative: NodalDiameter| NodalDiameter::new(wave + relative.signed(), sectors).signed();
        let growth: Vec<Growth> = found
            .growth
            .iter()
            .map(|(relative, multiplier)| Growth { nodal_diameter: seen(*relative), multiplier: *multiplier })
            .collect();
        Self {
            family: found.family,
            amplitude: found.ring.amplitude,
            amplitude_from_one_sector: found.amplitude_from_one_sector,
            amplitude_by_describing_function: found.amplitude_by_describing_function,
            angular_frequency: found.ring.orbit.angular_frequency(),
            residual: found.ring.orbit.residual,
            stable: found.stability == OrbitStability::Stable,
            stability: found.stability,
            fastest: Fastest::of(&growth),
            growth,
        }
    }
}

fn chart(rows: &[Row]) -> Chart {
    let found = |row: &Row| -> Vec<(f64, bool, f64)> {
        let cycles = row.found.as_ref().map_or(&[][..], |found| &found.cycles[..]);
        cycles.iter().map(|cycle| (row.wave.signed() as f64, cycle.stable, cycle.amplitude)).collect()
    };
    let cycles: Vec<(f64, bool, f64)> = rows.iter().flat_map(found).collect();
    let series = |label: &str, stable: bool, tint| Series {
        label: label.to_owned(),
        points: cycles.iter().filter(|cycle| cycle.1 == stable).map(|cycle| (cycle.0, cycle.2)).collect(),
        style: Style::Markers,
        tint,
    };
    Chart {
        title: "Travelling-wave limit cycles".to_owned(),
        x_label: "nodal diameter (positive: forward wave)".to_owned(),
        y_label: "amplitude of the blades".to_owned(),
        series: vec![series("stable", true, Tint::Blue), series("unstable or neutral", false, Tint::Orange)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_that_grow_together_are_named_together() {
        // The second of the pair is larger by a rounding.
        let growth = [(3, 0.2), (2, 1.5), (4, 1.5 + 3e-16), (5, 0.9)];
        let growth = growth.map(|(nodal_diameter, multiplier)| Growth { nodal_diameter, multiplier });
        let fastest = Fastest::of(&growth);
        assert_eq!((&fastest.nodal_diameters[..], fastest.names().as_str()), (&[2, 4][..], "waves 2 and 4"));
        assert_eq!(Fastest::of(&growth[..2]).names(), "wave 2");
    }
}
