//! Errors over steps on logarithmic axes, with slope triangles and the floors of rounding.

use crate::conformance::experiment::is_notable;
use crate::conformance::{Configuration, Report, Row};
use crate::engine::{Joints, Precision, Scheme};
use crate::report::{Figure, Mark, Panel, Series, Style, Tint};

/// Floors lower than this part of the smallest error are not drawn.
const NEAR_THE_FLOOR: f64 = 0.01;

/// `error of damping`; `state error` says so itself.
pub(super) fn axis_label(quantity: &str) -> String {
    let words = quantity.replace('_', " ");
    if words.ends_with("error") || words.ends_with("residual") { words } else { format!("error of {words}") }
}

/// Errors of one quantity of a scenario over the step; none without two points to draw.
pub(super) fn errors(report: &Report, scenario: &str, variant: &str, quantity: &str) -> Option<Figure> {
    let wanted = |row: &&Row| row.scenario == scenario && row.variant == variant && row.quantity == quantity;
    let rows: Vec<&Row> = report.rows.iter().filter(wanted).filter(|row| is_notable(row.configuration)).collect();
    let mut panel = Panel::new("step h", &axis_label(quantity)).log_x().log_y();
    let mut all = Vec::new();
    for configuration in configurations(&rows) {
        let points: Vec<(f64, f64)> = points(&rows, configuration, |row| row.deviation);
        if points.len() < 2 {
            continue;
        }
        let (style, tint) = look(configuration);
        all.extend(points.iter().copied());
        panel = panel.series(Series::new(&configuration.label(), points.clone(), style, tint));
        panel = panel.series(Series::new("", points, Style::Dots, tint));
    }
    for (precision, tint) in [(Precision::Single, Tint::Grey), (Precision::Double, Tint::LightGrey)] {
        let recipe = Configuration { precision, ..Configuration::RECIPE };
        let floor = points(&rows, recipe, |row| row.floor);
        // A floor far below all errors would only flatten them.
        let lowest = all.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
        if floor.len() > 1 && floor.iter().any(|point| point.1 > NEAR_THE_FLOOR * lowest) {
            panel = panel.series(Series::new(
                &format!("floor of rounding, {}", precision.word()),
                floor,
                Style::Dotted,
                tint,
            ));
        }
    }
    if all.len() < 2 {
        return None;
    }
    for mark in slopes(&rows) {
        panel = panel.with(mark);
    }
    Some(Figure::single(panel).sized(900, 640))
}

/// |Numerical damping| for each number of substeps: measured dots on the line of the formula.
pub(super) fn damping(report: &Report) -> Option<Figure> {
    let mut panel = Panel::new("step h", "|numerical damping|").log_x().log_y();
    let mut any = false;
    for (substeps, tint) in [(2, Tint::Green), (4, Tint::Vermillion), (8, Tint::Purple)] {
        let wanted = |row: &&Row| {
            row.quantity == "numerical_damping"
                && row.configuration.substeps == substeps
                && row.configuration.scheme == Scheme::Plain
        };
        let rows: Vec<&Row> = report.rows.iter().filter(wanted).collect();
        let of = |value: fn(&Row) -> Option<f64>| -> Vec<(f64, f64)> {
            rows.iter().filter_map(|row| Some((row.dt?, value(row)?.abs()))).collect()
        };
        let (mut formula, found) = (of(|row| row.expected), of(|row| row.found));
        formula.sort_by(|a, b| a.0.total_cmp(&b.0));
        if formula.len() < 2 {
            continue;
        }
        any = true;
        panel = panel.series(Series::new(&format!("formula, {substeps} substeps"), formula, Style::Line, tint));
        panel = panel.series(Series::new(
            &format!("measured, {substeps} substeps, both precisions and joints"),
            found,
            Style::Rings,
            tint,
        ));
    }
    any.then(|| Figure::single(panel).sized(900, 560))
}

fn configurations(rows: &[&Row]) -> Vec<Configuration> {
    let mut found = Vec::new();
    for row in rows {
        if !found.contains(&row.configuration) {
            found.push(row.configuration);
        }
    }
    found
}

fn points(rows: &[&Row], configuration: Configuration, value: fn(&Row) -> Option<f64>) -> Vec<(f64, f64)> {
    let of = rows.iter().filter(|row| row.configuration == configuration);
    of.filter_map(|row| Some((row.dt?, value(row)?))).filter(|(_, y)| *y > 0.0).collect()
}

fn look(configuration: Configuration) -> (Style, Tint) {
    match (configuration.scheme, configuration.precision, configuration.joints, configuration.substeps) {
        (Scheme::SecondOrder, Precision::Double, Joints::Impulse, _) => (Style::Line, Tint::Blue),
        (Scheme::SecondOrder, Precision::Double, Joints::Multibody, _) => (Style::Dashed, Tint::Green),
        (Scheme::SecondOrder, Precision::Single, ..) => (Style::Dashed, Tint::Sky),
        (Scheme::AveragedFriction, ..) => (Style::Dashed, Tint::Purple),
        (Scheme::LaggingDamping, ..) => (Style::Line, Tint::Orange),
        (Scheme::Plain, _, _, 1) => (Style::Line, Tint::Purple),
        (Scheme::Plain, Precision::Double, ..) => (Style::Line, Tint::Vermillion),
        (Scheme::Plain, Precision::Single, ..) => (Style::Dashed, Tint::Black),
    }
}

/// Triangles below the recipe's errors (order 2) and above those of the late velocity (order 1).
fn slopes(rows: &[&Row]) -> Vec<Mark> {
    let middle = |configuration: Configuration| {
        let points = points(rows, configuration, |row| row.deviation);
        points.get(points.len() / 2).copied()
    };
    let recipe =
        middle(Configuration::RECIPE).map(|(x, y)| Mark::Slope { at: (x, 0.15 * y), order: 2.0, decades: 0.4 });
    let late = Configuration { scheme: Scheme::LaggingDamping, ..Configuration::RECIPE };
    let first = middle(late).map(|(x, y)| Mark::Slope { at: (x, 4.0 * y), order: 1.0, decades: 0.4 });
    recipe.into_iter().chain(first).collect()
}
