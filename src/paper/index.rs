//! `index.html`: every figure with caption, verdict, numbers and data, and where we differ from the paper.

use super::check::{Check, Value};
use super::error::PaperError;
use super::item::{Case, Effort, Origin, PaperItem};
use super::run::ItemResult;
use crate::report::{Page, image, verdict_mark};
use crate::store::{OutputDir, read_whole};
use maud::{Markup, html};

/// Writes the page for the items with a result, in their order.
///
/// # Errors
/// [`PaperError::Store`] if a picture cannot be read or the page cannot be written.
pub fn write_index(results: &[(&PaperItem, ItemResult)], case: &Case, dir: &OutputDir) -> Result<(), PaperError> {
    let of = |beyond: bool| results.iter().filter(move |(item, _)| (item.origin == Origin::Beyond) == beyond);
    let (mut paper, mut further) = (Vec::new(), Vec::new());
    for (item, result) in of(false) {
        paper.push(section(item, result, dir)?);
    }
    for (item, result) in of(true) {
        further.push(section(item, result, dir)?);
    }
    let body = html! {
        (overview(results, case))
        @for section in &paper { (section) }
        (super::differences::section(case))
        @if !further.is_empty() {
            h2 id="beyond" { "Beyond the paper" }
            @for section in &further { (section) }
        }
        footer { p { "Made by stickslip " (env!("CARGO_PKG_VERSION")) " with the command " code { "stickslip paper" } ". Non-dimensional quantities throughout: time in 1/ω₀, length in R/k" sub { "t" } ", force in R." } }
    };
    let page = Page {
        title: "Self-excited vibration with dry friction: the paper, recomputed".to_owned(),
        lead: "Every figure and the table of Woiwode, Vakakis & Krack, Nonlinear Dynamics 106 (2021) 1659–1673, computed anew and checked."
            .to_owned(),
        body,
    };
    dir.write("index.html", "", |writer| writer.write_all(page.html().as_bytes()))?;
    Ok(())
}

fn overview(results: &[(&PaperItem, ItemResult)], case: &Case) -> Markup {
    let p = case.parameters;
    let checks = || results.iter().flat_map(|(_, result)| &result.checks);
    let count = |state: Option<bool>| checks().filter(|check| check.passed == state).count();
    html! {
        p {
            "Parameters: ξ₂ = " (p.xi2) ", κ = " (p.kappa) ", γ = " (p.gamma)
            @if case.is_nominal() { " (the paper's nominal set)" } @else { " (not the paper's nominal set: expectations bound to it do not apply)" }
            "; ξ₁ is varied. “Exact” is the piecewise linear system itself, solved in closed form with located events; “slow flow” is the paper's averaged system."
        }
        @if case.effort == Effort::Quick { p.verdict.failed { "A quick run: fewer points and shorter motions than the full one." } }
        p { (count(Some(true))) " checks passed, " (count(Some(false))) " failed, " (count(None)) " do not apply." }
        nav { ul { @for (item, result) in results { li { a href=(format!("#{}", item.id)) { (name(item)) } @if !result.passed { " " span.fail { "✗" } } } } li { a href="#differences" { "Where we differ" } } } }
    }
}

fn name(item: &PaperItem) -> String {
    match item.origin {
        Origin::Paper(place) => place.to_owned(),
        Origin::Beyond => item.title.to_owned(),
    }
}

fn section(item: &PaperItem, result: &ItemResult, dir: &OutputDir) -> Result<Markup, PaperError> {
    let heading = match item.origin {
        Origin::Paper(place) => format!("{place}: {}", item.title),
        Origin::Beyond => item.title.to_owned(),
    };
    let picture = match result.picture {
        Some(size) => {
            let file = |extension: &str| read_whole(&dir.path().join(format!("{}.{extension}", item.id)));
            let svg = String::from_utf8_lossy(&file("svg")?).into_owned();
            Some(image(&svg, &file("png")?, item.title, size))
        }
        None => None,
    };
    let class = if result.passed { "verdict passed" } else { "verdict failed" };
    Ok(html! {
        section {
            h2 id=(item.id) { (heading) }
            @if let Some(picture) = picture { (picture) }
            p.caption { (item.caption) }
            p class=(class) { (result.verdict) }
            @if let Some(overview) = &result.overview {
                div.scroll { table {
                    thead { tr { @for title in &overview.head { th { (title) } } } }
                    tbody { @for row in &overview.rows { tr { @for cell in row { td { (cell) } } } } }
                } }
            }
            @if !result.numbers.is_empty() {
                div.scroll { table {
                    tbody { @for number in &result.numbers { tr { td { (number.name) } td { (number.value) } } } }
                } }
            }
            @if !result.checks.is_empty() { (checks(&result.checks)) }
            p { "Files: " @for (n, file) in result.files.iter().enumerate() { @if n > 0 { ", " } a href=(file) { (file) } } }
        }
    })
}

fn checks(checks: &[Check]) -> Markup {
    let failed = checks.iter().any(|check| check.passed == Some(false));
    html! {
        details open[failed] {
            summary { (checks.len()) " checks" }
            div.scroll { table {
                thead { tr { th { "check" } th { "expected" } th { "found" } th { "tolerance" } th { "" } th { "why" } } }
                tbody { @for check in checks {
                    tr {
                        td { (check.name) }
                        td { (shown(&check.expected)) }
                        td { (shown(&check.found)) }
                        td { @if check.tolerance > 0.0 { (format!("{:.1e}", check.tolerance)) } }
                        td { (verdict_mark(check.passed)) }
                        td { (check.reason) }
                    }
                } }
            } }
        }
    }
}

fn shown(value: &Value) -> String {
    match value {
        Value::Words(words) => words.clone(),
        Value::Number(number) if *number == 0.0 || (1e-3..1e6).contains(&number.abs()) => {
            let text = format!("{number:.9}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        Value::Number(number) => format!("{number:.4e}"),
    }
}
