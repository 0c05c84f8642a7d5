//! Rows in words, for messages and tables.

use super::row::{Physics, Row, Verdict};

impl Verdict {
    /// For readers.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed => "failed",
            Self::NotRun => "not run",
        }
    }
}

impl Physics {
    /// For readers.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Wrong => "wrong",
            Self::NotJudged => "not judged",
        }
    }
}

/// `mode_1_damping` as `mode 1 damping`.
#[must_use]
pub fn quantity_in_words(quantity: &str) -> String {
    let words = quantity.replace('_', " ");
    words.replace("xi1", "ξ₁").replace("hopf", "Hopf")
}

/// Three digits, which is enough to see how far two numbers are apart; none is `none`.
#[must_use]
pub fn short(value: Option<f64>) -> String {
    let Some(value) = value else { return "none".to_owned() };
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e5).contains(&size) => format!("{value:.6}"),
        _ => format!("{value:.2e}"),
    }
}

/// What a row is about: `linear oscillator, damping ratio 0: damping at 377 steps per period (f64, ...)`.
#[must_use]
pub fn about(row: &Row) -> String {
    let variant = if row.variant.is_empty() { String::new() } else { format!(", {}", row.variant) };
    let step = match (row.steps_per_period, row.dt) {
        (Some(steps), _) => format!(" at {steps} steps per period"),
        (None, Some(dt)) => format!(" at dt = {dt:.5}"),
        (None, None) => String::new(),
    };
    let scenario = row.scenario.replace('_', " ");
    format!("{scenario}{variant}: {}{step} ({})", quantity_in_words(&row.quantity), row.configuration.label())
}

/// What was found and what should have been, with the reason of the tolerance or of there being no number.
#[must_use]
pub fn found_and_expected(row: &Row) -> String {
    let (Some(found), Some(expected)) = (row.found, row.expected) else { return row.reason.clone() };
    format!(
        "found {}, predicted {}, off by {}, allowed {} ({})",
        short(row.found),
        short(row.expected),
        short(Some((found - expected).abs())),
        short(row.tolerance),
        row.reason
    )
}

#[cfg(test)]
mod tests {
    use super::super::row::{Basis, Judgement, Subject};
    use super::super::{Configuration, Physics};
    use super::*;

    #[test]
    fn a_row_says_what_was_found_where_and_how_much_is_allowed() {
        let subject = Subject {
            scenario: "linear_oscillator".to_owned(),
            variant: "damping ratio 0".to_owned(),
            configuration: Configuration::SAMPLED_FRICTION,
            reference: String::new(),
            steps_per_period: Some(64),
            dt: Some(0.1),
        };
        let reason = "2 % of the formula".to_owned();
        let judgement = Judgement { basis: Basis::Formula, expected: 0.5, found: 0.75, tolerance: 0.01, reason };
        let row = subject.row("numerical_damping", judgement);
        assert_eq!(row.physics, Physics::NotJudged);
        let start = "linear oscillator, damping ratio 0: numerical damping at 64 steps per period (f64, impulse joints";
        assert!(about(&row).starts_with(start), "{}", about(&row));
        let said = found_and_expected(&row);
        assert_eq!(said, "found 0.750000, predicted 0.500000, off by 0.250000, allowed 0.010000 (2 % of the formula)");
        assert_eq!(found_and_expected(&subject.failed("damping", "the engine refused")), "the engine refused");
    }
}
