//! Tables of the report, as texts with the numbers they are sorted by.

use crate::conformance::experiment::is_notable;
use crate::conformance::{Advice, Changes, Fewest, Physics, Report, Row, Verdict};

/// A cell: what is shown, and the number it stands for.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    pub text: String,
    pub key: Option<f64>,
}

/// A table with headings.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    pub headings: Vec<&'static str>,
    pub rows: Vec<Vec<Entry>>,
}

pub(super) fn text(text: impl Into<String>) -> Entry {
    Entry { text: text.into(), key: None }
}

/// A number with as many digits as tell something.
pub(super) fn number(value: Option<f64>) -> Entry {
    let Some(value) = value else { return Entry { text: "–".to_owned(), key: Some(f64::MAX) } };
    let size = value.abs();
    let text = match size {
        0.0 => "0".to_owned(),
        _ if !(1e-3..1e5).contains(&size) => format!("{value:.2e}"),
        _ => format!("{value:.6}"),
    };
    Entry { text, key: Some(value) }
}

pub(super) fn verdict(verdict: Verdict) -> Entry {
    let (word, key) = match verdict {
        Verdict::Passed => ("✓ passed", 2.0),
        Verdict::Failed => ("✗ failed", 0.0),
        Verdict::NotRun => ("– not run", 1.0),
    };
    Entry { text: word.to_owned(), key: Some(key) }
}

pub(super) fn physics(physics: Physics) -> Entry {
    let (word, key) = match physics {
        Physics::Right => ("right", 2.0),
        Physics::Wrong => ("wrong", 0.0),
        Physics::NotJudged => ("–", 1.0),
    };
    Entry { text: word.to_owned(), key: Some(key) }
}

fn fewest(fewest: Fewest) -> Entry {
    match fewest {
        Fewest::Steps(steps) => Entry { text: steps.to_string(), key: Some(f64::from(steps)) },
        Fewest::Never => Entry { text: "none of those run".to_owned(), key: Some(1e8) },
        Fewest::NotRun => Entry { text: "not run".to_owned(), key: Some(1e9) },
    }
}

/// Fewest steps per period for 1 %, and what an oscillation then costs.
pub(super) fn advice(report: &Report) -> Grid {
    let row = |advice: &Advice| {
        let Advice { configuration, amplitude, frequency, hopf, all } = *advice;
        let needed = match (all, worse_of(amplitude, frequency)) {
            (Fewest::Steps(steps), _) | (Fewest::NotRun, Fewest::Steps(steps)) => Some(steps),
            _ => None,
        };
        let cost = needed.zip(report.cost(configuration)).map(|(steps, cost)| f64::from(steps) * cost);
        let cost = cost.map_or(number(None), |cost| Entry { text: format!("{cost:.0}"), key: Some(cost) });
        vec![text(configuration.label()), fewest(amplitude), fewest(frequency), fewest(hopf), cost]
    };
    Grid {
        headings: vec!["configuration", "amplitude", "frequency", "Hopf point", "µs per oscillation"],
        rows: report.advice.iter().map(row).collect(),
    }
}

fn worse_of(a: Fewest, b: Fewest) -> Fewest {
    match (a, b) {
        (Fewest::Steps(a), Fewest::Steps(b)) => Fewest::Steps(a.max(b)),
        _ => Fewest::Never,
    }
}

/// Numerical damping beside its formula.
pub(super) fn damping(rows: &[&Row]) -> Grid {
    let row = |row: &&Row| {
        let ratio = row.found.zip(row.expected).filter(|(_, e)| *e != 0.0).map(|(f, e)| f / e);
        let steps = Entry { text: steps(row), key: row.steps_per_period.map(f64::from) };
        vec![
            text(row.configuration.label()),
            steps,
            number(row.dt),
            number(row.expected),
            number(row.found),
            number(ratio),
            verdict(row.verdict),
            physics(row.physics),
        ]
    };
    Grid {
        headings: vec![
            "configuration",
            "steps/period",
            "dt",
            "formula",
            "measured",
            "measured/formula",
            "as predicted",
            "physics",
        ],
        rows: rows.iter().map(row).collect(),
    }
}

/// Observed orders of convergence.
pub(super) fn orders(rows: &[&Row]) -> Grid {
    let row = |row: &&Row| {
        vec![
            text(row.quantity.replace('_', " ")),
            text(row.configuration.label()),
            number2(row.expected_order),
            number2(row.order),
            number(row.floor),
            verdict(row.verdict),
            text(row.reason.clone()),
        ]
    };
    Grid {
        headings: vec![
            "error of",
            "configuration",
            "expected order",
            "observed",
            "rounding floor",
            "as predicted",
            "how judged",
        ],
        rows: rows.iter().map(row).collect(),
    }
}

/// Numbers at single steps.
pub(super) fn steps_table(rows: &[&Row]) -> Grid {
    let row = |row: &&Row| {
        vec![
            text(row.quantity.replace('_', " ")),
            text(row.configuration.label()),
            Entry { text: steps(row), key: row.steps_per_period.map(f64::from) },
            number(row.expected),
            number(row.found),
            number(row.tolerance),
            verdict(row.verdict),
            number(row.exact),
            number(row.deviation),
            physics(row.physics),
            number2(row.order),
        ]
    };
    Grid {
        headings: vec![
            "quantity",
            "configuration",
            "steps/period",
            "predicted",
            "found",
            "tolerance",
            "as predicted",
            "exact",
            "deviation",
            "physics",
            "local order",
        ],
        rows: rows.iter().map(row).collect(),
    }
}

/// Rows that are not as predicted.
pub(super) fn failures(report: &Report) -> Grid {
    let failed = report.rows.iter().filter(|row| row.verdict == Verdict::Failed);
    let row = |row: &Row| {
        vec![
            text(row.identity()),
            number(row.expected),
            number(row.found),
            number(row.tolerance),
            text(row.reason.clone()),
        ]
    };
    Grid { headings: vec!["row", "predicted", "found", "tolerance", "how judged"], rows: failed.map(row).collect() }
}

/// What changed since an older report.
pub(super) fn changes(changes: &Changes) -> Grid {
    let kinds = [("worse", &changes.worse), ("better", &changes.better), ("moved", &changes.moved)];
    let of = |(word, list): (&str, &Vec<crate::conformance::Change>)| {
        let word = word.to_owned();
        let row = move |change: &crate::conformance::Change| {
            vec![text(word.clone()), text(change.row.clone()), number(change.old), number(change.new)]
        };
        list.iter().map(row).collect::<Vec<_>>()
    };
    Grid { headings: vec!["change", "row", "old", "new"], rows: kinds.into_iter().flat_map(of).collect() }
}

/// Rows of a scenario and variant in configurations that tell most.
pub(super) fn notable<'a>(report: &'a Report, scenario: &str, variant: &str) -> Vec<&'a Row> {
    let wanted = |row: &&Row| row.scenario == scenario && row.variant == variant && is_notable(row.configuration);
    report.rows.iter().filter(wanted).collect()
}

fn number2(value: Option<f64>) -> Entry {
    Entry { text: value.map_or("–".to_owned(), |value| format!("{value:.2}")), key: Some(value.unwrap_or(f64::MAX)) }
}

fn steps(row: &Row) -> String {
    row.steps_per_period.map_or("all".to_owned(), |steps| steps.to_string())
}
