//! Fig. 5: largest and smallest amplitude of mass 1 over xi1.
//!
//! The exact motions start beside the limit cycle, as the paper's; the secondary Hopf point comes from the multipliers of the
//! cycle and the divergence from the motions themselves, so that the two can be compared with the dots.

use super::check::Check;
use super::error::PaperError;
use super::exact::{branch, diagram, fold, secondary_hopf, values};
use super::fig1::{branch_series, diverging, steady_series, steady_table};
use super::item::{Case, Findings, Origin, PaperItem};
use crate::chaos::{DiagramRow, MotionClass, divergence_edge};
use crate::orbit::Branch;
use crate::report::{Figure, Panel, Series, Style, Tint};

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig5",
    origin: Origin::Paper("Fig. 5"),
    title: "amplitude diagram",
    caption: "Largest and smallest maximum of |x₁| in the steady motion over ξ₁, for motions of the exact system started on the limit cycle with x₂ moved by 0.001, coloured by the kind of motion. \
        The line is the limit cycle, the marker the secondary Hopf point from its Floquet multipliers. Kinks of the upper edge at ξ₁ = −0.130 and −0.145 are doublings of the torus. \
        Shaded: motions that diverge. Each motion is watched for 3500 time units after it has settled.",
    revision: 1,
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
    let count = case.choose(431, 44);
    let rows = diagram(case, case.parameters, &values(end / (count - 1) as f64, end, count))?;
    let hopf = secondary_hopf(&branch).first().map(|point| (point.parameters.xi1, point.orbit.amplitude()));
    let mut findings = Findings::default();
    findings.checks = checks(case, &rows, hopf.map(|at| at.0), end.abs() / (count - 1) as f64);
    let edge = divergence_edge(&rows);
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
    let shown = |value: Option<f64>| value.map_or("no value".to_owned(), |xi1| format!("{xi1:.5}"));
    findings.verdict = format!(
        "Exact: torus from ξ₁ = {}, chaos from {}, divergence from {}.",
        shown(hopf.map(|at| at.0)),
        shown(first(&rows, MotionClass::Chaos)),
        shown(edge.map(|edge| edge.first_diverged))
    );
    findings.figure = Some(figure(&branch, &rows, hopf, end));
    findings.table("exact", steady_table(&rows));
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
    let mut checks = vec![
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
    ];
    if let Some(hopf) = hopf.filter(|_| first_split(rows).is_some()) {
        checks.push(Check::near(
            "first row with two amplitudes",
            hopf,
            number(first_split(rows)),
            case.choose(3.0, 8.0) * spacing,
            "the torus grows as the square root of the distance, past 1 % of the amplitude within a row; growth next to the point is slow, so up to three rows (quick: shorter motions, eight)",
        ));
    }
    checks
}

fn figure(branch: &Branch, rows: &[DiagramRow], hopf: Option<(f64, f64)>, end: f64) -> Figure {
    let mut panel = Panel::new("damping of the in-phase mode ξ₁", "amplitude a₁, max and min")
        .x_range(end, 0.0)
        .y_range(0.5, AMPLITUDE);
    if let Some(edge) = divergence_edge(rows) {
        panel = panel.with(diverging(edge.first_diverged));
    }
    panel = branch_series(branch).into_iter().fold(panel, Panel::series);
    panel = steady_series(rows).into_iter().fold(panel, Panel::series);
    let at = hopf.into_iter().collect();
    Figure::single(panel.series(Series::new("secondary Hopf (exact)", at, Style::Rings, Tint::Purple)))
}
