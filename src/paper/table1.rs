//! Table 1: period doublings of the slow flow's torus, with both definitions of the averaged energy, a converged frequency and 400 nodes.

use super::check::Check;
use super::error::PaperError;
use super::item::{Case, Findings, Origin, Overview, PaperItem, numbers, with_words};
use super::slow::first_hopf;
use crate::averaging::{EnergyDefinition, EnergyFrequency, Interpolation, NodeSpacing, SlowFlow, doubling_cascade};
use crate::report::{Figure, Panel, Series, Style, Tint};
use rayon::prelude::*;
use std::sync::Arc;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "table1",
    origin: Origin::Paper("Table 1"),
    title: "period doublings of the slow flow",
    caption: "Values of ξ₁ at which the torus of the slow flow doubles, found where a multiplier of its limit cycle is −1, following the doubled cycle each time. \
        Two definitions of the averaged energy of the Jenkins spring, with the frequency ω(E) converged and interpolated by PCHIP through 400 limit cycles spread in four ways; the paper's values beside them. \
        Drawn: (a) distance of each doubling from the printed one, the small dots with 400 limit cycles; (b) distance of successive doublings, with the slope of Feigenbaum's δ = 4.669 through the first printed one.",
    revision: 2,
    compute,
};

const PRINTED: [f64; 5] = [-0.105_575, -0.126_635, -0.132_057_5, -0.133_18, -0.133_342_5];
/// Computed outside this project, six digits.
const MEAN_POTENTIAL: [f64; 5] = [-0.105_942, -0.127_459, -0.133_161, -0.134_679, -0.134_950];
const EQUIVALENT_STIFFNESS: [f64; 5] = [-0.105_812, -0.127_108, -0.132_620, -0.133_861, -0.134_042];
const NODES: usize = 400;
/// Ratio of successive distances at the end of a cascade (M. J. Feigenbaum, J. Stat. Phys. 19 (1978) 25-52).
const FEIGENBAUM: f64 = 4.669_201_609;

struct Row {
    definition: EnergyDefinition,
    interpolation: Interpolation,
    hopf: f64,
    doublings: Vec<f64>,
    /// Why there are fewer than wanted.
    ended: Option<String>,
}

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let count = case.choose(5, 3);
    let definitions = DEFINITIONS;
    let pchip = |spacing| Interpolation::Pchip { nodes: NODES, spacing };
    let variants: Vec<_> = definitions
        .into_iter()
        .flat_map(|definition| {
            let nodes = NodeSpacing::ALL.map(pchip).into_iter();
            std::iter::once(Interpolation::Converged).chain(nodes).map(move |interpolation| (definition, interpolation))
        })
        .collect();
    let rows: Vec<Result<Row, PaperError>> = variants
        .into_par_iter()
        .map(|(definition, interpolation)| row(case, definition, interpolation, count))
        .collect();
    let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut findings = Findings { checks: checks(case, &rows, count), ..Findings::default() };
    for definition in definitions {
        describe(case, &mut findings, &rows, definition);
    }
    findings.verdict = verdict(case, &rows);
    findings.table("doublings", table(&rows));
    if rows.iter().any(|row| !row.doublings.is_empty()) {
        findings.overview = Some(overview(case, &rows));
        findings.figure = Some(figure(case, &rows));
    }
    Ok(findings)
}

fn row(
    case: &Case,
    definition: EnergyDefinition,
    interpolation: Interpolation,
    count: usize,
) -> Result<Row, PaperError> {
    let frequency = EnergyFrequency::new(case.parameters, definition, interpolation)?;
    let flow = SlowFlow::new(case.parameters, Arc::new(frequency))?;
    let hopf = first_hopf(&flow)?;
    let cascade = doubling_cascade(&flow, &hopf, count);
    let doublings = cascade.doublings.iter().map(|doubling| doubling.torus.xi1).collect();
    let ended = cascade.ended.map(|error| error.to_string());
    Ok(Row { definition, interpolation, hopf: hopf.point.xi1, doublings, ended })
}

fn converged(rows: &[Row], definition: EnergyDefinition) -> Option<&Row> {
    rows.iter().find(|row| row.definition == definition && row.interpolation == Interpolation::Converged)
}

/// Largest distance from the converged value over the ways of spreading 400 nodes.
fn spread(rows: &[Row], definition: EnergyDefinition, value: impl Fn(&Row) -> f64) -> f64 {
    let reference = converged(rows, definition).map_or(f64::NAN, &value);
    let nodes = rows.iter().filter(|row| row.definition == definition);
    nodes.map(|row| (value(row) - reference).abs()).fold(0.0, f64::max)
}

fn name(definition: EnergyDefinition) -> &'static str {
    match definition {
        EnergyDefinition::MeanPotential => "mean potential",
        EnergyDefinition::EquivalentStiffness => "equivalent stiffness",
    }
}

