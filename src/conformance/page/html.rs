//! `report.html`: one file with everything in it.

use super::answer::{FORMULA, HOW_TO_READ, MULTIBODY, RECIPE, answer};
use super::charts;
use super::diagram;
use super::markdown::{provenance, summary};
use super::tables::{self, Entry, Grid};
use crate::conformance::{Changes, ConformanceError, Report, Row, ScenarioNote};
use crate::report::{Cell, Figure, Page, SortableTable, image};
use maud::{Markup, html};

/// The report as a self-contained page.
///
/// # Errors
/// [`ConformanceError::Report`] if a chart cannot be drawn.
pub fn html(report: &Report, changes: Option<&Changes>) -> Result<String, ConformanceError> {
    let said = answer(report);
    let sections = report.scenarios.iter().map(|note| scenario(report, note)).collect::<Result<Vec<_>, _>>()?;
    let damping_rows: Vec<&Row> = report.rows.iter().filter(|row| row.quantity == "numerical_damping").collect();
    let damping = match charts::damping(report) {
        Some(figure) => {
            picture(&figure, "Numerical damping over the step: measured values lie on the lines of the formula.")?
        }
        None => html! {},
    };
    let class = if report.tally.failed == 0 { "verdict passed" } else { "verdict failed" };
    let body = html! {
        div class=(class) { @for sentence in &said { p { (sentence) } } }
        nav { ul {
            li { a href="#advice" { "Steps to use" } } li { a href="#reading" { "How to read this" } } li { a href="#damping" { "Numerical damping" } }
            @for note in &report.scenarios { li { a href=(format!("#{}", note.id)) { (note.title) } } }
            li { a href="#provenance" { "Where and with what" } }
        } }
        @if report.tally.failed > 0 { h2 { "Not as predicted" } (table(&tables::failures(report))) }
        @if let Some(changes) = changes {
            h2 { "Changes" } p { (summary(changes)) } (table(&tables::changes(changes)))
        }
        h2 id="advice" { "Fewest steps per period for 1 %" }
        p { "From this number of steps per period on, all that were run have the settled limit cycle's amplitude (and no torus in its place) and \
             frequency, and the engine's own secondary Hopf point, within 1 % of the exact values. The cost is that number of steps." }
        (table(&tables::advice(report)))
        h2 id="reading" { "How to read this" }
        ul { @for line in HOW_TO_READ { li { (line) } } }
        p { (RECIPE) } p { (MULTIBODY) }
        h2 id="damping" { "Numerical damping" }
        p { (FORMULA) }
        (damping)
        details { summary { (format!("{} rows", damping_rows.len())) } (table(&tables::damping(&damping_rows))) }
        @for section in sections { (section) }
        h2 id="provenance" { "Where and with what" }
        @for line in provenance(report) { p { (line) } }
        p { "Every row, with tolerances, limits, reasons and the hashes of the engine's trajectories, is in report.json." }
    };
    let lead = "Numbers measured in Rapier, beside what the theory of its configuration predicts and what the equations of motion say.";
    Ok(Page { title: "How wrong is the physics engine?".to_owned(), lead: lead.to_owned(), body }.html())
}

fn scenario(report: &Report, note: &ScenarioNote) -> Result<Markup, ConformanceError> {
    let mut variants: Vec<&str> = Vec::new();
    for row in report.rows.iter().filter(|row| row.scenario == note.id) {
        if !variants.contains(&row.variant.as_str()) {
            variants.push(&row.variant);
        }
    }
    let parts = if diagram::shows(&note.id) {
        vec![amplitude_diagram(report)?]
    } else {
        variants.iter().map(|variant| part(report, note, variant)).collect::<Result<Vec<_>, _>>()?
    };
    Ok(html! {
        h2 id=(note.id) { (note.title) }
        p { (note.description) }
        p { "Reference: " (note.reference) "." }
        @for part in parts { (part) }
    })
}

fn part(report: &Report, note: &ScenarioNote, variant: &str) -> Result<Markup, ConformanceError> {
    let of = |row: &&Row| row.scenario == note.id && row.variant == variant;
    let orders: Vec<&Row> = report
        .rows
        .iter()
        .filter(of)
        .filter(|row| row.steps_per_period.is_none() && row.expected_order.is_some())
        .collect();
    let notable: Vec<&Row> =
        tables::notable(report, &note.id, variant).into_iter().filter(|row| row.steps_per_period.is_some()).collect();
    let mut quantities: Vec<&str> = Vec::new();
    for row in &orders {
        if !quantities.contains(&row.quantity.as_str()) {
            quantities.push(&row.quantity);
        }
    }
    let mut pictures = Vec::new();
    for quantity in quantities {
        if let Some(figure) = charts::errors(report, &note.id, variant, quantity) {
            let what = charts::axis_label(quantity);
            pictures.push((what.clone(), picture(&figure, &format!("{}: {what} over the step", note.title))?));
        }
    }
    Ok(html! {
        @if !variant.is_empty() { h3 { (variant) } }
        @for (what, picture) in pictures { p.caption { (note.title) ": " (what) " over the step, both logarithmic" } (picture) }
        @if !orders.is_empty() { details { summary { (format!("Orders of convergence: {} rows", orders.len())) } (table(&tables::orders(&orders))) } }
        @if !notable.is_empty() {
            details open[orders.is_empty()] {
                summary { (format!("Numbers at single steps: {} rows of the configurations that tell most", notable.len())) }
                (table(&tables::steps_table(&notable)))
            }
        }
    })
}

/// Its variants are the values of one parameter: one picture and one table for all of them.
fn amplitude_diagram(report: &Report) -> Result<Markup, ConformanceError> {
    let picture =
        diagram::figure(report).map(|figure| picture(&figure, "Amplitude diagram, engine and exact")).transpose()?;
    let grid = diagram::table(report);
    Ok(html! {
        @if let Some(picture) = picture { p.caption { (diagram::CAPTION) } (picture) }
        details { summary { (format!("Numbers at single values of ξ₁: {} rows", grid.rows.len())) } (table(&grid)) }
    })
}

fn picture(figure: &Figure, alt: &str) -> Result<Markup, ConformanceError> {
    Ok(image(&figure.svg()?, &[], alt, figure.size))
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
