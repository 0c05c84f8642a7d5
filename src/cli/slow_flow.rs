//! `slow-flow`: bifurcations of the slow flow (complexification-averaging) over xi1.

use super::Verdict;
use super::case_args::{RigArgs, check, load};
use super::common::{Common, Document, print};
use super::plot::PlotArgs;
use crate::averaging::{
    EnergyDefinition, EnergyFrequency, Interpolation, NodeSpacing, SlowFlow, SlowHopf, folds, hopf_points,
    period_doublings,
};
use crate::model::RigParameters;
use crate::report::{Chart, Series, Style, Tint};
use anyhow::{Context, ensure};
use clap::{Args, Subcommand, ValueEnum};
use serde_json::{Value, json};
use std::sync::Arc;

/// Amplitude up to which folds are looked for.
const LARGEST_AMPLITUDE: f64 = 30.0;
/// Amplitude up to which the picture shows the branch.
const CHART_AMPLITUDE: f64 = 6.0;
const MOST_DOUBLINGS: usize = 6;

/// Bifurcations of the slow flow over xi1: of its fixed points, which are limit cycles of the rig, and of its limit cycles, which are tori.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  stickslip slow-flow hopf --json\n  \
    stickslip slow-flow doublings --energy equivalent-stiffness\n  stickslip slow-flow fold --gamma 0.7")]
pub struct SlowFlowArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Secondary Hopf points, where a limit cycle becomes a torus.
    Hopf(PointArgs),
    /// Period doublings of the torus born at the first of them (Table 1 of the paper).
    Doublings(DoublingArgs),
    /// Folds of the limit cycles.
    Fold(PointArgs),
}

/// What the averaged energy of the Jenkins spring is, on which the frequency depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Energy {
    /// The mean of the energy stored over a cycle.
    #[default]
    MeanPotential,
    /// That of the equivalent linear spring.
    EquivalentStiffness,
}