fn checks(case: &Case, rows: &[Row], count: usize) -> Vec<Check> {
    let fewest = rows.iter().map(|row| row.doublings.len()).min().unwrap_or(0);
    let mut checks = vec![Check::at_least(
        "doublings found with each definition and frequency",
        count as f64,
        fewest as f64,
        "the paper finds five; without them nothing below would be checked",
    )];
    let expected = [
        (EnergyDefinition::MeanPotential, MEAN_POTENTIAL, -0.035_002_1),
        (EnergyDefinition::EquivalentStiffness, EQUIVALENT_STIFFNESS, -0.034_834_4),
    ];
    for (definition, values, hopf) in expected {
        let Some(found) = converged(rows, definition) else { continue };
        let name = name(definition);
        checks.push(Check::near(
            &format!("{name}: secondary Hopf"),
            hopf,
            found.hopf,
            1e-6,
            "computed outside this project to seven decimal places",
        ));
        for (i, (found, expected)) in found.doublings.iter().zip(values).enumerate() {
            checks.push(Check::near(
                &format!("{name}: doubling {}", i + 1),
                expected,
                *found,
                3e-6,
                "computed outside this project to six digits; a unit of the last, and the error of that computation",
            ));
        }
    }
    checks.into_iter().map(|check| case.nominal_only(check)).collect()
}

fn ratios(doublings: &[f64]) -> Vec<f64> {
    doublings.windows(3).map(|d| (d[1] - d[0]) / (d[2] - d[1])).collect()
}

fn words(values: &[f64], digits: usize) -> String {
    values.iter().map(|value| format!("{value:.digits$}")).collect::<Vec<_>>().join(", ")
}

fn describe(case: &Case, findings: &mut Findings, rows: &[Row], definition: EnergyDefinition) {
    let Some(found) = converged(rows, definition) else { return };
    let name = name(definition);
    if let Some(ended) = &found.ended {
        findings.number(&format!("{name}: the cascade ends after {}", found.doublings.len()), ended);
    }
    if found.doublings.is_empty() {
        return;
    }
    findings.number(&format!("{name}: doublings"), words(&found.doublings, 7));
    findings.number(&format!("{name}: ratios"), words(&ratios(&found.doublings), 4));
    findings.number(
        &format!("{name}: 400 nodes move the Hopf point by up to"),
        format!("{:.1e}", spread(rows, definition, |row| row.hopf)),
    );
    if !case.is_nominal() {
        return;
    }
    let off = found.doublings.iter().zip(PRINTED).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    findings.number(&format!("{name}: largest distance from the printed values"), format!("{off:.2e}"));
}

const DEFINITIONS: [EnergyDefinition; 2] = [EnergyDefinition::MeanPotential, EnergyDefinition::EquivalentStiffness];

/// The table as on paper: doubling by doubling, the printed values beside the found ones.
fn overview(case: &Case, rows: &[Row]) -> Overview {
    let mut head = vec!["i".to_owned()];
    if case.is_nominal() {
        head.extend(["printed", "ratio"].map(str::to_owned));
    }
    for definition in DEFINITIONS {
        head.push(name(definition).to_owned());
        if case.is_nominal() {
            head.push("− printed, 10⁻³".to_owned());
        }
        head.extend(["400 nodes ±", "ratio"].map(str::to_owned));
    }
    let most = DEFINITIONS.iter().filter_map(|d| converged(rows, *d)).map(|row| row.doublings.len()).max().unwrap_or(0);
    Overview { head, rows: (0..most).map(|i| overview_row(case, rows, i)).collect() }
}

fn overview_row(case: &Case, rows: &[Row], i: usize) -> Vec<String> {
    let shown = |value: Option<f64>, digits: usize| value.map_or("–".to_owned(), |value| format!("{value:.digits$}"));
    let ratio = |doublings: &[f64]| shown(i.checked_sub(1).and_then(|n| ratios(doublings).get(n).copied()), 4);
    let mut cells = vec![(i + 1).to_string()];
    if case.is_nominal() {
        cells.extend([shown(PRINTED.get(i).copied(), 7), ratio(&PRINTED)]);
    }
    for definition in DEFINITIONS {
        let doublings = converged(rows, definition).map_or(&[][..], |row| &row.doublings);
        let value = doublings.get(i).copied();
        cells.push(shown(value, 7));
        if case.is_nominal() {
            cells.push(shown(value.zip(PRINTED.get(i)).map(|(found, printed)| 1e3 * (found - printed)), 3));
        }
        let moved = spread(rows, definition, |row| row.doublings.get(i).copied().unwrap_or(f64::NAN));
        cells.extend([format!("{moved:.1e}"), ratio(doublings)]);
    }
    cells
}

