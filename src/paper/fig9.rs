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
    caption: "(a) Equation (31), normalised: the limit cycle loses stability on the upper curve (start) and would regain it on the lower one (end); both meet in a cusp at ν = πκ²/(γξ₂) = 3. Circles: exact limit cycles, with κ varied at the given γ and ξ₂. \
        (b)–(d) The same over ξ₂, κ and γ: equation (31) (pink) and exact points from Floquet multipliers (black). Grey: the motion started beside the limit cycle diverges within 6500 time units; \
        an end point inside is never reached by increasing the self-excitation.",
    revision: 1,
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
    for (parameter, from, to, symbol, name) in VARIED {
        let sets = values(from, to, case.choose(41, 5));
        let rows: Vec<Result<Row, PaperError>> = sets.par_iter().map(|&value| row(case, parameter, value)).collect();
        let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
        if parameter == RigParameter::Kappa {
            panels.insert(0, normalised(case, &rows));
        }
        if let Some((low, high)) = regained(&rows) {
            reached += &format!(" {symbol} from {low:.3} to {high:.3};");
        }
        panels.push(panel(&rows, parameter, (from, to), symbol, name));
        tables.push((parameter.name(), table(parameter, &rows)));
    }
    findings.number("an exact end point is reached before divergence for", reached.trim_end_matches(';'));
    // The order of the page: what is varied comes first.
    tables.into_iter().for_each(|(name, table)| findings.table(name, table));
    findings.checks = checks(case)?;
    let order = observed_orders(case)?;
    findings.verdict = format!(
        "Equation (31) against the exact limit cycle: the difference shrinks with order {:.2} in ε (leading term: order 2); both end points exist only for ν ≥ 3.",
        order.last().map_or(f64::NAN, |row| row.order)
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

fn row(case: &Case, parameter: RigParameter, value: f64) -> Result<Row, PaperError> {
    let parameters = case.parameters.with(parameter, value).validated()?;
    let step = case.choose(0.0025, 0.01);
    Ok(Row {
        varied: value,
        parameters,
        exact: exact_points(parameters)?,
        divergence: divergence(parameters, step, LOWEST)?,
    })
}

/// Range of the varied parameter in which the limit cycle regains stability before motions diverge.
fn regained(rows: &[Row]) -> Option<(f64, f64)> {
    let inside =
        |row: &&Row| row.exact.get(1).is_some_and(|end| row.divergence.is_none_or(|divergence| *end > divergence));
    let found = || rows.iter().filter(inside).map(|row| row.varied);
    found().next().map(|first| (first, found().fold(first, f64::max)))
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

fn checks(case: &Case) -> Result<Vec<Check>, PaperError> {
    let p = case.parameters;
    let at_nu = |nu: f64| RigParameters { kappa: (nu * p.gamma * p.xi2 / PI).sqrt(), ..p };
    let cusp = at_nu(3.0 * (1.0 + 1e-12)).analytic_hopf();
    let ratio = |xi1: Option<f64>| xi1.map_or(f64::NAN, |xi1| xi1 / p.xi2);
    let orders = observed_orders(case)?;
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
    let nu = |row: &Row| PI * row.parameters.kappa.powi(2) / (row.parameters.gamma * row.parameters.xi2);
    let exact =
        rows.iter().flat_map(|row| row.exact.iter().map(move |xi1| (nu(row), xi1 / row.parameters.xi2))).collect();
    Panel::new("ν = πκ²/(γξ₂)", "ξ₁ / ξ₂")
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
        ))
        .series(Series::new("exact limit cycle", exact, Style::Rings, Tint::Black))
}

fn panel(rows: &[Row], parameter: RigParameter, (from, to): (f64, f64), symbol: &str, name: &str) -> Panel {
    let lowest = -0.3;
    let mut outline: Vec<_> = rows.iter().map(|row| (row.varied, row.divergence.unwrap_or(LOWEST))).collect();
    outline.extend([(to, LOWEST), (from, LOWEST)]);
    let base = rows.first().map_or_else(RigParameters::default, |row| row.parameters);
    let analytic = |pick: fn(crate::model::AnalyticHopf) -> f64| {
        let at = |value: f64| base.with(parameter, value).analytic_hopf().map_or(f64::NAN, pick);
        values(from, to, 800).into_iter().map(|value| (value, at(value))).collect()
    };
    let exact = rows.iter().flat_map(|row| row.exact.iter().map(|xi1| (row.varied, *xi1))).collect();
    Panel::new(symbol, "ξ₁")
        .titled(name)
        .x_range(from, to)
        .y_range(lowest, 0.0)
        .with(Mark::Region { label: "diverges".to_owned(), outline, tint: Tint::Grey })
        .series(Series::new("equation (31), start", analytic(|hopf| hopf.start), Style::Line, Tint::Purple))
        .series(Series::new("equation (31), end", analytic(|hopf| hopf.end), Style::Dashed, Tint::Purple))
        .series(Series::new("exact limit cycle", exact, Style::Rings, Tint::Black))
}

fn table(parameter: RigParameter, rows: &[Row]) -> crate::store::Table {
    let analytic = |pick: fn(crate::model::AnalyticHopf) -> f64| {
        rows.iter().map(|row| row.parameters.analytic_hopf().map_or(f64::NAN, pick)).collect::<Vec<_>>()
    };
    let nth = |n: usize| rows.iter().map(|row| row.exact.get(n).copied().unwrap_or(f64::NAN)).collect::<Vec<_>>();
    numbers(vec![
        (parameter.name(), rows.iter().map(|row| row.varied).collect()),
        ("start_equation_31", analytic(|hopf| hopf.start)),
        ("end_equation_31", analytic(|hopf| hopf.end)),
        ("start_exact", nth(0)),
        ("end_exact", nth(1)),
        ("divergence", rows.iter().map(|row| row.divergence.unwrap_or(f64::NAN)).collect()),
    ])
}
