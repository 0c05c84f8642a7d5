//! Errors over steps on logarithmic axes, with slope triangles and the floors of rounding.

use super::slopes::slopes;
use crate::conformance::experiment::is_notable;
use crate::conformance::ladder::ABOVE_FLOOR;
use crate::conformance::{Configuration, HOPF_WORST, Report, Row, quantity_in_words};
use crate::engine::{Joints, Precision, Scheme};
use crate::report::{Figure, Panel, Series, Style, Tint};

/// Floors lower than this part of the smallest error are not drawn.
const NEAR_THE_FLOOR: f64 = 0.01;
/// Curves that differ by less are one line on paper.
const SAME: f64 = 0.03;

/// A picture with what is to be said of it.
pub(super) struct Chart {
    pub figure: Figure,
    pub notes: Vec<String>,
}

/// Errors in one configuration, and others that have the same.
pub(super) struct Curve {
    pub configuration: Configuration,
    pub points: Vec<(f64, f64)>,
    same: Vec<Configuration>,
}

/// `error of damping`; `state error` says so itself.
pub(super) fn axis_label(quantity: &str) -> String {
    if quantity == HOPF_WORST {
        return "error of ξ₁, worst phase".to_owned();
    }
    let words = quantity_in_words(quantity);
    if words.ends_with("error") || words.ends_with("residual") { words } else { format!("error of {words}") }
}

/// Errors of one quantity of a scenario over the step; none without two points to draw.
pub(super) fn errors(report: &Report, scenario: &str, variant: &str, quantity: &str) -> Option<Chart> {
    let wanted = |row: &&Row| row.scenario == scenario && row.variant == variant && row.quantity == quantity;
    let rows: Vec<&Row> = report.rows.iter().filter(wanted).filter(|row| is_notable(row.configuration)).collect();
    let (mut curves, mut exact) = (Vec::new(), Vec::new());
    for configuration in configurations(&rows) {
        let points = points(&rows, configuration, |row| row.deviation);
        if points.len() < 2 {
            continue;
        }
        if only_rounding(&rows, configuration) {
            exact.push(configuration);
        } else {
            add(&mut curves, configuration, points);
        }
    }
    if curves.is_empty() {
        return None;
    }
    let mut panel = Panel::new("step h (a period is about 2π)", &axis_label(quantity)).log_x().log_y();
    let mut floors = Vec::new();
    for (precision, tint) in [(Precision::Single, Tint::Grey), (Precision::Double, Tint::LightGrey)] {
        if let Some(floor) = floor(&rows, precision, &curves) {
            let label = format!("floor of rounding, {}", precision.word());
            panel = panel.series(Series::new(&label, floor.clone(), Style::Thin, tint));
            floors.push(floor);
        }
    }
    for curve in &curves {
        let (style, tint) = look(curve.configuration);
        panel = panel.series(Series::new(&curve.label(), curve.points.clone(), style, tint));
        panel = panel.series(Series::new("", curve.points.clone(), Style::Dots, tint));
    }
    for mark in slopes(&curves, &floors) {
        panel = panel.with(mark);
    }
    let mut notes = Vec::new();
    if !exact.is_empty() {
        let names: Vec<String> = exact.iter().map(|configuration| configuration.short_name()).collect();
        notes.push(format!("Not drawn, because nothing but rounding is left of their errors: {}.", names.join("; ")));
    }
    Some(Chart { figure: Figure::single(panel).sized(900, 560), notes })
}

impl Curve {
    /// All configurations with these errors.
    fn label(&self) -> String {
        let others: Vec<String> = self.same.iter().map(|other| other.unlike(self.configuration)).collect();
        let first = self.configuration.short_name();
        if others.is_empty() { first } else { format!("{first}; the same: {}", others.join("; ")) }
    }
}

/// With the first curve that it cannot be told from, or as a new one.
fn add(curves: &mut Vec<Curve>, configuration: Configuration, points: Vec<(f64, f64)>) {
    let near = |a: f64, b: f64| (a / b).ln().abs() <= SAME;
    let close = |a: &(f64, f64), b: &(f64, f64)| near(a.0, b.0) && near(a.1, b.1);
    let same = |curve: &&mut Curve| {
        curve.points.len() == points.len() && curve.points.iter().zip(&points).all(|(a, b)| close(a, b))
    };
    match curves.iter_mut().find(same) {
        Some(curve) => curve.same.push(configuration),
        None => curves.push(Curve { configuration, points, same: Vec::new() }),
    }
}

/// Whether all errors lie where rounding decides.
fn only_rounding(rows: &[&Row], configuration: Configuration) -> bool {
    let mut of = rows.iter().filter(|row| row.configuration == configuration && row.steps_per_period.is_some());
    of.all(|row| row.deviation.zip(row.floor).is_some_and(|(error, floor)| error <= ABOVE_FLOOR * floor))
}

/// Of the second-order scheme; none if it lies far below all errors, which it would only flatten.
fn floor(rows: &[&Row], precision: Precision, curves: &[Curve]) -> Option<Vec<(f64, f64)>> {
    let floor = points(rows, Configuration { precision, ..Configuration::SAMPLED_FRICTION }, |row| row.floor);
    let lowest = curves.iter().flat_map(|curve| &curve.points).map(|point| point.1).fold(f64::INFINITY, f64::min);
    (floor.len() > 1 && floor.iter().any(|point| point.1 > NEAR_THE_FLOOR * lowest)).then_some(floor)
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
        formula.dedup();
        if formula.len() < 2 {
            continue;
        }
        any = true;
        panel = panel.series(Series::new(&format!("formula, {substeps} substeps"), formula, Style::Line, tint));
        panel = panel.series(Series::new(
            &format!("measured, {substeps} substeps, all precisions and joints run"),
            found,
            Style::Rings,
            tint,
        ));
    }
    any.then(|| Figure::single(panel).sized(900, 480))
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
        (Scheme::AveragedFriction, Precision::Double, ..) => (Style::Dashed, Tint::Green),
        (Scheme::AveragedFriction, Precision::Single, ..) => (Style::Dashed, Tint::Grey),
        (Scheme::LaggingDamping, ..) => (Style::Line, Tint::Orange),
        (Scheme::Plain, _, _, 1) => (Style::Line, Tint::Purple),
        (Scheme::Plain, Precision::Double, ..) => (Style::Line, Tint::Vermillion),
        (Scheme::Plain, Precision::Single, ..) => (Style::Dashed, Tint::Black),
    }
}
