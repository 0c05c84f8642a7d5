//! `disk waves`: travelling-wave limit cycles over the nodal diameter, and their stability.

use super::super::Verdict;
use super::super::common::{Common, Document, print};
use super::super::plot::PlotArgs;
use crate::disk::{
    DESCRIBING_FUNCTION, DiskError, MANY_HARMONICS, TravellingWave, largest_by_wave, ring_wave, wave_multipliers,
};
use crate::exact::SparseFlow;
use crate::model::{BladedDisk, ModesError, NodalDiameter};
use crate::report::{Chart, Series, Style, Tint};
use clap::Args;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use std::path::PathBuf;

/// Travelling-wave limit cycles of the tuned ring: amplitude and frequency by nodal diameter, stability against every other wave.
///
/// Of each nodal diameter it gives one limit cycle, that of least amplitude beyond the slip limit of the lowest family (of disks with segments). Where
/// further ones of larger amplitude exist, the next is unstable and bounds what friction holds: a wave that starts beyond it grows without bound
/// although a limit cycle is listed.
///
/// A perturbation of relative nodal diameter r comes with -r, as the multipliers are conjugate: the waves n + r and n - r grow together. With --json
/// `growth` lists all waves and `fastest` those that grow most, with their common multiplier. Within 1e-9 of 1 a multiplier is neutral.
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
    /// All multipliers but the one along the motion are less than 1, and not neutral.
    stable: bool,
    stability: Stability,
    fastest: Fastest,
    /// Largest modulus of the multipliers over a period by the wave of the perturbation.
    growth: Vec<Growth>,
}

/// Multipliers this near to 1 in modulus are neutral: orbits close to some 1e-12, and their multipliers to about a thousand times that.
const NEUTRAL: f64 = 1e-9;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Stability {
    Stable,
    Neutral,
    Unstable,
}

impl Stability {
    fn of(multiplier: f64) -> Self {
        match multiplier - 1.0 {
            d if d < -NEUTRAL => Self::Stable,
            d if d > NEUTRAL => Self::Unstable,
            _ => Self::Neutral,
        }
    }
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
        let together = growth.iter().filter(|g| g.multiplier >= multiplier * (1.0 - NEUTRAL));
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
            Err(error) if of_one_wave(&error) => rows.push((wave, Err(error))),
            Err(error) => return Err(error.into()),
        }
    }
    args.plot.draw(|| Ok(chart(&rows)))?;
    if args.common.json {
        let row = |(wave, cycle): &(NodalDiameter, Result<Cycle, DiskError>)| {
            let (cycle, reason) = (cycle.as_ref().ok(), cycle.as_ref().err().map(ToString::to_string));
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
            Err(DiskError::NoWave { .. } | DiskError::NoSlip { .. }) => format!("{n:>14}  no limit cycle"),
            Err(error) => format!("{n:>14}  not found: {error}"),
        })?;
    }
    Ok(Verdict::Done)
}

/// Whether a failure says something about its wave alone; the other waves are shown then.
fn of_one_wave(error: &DiskError) -> bool {
    use DiskError::{ManyReversals, Modes, NoConvergence, NoSlip, NoWave, Orbit};
    matches!(
        error,
        NoWave { .. }
            | NoSlip { .. }
            | ManyReversals { .. }
            | NoConvergence { .. }
            | Orbit(_)
            | Modes(ModesError::NoConvergence { .. })
    )
}

fn stability(cycle: &Cycle) -> String {
    let Fastest { nodal_diameters, multiplier } = &cycle.fastest;
    let names = cycle.fastest.names();
    match cycle.stability {
        Stability::Stable => format!("stable, largest multiplier {multiplier:.6} ({names})"),
        Stability::Neutral => format!("neutral, largest multiplier 1 to rounding ({names})"),
        Stability::Unstable if nodal_diameters.len() > 1 => {
            format!("unstable: {names} grow together by {multiplier:.6} per period")
        }
        Stability::Unstable => format!("unstable: {names} grows by {multiplier:.6} per period"),
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
    let fastest = Fastest::of(&growth);
    let stability = Stability::of(fastest.multiplier);
    Ok(Cycle {
        amplitude: whole.amplitude,
        amplitude_from_one_sector: one.amplitude,
        amplitude_by_describing_function: estimate.amplitude,
        angular_frequency: whole.orbit.angular_frequency(),
        residual: whole.orbit.residual,
        stable: stability == Stability::Stable,
        stability,
        fastest,
        growth,
    })
}

fn chart(rows: &[(NodalDiameter, Result<Cycle, DiskError>)]) -> Chart {
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

    #[test]
    fn a_multiplier_of_one_to_rounding_is_neutral() {
        assert_eq!(Stability::of(1.0 + 1e-13), Stability::Neutral);
        assert_eq!(Stability::of(1.0 - 1e-13), Stability::Neutral);
        assert_eq!((Stability::of(1.0 + 1e-8), Stability::of(1.0 - 1e-8)), (Stability::Unstable, Stability::Stable));
    }
}
