//! `report.html`: one file with everything in it.

use super::advice::{self, FEWEST_CAPTION};
use super::answer::{DERIVATION, FAULTS, FORMULA, HOW_TO_READ, MULTIBODY, SCHEME, STEPS, WHY, answer, steps_for_all};
use super::charts::{self, Chart};
use super::diagram;
use super::markdown::{provenance, summary};
use super::tables::{self, Entry, Grid};
use crate::conformance::{Changes, ConformanceError, HOPF_QUANTITY, HOPF_WORST, Report, Row, ScenarioNote};
use crate::report::{Cell, Figure, Page, SortableTable, TablePack, image};
use maud::{Markup, html};

/// The report as a self-contained page.
///
/// # Errors
/// [`ConformanceError::Report`] if a chart cannot be drawn.
pub fn html(report: &Report, changes: Option<&Changes>) -> Result<String, ConformanceError> {
    let mut pack = TablePack::default();
    let damping = damping(report, &mut pack)?;
    let sections =
        report.scenarios.iter().map(|note| scenario(report, note, &mut pack)).collect::<Result<Vec<_>, _>>()?;
    let class = if report.tally.failed == 0 { "verdict passed" } else { "verdict failed" };
    let body = html! {
        div class=(class) { @for sentence in answer(report) { p { (sentence) } } }
        h2 #advice { "Fewest steps per period for 1 %" }
        (table(&advice::fewest_steps(report)))
        p.caption { (FEWEST_CAPTION) }
        p { (STEPS) }
        @if report.tally.failed > 0 { h2 { "Not as predicted" } (table(&tables::failures(report))) }
        @if let Some(changes) = changes {
            h2 { "Changes" } p { (summary(changes)) } (table(&tables::changes(changes)))
        }
        nav { ul {
            li { a href="#why" { "Why this, and not its neighbours" } } li { a href="#faults" { "Whose fault is what" } }
            li { a href="#reading" { "How to read this" } } li { a href="#damping" { "Numerical damping" } }
            @for note in &report.scenarios { li { a href=(format!("#{}", note.id)) { (note.title) } } }
            li { a href="#provenance" { "Where and with what" } }
        } }
        (why(report))
        h2 #faults { "Whose fault is what" }
        (table(&faults()))
        h2 #reading { "How to read this" }
        ul { @for line in HOW_TO_READ { li { (line) } } }
        p { (SCHEME) } p { (MULTIBODY) }
        (damping)
        @for section in sections { (section) }
        h2 #provenance { "Where and with what" }
        @for line in provenance(report) { p { (line) } }
        p { "Every row of every configuration, with the hashes of the engine's trajectories, is in report.json." }
        (pack.words())
    };
    let lead = "Numbers measured in Rapier, beside what the theory of its configuration predicts and what the equations of motion say.";
    Ok(Page { title: "How wrong is the physics engine?".to_owned(), lead: lead.to_owned(), body }.html())
}

fn why(report: &Report) -> Markup {
    html! {
        h2 #why { "Why this, and not its neighbours" }
        @for line in WHY { p { (line) } }
        @if let Some(steps) = steps_for_all(report) {
            p.caption { (format!("Errors at {steps} steps per period, in per cent of the quantity or of the size of the motion")) }
            (table(&advice::comparison(report, steps)))
        }
    }
}

fn faults() -> Grid {
    Grid {
        headings: vec!["error", "whose", "how large", "what helps"],
        rows: FAULTS.iter().map(|row| row.iter().map(|cell| tables::text(*cell)).collect()).collect(),
    }
}

fn damping(report: &Report, pack: &mut TablePack) -> Result<Markup, ConformanceError> {
    let rows: Vec<&Row> = report.rows.iter().filter(|row| row.quantity == "numerical_damping").collect();
    let figure = charts::damping(report);
    let alt = "Numerical damping over the step: measured values lie on the lines of the formula.";
    let picture = figure.map(|figure| picture(&figure, alt)).transpose()?;
    let grid = tables::damping(&rows);
    Ok(html! {
        h2 #damping { "Numerical damping" }
        p { (FORMULA) } p { (DERIVATION) }
        @if let Some(picture) = picture { (picture) }
        (packed(pack, &format!("{} rows", grid.rows.len()), &grid))
    })
}

