//! Fig. 9: critical damping of the secondary Hopf bifurcation, equation (31) against the exact limit cycle.
//!
//! (a) normalised: `xi1/xi2` is a function of `nu = pi kappa^2/(gamma xi2)` alone, with a cusp (-6) at nu = 3. (b)-(d): over xi2, kappa
//! and gamma, with exact points from Floquet multipliers and the divergence of motions.

use super::check::Check;
use super::error::PaperError;
use super::exact::{branch_to_fold, divergence, secondary_hopf, values};
use super::item::{Case, Findings, Origin, PaperItem, numbers};
use crate::model::{RigParameter, RigParameters};
use crate::report::{Figure, Mark, Panel, Series, Style, Tint};
use rayon::prelude::*;
use std::f64::consts::PI;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig9",
    origin: Origin::Paper("Fig. 9"),
    title: "critical damping of the secondary Hopf bifurcation",
    caption: "(a) Equation (31), normalised: the limit cycle loses stability on the upper curve (start) and would regain it on the lower one (end); both meet in a cusp at ν = πκ²/(γξ₂) = 3. Exact limit cycles with κ varied at the given γ and ξ₂ stand beside it. \
        (b)–(d) The same over ξ₂, κ and γ: equation (31) (pink) and exact points from Floquet multipliers (black): stability lost (filled), regained (open) and lost again (crosses). Grey: the motion started beside the limit cycle diverges within 6500 time units; \
        an end point inside is never reached by increasing the self-excitation. Exact points are shown up to the fold of the limit cycle: sets without a symbol have no secondary Hopf point before it.",
    revision: 3,
    compute,
};

/// What is varied in panels b, c and d.
const VARIED: [(RigParameter, f64, f64, &str, &str); 3] = [
    (RigParameter::Xi2, 0.001, 0.03, "ξ₂", "(b)"),
    (RigParameter::Kappa, 0.06, 0.25, "κ", "(c)"),
    (RigParameter::Gamma, 0.2, 1.0, "γ", "(d)"),
];
/// Largest self-excitation at which divergence is looked for.
const LOWEST: f64 = -0.5;

/// Critical values at one parameter set.
struct Row {
    varied: f64,
    parameters: RigParameters,
    exact: Vec<f64>,
    divergence: Option<f64>,
}

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let mut panels = vec![];
    let mut findings = Findings::default();
    let mut tables = Vec::new();
    let mut reached = String::new();
    let (mut without, mut sets_in_all) = (0, 0);
    let mut below = BelowCusp::default();
    for (parameter, from, to, symbol, name) in VARIED {
        let sets = values(from, to, case.choose(41, 5));
        let rows: Vec<Result<Row, PaperError>> = sets.par_iter().map(|&value| row(case, parameter, value)).collect();
        let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
        if parameter == RigParameter::Kappa {
            panels.insert(0, normalised(case, &rows));
            tables.push(("normalised", normalised_table(&rows)));
        }
        findings.number(&format!("{name}: spacing of the sets"), format!("{symbol}: {:.4}", sets[1] - sets[0]));
        sets_in_all += rows.len();
        without += rows.iter().filter(|row| row.exact.is_empty()).count();
        rows.iter().for_each(|row| below.take(row));
        for (low, high) in regained(&rows) {
            reached += &format!(" {symbol} from {low:.3} to {high:.3};");
        }
        panels.push(panel(&rows, parameter, (from, to), symbol, name));
        tables.push((parameter.name(), table(parameter, &rows)));
    }
    findings.number("divergence looked for in steps of ξ₁ of", divergence_step(case));
    findings.number("sets without a secondary Hopf point before the fold", format!("{without} of {sets_in_all}"));
    let reached = if reached.is_empty() { "none of the sets" } else { reached.trim_end_matches(';') };
    findings.number("an exact end point is reached before divergence for", reached);
    // The order of the page: what is varied comes first.
    tables.into_iter().for_each(|(name, table)| findings.table(name, table));
    let order = observed_orders(case)?;
    findings.checks = checks(case, &order)?;
    findings.verdict = format!(
        "Equation (31) against the exact limit cycle: the difference shrinks with order {:.2} in ε (leading term: order 2). (31) has no solution below ν = 3; {}.",
        order.last().map_or(f64::NAN, |row| row.order),
        below.words()
    );
    findings.table(
        "order",
        numbers(vec![
            ("epsilon", order.iter().map(|row| row.epsilon).collect()),
            ("xi1_exact", order.iter().map(|row| row.exact).collect()),
            ("xi1_equation_31", order.iter().map(|row| row.analytic).collect()),
            ("observed_order", order.iter().map(|row| row.order).collect()),
        ]),
    );
    findings.figure = Some(Figure::grid(2, (1160, 900), panels));
    Ok(findings)
}

