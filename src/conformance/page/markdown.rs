//! `report.md`: the answer, the tables, the failures; charts are in the page.

use super::answer::{FORMULA, HOW_TO_READ, MULTIBODY, RECIPE, answer};
use super::tables::{self, Grid};
use crate::conformance::{Changes, Report, Row};
use std::fmt::Write;

/// The report as Markdown.
#[must_use]
pub fn markdown(report: &Report, changes: Option<&Changes>) -> String {
    let mut page = String::from("# How wrong is the physics engine?\n\n");
    let mut say = |line: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(page, "{line}\n");
    };
    answer(report).iter().for_each(|sentence| say(sentence));
    if report.tally.failed > 0 {
        say("## Not as predicted");
        say(&grid(&tables::failures(report)));
    }
    if let Some(changes) = changes {
        say("## Changes");
        say(&summary(changes));
        say(&grid(&tables::changes(changes)));
    }
    say("## Fewest steps per period for 1 %");
    say(&grid(&tables::advice(report)));
    say("## How to read this");
    HOW_TO_READ.iter().for_each(|line| say(line));
    say(RECIPE);
    say(MULTIBODY);
    say("## Numerical damping at dt = 1/60");
    say(FORMULA);
    let damping = |row: &&Row| row.quantity == "numerical_damping" && row.steps_per_period == Some(377);
    say(&grid(&tables::damping(&report.rows.iter().filter(damping).collect::<Vec<_>>())));
    for note in &report.scenarios {
        say(&format!("## {}", note.title));
        say(&note.description);
        say(&format!("Reference: {}.", note.reference));
        let orders =
            |row: &&Row| row.scenario == note.id && row.expected_order.is_some() && row.steps_per_period.is_none();
        let rows: Vec<&Row> = report.rows.iter().filter(orders).collect();
        if !rows.is_empty() {
            say(&grid(&tables::orders(&rows)));
        }
    }
    say("## Where and with what");
    provenance(report).iter().for_each(|line| say(line));
    page
}

/// Versions, machine, fingerprint.
pub(super) fn provenance(report: &Report) -> Vec<String> {
    let mut lines = vec![
        format!(
            "stickslip {}, engines {}; {:?} run.",
            report.stickslip,
            report.engines.join(", "),
            report.parameters.depth
        ),
        format!("{}, {} cores, {}.", report.machine.cpu, report.machine.cores, report.machine.system),
        format!("SHA-256 of all rows, trajectories included: {}.", report.rows_sha256),
    ];
    if let Some(timing) = &report.timing {
        lines.push(format!(
            "{:.0} s for the rows. Costs are the fastest of three runs on the machine as it was; under load they are upper bounds.",
            timing.seconds
        ));
    }
    lines
}

/// One sentence about the changes.
pub(super) fn summary(changes: &Changes) -> String {
    format!(
        "Against the older report: {} rows worse, {} better, {} numbers moved beyond their tolerance, {} rows new, {} gone; {} of {} common rows have \
         other trajectories bit for bit{}.",
        changes.worse.len(),
        changes.better.len(),
        changes.moved.len(),
        changes.added,
        changes.gone.len(),
        changes.other_trajectories,
        changes.common,
        if changes.engines.is_empty() {
            String::new()
        } else {
            format!("; it was made with {}", changes.engines.join(", "))
        }
    )
}

fn grid(grid: &Grid) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut text = line(grid.headings.iter().map(|&heading| heading.to_owned()).collect());
    text += &line(vec!["---".to_owned(); grid.headings.len()]);
    for row in &grid.rows {
        text += &line(row.iter().map(|entry| entry.text.replace('|', "/")).collect());
    }
    text
}