fn scenario(report: &Report, note: &ScenarioNote, pack: &mut TablePack) -> Result<Markup, ConformanceError> {
    let mut variants: Vec<&str> = Vec::new();
    for row in report.rows.iter().filter(|row| row.scenario == note.id) {
        if !variants.contains(&row.variant.as_str()) {
            variants.push(&row.variant);
        }
    }
    let parts = if diagram::shows(&note.id) {
        vec![amplitude_diagram(report, pack)?]
    } else {
        variants.iter().map(|variant| part(report, note, variant, pack)).collect::<Result<Vec<_>, _>>()?
    };
    let hopf = advice::hopf(report);
    Ok(html! {
        h2 id=(note.id) { (note.title) }
        p { (note.description) }
        p { "Reference: " (note.reference) "." }
        @if note.id == "secondary_hopf" && !hopf.rows.is_empty() { (table(&hopf)) }
        @for part in parts { (part) }
    })
}

fn part(report: &Report, note: &ScenarioNote, variant: &str, pack: &mut TablePack) -> Result<Markup, ConformanceError> {
    let of = |row: &&Row| row.scenario == note.id && row.variant == variant;
    let ladder = |row: &&Row| row.steps_per_period.is_none() && row.expected_order.is_some();
    let orders: Vec<&Row> = report.rows.iter().filter(of).filter(ladder).collect();
    let notable = tables::notable(report, &note.id, variant);
    let steps: Vec<&Row> = notable.into_iter().filter(|row| row.steps_per_period.is_some()).collect();
    let mut quantities: Vec<&str> = Vec::new();
    for row in &orders {
        // The mean over the phases would hide the worst of them.
        let quantity = if row.quantity == HOPF_QUANTITY { HOPF_WORST } else { row.quantity.as_str() };
        if !quantities.contains(&quantity) {
            quantities.push(quantity);
        }
    }
    let charts: Vec<(String, Chart)> = quantities
        .into_iter()
        .filter_map(|quantity| {
            charts::errors(report, &note.id, variant, quantity).map(|chart| (charts::axis_label(quantity), chart))
        })
        .collect();
    let pictures = charts
        .iter()
        .map(|(what, chart)| {
            Ok((
                caption(note, variant, what, chart),
                picture(&chart.figure, &format!("{}: {what} over the step", note.title))?,
            ))
        })
        .collect::<Result<Vec<_>, ConformanceError>>()?;
    let order_grid = tables::orders(&orders);
    let steps_grid = tables::steps_table(&steps);
    Ok(html! {
        @if !variant.is_empty() { h3 { (variant) } }
        @for (caption, picture) in pictures { p.caption { (caption) } (picture) }
        @if !orders.is_empty() { (packed(pack, &format!("Orders of convergence: {} rows", orders.len()), &order_grid)) }
        @if !steps.is_empty() {
            (packed(pack, &format!("Numbers at single steps: {} rows of the configurations that tell most", steps.len()), &steps_grid))
        }
    })
}

fn caption(note: &ScenarioNote, variant: &str, what: &str, chart: &Chart) -> String {
    let variant = if variant.is_empty() { String::new() } else { format!(", {variant}") };
    let notes: String = chart.notes.iter().map(|note| format!(" {note}")).collect();
    format!("{}{variant}: {what} over the step, both logarithmic.{notes}", note.title)
}

/// Its variants are the values of one parameter: one picture and one table for all of them.
fn amplitude_diagram(report: &Report, pack: &mut TablePack) -> Result<Markup, ConformanceError> {
    let picture =
        diagram::figure(report).map(|figure| picture(&figure, "Amplitude diagram, engine and exact")).transpose()?;
    let grid = diagram::table(report);
    let summary = format!("Numbers at single values of ξ₁: {} rows", grid.rows.len());
    Ok(html! {
        @if let Some(picture) = picture { p.caption { (diagram::CAPTION) } (picture) }
        (packed(pack, &summary, &grid))
    })
}

fn picture(figure: &Figure, alt: &str) -> Result<Markup, ConformanceError> {
    Ok(image(&figure.svg()?, &[], alt, figure.size))
}

/// Long tables, which would fill the page.
fn packed(pack: &mut TablePack, summary: &str, grid: &Grid) -> Markup {
    let rows: Vec<Vec<String>> =
        grid.rows.iter().map(|row| row.iter().map(|entry| entry.text.clone()).collect()).collect();
    pack.table(summary, &grid.headings, &rows)
}

fn table(grid: &Grid) -> Markup {
    let cell = |entry: &Entry| {
        let content = match entry.text.as_str() {
            "✓ passed" | "right" => html! { span.pass { (entry.text) } },
            "✗ failed" | "wrong" => html! { span.fail { (entry.text) } },
            other => html! { (other) },
        };
        Cell { content, key: entry.key }
    };
    let headings = grid.headings.iter().map(|&heading| heading.to_owned()).collect();
    SortableTable { headings, rows: grid.rows.iter().map(|row| row.iter().map(cell).collect()).collect() }.markup()
}