fn exact_points(parameters: RigParameters) -> Result<Vec<f64>, PaperError> {
    let branch = branch_to_fold(parameters)?;
    Ok(secondary_hopf(&branch).iter().map(|point| point.parameters.xi1).collect())
}

/// Exact points where equation (31) has none.
#[derive(Default)]
struct BelowCusp {
    tried: usize,
    /// Of those with a secondary Hopf point, the one with the smallest nu.
    lowest: Option<(f64, RigParameters)>,
}

impl BelowCusp {
    fn take(&mut self, row: &Row) {
        let nu = nu(row.parameters);
        if nu >= 3.0 {
            return;
        }
        self.tried += 1;
        if !row.exact.is_empty() && self.lowest.is_none_or(|(lowest, _)| nu < lowest) {
            self.lowest = Some((nu, row.parameters));
        }
    }

    fn words(&self) -> String {
        match (self.tried, self.lowest) {
            (0, _) => "no set below was tried".to_owned(),
            (tried, None) => format!("nor has the exact cycle a secondary Hopf point before its fold in {tried} sets"),
            (_, Some((nu, p))) => format!(
                "the exact cycle still loses stability there, down to ν = {nu:.1} (ξ₂ = {:.4}, κ = {:.4}, γ = {:.4})",
                p.xi2, p.kappa, p.gamma
            ),
        }
    }
}

/// What equation (31) depends on alone.
fn nu(p: RigParameters) -> f64 {
    PI * p.kappa.powi(2) / (p.gamma * p.xi2)
}

fn divergence_step(case: &Case) -> f64 {
    case.choose(0.0025, 0.01)
}

fn row(case: &Case, parameter: RigParameter, value: f64) -> Result<Row, PaperError> {
    let parameters = case.parameters.with(parameter, value).validated()?;
    Ok(Row {
        varied: value,
        parameters,
        exact: exact_points(parameters)?,
        divergence: divergence(parameters, divergence_step(case), LOWEST)?,
    })
}

/// Ranges of the varied parameter in which the limit cycle regains stability before motions diverge, from first to last row.
fn regained(rows: &[Row]) -> Vec<(f64, f64)> {
    let inside =
        |row: &Row| row.exact.get(1).is_some_and(|end| row.divergence.is_none_or(|divergence| *end > divergence));
    let runs = rows.chunk_by(|a, b| inside(a) == inside(b)).filter(|run| inside(&run[0]));
    runs.map(|run| (run[0].varied, run[run.len() - 1].varied)).collect()
}

/// One row of the test of order.
struct OrderRow {
    epsilon: f64,
    exact: f64,
    analytic: f64,
    /// From the row before.
    order: f64,
}

/// The start point for kappa = e kappa0, xi2 = e^2 xi20, gamma fixed, e halved.
fn observed_orders(case: &Case) -> Result<Vec<OrderRow>, PaperError> {
    let p = case.parameters;
    let mut rows: Vec<OrderRow> = Vec::new();
    for halvings in 0..case.choose(6, 4) {
        let epsilon = 0.5_f64.powi(halvings);
        let at = RigParameters { kappa: epsilon * p.kappa, xi2: epsilon * epsilon * p.xi2, ..p };
        let (Some(analytic), Some(&exact)) = (at.analytic_hopf(), exact_points(at)?.first()) else {
            return Err(PaperError::missing("secondary Hopf point", at));
        };
        let difference = (exact - analytic.start).abs();
        let order = rows.last().map_or(f64::NAN, |last| ((last.exact - last.analytic) / difference).abs().log2());
        rows.push(OrderRow { epsilon, exact, analytic: analytic.start, order });
    }
    Ok(rows)
}