fn verdict(case: &Case, rows: &[Row]) -> String {
    let off = |definition| {
        let found = converged(rows, definition).map_or(&[][..], |row| &row.doublings);
        found.iter().zip(PRINTED).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let [mean, stiffness] = [EnergyDefinition::MeanPotential, EnergyDefinition::EquivalentStiffness].map(off);
    if case.is_nominal() {
        format!(
            "The cascade is there, the printed digits are not met: off by up to {mean:.1e} (mean potential) and {stiffness:.1e} (equivalent stiffness)."
        )
    } else if rows.iter().all(|row| row.doublings.is_empty()) {
        "The torus of these parameters never doubles.".to_owned()
    } else {
        "The cascade of these parameters; the paper has none to compare with.".to_owned()
    }
}

fn table(rows: &[Row]) -> crate::store::Table {
    let flat: Vec<(&Row, usize, f64)> =
        rows.iter().flat_map(|row| row.doublings.iter().enumerate().map(move |(i, xi1)| (row, i, *xi1))).collect();
    let ratio = |(row, i, _): &(&Row, usize, f64)| match i.checked_sub(1) {
        Some(n) => ratios(&row.doublings).get(n).copied().unwrap_or(f64::NAN),
        None => f64::NAN,
    };
    let table = numbers(vec![
        ("i", flat.iter().map(|entry| (entry.1 + 1) as f64).collect()),
        ("xi1", flat.iter().map(|entry| entry.2).collect()),
        ("ratio", flat.iter().map(ratio).collect()),
        ("printed", flat.iter().map(|entry| PRINTED.get(entry.1).copied().unwrap_or(f64::NAN)).collect()),
    ]);
    let table = with_words(table, "energy", flat.iter().map(|entry| name(entry.0.definition).to_owned()).collect());
    let interpolation = |row: &Row| match row.interpolation {
        Interpolation::Converged => "converged".to_owned(),
        Interpolation::Pchip { nodes, spacing } => format!("{nodes} nodes, {spacing:?}"),
    };
    with_words(table, "frequency", flat.iter().map(|entry| interpolation(entry.0)).collect())
}

const STYLES: [(Style, Tint); 2] = [(Style::Markers, Tint::Blue), (Style::Crosses, Tint::Vermillion)];

fn figure(case: &Case, rows: &[Row]) -> Figure {
    let mut panels = vec![gaps_panel(case, rows)];
    if case.is_nominal() {
        panels.insert(0, distance_panel(rows));
    }
    let columns = panels.len();
    Figure::grid(columns, (600 * columns as u32, 560), panels)
}

/// Points over the number of the doubling, moved aside a little so that they do not hide each other.
fn numbered(values: impl Iterator<Item = f64>, aside: f64) -> Vec<(f64, f64)> {
    values.enumerate().map(|(i, value)| ((i + 1) as f64 + aside, value)).collect()
}

fn distance_panel(rows: &[Row]) -> Panel {
    let off = |row: &Row, aside: f64| {
        numbered(row.doublings.iter().zip(PRINTED).map(|(found, printed)| 1e3 * (found - printed)), aside)
    };
    let mut panel = Panel::new("number i of the doubling", "10³ (ξ₁ − printed)")
        .titled("(a) distance from the printed values")
        .x_range(0.5, 5.5)
        .series(Series::new("printed", vec![(0.5, 0.0), (5.5, 0.0)], Style::Line, Tint::Black));
    for ((definition, (style, tint)), aside) in DEFINITIONS.into_iter().zip(STYLES).zip([-0.06, 0.06]) {
        let nodes =
            rows.iter().filter(|row| row.definition == definition && row.interpolation != Interpolation::Converged);
        let spread = nodes.flat_map(|row| off(row, 2.0 * aside)).collect();
        panel = panel.series(Series::new(&format!("{}, 400 nodes", name(definition)), spread, Style::Dots, tint));
        let found = converged(rows, definition).map_or(Vec::new(), |row| off(row, aside));
        panel = panel.series(Series::new(name(definition), found, style, tint));
    }
    panel
}

fn gaps_panel(case: &Case, rows: &[Row]) -> Panel {
    let gaps = |values: &[f64], aside: f64| numbered(values.windows(2).map(|pair| pair[0] - pair[1]), aside);
    let title = if case.is_nominal() { "(b) distance to the next" } else { "distance to the next" };
    let mut panel = Panel::new("number i of the doubling", "ξ₁(i) − ξ₁(i+1)").titled(title).log_y().x_range(0.5, 4.5);
    let converged_gaps =
        |definition, aside| converged(rows, definition).map_or(Vec::new(), |row| gaps(&row.doublings, aside));
    let reference = if case.is_nominal() { gaps(&PRINTED, 0.0) } else { converged_gaps(DEFINITIONS[0], 0.0) };
    if let Some((_, first)) = reference.first() {
        let slope = (0..4).map(|n| (f64::from(n + 1), first * FEIGENBAUM.powi(-n))).collect();
        panel = panel.series(Series::new("slope of δ = 4.669", slope, Style::Dashed, Tint::Grey));
    }
    for ((definition, (style, tint)), aside) in DEFINITIONS.into_iter().zip(STYLES).zip([-0.06, 0.06]) {
        panel = panel.series(Series::new(name(definition), converged_gaps(definition, aside), style, tint));
    }
    if case.is_nominal() {
        panel = panel.series(Series::new("printed in the paper", gaps(&PRINTED, 0.0), Style::Rings, Tint::Black));
    }
    panel
}
