//! `lyapunov`: the spectrum of exponents with exact tangents.

use super::analysis::{RigInput, Transient, beside_the_cycle, exact_flow, window};
use super::common::{Common, Document, print};
use super::plot::PlotArgs;
use super::{Verdict, case_args::parse_initial};
use crate::chaos::{LyapunovOutcome, LyapunovPlan, lyapunov_spectrum};
use crate::report::{Chart, Series, Style, Tint};
use crate::scene::Initial;
use anyhow::Context;
use clap::Args;
use serde_json::{Value, json};

const SHORTEST_TRANSIENT: f64 = 5000.0;
/// Time averaged over unless told otherwise.
const AVERAGED: f64 = 15_000.0;

/// Lyapunov exponents of the exact motion with exact tangents.
///
/// The direction that slip wipes out (exponent minus infinity) is not listed. Exponents are null where the motion diverges.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip lyapunov --xi1 -0.155 --t-end 20000 --json")]
pub struct LyapunovArgs {
    /// End of the motion; 15000 time units after the transient by default.
    #[arg(long, allow_hyphen_values = true)]
    t_end: Option<f64>,
    /// Length of its beginning that is not averaged over; by default what the multipliers of the limit cycle say it takes to settle, at least 5000.
    #[arg(long, allow_hyphen_values = true)]
    transient: Option<f64>,
    /// Which perturbation of the limit cycle the motion starts with.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Start here instead of beside the limit cycle.
    #[arg(long, value_name = "x1,x2,v1,v2,f", allow_hyphen_values = true, value_parser = parse_initial)]
    initial: Option<Initial>,
    #[command(flatten)]
    rig: RigInput,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &LyapunovArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("lyapunov")?;
    args.plot.check(args.common.force)?;
    let p = args.rig.parameters()?;
    let start = beside_the_cycle(p, args.initial, args.seed)?;
    let transient = Transient::of(p, args.transient, args.initial, SHORTEST_TRANSIENT);
    let t_end = args.t_end.unwrap_or(transient.length + AVERAGED);
    let plan = LyapunovPlan::new(window(transient.length, t_end)?);
    let outcome = lyapunov_spectrum(&exact_flow(p)?, &start, plan)
        .with_context(|| format!("from --transient {} to --t-end {t_end}", transient.length))?;
    args.plot.draw(|| convergence(&outcome, p.xi1))?;
    if !args.common.json {
        print(&match &outcome {
            LyapunovOutcome::Diverged { time, .. } => format!("diverged at t = {time}: no exponents"),
            LyapunovOutcome::Bounded(s) => s
                .exponents
                .iter()
                .zip(&s.standard_errors)
                .map(|(exponent, error)| format!("{exponent:+.6} +- {error:.1e}"))
                .collect::<Vec<_>>()
                .join("\n"),
        })?;
        transient.remark().map_or(Ok(()), |remark| print(&remark))?;
        return Ok(Verdict::Done);
    }
    let parameters = json!({
        "xi1": p.xi1, "xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma, "t_end": t_end,
        "transient": transient.length,
        "seed": args.seed, "initial": start,
    });
    let document = Document::new("lyapunov", parameters)
        .with("settled", json!(transient.settled()))
        .with("settling_time", json!(transient.needed));
    let document = match outcome {
        LyapunovOutcome::Diverged { time, .. } => document
            .with("exponents", Value::Null)
            .with("convergence", json!([]))
            .with("diverged", json!(true))
            .with("diverged_at", json!(time)),
        LyapunovOutcome::Bounded(s) => document
            .with("exponents", json!(s.exponents))
            .with("standard_errors", json!(s.standard_errors))
            .with("vanished_directions", json!(s.vanished))
            .with("convergence", json!(s.convergence))
            .with("diverged", json!(false)),
    };
    print(&document.text()?)?;
    Ok(Verdict::Done)
}

/// Averages over the motion so far.
fn convergence(outcome: &LyapunovOutcome, xi1: f64) -> anyhow::Result<Chart> {
    let spectrum = outcome.spectrum().context("the motion diverged: there are no exponents to draw")?;
    let tints = [Tint::Blue, Tint::Orange, Tint::Green, Tint::Vermillion, Tint::Purple];
    let series = (0..spectrum.exponents.len()).zip(tints.into_iter().cycle()).map(|(i, tint)| Series {
        label: format!("λ{} = {:.5} ± {:.1e}", i + 1, spectrum.exponents[i], spectrum.standard_errors[i]),
        points: spectrum.convergence.iter().filter_map(|c| Some((c.t, *c.exponents.get(i)?))).collect(),
        style: Style::Line,
        tint,
    });
    Ok(Chart {
        title: format!("Lyapunov exponents at ξ₁ = {xi1}"),
        x_label: "averaging time".to_owned(),
        y_label: "exponent".to_owned(),
        series: series.collect(),
    })
}