fn checks(case: &Case, orders: &[OrderRow]) -> Result<Vec<Check>, PaperError> {
    let p = case.parameters;
    let at_nu = |nu: f64| RigParameters { kappa: (nu * p.gamma * p.xi2 / PI).sqrt(), ..p };
    let cusp = at_nu(3.0 * (1.0 + 1e-12)).analytic_hopf();
    let ratio = |xi1: Option<f64>| xi1.map_or(f64::NAN, |xi1| xi1 / p.xi2);
    let last = orders.last().map_or(f64::NAN, |row| row.order);
    let nominal = exact_points(RigParameters::default())?;
    let pairs = [(RigParameter::Kappa, 0.074), (RigParameter::Kappa, 0.21), (RigParameter::Gamma, 0.7)];
    let mut checks = vec![
        Check::near(
            "(a) start at ν = 3: ξ₁/ξ₂",
            -6.0,
            ratio(cusp.map(|hopf| hopf.start)),
            1e-4,
            "3 (1 − ν) at ν = 3, met with a square root: 6 √(1e-12) · 2√2/3 · 3 at the point tried, and margin",
        ),
        Check::near(
            "(a) end at ν = 3: ξ₁/ξ₂",
            -6.0,
            ratio(cusp.map(|hopf| hopf.end)),
            1e-4,
            "the two curves meet there",
        ),
        Check::holds(
            "(a) below ν = 3",
            "no solution",
            if at_nu(2.999).analytic_hopf().is_none() { "no solution" } else { "a solution" },
            at_nu(2.999).analytic_hopf().is_none(),
            "the root of (31) is of 1 − 3/ν",
        ),
        Check::at_least(
            "order in ε of the difference between (31) and the exact start",
            2.8,
            last,
            "(31) neglects terms of order ε³ and up, its leading term has order ε²; 0.2 for the next order at the last halving",
        ),
        Check::near(
            "exact start, nominal",
            -0.034_575_371,
            nominal.first().copied().unwrap_or(f64::NAN),
            1e-9,
            "computed outside this project to nine decimal places",
        ),
    ];
    for (parameter, value) in pairs {
        let at = RigParameters::default().with(parameter, value);
        let end = exact_points(at)?.get(1).copied();
        let divergence = divergence(at, 0.0025, LOWEST)?;
        let before = end.is_some_and(|end| divergence.is_none_or(|divergence| end > divergence));
        let found = format!("end {}, divergence {}", number(end), number(divergence));
        checks.push(Check::holds(
            &format!("{} = {value}: stability regained before divergence", parameter.name()),
            "end point nearer to 0 than the divergence",
            found,
            before,
            "the paper's text on Fig. 9 names these sets as reaching it",
        ));
    }
    Ok(checks)
}

fn number(value: Option<f64>) -> String {
    value.map_or("none".to_owned(), |value| format!("{value:.5}"))
}

fn normalised(case: &Case, rows: &[Row]) -> Panel {
    let p = case.parameters;
    let analytic: Vec<_> = values(3.0, 12.0, 400)
        .into_iter()
        .filter_map(|nu| {
            let at = RigParameters { kappa: (nu * p.gamma * p.xi2 / PI).sqrt() * (1.0 + 1e-14), ..p };
            at.analytic_hopf().map(|hopf| (nu, hopf.start / p.xi2, hopf.end / p.xi2))
        })
        .collect();
    let panel = Panel::new("ν = πκ²/(γξ₂)", "ξ₁ / ξ₂")
        .titled("(a)")
        .x_range(2.0, 12.0)
        .y_range(-40.0, 0.0)
        .series(Series::new(
            "equation (31), start",
            analytic.iter().map(|a| (a.0, a.1)).collect(),
            Style::Line,
            Tint::Purple,
        ))
        .series(Series::new(
            "equation (31), end",
            analytic.iter().map(|a| (a.0, a.2)).collect(),
            Style::Dashed,
            Tint::Purple,
        ));
    exact_series(rows, |row, xi1| (nu(row.parameters), xi1 / row.parameters.xi2)).into_iter().fold(panel, Panel::series)
}

/// Secondary Hopf points in the order in which they are met.
fn exact_series(rows: &[Row], place: impl Fn(&Row, f64) -> (f64, f64)) -> Vec<Series> {
    let looks = [("start", Style::Markers), ("end", Style::Rings), ("lost again", Style::Crosses)];
    let series = looks.iter().enumerate().map(|(n, (name, style))| {
        let points = rows.iter().filter_map(|row| row.exact.get(n).map(|xi1| place(row, *xi1))).collect();
        Series::new(&format!("exact limit cycle, {name}"), points, *style, Tint::Black)
    });
    series.filter(|series| !series.points.is_empty()).collect()
}

