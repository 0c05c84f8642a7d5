//! Fig. 5: largest and smallest amplitude of mass 1 over xi1.
//!
//! The exact motions start beside the limit cycle, as the paper's; the secondary Hopf point comes from the multipliers of the
//! cycle and the divergence from the motions themselves, so that the two can be compared with the dots.

use super::check::Check;
use super::error::PaperError;
use super::exact::{branch, diagram, fold, secondary_hopf, values};
use super::fig1::{branch_series, diverging, steady_series, steady_table};
use super::item::{Case, Findings, Origin, PaperItem};
use super::slow;
use crate::averaging::SlowFlow;
use crate::chaos::{DiagramRow, MotionClass, divergence_edge};
use crate::orbit::Branch;
use crate::report::{Figure, Panel, Series, Style, Tint};

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig5",
    origin: Origin::Paper("Fig. 5"),
    title: "amplitude diagram",
    caption: "Largest and smallest maximum of |x₁| in the steady motion over ξ₁, for motions of the exact system started on the limit cycle with x₂ moved by 0.001, coloured by the kind of motion. \
        Small black dots: the same from the slow flow, started beside its own limit cycle. The line is the exact limit cycle, the circle its secondary Hopf point from Floquet multipliers, the cross that of the slow flow from eigenvalues. Kinks of the upper edge are doublings of the torus. \
        Shaded: exact motions diverge; dotted: the first slow flow that does. Each exact motion is watched for 8000 time units after it has settled, each slow flow for 3500.",
    revision: 4,
    compute,
};

/// Amplitudes shown.
const AMPLITUDE: f64 = 4.0;
/// Largest spread of the amplitude, relative, that still counts as constant.
const CONSTANT: f64 = 0.01;

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let branch = branch(case.parameters, AMPLITUDE)?;
    let fold = fold(&branch).ok_or_else(|| PaperError::missing("fold of the limit cycle", case.parameters))?;
    let end = 0.8 * fold.parameters.xi1;
    let count = case.choose(431, 87);
    let rows = diagram(case, case.parameters, &values(end / (count - 1) as f64, end, count))?;
    let hopf = secondary_hopf(&branch).first().map(|point| (point.parameters.xi1, point.orbit.amplitude()));
    let checks = checks(case, &rows, hopf.map(|at| at.0), end.abs() / (count - 1) as f64);
    let mut findings = Findings { checks, ..Findings::default() };
    let edge = divergence_edge(&rows);
    let slow = Slow::compute(case, end)?;
    slow.describe(case, &mut findings, end);
    if let Some((xi1, _)) = hopf {
        findings.number("secondary Hopf, exact", format!("ξ₁ = {xi1:.9}"));
    }
    if let Some(chaos) = first(&rows, MotionClass::Chaos) {
        findings.number("first chaos", format!("ξ₁ = {chaos:.5}"));
    }
    if let Some(edge) = edge {
        let last = edge.last_bounded.map_or("none".to_owned(), |xi1| format!("{xi1:.5}"));
        findings.number("first divergence", format!("ξ₁ = {:.5} (last bounded motion: {last})", edge.first_diverged));
    }
    // Chaos and divergence are known to the spacing of the rows only.
    let about = |value: Option<f64>| value.map_or("no value".to_owned(), |xi1| format!("about {xi1:.3}"));
    findings.verdict = format!(
        "Exact: torus from ξ₁ = {}, chaos from {}, divergence from {} (rows {:.4} apart).",
        hopf.map_or("no value".to_owned(), |at| format!("{:.5}", at.0)),
        about(first(&rows, MotionClass::Chaos)),
        about(edge.map(|edge| edge.first_diverged)),
        end.abs() / (count - 1) as f64
    );
    findings.figure = Some(figure(&branch, &rows, hopf, &slow, end));
    findings.table("exact", steady_table(&rows));
    findings.table("slow", steady_table(&slow.rows));
    Ok(findings)
}

fn first(rows: &[DiagramRow], class: MotionClass) -> Option<f64> {
    rows.iter().find(|row| row.outcome == class).map(|row| row.value)
}

/// First value at which the amplitude is not constant.
fn first_split(rows: &[DiagramRow]) -> Option<f64> {
    let split = |row: &&DiagramRow| row.a1_max.zip(row.a1_min).is_some_and(|(max, min)| max - min > CONSTANT * max);
    rows.iter().find(split).map(|row| row.value)
}

fn checks(case: &Case, rows: &[DiagramRow], hopf: Option<f64>, spacing: f64) -> Vec<Check> {
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let edge = divergence_edge(rows).map(|edge| edge.first_diverged);
    vec![
        case.nominal_only(Check::near(
            "secondary Hopf of the exact limit cycle",
            -0.034_575_371,
            number(hopf),
            1e-9,
            "computed outside this project to nine decimal places",
        )),
        case.nominal_only(Check::near(
            "first divergence",
            -0.165,
            number(edge),
            0.003_f64.max(spacing),
            "known as “about −0.165”: three digits, and chaotic transients end at random times near the edge; or the spacing of the rows if wider",
        )),
        case.nominal_only(Check::near(
            "first chaos",
            -0.15,
            number(first(rows, MotionClass::Chaos)),
            0.005_f64.max(spacing),
            "the paper's footnote 2, “≈ −0.15”: half a unit of its last digit; or the spacing of the rows if wider",
        )),
        split_check(case, rows, hopf, spacing),
    ]
}

