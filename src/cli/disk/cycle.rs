//! `disk cycle`: a limit cycle of a disk that need not be tuned.

use super::super::Verdict;
use super::super::common::{Common, Document, print};
use super::super::plot::PlotArgs;
use super::super::progress::Heartbeat;
use super::motion::start;
use crate::disk::{DiskCycle, OrbitStability, mistuned_wave, settled_cycle, strongest, wave_amplitudes};
use crate::dynamics::State;
use crate::exact::SparseFlow;
use crate::model::{NodalDiameter, Range, Topology};
use crate::report::{Chart, Series, Style, Tint};
use anyhow::ensure;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Limit cycle of a mistuned disk: amplitude of every blade, frequency, Floquet multipliers, localisation.
///
/// The motion of the scene is followed until it has settled, then closed by Newton's method (shooting on the exact flow). The cycle is given only if
/// the motion is on it; how far off it is, is told. Motions that diverge, come to rest, keep several waves as on a torus, or have not settled
/// are refused by name. Within 1e-9 of 1 the leading multiplier is neutral.
///
/// With --wave the travelling wave of the tuned disk (the one of least amplitude that `disk waves` lists) is followed instead while the mistuning
/// grows: unstable cycles are found too.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  stickslip disk cycle scenes/disk_mistuned.toml --settle 20000 --plot amplitudes.svg\n  \
    stickslip disk cycle scenes/disk_mistuned.toml --wave 6 --json"
)]
pub struct CycleArgs {
    scene: PathBuf,
    /// Time for which the motion is followed before it is closed, at most 1e8; the length of the scene's motion without it.
    #[arg(long, conflicts_with = "wave", allow_hyphen_values = true)]
    settle: Option<f64>,
    /// Signed nodal diameter of the wave to follow.
    #[arg(long, allow_hyphen_values = true)]
    wave: Option<i64>,
    /// Steps in which the mistuning grows, at most 10000.
    #[arg(long, requires = "wave", default_value_t = 16)]
    steps: usize,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &CycleArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("disk cycle")?;
    args.plot.check(args.common.force)?;
    let (whole, case) = super::load_case(&args.scene, None)?;
    let disk = &case.disk;
    let chain = disk.chain()?;
    let settle = Range::NonNegative.check("--settle", args.settle.unwrap_or(whole.duration))?;
    let (cycle, distance, how) = match args.wave {
        Some(wave) => {
            ensure!(disk.topology == Topology::Ring, "--wave follows a wave of a ring: leave it out for a chain");
            let number = NodalDiameter::checked("--wave", wave, disk.sectors)?;
            let how = json!({"wave": number.signed(), "steps": args.steps});
            (mistuned_wave(disk, number, args.steps)?, None, how)
        }
        None => {
            let flow = SparseFlow::new(&chain).with_amplitude_bound(whole.amplitude_bound)?;
            let from = start(&case, &chain, whole.amplitude_bound)?;
            let heartbeat = Heartbeat::new(args.common.quiet, "settling", "parts");
            let found = settled_cycle(disk, &flow, &from, settle, |done, all| heartbeat.at(done, all))?;
            let how = json!({"start": case.start, "settle": settle, "amplitude_bound": whole.amplitude_bound});
            (found.cycle, Some(found.distances[1]), how)
        }
    };
    args.plot.draw(|| Ok(chart(&cycle)))?;
    if args.common.json {
        let state = State::from_components(cycle.orbit.state.as_slice(), &chain)?;
        let waves = wave_amplitudes(&state, disk.sectors, cycle.orbit.angular_frequency());
        let ring = disk.topology == Topology::Ring;
        let multipliers: Vec<[f64; 2]> = cycle.orbit.multipliers()?.iter().map(|m| [m.re, m.im]).collect();
        let document = Document::new("disk cycle", json!({"disk": disk, "from": how}))
            .with("amplitudes", json!(cycle.amplitudes))
            .with("angular_frequency", json!(cycle.orbit.angular_frequency()))
            .with("period", json!(cycle.orbit.period))
            .with("stable", json!(cycle.stable()))
            .with("stability", json!(cycle.stability()))
            .with("distance", json!(distance))
            .with("leading_multiplier", json!(cycle.leading_multiplier))
            .with("floquet_multipliers", json!(multipliers))
            .with("stuck_contacts", json!(cycle.stuck_contacts))
            .with("participation", json!(cycle.participation()))
            .with("strongest_nodal_diameter", json!(ring.then(|| strongest(&waves).signed())))
            .with("residual", json!(cycle.orbit.residual));
        return print(&document.text()?).map(|()| Verdict::Done);
    }
    let (low, high) = cycle.amplitudes.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), a| (l.min(*a), h.max(*a)));
    print(&format!(
        "angular frequency {:.12}, residual {:.1e}",
        cycle.orbit.angular_frequency(),
        cycle.orbit.residual
    ))?;
    print(&format!("amplitudes of the blades {low:.10} to {high:.10}, participation {:.4}", cycle.participation()))?;
    let multiplier = match cycle.stability() {
        OrbitStability::Neutral => "leading multiplier 1 to rounding".to_owned(),
        _ => format!("leading multiplier {:.8}", cycle.leading_multiplier),
    };
    print(&format!("{}, {multiplier}; {} contacts never slip", cycle.stability().word(), cycle.stuck_contacts))?;
    if let Some(distance) = distance {
        print(&format!("the motion followed is within {distance:.1e} of it"))?;
    }
    Ok(Verdict::Done)
}

fn chart(cycle: &DiskCycle) -> Chart {
    Chart {
        title: "Limit cycle of the disk".to_owned(),
        x_label: "blade".to_owned(),
        y_label: "amplitude".to_owned(),
        series: vec![Series {
            label: "half the range of displacements".to_owned(),
            points: cycle.amplitudes.iter().enumerate().map(|(j, a)| (j as f64, *a)).collect(),
            style: Style::Markers,
            tint: Tint::Blue,
        }],
    }
}