impl Energy {
    pub fn definition(self) -> EnergyDefinition {
        match self {
            Self::MeanPotential => EnergyDefinition::MeanPotential,
            Self::EquivalentStiffness => EnergyDefinition::EquivalentStiffness,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Spacing {
    Arclength,
    Amplitude,
    RootEnergy,
    Energy,
}

/// The slow flow of which rig, with which frequency.
#[derive(Debug, Args)]
struct SlowArgs {
    /// Definition of the averaged energy of the Jenkins spring.
    #[arg(long, value_enum, default_value_t)]
    energy: Energy,
    /// Interpolate the frequency over the energy by PCHIP through this many limit cycles, as the paper did through about 400; converged without.
    #[arg(long)]
    nodes: Option<usize>,
    /// How these are spread along the branch.
    #[arg(long, value_enum, requires = "nodes")]
    spacing: Option<Spacing>,
    #[command(flatten)]
    rig: RigArgs,
}

#[derive(Debug, Args)]
struct PointArgs {
    #[command(flatten)]
    slow: SlowArgs,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

#[derive(Debug, Args)]
struct DoublingArgs {
    /// How many, at most 6: each takes twice as long as the one before.
    #[arg(long, default_value_t = 5)]
    count: usize,
    #[command(flatten)]
    slow: SlowArgs,
    #[command(flatten)]
    common: Common,
}

impl SlowArgs {
    fn rig(&self) -> anyhow::Result<RigParameters> {
        ensure!(
            self.rig.xi1.is_none(),
            "--xi1 decides nothing here: bifurcations are looked for over xi1; leave it out"
        );
        let mut scene = load(None)?;
        self.rig.apply(&mut scene)?;
        Ok(check(&scene, None)?.parameters)
    }

    fn interpolation(&self) -> Interpolation {
        let spacing = match self.spacing {
            None | Some(Spacing::Arclength) => NodeSpacing::Arclength,
            Some(Spacing::Amplitude) => NodeSpacing::Amplitude,
            Some(Spacing::RootEnergy) => NodeSpacing::RootEnergy,
            Some(Spacing::Energy) => NodeSpacing::Energy,
        };
        self.nodes.map_or(Interpolation::Converged, |nodes| Interpolation::Pchip { nodes, spacing })
    }

    fn flow(&self) -> anyhow::Result<SlowFlow> {
        let p = self.rig()?;
        let frequency = EnergyFrequency::new(p, self.energy.definition(), self.interpolation())?;
        Ok(SlowFlow::new(p, Arc::new(frequency))?)
    }

    /// xi1 decides nothing here.
    fn parameters(&self) -> anyhow::Result<Value> {
        let p = self.rig()?;
        Ok(json!({
            "xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma,
            "energy": self.energy.definition(), "interpolation": self.interpolation(),
        }))
    }
}

pub fn run(args: &SlowFlowArgs) -> anyhow::Result<Verdict> {
    match &args.what {
        What::Hopf(args) => hopf(args),
        What::Fold(args) => fold(args),
        What::Doublings(args) => doublings(args),
    }
}

/// The document, or its rows as a table.
fn tell(args: &PointArgs, document: &Document, rows: &[Value]) -> anyhow::Result<Verdict> {
    if args.common.json {
        return print(&document.text()?).map(|()| Verdict::Done);
    }
    print("xi1             a1            angular frequency")?;
    let number = |row: &Value, name: &str| row[name].as_f64().unwrap_or(f64::NAN);
    for row in rows {
        let [xi1, a1, frequency] = ["xi1", "a1", "angular_frequency"].map(|name| number(row, name));
        print(&format!("{xi1:<14.10}  {a1:<12.8}  {frequency:.8}"))?;
    }
    Ok(Verdict::Done)
}

fn hopf(args: &PointArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("slow-flow hopf")?;
    args.plot.check(args.common.force)?;
    let flow = args.slow.flow()?;
    let points = hopf_points(&flow)?;
    args.plot.draw(|| branch_chart(&flow, &points))?;
    let rows = |beyond: bool| points.iter().filter(|p| p.beyond_fold == beyond).map(hopf_json).collect::<Vec<_>>();
    let analytic = flow
        .parameters()
        .analytic_hopf()
        .map_or(json!([]), |h| json!([{"xi1": h.start, "side": "start"}, {"xi1": h.end, "side": "end"}]));
    let document = Document::new("slow-flow hopf", args.slow.parameters()?)
        .with("xi1", json!(points.first().map(|p| p.point.xi1)))
        .with("secondary_hopf", json!(rows(false)))
        .with("beyond_fold", json!(rows(true)))
        .with("analytic", analytic);
    tell(args, &document, &[rows(false), rows(true)].concat())
}

fn hopf_json(hopf: &SlowHopf) -> Value {
    let p = &hopf.point;
    json!({
        "xi1": p.xi1, "a1": p.state[0], "a2": p.state[1].hypot(p.state[2]), "angular_frequency": p.angular_frequency,
        "energy": p.energy, "torus_angular_frequency": hopf.slow_angular_frequency,
    })
}

fn fold(args: &PointArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("slow-flow fold")?;
    args.plot.check(args.common.force)?;
    let found = folds(args.slow.rig()?, LARGEST_AMPLITUDE)?;
    args.plot.draw(|| {
        let flow = args.slow.flow()?;
        let points = hopf_points(&flow)?;
        branch_chart(&flow, &points)
    })?;
    let rows: Vec<Value> = found
        .iter()
        .map(|fold| json!({"xi1": fold.cycle.xi1, "a1": fold.cycle.amplitude, "angular_frequency": fold.cycle.angular_frequency}))
        .collect();
    let first = found.first().with_context(|| format!("there is no fold up to a1 = {LARGEST_AMPLITUDE}"))?.cycle;
    let document = Document::new("slow-flow fold", args.slow.parameters()?)
        .with("xi1", json!(first.xi1))
        .with("a1", json!(first.amplitude))
        .with("angular_frequency", json!(first.angular_frequency))
        .with("folds", json!(rows));
    tell(args, &document, &rows)
}

/// The branch of limit cycles over xi1 with its secondary Hopf points.
fn branch_chart(flow: &SlowFlow, points: &[SlowHopf]) -> anyhow::Result<Chart> {
    let branch: Vec<(f64, f64)> = flow
        .frequency()
        .branch()
        .map(|(_, cycle)| (cycle.xi1, cycle.amplitude))
        .take_while(|(_, amplitude)| *amplitude <= CHART_AMPLITUDE)
        .collect();
    let hopf = points.iter().map(|h| (h.point.xi1, h.point.state[0])).filter(|(_, a)| *a <= CHART_AMPLITUDE).collect();
    let series = |label: &str, points, style, tint| Series { label: label.to_owned(), points, style, tint };
    Ok(Chart {
        title: "Limit cycles of the slow flow".to_owned(),
        x_label: "ξ₁".to_owned(),
        y_label: "a₁".to_owned(),
        series: vec![
            series("limit cycle", branch, Style::Line, Tint::Blue),
            series("secondary Hopf", hopf, Style::Markers, Tint::Vermillion),
        ],
    })
}

fn doublings(args: &DoublingArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("slow-flow doublings")?;
    ensure!(
        (1..=MOST_DOUBLINGS).contains(&args.count),
        "--count {} is not allowed: from 1 to {MOST_DOUBLINGS}",
        args.count
    );
    let flow = args.slow.flow()?;
    let points = hopf_points(&flow)?;
    let p = args.slow.rig()?;
    let first = points.iter().find(|point| !point.beyond_fold).with_context(|| {
        let rig = format!("xi2 = {}, kappa = {}, gamma = {}", p.xi2, p.kappa, p.gamma);
        format!("{rig}: there is no secondary Hopf point before the fold, hence no torus that could double")
    })?;
    let found = period_doublings(&flow, first, args.count)?;
    let xi1: Vec<f64> = found.iter().map(|doubling| doubling.torus.xi1).collect();
    let ratio = |i: usize| (i > 0).then(|| Some((xi1[i] - xi1[i - 1]) / (xi1.get(i + 1)? - xi1[i]))).flatten();
    let mut parameters = args.slow.parameters()?;
    parameters["count"] = json!(args.count);
    if args.common.json {
        let rows: Vec<Value> = found
            .iter()
            .enumerate()
            .map(|(i, d)| {
                json!({"i": i + 1, "xi1": d.torus.xi1, "ratio": ratio(i), "period": d.torus.period,
                    "multiplier": d.torus.multipliers()[0].re, "residual": d.torus.residual})
            })
            .collect();
        let document = Document::new("slow-flow doublings", parameters)
            .with("secondary_hopf", hopf_json(first))
            .with("doublings", json!(rows));
        return print(&document.text()?).map(|()| Verdict::Done);
    }
    print("i  xi1            ratio     slow period")?;
    for (i, doubling) in found.iter().enumerate() {
        let ratio = ratio(i).map_or("-".to_owned(), |ratio| format!("{ratio:.4}"));
        print(&format!("{}  {:<13.9}  {ratio:<8}  {:.5}", i + 1, doubling.torus.xi1, doubling.torus.period))?;
    }
    Ok(Verdict::Done)
}
