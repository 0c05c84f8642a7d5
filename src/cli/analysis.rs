//! What the commands of the exact bifurcation analysis share.

use super::case_args::{RigArgs, check, load};
use super::motions;
use crate::chaos::Window;
use crate::dynamics::State;
use crate::exact::TwoMassFlow;
use crate::model::{RigParameter, RigParameters, TwoMassRig};
use crate::orbit::{Bifurcation, Heading, OrbitError, PseudoArclength, SpecialPoint, limit_cycle};
use crate::scene::Initial;
use anyhow::{Context, ensure};
use clap::Args;
use nalgebra::Complex;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Longest motion that is averaged over: minutes of computing.
const LONGEST: f64 = 1e8;

/// Which rig.
#[derive(Debug, Args)]
pub struct RigInput {
    /// Take the rig of this scene.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    rig: RigArgs,
}

impl RigInput {
    pub fn parameters(&self) -> anyhow::Result<RigParameters> {
        let mut scene = load(self.scene.as_deref())?;
        self.rig.apply(&mut scene)?;
        Ok(check(&scene, self.scene.as_deref())?.parameters)
    }
}

pub fn exact_flow(parameters: RigParameters) -> Result<TwoMassFlow, OrbitError> {
    Ok(TwoMassFlow::new(&TwoMassRig::new(parameters)?))
}

type FlowAt = fn(RigParameters) -> Result<TwoMassFlow, OrbitError>;

/// Where the branch starts: the cycle has amplitude 1.007 at most there, and it lies before the secondary Hopf point, which scales as kappa^2.
fn branch_start(p: RigParameters) -> RigParameters {
    RigParameters { xi1: -(0.001 * p.gamma).min(0.05 * p.kappa * p.kappa), ..p }
}

/// The branch of limit cycles over xi1 from near a1 = 1, of which the other parameters are given.
pub fn lower_branch(p: RigParameters, heading: Heading) -> anyhow::Result<PseudoArclength<FlowAt>> {
    ensure!(p.kappa > 0.0, "kappa = {} is not allowed: the branch of limit cycles needs kappa > 0", p.kappa);
    let start = branch_start(p);
    let orbit = limit_cycle(start, exact_flow)?;
    Ok(PseudoArclength::new(exact_flow as FlowAt, start, &orbit, RigParameter::Xi1, heading)?)
}

pub fn complexes(values: &[Complex<f64>]) -> Value {
    json!(values.iter().map(|value| [value.re, value.im]).collect::<Vec<_>>())
}

/// `0.977968 + 0.248221 i`
pub fn complex(value: Complex<f64>) -> String {
    if value.im == 0.0 {
        return format!("{:.6}", value.re);
    }
    format!("{:.6} {} {:.6} i", value.re, if value.im < 0.0 { "-" } else { "+" }, value.im.abs())
}

/// The field `special_points` of a branch.
pub fn special_json(point: &SpecialPoint) -> Value {
    let kind = match point.kind {
        Bifurcation::Fold => "fold",
        Bifurcation::NeimarkSacker => "neimark_sacker",
        Bifurcation::PeriodDoubling => "period_doubling",
        Bifurcation::BranchPoint => "branch_point",
    };
    json!({"type": kind, "xi1": point.parameters.xi1, "a1": point.orbit.amplitude()})
}

/// The state given, or the limit cycle with a small perturbation of x2: 0.001 for seed 0, otherwise between -0.002 and 0.002 by the seed.
pub fn beside_the_cycle(p: RigParameters, initial: Option<Initial>, seed: u64) -> anyhow::Result<State> {
    if let Some(Initial::State { state }) = initial {
        let rig = TwoMassRig::new(p)?;
        return Ok(State::two_mass(state).validated(rig.chain())?);
    }
    let orbit = motions::exact_limit_cycle(p)
        .context("the motion was to start beside the limit cycle; give --initial instead")?;
    let mut state = orbit.reversal();
    // Multiples of the golden ratio modulo 1 are spread evenly over the seeds.
    let spread = (seed as f64 * 0.618_033_988_749_894_8).fract();
    state.positions[1] += if seed == 0 { 0.001 } else { 0.004 * (spread - 0.5) };
    Ok(state)
}

/// What is looked at of a motion up to `t_end`.
pub fn window(transient: f64, t_end: f64) -> anyhow::Result<Window> {
    ensure!(
        transient >= 0.0 && t_end > transient && t_end <= LONGEST,
        "--transient {transient} and --t-end {t_end} are not allowed: 0 <= transient < t-end <= {LONGEST:e}"
    );
    Ok(Window { transient, length: t_end - transient })
}
