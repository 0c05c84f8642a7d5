//! Tables of the report, as texts with the numbers they are sorted by.

use crate::conformance::experiment::is_notable;
use crate::conformance::{Change, Changes, Physics, Report, Row, Verdict, about, quantity_in_words};

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
    let Some(value) = value else { return none() };
    let text = match value.abs() {
        0.0 => "0".to_owned(),
        size if !(1e-3..1e5).contains(&size) => format!("{value:.2e}"),
        _ => format!("{value:.6}"),
    };
    Entry { text, key: Some(value) }
}

/// Two significant digits: what differs in later ones tells nothing.
pub(super) fn rough(value: Option<f64>) -> Entry {
    let Some(value) = value.filter(|value| value.is_finite()) else { return none() };
    let text = match value.abs() {
        0.0 => "0".to_owned(),
        size if !(1e-3..1e5).contains(&size) => format!("{value:.1e}"),
        _ => {
            // Rounded first: 9.97 has no decimal of two digits.
            let rounded: f64 = format!("{value:.1e}").parse().unwrap_or(value);
            let decimals = (1.0 - rounded.abs().log10().floor()).max(0.0);
            format!("{rounded:.*}", decimals as usize)
        }
    };
    Entry { text, key: Some(value) }
}

fn none() -> Entry {
    Entry { text: "–".to_owned(), key: Some(f64::MAX) }
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

fn variant(row: &Row) -> Entry {
    text(if row.variant.is_empty() { "–" } else { row.variant.as_str() })
}

/// Numerical damping beside its formula.
pub(super) fn damping(rows: &[&Row]) -> Grid {
    let row = |row: &&Row| {
        let ratio = row.found.zip(row.expected).filter(|(_, e)| *e != 0.0).map(|(f, e)| f / e);
        vec![
            text(row.configuration.label()),
            steps(row),
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
            variant(row),
            text(quantity_in_words(&row.quantity)),
            text(row.configuration.label()),
            number2(row.expected_order),
            number2(row.order),
            rough(row.floor),
            verdict(row.verdict),
            text(row.reason.clone()),
        ]
    };
    Grid {
        headings: vec![
            "variant",
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
            text(quantity_in_words(&row.quantity)),
            text(row.configuration.label()),
            steps(row),
            number(row.expected),
            number(row.found),
            rough(row.tolerance),
            verdict(row.verdict),
            number(row.exact),
            rough(row.deviation),
            rough(row.limit),
            physics(row.physics),
            number2(row.order),
            text(row.reason.clone()),
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
            "off by",
            "1 % limit",
            "physics",
            "local order",
            "how judged",
        ],
        rows: rows.iter().map(row).collect(),
    }
}

/// Rows that are not as predicted.
pub(super) fn failures(report: &Report) -> Grid {
    let failed = report.rows.iter().filter(|row| row.verdict == Verdict::Failed);
    let row = |row: &Row| {
        let off = row.found.zip(row.expected).map(|(found, expected)| (found - expected).abs());
        vec![
            text(about(row)),
            number(row.found),
            number(row.expected),
            rough(off),
            rough(row.tolerance),
            text(row.reason.clone()),
        ]
    };
    Grid {
        headings: vec!["what", "found", "predicted", "off by", "allowed", "how judged, or why there is no number"],
        rows: failed.map(row).collect(),
    }
}

/// What changed since an older run.
pub(super) fn changes(changes: &Changes) -> Grid {
    let in_both = [
        ("worse", &changes.worse),
        ("better", &changes.better),
        ("moved", &changes.moved),
        ("other reason", &changes.other_reasons),
    ];
    let of = |(word, list): (&'static str, &Vec<Change>)| {
        list.iter().map(|change| [word.to_owned(), change.row.clone(), change.in_words()]).collect::<Vec<_>>()
    };
    let alone = |word: &'static str, list: &[String]| {
        list.iter().map(|row| [word.to_owned(), row.clone(), String::new()]).collect::<Vec<_>>()
    };
    let new: Vec<String> = changes.added.iter().filter(|row| !changes.added_failed.contains(row)).cloned().collect();
    let rows = in_both
        .into_iter()
        .flat_map(of)
        .chain(alone("gone", &changes.gone))
        .chain(alone("new and failed", &changes.added_failed))
        .chain(alone("new", &new));
    Grid { headings: vec!["change", "row", "what"], rows: rows.map(|cells| cells.map(text).to_vec()).collect() }
}

/// Rows of a scenario and variant in configurations that tell most.
pub(super) fn notable<'a>(report: &'a Report, scenario: &str, variant: &str) -> Vec<&'a Row> {
    let wanted = |row: &&Row| row.scenario == scenario && row.variant == variant && is_notable(row.configuration);
    report.rows.iter().filter(wanted).collect()
}

fn number2(value: Option<f64>) -> Entry {
    Entry { text: value.map_or("–".to_owned(), |value| format!("{value:.2}")), key: Some(value.unwrap_or(f64::MAX)) }
}

fn steps(row: &Row) -> Entry {
    let text = row.steps_per_period.map_or("–".to_owned(), |steps| steps.to_string());
    Entry { text, key: row.steps_per_period.map(f64::from) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_numbers_have_two_digits() {
        let shown = |value| rough(Some(value)).text;
        assert_eq!([1819.3, 94.96, 9.97, 9.44, 0.01578].map(shown), ["1800", "95", "10", "9.4", "0.016"]);
        assert_eq!([1.25e-7, 2.04e6, 0.0].map(shown), ["1.2e-7", "2.0e6", "0"]);
        assert_eq!(rough(None).text, "–");
    }
}
