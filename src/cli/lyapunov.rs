//! `lyapunov`: the spectrum of exponents with exact tangents.

use super::analysis::{RigInput, beside_the_cycle, exact_flow, window};
use super::common::{Common, Document, print};
use super::{Verdict, case_args::parse_initial};
use crate::chaos::{LyapunovOutcome, LyapunovPlan, lyapunov_spectrum};
use crate::scene::Initial;
use clap::Args;
use serde_json::{Value, json};

/// Lyapunov exponents of the exact motion with exact tangents.
///
/// The direction that slip wipes out (exponent minus infinity) is not listed. Exponents are null where the motion diverges.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip lyapunov --xi1 -0.155 --t-end 20000 --json")]
pub struct LyapunovArgs {
    /// End of the motion.
    #[arg(long, default_value_t = 20_000.0, allow_hyphen_values = true)]
    t_end: f64,
    /// Length of its beginning that is not averaged over.
    #[arg(long, default_value_t = 5000.0, allow_hyphen_values = true)]
    transient: f64,
    /// Which perturbation of the limit cycle the motion starts with.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Start here instead of beside the limit cycle.
    #[arg(long, value_name = "x1,x2,v1,v2,f", allow_hyphen_values = true, value_parser = parse_initial)]
    initial: Option<Initial>,
    #[command(flatten)]
    rig: RigInput,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &LyapunovArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("lyapunov")?;
    let p = args.rig.parameters()?;
    let start = beside_the_cycle(p, args.initial, args.seed)?;
    let plan = LyapunovPlan::new(window(args.transient, args.t_end)?);
    let outcome = lyapunov_spectrum(&exact_flow(p)?, &start, plan)?;
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
        return Ok(Verdict::Done);
    }
    let parameters = json!({
        "xi1": p.xi1, "xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma, "t_end": args.t_end, "transient": args.transient,
        "seed": args.seed, "initial": start,
    });
    let document = Document::new("lyapunov", parameters);
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