/// The diagram must split where the multipliers say so; it cannot where motions diverge before, or the point lies beyond the rows.
fn split_check(case: &Case, rows: &[DiagramRow], hopf: Option<f64>, spacing: f64) -> Check {
    let name = "first row with two amplitudes";
    let last = rows.iter().take_while(|row| row.a1_max.is_some()).last().map_or(f64::INFINITY, |row| row.value);
    match hopf {
        Some(hopf) if last < hopf - 3.0 * spacing => Check::near(
            name,
            hopf,
            first_split(rows).unwrap_or(f64::NAN),
            3.0 * spacing,
            "the torus grows as the square root of the distance, past 1 % of the amplitude within a row; growth next to the point is slow, so up to three rows",
        ),
        _ => case.nominal_only(Check::holds(
            name,
            "beside the secondary Hopf point",
            "no secondary Hopf point among bounded motions",
            false,
            "the limit cycle loses stability to a torus",
        )),
    }
}

/// The same of the slow flow.
struct Slow {
    rows: Vec<DiagramRow>,
    hopf: (f64, f64),
}

impl Slow {
    fn compute(case: &Case, end: f64) -> Result<Self, PaperError> {
        let rows = slow::diagram(case, end, case.choose(341, 34))?;
        let flow = SlowFlow::new(case.parameters, slow::frequency(case.parameters)?)?;
        let point = slow::first_hopf(&flow)?.point;
        Ok(Self { rows, hopf: (point.xi1, point.state[0]) })
    }

    fn describe(&self, case: &Case, findings: &mut Findings, end: f64) {
        let spacing = end.abs() / self.rows.len() as f64;
        let edge = divergence_edge(&self.rows).map(|edge| edge.first_diverged);
        findings.number("secondary Hopf, slow flow", format!("ξ₁ = {:.9}", self.hopf.0));
        let shown = |value: Option<f64>| value.map_or("none".to_owned(), |xi1| format!("ξ₁ = {xi1:.5}"));
        let paper = if case.is_nominal() { " (the paper's slow flow: −0.1335)" } else { "" };
        let chaos = shown(first(&self.rows, MotionClass::Chaos));
        findings.number("first chaos, slow flow", format!("{chaos}, rows {spacing:.4} apart{paper}"));
        findings.number("first divergence, slow flow", shown(edge));
        findings.checks.extend([
            case.nominal_only(Check::near(
                "secondary Hopf of the slow flow",
                -0.035_002_1,
                self.hopf.0,
                1e-6,
                "computed outside this project to seven decimal places",
            )),
            case.nominal_only(Check::near(
                "first divergence of the slow flow",
                -0.1635,
                edge.unwrap_or(f64::NAN),
                0.005_f64.max(2.0 * spacing),
                "known as “about −0.1635, the edge is not sharp”: chaotic transients end at random times; or two rows if wider",
            )),
        ]);
    }
}

fn figure(branch: &Branch, rows: &[DiagramRow], hopf: Option<(f64, f64)>, slow: &Slow, end: f64) -> Figure {
    let mut panel = Panel::new("damping of the in-phase mode ξ₁", "amplitude a₁, max and min")
        .x_range(end, 0.0)
        .y_range(0.5, AMPLITUDE);
    if let Some(edge) = divergence_edge(rows) {
        panel = panel.with(diverging(edge.first_diverged));
    }
    if let Some(edge) = divergence_edge(&slow.rows) {
        let line = vec![(edge.first_diverged, 0.5), (edge.first_diverged, AMPLITUDE)];
        panel = panel.series(Series::new("slow flow, first divergence", line, Style::Dotted, Tint::Purple));
    }
    // Dots last, so that stable cycles met by motions are seen on their line.
    panel = branch_series(branch).into_iter().fold(panel, Panel::series);
    panel = steady_series(rows).into_iter().fold(panel, Panel::series);
    let pairs =
        slow.rows.iter().flat_map(|row| [row.a1_max, row.a1_min].into_iter().flatten().map(|a1| (row.value, a1)));
    panel = panel
        .series(Series::new("slow flow, max and min", pairs.collect(), Style::Cloud, Tint::Black))
        .series(Series::new("secondary Hopf (slow flow)", vec![slow.hopf], Style::Crosses, Tint::Purple));
    let at = hopf.into_iter().collect();
    Figure::single(panel.series(Series::new("secondary Hopf (exact)", at, Style::Rings, Tint::Purple)))
}
