//! What the commands of the exact bifurcation analysis share.

use super::case_args::{RigArgs, check, load};
use super::motions;
use crate::chaos::Window;
use crate::dynamics::State;
use crate::exact::TwoMassFlow;
use crate::model::{RigParameter, RigParameters, TwoMassRig};
use crate::orbit::{Bifurcation, Branch, BranchEnd, Heading, OrbitError, PseudoArclength, SpecialPoint, limit_cycle};
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
    /// For commands that find or follow the values of xi1 themselves.
    ///
    /// # Errors
    /// As [`Self::parameters`], and where xi1 is given.
    pub fn parameters_but_xi1(&self, command: &str) -> anyhow::Result<RigParameters> {
        ensure!(
            self.rig.xi1.is_none(),
            "--xi1 has no effect: `{command}` goes through the values of xi1 by itself; leave --xi1 out"
        );
        self.parameters()
    }

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

/// How far a branch was searched: its last orbit, why it ends there, and how close two special points could lie unseen.
pub fn searched(branch: &Branch) -> Value {
    let last = branch.points.last();
    json!({
        "xi1": last.map(|point| point.parameters.xi1),
        "a1": last.map(|point| point.orbit.amplitude()),
        "end": end_of(branch),
        "resolution": branch.resolution,
        "longest_step": longest_step(branch),
        "pairs": pairs(branch),
    })
}

/// [`searched`] as a line of text.
pub fn search_line(branch: &Branch) -> String {
    let Some(last) = branch.points.last() else { return format!("nothing was searched: {}", end_of(branch)) };
    let (xi1, a1) = (last.parameters.xi1, last.orbit.amplitude());
    format!("searched up to xi1 = {xi1:.10}, a1 = {a1:.6}: {}; {}", end_of(branch), pairs(branch))
}

/// How pairs of special points were looked for, and how close an unresolved one could lie.
pub fn pairs(branch: &Branch) -> String {
    let step = longest_step(branch);
    let sought =
        format!("orbits at most {step:.1e} apart in xi1, pairs between them by the extremes of the test functions");
    match branch.resolution {
        0.0 => sought,
        width => format!("{sought}; pairs closer than {width:.1e} could lie unseen where these could not be told"),
    }
}

fn longest_step(branch: &Branch) -> f64 {
    let steps = branch.points.windows(2).map(|pair| (pair[1].parameters.xi1 - pair[0].parameters.xi1).abs());
    steps.fold(0.0, f64::max)
}

/// Why a branch was not followed further, in words.
pub fn end_of(branch: &Branch) -> String {
    match &branch.end {
        BranchEnd::Enough | BranchEnd::Amplitude => "the largest amplitude of the search".to_owned(),
        BranchEnd::Unbounded => "the branch goes to infinity there".to_owned(),
        BranchEnd::Lost { reason } => format!("the branch was lost there: {reason}"),
    }
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

/// Decay exponents after which nothing of the start is left: e^-30 = 1e-13.
const DECAYS: f64 = 30.0;
/// Longest transient that is taken without being asked for: minutes of computing.
const LONGEST_TRANSIENT: f64 = 1e6;

/// The beginning of a motion that is left out, and what is known of how long it takes to settle.
#[derive(Debug, Clone, Copy)]
pub struct Transient {
    pub length: f64,
    /// What the multipliers of the limit cycle say it takes; `None` where there is no cycle, or the motion starts elsewhere.
    pub needed: Option<f64>,
}

impl Transient {
    /// A motion leaves an unstable cycle, and nears a stable one, at the rate of its leading multiplier. The torus that a cycle
    /// next to its secondary Hopf point gives way to attracts about twice as fast. The transient is the one asked for, or what it takes, at least
    /// `shortest`.
    pub fn of(p: RigParameters, asked: Option<f64>, initial: Option<Initial>, shortest: f64) -> Self {
        let beside_the_cycle = !matches!(initial, Some(Initial::State { .. }));
        let orbit = motions::exact_limit_cycle(p).ok().filter(|_| beside_the_cycle);
        let needed = orbit.map(|orbit| {
            let rate = orbit.section_multipliers()[0].norm().ln().abs() * 2.0 / orbit.period;
            DECAYS / rate
        });
        let length = asked.unwrap_or_else(|| needed.unwrap_or(shortest).clamp(shortest, LONGEST_TRANSIENT).ceil());
        Self { length, needed }
    }

    /// Whether the motion has settled after the transient; `None` where nothing is known of it.
    pub fn settled(&self) -> Option<bool> {
        self.needed.map(|needed| self.length >= needed)
    }

    /// A line for people where the motion has not settled, or it is not known whether.
    pub fn remark(&self) -> Option<String> {
        match self.needed {
            Some(needed) if self.length < needed => Some(format!(
                "not settled: by the multipliers of the limit cycle it takes {needed:.0} time units, left out were {}; the numbers and \
                 their errors are those of the beginning",
                self.length
            )),
            None => Some("whether the motion had settled is not known: no limit cycle to judge by".to_owned()),
            _ => None,
        }
    }
}

/// What is looked at of a motion up to `t_end`.
pub fn window(transient: f64, t_end: f64) -> anyhow::Result<Window> {
    ensure!(
        transient >= 0.0 && t_end > transient && t_end <= LONGEST,
        "--transient {transient} and --t-end {t_end} are not allowed: 0 <= transient < t-end <= {LONGEST:e}"
    );
    Ok(Window { transient, length: t_end - transient })
}
