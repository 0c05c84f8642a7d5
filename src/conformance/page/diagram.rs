//! The amplitude diagram: the engine's over the exact one, and its table.

use super::tables::{Entry, Grid, steps_table};
use crate::conformance::scenarios::amplitude_diagram::{BOUNDED, DEFAULTS, ID, LARGEST, SMALLEST, xi1_of};
use crate::conformance::{Configuration, Report, Row};
use crate::report::{Figure, Mark, Panel, Series, Style, Tint};

/// Under the picture.
pub(super) const CAPTION: &str = "Largest and smallest maximum of x1 from 300 to 600 periods, over ξ₁. One value at an ξ₁: a limit cycle; \
     two: a torus, or chaos. No mark where a motion diverged. Lines only join the exact values that were computed; the band begins at the first ξ₁ tried at which the exact solution diverges.";

/// Exact lines, and the two ways to run the engine over them; none without two exact values to join.
pub(super) fn figure(report: &Report) -> Option<Figure> {
    let rows: Vec<&Row> = report.rows.iter().filter(|row| row.scenario == ID).collect();
    let exact = [LARGEST, SMALLEST].map(|quantity| points(&rows, quantity, None, |row| row.exact));
    if exact.iter().any(|points| points.len() < 2) {
        return None;
    }
    let mut panel = Panel::new("ξ₁", "maxima of x1, largest and smallest");
    let outcomes = points(&rows, BOUNDED, None, |row| row.exact);
    if let Some(edge) = outcomes.iter().filter(|(_, bounded)| *bounded == 0.0).map(|(xi1, _)| *xi1).reduce(f64::max) {
        let label = "exact solution diverges".to_owned();
        panel = panel.with(Mark::BandX { label, from: None, to: Some(edge), tint: Tint::LightGrey });
    }
    for (points, label) in exact.into_iter().zip(["exact solution", ""]) {
        panel = panel.series(Series::new(label, points, Style::Line, Tint::Grey));
    }
    for (configuration, words, style, tint) in [
        (Configuration::AVERAGED_FRICTION, "friction averaged, 256 steps per period", Style::Rings, Tint::Blue),
        (DEFAULTS, "Rapier's defaults, dt = 1/60, 4 substeps, in f64", Style::Crosses, Tint::Vermillion),
    ] {
        let found = [LARGEST, SMALLEST].map(|quantity| points(&rows, quantity, Some(configuration), |row| row.found));
        panel = panel.series(Series::new(words, found.concat(), style, tint));
    }
    // The whole range, also where nothing has an amplitude.
    let (lowest, highest) = (outcomes.first()?.0, outcomes.last()?.0);
    let margin = 0.02 * (highest - lowest);
    Some(Figure::single(panel.x_range(lowest - margin, highest + margin)).sized(900, 600))
}

/// In order of xi1. The exact values stand in the rows of every configuration, and are taken from the first.
fn points(
    rows: &[&Row],
    quantity: &str,
    configuration: Option<Configuration>,
    value: fn(&Row) -> Option<f64>,
) -> Vec<(f64, f64)> {
    let of = rows.iter().filter(|row| row.quantity == quantity);
    let of = of.filter(|row| configuration.is_none_or(|wanted| row.configuration == wanted));
    let mut points: Vec<(f64, f64)> = of.filter_map(|row| Some((xi1_of(&row.variant)?, value(row)?))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by_key(|point| point.0);
    points
}

/// All numbers, with xi1 in the first column.
pub(super) fn table(report: &Report) -> Grid {
    let computed = |row: &&Row| row.scenario == ID && row.steps_per_period.is_some();
    let rows: Vec<&Row> = report.rows.iter().filter(computed).collect();
    let grid = steps_table(&rows);
    let with_xi1 = |(row, cells): (&&Row, Vec<Entry>)| {
        let key = xi1_of(&row.variant);
        let text = key.map_or_else(|| row.variant.clone(), |xi1| format!("{xi1:.3}"));
        std::iter::once(Entry { text, key }).chain(cells).collect()
    };
    Grid {
        headings: std::iter::once("ξ₁").chain(grid.headings).collect(),
        rows: rows.iter().zip(grid.rows).map(with_xi1).collect(),
    }
}

/// Whether the scenario is shown in this way.
pub(super) fn shows(scenario: &str) -> bool {
    scenario == ID
}
