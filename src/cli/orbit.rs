//! `orbit`: the limit cycle at given parameters, and its multipliers.

use super::Verdict;
use super::analysis::{RigInput, complex, complexes, exact_flow, lower_branch};
use super::common::{Common, Document, print};
use super::plot::PlotArgs;
use crate::dynamics::{Flow, Sampling};
use crate::exact::TwoMassFlow;
use crate::model::RigParameters;
use crate::orbit::{FloquetMultipliers, Heading, Mode, PeriodicOrbit, limit_cycle_of, shoot};
use crate::report::{Chart, Series, Style, Tint};
use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
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
    /// Take the cycle fed by this mode: in-phase (xi1 < 0) or out-of-phase (xi2 < 0). By default the in-phase one where xi1 < 0.
    #[arg(long, value_enum, conflicts_with = "upper")]
    mode: Option<FedBy>,
    #[command(flatten)]
    rig: RigInput,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

/// The mode whose negative damping feeds the cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum FedBy {
    InPhase,
    OutOfPhase,
}

impl FedBy {
    fn mode(self) -> Mode {
        match self {
            Self::InPhase => Mode::InPhase,
            Self::OutOfPhase => Mode::OutOfPhase,
        }
    }

    fn word(self) -> &'static str {
        match self {
            Self::InPhase => "in-phase",
            Self::OutOfPhase => "out-of-phase",
        }
    }

    /// The mode asked for, or the one that is excited; the in-phase one where both or neither are.
    fn of(asked: Option<Self>, p: &RigParameters) -> Self {
        asked.unwrap_or(if p.xi1 >= 0.0 && p.xi2 < 0.0 { Self::OutOfPhase } else { Self::InPhase })
    }

    /// What else there is to look for.
    fn not_searched(self, p: &RigParameters) -> Option<String> {
        let other = if self == Self::InPhase { Self::OutOfPhase } else { Self::InPhase };
        let damping = if other == Self::InPhase { p.xi1 } else { p.xi2 };
        (damping < 0.0).then(|| format!("the {0} mode is excited too: its cycle is --mode {0}", other.word()))
    }
}

pub fn run(args: &OrbitArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("orbit")?;
    args.plot.check(args.common.force)?;
    let p = args.rig.parameters()?;
    let fed_by = FedBy::of(args.mode, &p);
    let orbit = if args.upper { upper(p) } else { Ok(limit_cycle_of(fed_by.mode(), p, exact_flow)?) };
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
        let parameters = json!({
            "xi1": p.xi1, "xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma, "upper": args.upper, "mode": fed_by.word(),
        });
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
            .with("residual", json!(orbit.residual))
            .with("not_searched", json!(fed_by.not_searched(&p)));
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
    if let Some(other) = fed_by.not_searched(&p) {
        print(&other)?;
    }
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
    let reached = before.parameters.xi1;
    let remedy = if reached <= p.xi1 {
        format!("the branch has come back to xi1 = {reached} there, the orbit asked for is larger")
    } else {
        "choose xi1 above the fold".to_owned()
    };
    bail!("no orbit beyond the fold at xi1 = {} up to amplitude {LARGEST_AMPLITUDE}: {remedy}", p.xi1)
}
