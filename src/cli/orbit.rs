//! `orbit`: the limit cycle at given parameters, and its multipliers.

use super::analysis::{RigInput, complex, complexes, exact_flow, lower_branch};
use super::common::{Common, Document, print};
use super::plot::PlotArgs;
use super::{Verdict, motions};
use crate::dynamics::{Flow, Sampling};
use crate::exact::TwoMassFlow;
use crate::model::RigParameters;
use crate::orbit::{FloquetMultipliers, Heading, PeriodicOrbit, shoot};
use crate::report::{Chart, Series, Style, Tint};
use anyhow::{Context, bail};
use clap::Args;
use nalgebra::Complex;
use serde_json::json;

/// Amplitude beyond which the upper branch is not looked for.
const LARGEST_AMPLITUDE: f64 = 50.0;

/// The limit cycle at xi1, by Newton's method on the half-period map, and its Floquet multipliers.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip orbit --xi1 -0.06 --json")]
pub struct OrbitArgs {
    /// Take the branch beyond the fold.
    #[arg(long)]
    upper: bool,
    #[command(flatten)]
    rig: RigInput,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &OrbitArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("orbit")?;
    args.plot.check(args.common.force)?;
    let p = args.rig.parameters()?;
    let orbit = if args.upper { upper(p) } else { motions::exact_limit_cycle(p).map_err(Into::into) };
    let rig = || format!("limit cycle at xi1 = {}, xi2 = {}, kappa = {}, gamma = {}", p.xi1, p.xi2, p.kappa, p.gamma);
    let orbit = orbit.with_context(rig)?;
    let flow = exact_flow(p)?;
    let floquet = FloquetMultipliers::of(&flow, &orbit)?;
    let measures = orbit.measures(&flow)?;
    args.plot.draw(|| phase_plane(&orbit, &flow, p.xi1))?;
    let [x1, x2, v2] = orbit.section.into();
    if args.common.json {
        let all: Vec<Complex<f64>> =
            [Complex::new(1.0, 0.0)].into_iter().chain(floquet.others).chain([floquet.zero]).collect();
        let parameters = json!({"xi1": p.xi1, "xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma, "upper": args.upper});
        let document = Document::new("orbit", parameters)
            .with("section", json!({"x1": x1, "x2": x2, "v2": v2}))
            .with("period", json!(orbit.period))
            .with("angular_frequency", json!(orbit.angular_frequency()))
            .with("a1", json!(measures.amplitude1))
            .with("a2", json!(measures.amplitude2))
            .with("energy", json!(measures.mean_energy))
            .with("half_period_multipliers", complexes(&orbit.section_multipliers()))
            .with("floquet_multipliers", complexes(&all))
            .with("trivial_multiplier_error", json!(floquet.trivial_error))
            .with("stable", json!(floquet.stable()))
            .with("residual", json!(orbit.residual));
        print(&document.text()?)?;
        return Ok(Verdict::Done);
    }
    let multipliers: Vec<String> = orbit.section_multipliers().iter().map(|m| complex(*m)).collect();
    print(&format!(
        "limit cycle at xi1 = {}: {}\nreversal   x1 = {x1:.12}  x2 = {x2:.12}  v2 = {v2:.12}\namplitudes a1 = {:.9}  a2 = {:.9}\n\
         period {:.12}, angular frequency {:.12}\nhalf-period multipliers {}\ntrivial multiplier off by {:.1e}, residual {:.1e}",
        p.xi1,
        if floquet.stable() { "stable" } else { "unstable" },
        measures.amplitude1,
        measures.amplitude2,
        orbit.period,
        orbit.angular_frequency(),
        multipliers.join(", "),
        floquet.trivial_error,
        orbit.residual,
    ))?;
    Ok(Verdict::Done)
}

/// Both masses over one period.
fn phase_plane(orbit: &PeriodicOrbit, flow: &TwoMassFlow, xi1: f64) -> anyhow::Result<Chart> {
    let sampling = Sampling { interval: orbit.period / 400.0, t_end: orbit.period };
    let samples = flow.trajectory(&orbit.reversal(), sampling)?.samples;
    let series = |mass: usize, tint| Series {
        label: format!("mass {}", mass + 1),
        points: samples.iter().map(|s| (s.state.positions[mass], s.state.velocities[mass])).collect(),
        style: Style::Line,
        tint,
    };
    Ok(Chart {
        title: format!("Limit cycle at ξ₁ = {xi1}, {}", if orbit.stable() { "stable" } else { "unstable" }),
        x_label: "displacement x".to_owned(),
        y_label: "velocity v".to_owned(),
        series: vec![series(0, Tint::Blue), series(1, Tint::Orange)],
    })
}

/// The orbit at the same xi1 beyond the first fold: the branch is followed until it comes back to this xi1.
fn upper(p: RigParameters) -> anyhow::Result<PeriodicOrbit> {
    let mut branch = lower_branch(p, Heading::Decreasing)?.up_to_amplitude(LARGEST_AMPLITUDE);
    let mut before = branch.next().context("the branch has no points")??;
    for point in branch {
        let point = point?;
        let [x0, x1] = [before.parameters.xi1, point.parameters.xi1];
        if x1 > x0 && (x0..=x1).contains(&p.xi1) {
            let part = (p.xi1 - x0) / (x1 - x0);
            let guess = before.orbit.section + (point.orbit.section - before.orbit.section) * part;
            return Ok(shoot(&exact_flow(p)?, guess)?);
        }
        before = point;
    }
    bail!("no orbit beyond the fold at xi1 = {} up to amplitude {LARGEST_AMPLITUDE}: choose xi1 above the fold", p.xi1)
}
