//! Fig. 1: amplitude over damping, drawn from computed data.
//!
//! Limit cycles from the branch (stable and unstable), the fold, and the largest and smallest maximum of the steady motion.

use super::check::Check;
use super::error::PaperError;
use super::exact::{branch, diagram, fold, secondary_hopf, values};
use super::item::{Case, Findings, Origin, PaperItem, numbers, with_words};
use crate::chaos::{DiagramRow, MotionClass, divergence_edge};
use crate::orbit::Branch;
use crate::report::{Figure, Mark, Panel, Series, Side, Style, Tint};

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig1",
    origin: Origin::Paper("Fig. 1"),
    title: "amplitude over damping",
    caption: "Amplitude of mass 1 over the damping ξ₁ of the self-excited mode. Lines: limit cycles, stable (solid) and unstable (dashed), up to the fold and back. \
        Dots: largest and smallest maximum of the steady motion started beside the limit cycle. A: at rest; B: limit cycle; C: torus, then chaos; D: divergence, beyond whose edge \
        nothing bounded was found from these starts. Beyond the fold there is no limit cycle. Each motion is watched for 8000 time units after it has settled. Where the paper sketches, everything here is computed.",
    revision: 3,
    compute,
};

/// Amplitude up to which the branch is drawn: the upper part turns back towards small damping there.
const AMPLITUDE: f64 = 6.0;
/// Kinds of motion with their names and colours.
pub(super) const CLASSES: [(MotionClass, &str, Tint); 3] = [
    (MotionClass::LimitCycle, "limit cycle", Tint::Green),
    (MotionClass::Torus, "torus", Tint::Blue),
    (MotionClass::Chaos, "chaos", Tint::Vermillion),
];

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let branch = branch(case.parameters, AMPLITUDE)?;
    let fold = fold(&branch).ok_or_else(|| PaperError::missing("fold of the limit cycle", case.parameters))?;
    let end = 1.02 * fold.parameters.xi1;
    let rows = diagram(case, case.parameters, &values(end / 400.0, end, case.choose(401, 41)))?;
    let hopf = secondary_hopf(&branch);
    let mut findings = Findings::default();
    findings.checks.push(case.nominal_only(Check::near(
        "fold: xi1",
        -0.215_051_734,
        fold.parameters.xi1,
        1e-9,
        "computed outside this project to nine decimal places; half a unit of the last, and rounding",
    )));
    findings.checks.push(case.nominal_only(Check::near(
        "fold: amplitude",
        2.7628,
        fold.orbit.amplitude(),
        5e-5,
        "known to four decimal places",
    )));
    findings.number("fold", format!("ξ₁ = {:.9}, a₁ = {:.6}", fold.parameters.xi1, fold.orbit.amplitude()));
    for point in &hopf {
        findings.number("secondary Hopf", format!("ξ₁ = {:.9}", point.parameters.xi1));
    }
    if let Some(edge) = divergence_edge(&rows) {
        findings.number("first divergence in the rows", format!("ξ₁ = {:.5}", edge.first_diverged));
    }
    findings.verdict = format!(
        "The limit cycle exists from ξ₁ = 0 to the fold at {:.6}; it is left for a torus at {}.",
        fold.parameters.xi1,
        hopf.first().map_or("no value".to_owned(), |point| format!("{:.6}", point.parameters.xi1))
    );
    findings.figure = Some(figure(&branch, &rows, end));
    findings.table("limit cycles", branch_table(&branch));
    findings.table("steady", steady_table(&rows));
    Ok(findings)
}

