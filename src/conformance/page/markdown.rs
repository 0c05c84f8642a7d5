//! `report.md`: the answer, the tables, the failures; charts are in the page.

use super::advice::{self, FEWEST_CAPTION};
use super::answer::{DERIVATION, FAULTS, FORMULA, HOW_TO_READ, MULTIBODY, SCHEME, STEPS, WHY, answer, steps_for_all};
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
    say("## Fewest steps per period for 1 %");
    say(&grid(&advice::fewest_steps(report)));
    say(FEWEST_CAPTION);
    say(STEPS);
    if report.tally.failed > 0 {
        say("## Not as predicted");
        say(&grid(&tables::failures(report)));
    }
    if let Some(changes) = changes {
        say("## Changes");
        say(&summary(changes));
        say(&grid(&tables::changes(changes)));
    }
    say("## Why this, and not its neighbours");
    WHY.iter().for_each(|line| say(line));
    if let Some(steps) = steps_for_all(report) {
        say(&format!("Errors at {steps} steps per period, in per cent of the quantity or of the size of the motion:"));
        say(&grid(&advice::comparison(report, steps)));
    }
    say("## Whose fault is what");
    for [error, whose, size, help] in FAULTS {
        say(&format!("- {error}: {whose}; {size}. Helps: {help}."));
    }
    say("## How to read this");
    HOW_TO_READ.iter().for_each(|line| say(line));
    say(SCHEME);
    say(MULTIBODY);
    say("## Numerical damping at dt = 1/60");
    say(FORMULA);
    say(DERIVATION);
    let damping = |row: &&Row| row.quantity == "numerical_damping" && row.steps_per_period == Some(377);
    say(&grid(&tables::damping(&report.rows.iter().filter(damping).collect::<Vec<_>>())));
    for note in &report.scenarios {
        say(&format!("## {}", note.title));
        say(&note.description);
        say(&format!("Reference: {}.", note.reference));
        let hopf = advice::hopf(report);
        if note.id == "secondary_hopf" && !hopf.rows.is_empty() {
            say(&grid(&hopf));
        }
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

/// What was compared, and what came of it.
pub(super) fn summary(changes: &Changes) -> String {
    let Changes { worse, gone, added_failed, better, moved, other_reasons, added, .. } = changes;
    let engines = if changes.engines.is_empty() {
        String::new()
    } else {
        format!(" The older run was made with {}.", changes.engines.join(", "))
    };
    let verdict = if changes.acceptable() { "Nothing got worse" } else { "Something got worse" };
    format!(
        "{verdict}: of {} rows in both runs {} are worse (by verdict, passed < not run < failed, by physics, right < not judged < wrong, or \
         without their number) and {} better; {} rows are gone, {} are new and failed, which count as worse; {} others are new. Told only, for between \
         processors numbers differ in rounding: {} numbers moved beyond their tolerance, {} rows without a number have another reason, {} trajectories are \
         others bit for bit.{engines}",
        changes.common,
        worse.len(),
        better.len(),
        gone.len(),
        added_failed.len(),
        added.len() - added_failed.len(),
        moved.len(),
        other_reasons.len(),
        changes.other_trajectories,
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
