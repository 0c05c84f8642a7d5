//! Fig. 10: amplitude diagrams of three parameter sets for which the limit cycle regains stability.

use super::check::Check;
use super::error::PaperError;
use super::exact::{branch, diagram, divergence, fold, secondary_hopf, values};
use super::fig1::{branch_series, branch_table, diverging, steady_series, steady_table};
use super::item::{Case, Findings, Origin, PARAMETERS, PaperItem, numbers, with_words};
use crate::chaos::{DiagramRow, MotionClass, divergence_edge};
use crate::model::{RigParameter, RigParameters};
use crate::orbit::Branch;
use crate::report::{Figure, Panel, Series, Style, Tint};
use crate::store::Table;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig10",
    origin: Origin::Paper("Fig. 10"),
    title: "limit cycles that regain stability",
    caption: "Amplitude diagrams for (a) κ = 0.074, (b) κ = 0.21, (c) γ = 0.7, the other parameters as above. Lines: limit cycles, stable (solid) and unstable (dashed). Dots: largest and smallest maximum of the steady motion started beside the limit cycle. \
        Circles: both secondary Hopf points from Floquet multipliers; crosses: equation (31), put on the branch; what lies outside a panel is among the numbers. Between the points the motion is a torus; beyond the second the limit cycle attracts again. \
        Each motion is watched for 8000 time units after it has settled; shaded: it diverges before that is over. Each panel ends a little beyond the first divergence.",
    revision: 3,
    compute,
};

const SETS: [(RigParameter, f64, &str); 3] = [
    (RigParameter::Kappa, 0.074, "(a) κ = 0.074"),
    (RigParameter::Kappa, 0.21, "(b) κ = 0.21"),
    (RigParameter::Gamma, 0.7, "(c) γ = 0.7"),
];
const AMPLITUDE: f64 = 4.0;
/// Largest self-excitation at which divergence is looked for.
const LOWEST: f64 = -0.5;
/// How far the panels go, relative to the first divergence.
const BEYOND: f64 = 1.05;

/// Secondary Hopf points of a set by either method, with the amplitude where there is one.
struct Points {
    parameters: RigParameters,
    method: &'static str,
    points: Vec<(f64, f64)>,
}

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let mut findings = Findings::default();
    let (mut panels, mut words) = (Vec::new(), Vec::new());
    let (mut points, mut tables) = (Vec::new(), Vec::new());
    for (parameter, value, name) in SETS {
        let parameters = case.parameters.with(parameter, value).validated()?;
        let branch = branch(parameters, AMPLITUDE)?;
        let hopf: Vec<_> = secondary_hopf(&branch).iter().map(|p| (p.parameters.xi1, p.orbit.amplitude())).collect();
        let diverged = divergence(parameters, case.choose(0.0025, 0.01), LOWEST)?;
        let end = diverged.map_or(1.5 * hopf.last().map_or(-0.1, |point| point.0), |xi1| BEYOND * xi1);
        let count = case.choose(201, 41);
        let rows = diagram(case, parameters, &values(end / (count - 1) as f64, end, count))?;
        let fold = fold(&branch).map(|fold| (fold.parameters.xi1, fold.orbit.amplitude()));
        findings.checks.extend(checks(case, name, &hopf, &rows, fold.map_or(f64::NEG_INFINITY, |fold| fold.0)));
        describe(&mut findings, name, parameters, &hopf, fold, &rows);
        words.push(format!("{name}: {}", hopf.len()));
        let set = format!("{}{value}", parameter.name());
        tables.push((set.clone(), parameters, steady_table(&rows)));
        tables.push((format!("{set}-branch"), parameters, branch_table(&branch)));
        panels.push(panel(name, parameters, &branch, &rows, &hopf, end));
        points.push(Points { parameters, method: "exact", points: hopf });
        let analytic = parameters.analytic_hopf().map(|hopf| [hopf.start, hopf.end]);
        let analytic = analytic.into_iter().flatten().map(|xi1| (xi1, f64::NAN)).collect();
        points.push(Points { parameters, method: "equation_31", points: analytic });
    }
    findings.table("secondary Hopf points", hopf_table(&points));
    tables.into_iter().for_each(|(name, parameters, table)| findings.table_at(&name, parameters, table));
    findings.verdict = format!("Secondary Hopf points before the fold: {}.", words.join("; "));
    findings.figure = Some(Figure::grid(3, (1260, 560), panels));
    Ok(findings)
}

