//! `branch`: the limit cycles over xi1, through the fold.

use super::Verdict;
use super::analysis::{RigInput, exact_flow, lower_branch, search_line, searched, special_json};
use super::common::{Common, Document, print};
use super::plot::PlotArgs;
use crate::orbit::{Branch, BranchEnd, BranchPoint, Heading};
use crate::report::{Chart, Series, Style, Tint};
use anyhow::ensure;
use clap::Args;
use serde_json::{Value, json};

/// The branch of limit cycles over xi1 by pseudo-arclength continuation, through the fold, with its special points.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip branch --from 0 --to -0.25 --json")]
pub struct BranchArgs {
    /// Points of larger xi1 are left out.
    #[arg(long, allow_hyphen_values = true, default_value_t = 0.0)]
    from: f64,
    /// Points of smaller xi1 are left out.
    #[arg(long, allow_hyphen_values = true, default_value_t = -1.0)]
    to: f64,
    /// The branch ends at this amplitude of mass 1.
    #[arg(long, default_value_t = 50.0)]
    amplitude: f64,
    #[command(flatten)]
    rig: RigInput,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &BranchArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("branch")?;
    args.plot.check(args.common.force)?;
    let (from, to) = (args.from.max(args.to), args.from.min(args.to));
    ensure!(
        from > to && from - to <= f64::MAX,
        "--from {} --to {} is no range: give two different numbers",
        args.from,
        args.to
    );
    ensure!(
        args.amplitude > 1.0 && args.amplitude <= 900.0,
        "--amplitude = {} is not allowed: it must be greater than 1 and at most 900",
        args.amplitude
    );
    let p = args.rig.parameters_but_xi1("branch")?;
    let points = lower_branch(p, Heading::Decreasing)?.up_to_amplitude(args.amplitude);
    let branch = Branch::explore(points, |_| false);
    let verdict = if matches!(branch.end, BranchEnd::Lost { .. }) { Verdict::Failed } else { Verdict::Done };
    let inside = |xi1: f64| (to..=from).contains(&xi1);
    let rows: Vec<Value> =
        branch.points.iter().filter(|point| inside(point.parameters.xi1)).map(row).collect::<anyhow::Result<_>>()?;
    let special: Vec<Value> =
        branch.special.iter().filter(|point| inside(point.parameters.xi1)).map(special_json).collect();
    args.plot.draw(|| Ok(chart(&rows, &special)))?;
    if args.common.json {
        let parameters = json!({
            "xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma, "from": from, "to": to, "amplitude": args.amplitude,
        });
        let document =
            Document::new("branch", parameters).with("points", json!(rows)).with("special_points", json!(special));
        print(&document.with("searched", searched(&branch)).text()?)?;
        return Ok(verdict);
    }
    print("xi1              a1               a2               angular_freq     energy           stable")?;
    for row in &rows {
        let n = |key: &str| row[key].as_f64().unwrap_or(f64::NAN);
        let line = ["xi1", "a1", "a2", "angular_frequency", "energy"].map(|key| format!("{:<16.10}", n(key))).join(" ");
        print(&format!("{line} {}", row["stable"]))?;
    }
    for point in &special {
        print(&format!("{} at xi1 = {}, a1 = {}", point["type"], point["xi1"], point["a1"]))?;
    }
    print(&search_line(&branch))?;
    Ok(verdict)
}

pub fn row(point: &BranchPoint) -> anyhow::Result<Value> {
    let measures = point.orbit.measures(&exact_flow(point.parameters)?)?;
    let leading = point.orbit.section_multipliers()[0];
    Ok(json!({
        "xi1": point.parameters.xi1, "a1": measures.amplitude1, "a2": measures.amplitude2,
        "angular_frequency": point.orbit.angular_frequency(), "energy": measures.mean_energy,
        "leading_multiplier": [leading.re, leading.im], "stable": point.orbit.stable(),
    }))
}

/// Amplitude over xi1: stable and unstable parts and the special points.
pub fn chart(rows: &[Value], special: &[Value]) -> Chart {
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    // Each part goes on to the first point of the next, so that the line has no gap.
    let part = |stable: bool| {
        let shown = |n: usize| rows[n]["stable"] == stable || (n > 0 && rows[n - 1]["stable"] == stable);
        let a1 = |n: usize| if shown(n) { number(&rows[n]["a1"]) } else { f64::NAN };
        (0..rows.len()).map(|n| (number(&rows[n]["xi1"]), a1(n))).collect()
    };
    let points = |kind: &str| {
        special.iter().filter(|p| p["type"] == kind).map(|p| (number(&p["xi1"]), number(&p["a1"]))).collect()
    };
    let series = |label: &str, points, style, tint| Series { label: label.to_owned(), points, style, tint };
    Chart {
        title: "Limit cycles over the damping of the in-phase mode".to_owned(),
        x_label: "ξ₁".to_owned(),
        y_label: "amplitude a₁".to_owned(),
        series: vec![
            series("stable", part(true), Style::Line, Tint::Blue),
            series("unstable", part(false), Style::Line, Tint::Orange),
            series("secondary Hopf", points("neimark_sacker"), Style::Markers, Tint::Vermillion),
            series("fold", points("fold"), Style::Markers, Tint::Green),
        ],
    }
}