fn figure(branch: &Branch, rows: &[DiagramRow], end: f64) -> Figure {
    let mut panel = Panel::new("damping of the in-phase mode ξ₁", "amplitude a₁")
        .x_range(end, -0.08 * end)
        .y_range(-0.25, AMPLITUDE);
    if let Some(edge) = divergence_edge(rows) {
        let middle = 0.5 * (edge.first_diverged + end);
        panel = panel.with(diverging(edge.first_diverged)).text((middle, 0.5), "D", Side::Centre);
    }
    // Dots last, so that stable cycles met by motions are seen on their line.
    panel = branch_series(branch).into_iter().fold(panel, Panel::series);
    panel = steady_series(rows).into_iter().fold(panel, Panel::series);
    let (stable, unstable) = (vec![(0.0, 0.0), (-0.08 * end, 0.0)], vec![(end, 0.0), (0.0, 0.0)]);
    panel = panel.series(Series::new("at rest, stable", stable, Style::Line, Tint::Purple)).series(Series::new(
        "at rest, unstable",
        unstable,
        Style::Dashed,
        Tint::Purple,
    ));
    // Letters stand beside computed points: the middle of each range of the steady motion, and the fold.
    let upper = |class| {
        let of: Vec<_> = rows.iter().filter(|row| row.outcome == class).collect();
        of.get(of.len() / 2).and_then(|row| Some((row.value, row.a1_max?)))
    };
    let letters = [
        ("A", Some((-0.04 * end, 0.0))),
        ("B", upper(MotionClass::LimitCycle)),
        ("C", upper(MotionClass::Torus)),
        ("C", upper(MotionClass::Chaos)),
    ];
    for (letter, at) in letters {
        panel = at.into_iter().fold(panel, |panel, at| panel.text(at, letter, Side::Above));
    }
    if let Some(fold) = fold(branch) {
        let at = (fold.parameters.xi1, fold.orbit.amplitude());
        panel = panel.series(Series::new("fold", vec![at], Style::Markers, Tint::Orange));
    }
    Figure::single(panel)
}

/// Values of xi1 at which motions beside the limit cycle diverge.
pub(super) fn diverging(from: f64) -> Mark {
    Mark::BandX { label: "exact motion diverges".to_owned(), from: None, to: Some(from), tint: Tint::LightGrey }
}

/// Stable and unstable parts; each goes on to the first point of the next, so that the line has no gap.
pub(super) fn branch_series(branch: &Branch) -> Vec<Series> {
    let points = &branch.points;
    let part = |stable: bool| {
        (0..points.len())
            .map(|n| {
                let shown = points[n].orbit.stable() == stable || (n > 0 && points[n - 1].orbit.stable() == stable);
                (points[n].parameters.xi1, if shown { points[n].orbit.amplitude() } else { f64::NAN })
            })
            .collect()
    };
    vec![
        Series::new("limit cycle, stable", part(true), Style::Line, Tint::Black),
        Series::new("limit cycle, unstable", part(false), Style::Dashed, Tint::Black),
    ]
}

/// Largest and smallest maxima by kind of motion.
pub(super) fn steady_series(rows: &[DiagramRow]) -> Vec<Series> {
    let of = |class: MotionClass| {
        let rows = rows.iter().filter(move |row| row.outcome == class);
        rows.flat_map(|row| [row.a1_max, row.a1_min].into_iter().flatten().map(|a1| (row.value, a1)))
            .collect::<Vec<_>>()
    };
    let all = CLASSES
        .iter()
        .map(|(class, name, tint)| Series::new(&format!("{name}, max and min"), of(*class), Style::Dots, *tint));
    all.filter(|series| !series.points.is_empty()).collect()
}

pub(super) fn branch_table(branch: &Branch) -> crate::store::Table {
    let column = |value: fn(&crate::orbit::BranchPoint) -> f64| branch.points.iter().map(value).collect();
    let table = numbers(vec![
        ("xi1", column(|p| p.parameters.xi1)),
        ("a1", column(|p| p.orbit.amplitude())),
        ("angular_frequency", column(|p| p.orbit.angular_frequency())),
    ]);
    let words = branch.points.iter().map(|p| if p.orbit.stable() { "stable" } else { "unstable" }.to_owned());
    with_words(table, "stability", words.collect())
}

pub(super) fn steady_table(rows: &[DiagramRow]) -> crate::store::Table {
    let optional = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let table = numbers(vec![
        ("xi1", rows.iter().map(|row| row.value).collect()),
        ("a1_max", rows.iter().map(|row| optional(row.a1_max)).collect()),
        ("a1_min", rows.iter().map(|row| optional(row.a1_min)).collect()),
        ("life_time", rows.iter().map(|row| optional(row.evidence.life_time)).collect()),
    ]);
    let word = |row: &DiagramRow| serde_json::json!(row.outcome).as_str().unwrap_or_default().to_owned();
    with_words(table, "outcome", rows.iter().map(word).collect())
}