fn describe(
    findings: &mut Findings,
    name: &str,
    parameters: RigParameters,
    hopf: &[(f64, f64)],
    fold: Option<(f64, f64)>,
    rows: &[DiagramRow],
) {
    let shown: Vec<_> = hopf.iter().map(|point| format!("{:.9}", point.0)).collect();
    findings.number(&format!("{name}: secondary Hopf points, exact"), shown.join(", "));
    let analytic = parameters.analytic_hopf();
    let shown = analytic.map_or("none".to_owned(), |hopf| format!("{:.6}, {:.6}", hopf.start, hopf.end));
    findings.number(&format!("{name}: equation (31)"), shown);
    let shown = fold.map_or("none".to_owned(), |(xi1, a1)| format!("ξ₁ = {xi1:.6}, a₁ = {a1:.4}"));
    findings.number(&format!("{name}: first fold up to a₁ = {AMPLITUDE}"), shown);
    let edge = divergence_edge(rows);
    let shown = edge.map_or("none".to_owned(), |edge| format!("ξ₁ = {:.4}", edge.first_diverged));
    findings.number(&format!("{name}: first divergence in the rows"), shown);
}

fn hopf_table(points: &[Points]) -> Table {
    let all = || points.iter().flat_map(|set| set.points.iter().map(move |point| (set, *point)));
    let parameter = |value: fn(RigParameters) -> f64| all().map(|(set, _)| value(set.parameters)).collect();
    let mut table = numbers(vec![
        ("xi2", parameter(|p| p.xi2)),
        ("kappa", parameter(|p| p.kappa)),
        ("gamma", parameter(|p| p.gamma)),
        ("xi1", all().map(|(_, point)| point.0).collect()),
        ("a1", all().map(|(_, point)| point.1).collect()),
    ]);
    table.metadata.push((PARAMETERS.to_owned(), "as in the columns".to_owned()));
    with_words(table, "method", all().map(|(set, _)| set.method.to_owned()).collect())
}

fn checks(case: &Case, name: &str, hopf: &[(f64, f64)], rows: &[DiagramRow], fold: f64) -> Vec<Check> {
    let count = Check::near(
        &format!("{name}: secondary Hopf points"),
        2.0,
        hopf.len() as f64,
        0.0,
        "the paper shows stability lost and regained",
    );
    let [start, end] = [0, 1].map(|n| hopf.get(n).map_or(f64::NAN, |point| point.0));
    // Within a tenth of the gap from either point motions settle too slowly to be told.
    let gap = 0.1 * (start - end);
    let share = |inside: &dyn Fn(f64) -> bool, class: MotionClass| {
        let of: Vec<_> = rows.iter().filter(|row| inside(row.value)).collect();
        of.iter().filter(|row| row.outcome == class).count() as f64 / of.len() as f64
    };
    let reason = "Floquet multipliers decide: nearly every motion; a twentieth is left to motions that settle too slowly to be told (a tenth of the range at either point is left out)";
    let between = share(&|xi1| xi1 < start - gap && xi1 > end + gap, MotionClass::Torus);
    let before = share(&|xi1| xi1 > start + gap, MotionClass::LimitCycle);
    // There is no limit cycle beyond the fold.
    let beyond = share(&|xi1| xi1 < end - gap && xi1 > fold, MotionClass::LimitCycle);
    vec![
        case.nominal_only(count),
        case.nominal_only(Check::at_least(
            &format!("{name}: share of limit cycles before the first point"),
            0.95,
            before,
            reason,
        )),
        case.nominal_only(Check::at_least(&format!("{name}: share of tori between the points"), 0.95, between, reason)),
        case.nominal_only(Check::at_least(
            &format!("{name}: share of limit cycles beyond the second point"),
            0.95,
            beyond,
            reason,
        )),
    ]
}

fn panel(
    name: &str,
    parameters: RigParameters,
    branch: &Branch,
    rows: &[DiagramRow],
    hopf: &[(f64, f64)],
    end: f64,
) -> Panel {
    let top = rows.iter().filter_map(|row| row.a1_max).fold(1.0, f64::max);
    let mut panel =
        Panel::new("ξ₁", "a₁, max and min").titled(name).x_range(end, 0.0).y_range(0.8, (1.08 * top).min(AMPLITUDE));
    if let Some(edge) = divergence_edge(rows) {
        panel = panel.with(diverging(edge.first_diverged));
    }
    // Dots last, so that stable cycles met by motions are seen on their line.
    panel = branch_series(branch).into_iter().fold(panel, Panel::series);
    panel = steady_series(rows).into_iter().fold(panel, Panel::series);
    // Equation (31) has no amplitude: its points are put on the branch.
    let on_branch = |xi1: f64| {
        branch.points.windows(2).find_map(|pair| {
            let [a, b] = [0, 1].map(|n| (pair[n].parameters.xi1, pair[n].orbit.amplitude()));
            let share = (xi1 - a.0) / (b.0 - a.0);
            (0.0..=1.0).contains(&share).then_some((xi1, a.1 + share * (b.1 - a.1)))
        })
    };
    let analytic = parameters.analytic_hopf().map(|hopf| [hopf.start, hopf.end]);
    let analytic = analytic.into_iter().flatten().filter_map(on_branch).collect();
    panel.series(Series::new("secondary Hopf, exact", hopf.to_vec(), Style::Rings, Tint::Black)).series(Series::new(
        "equation (31)",
        analytic,
        Style::Crosses,
        Tint::Purple,
    ))
}