fn panel(rows: &[Row], parameter: RigParameter, (from, to): (f64, f64), symbol: &str, name: &str) -> Panel {
    let lowest = -0.3;
    let mut outline: Vec<_> = rows.iter().map(|row| (row.varied, row.divergence.unwrap_or(LOWEST))).collect();
    outline.extend([(to, LOWEST), (from, LOWEST)]);
    let base = rows.first().map_or_else(RigParameters::default, |row| row.parameters);
    let analytic = |pick: fn(crate::model::AnalyticHopf) -> f64| {
        let at = |value: f64| base.with(parameter, value).analytic_hopf().map_or(f64::NAN, pick);
        let mut places = values(from, to, 800);
        // The nose lies between two of them: without it the two curves would not meet.
        places.extend(cusp(base, parameter));
        places.sort_by(f64::total_cmp);
        places.into_iter().map(|value| (value, at(value))).collect()
    };
    let panel = Panel::new(symbol, "ξ₁")
        .titled(name)
        .x_range(from, to)
        .y_range(lowest, 0.0)
        .with(Mark::Region { label: "diverges".to_owned(), outline, tint: Tint::Grey })
        .series(Series::new("equation (31), start", analytic(|hopf| hopf.start), Style::Line, Tint::Purple))
        .series(Series::new("equation (31), end", analytic(|hopf| hopf.end), Style::Dashed, Tint::Purple));
    exact_series(rows, |row, xi1| (row.varied, xi1)).into_iter().fold(panel, Panel::series)
}

/// Where nu = 3 when one parameter is varied, on the side of larger nu by less than the width of a line.
fn cusp(p: RigParameters, parameter: RigParameter) -> Option<f64> {
    let inside = 1e-12;
    match parameter {
        RigParameter::Xi2 => Some(PI * p.kappa.powi(2) / (3.0 * p.gamma) * (1.0 - inside)),
        RigParameter::Kappa => Some((3.0 * p.gamma * p.xi2 / PI).sqrt() * (1.0 + inside)),
        RigParameter::Gamma => Some(PI * p.kappa.powi(2) / (3.0 * p.xi2) * (1.0 - inside)),
        // Equation (31) is solved for it.
        RigParameter::Xi1 => None,
    }
}

/// The n-th exact point of each row.
fn nth(rows: &[Row], n: usize) -> Vec<f64> {
    rows.iter().map(|row| row.exact.get(n).copied().unwrap_or(f64::NAN)).collect()
}

fn normalised_table(rows: &[Row]) -> crate::store::Table {
    let over_xi2 =
        |values: Vec<f64>| values.iter().zip(rows).map(|(xi1, row)| xi1 / row.parameters.xi2).collect::<Vec<_>>();
    let analytic = |pick: fn(crate::model::AnalyticHopf) -> f64| {
        over_xi2(rows.iter().map(|row| row.parameters.analytic_hopf().map_or(f64::NAN, pick)).collect())
    };
    numbers(vec![
        ("nu", rows.iter().map(|row| nu(row.parameters)).collect()),
        ("start_equation_31_over_xi2", analytic(|hopf| hopf.start)),
        ("end_equation_31_over_xi2", analytic(|hopf| hopf.end)),
        ("start_exact_over_xi2", over_xi2(nth(rows, 0))),
        ("end_exact_over_xi2", over_xi2(nth(rows, 1))),
        ("lost_again_exact_over_xi2", over_xi2(nth(rows, 2))),
    ])
}

fn table(parameter: RigParameter, rows: &[Row]) -> crate::store::Table {
    let analytic = |pick: fn(crate::model::AnalyticHopf) -> f64| {
        rows.iter().map(|row| row.parameters.analytic_hopf().map_or(f64::NAN, pick)).collect::<Vec<_>>()
    };
    numbers(vec![
        (parameter.name(), rows.iter().map(|row| row.varied).collect()),
        ("start_equation_31", analytic(|hopf| hopf.start)),
        ("end_equation_31", analytic(|hopf| hopf.end)),
        ("start_exact", nth(rows, 0)),
        ("end_exact", nth(rows, 1)),
        ("lost_again_exact", nth(rows, 2)),
        ("divergence", rows.iter().map(|row| row.divergence.unwrap_or(f64::NAN)).collect()),
    ])
}
