//! Rows about the frequency and damping of a mode.

use super::configuration::Configuration;
use super::experiment::RIGHT;
use super::row::{Basis, Judgement, Row, Subject};
use super::theory::hook_damping;
use crate::engine::Scheme;
use crate::model::LinearMode;
use std::f64::consts::TAU;

/// Numerical damping follows its formula within this part: the size of the next order at 32 steps per period, 0.9 %, and as much for
/// rounding.
pub const FORMULA_TOLERANCE: f64 = 0.02;

/// Rounding errors of the fit, in floors.
const ROUNDINGS: f64 = 16.0;

/// A mode as it was found, as the difference equation has it, and as it is.
#[derive(Debug, Clone, Copy)]
pub struct ModeAt<'a> {
    pub subject: &'a Subject,
    /// In front of the quantities: empty, or such as `mode_1_`.
    pub prefix: &'a str,
    pub found: LinearMode,
    pub predicted: LinearMode,
    pub truth: LinearMode,
    /// What rounding does to a frequency or damping.
    pub rounding: f64,
}

impl ModeAt<'_> {
    /// Frequency and damping against the difference equation and the exact mode.
    #[must_use]
    pub fn rows(&self) -> [Row; 2] {
        let Self { found, predicted, truth, .. } = self;
        let period = TAU / truth.angular_frequency;
        [
            self.row(
                "angular_frequency",
                (found.angular_frequency, predicted.angular_frequency, truth.angular_frequency),
                RIGHT * truth.angular_frequency,
                "right: within 1 %",
            ),
            self.row(
                "damping",
                (found.damping, predicted.damping, truth.damping),
                // e^(-d t/2) changes by 1 % where d t/2 = 0.01.
                2.0 * RIGHT / (10.0 * period),
                "right: amplitude within 1 % after ten periods",
            ),
        ]
    }

    fn row(&self, quantity: &str, (found, expected, exact): (f64, f64, f64), limit: f64, right: &str) -> Row {
        let reason = format!("{ROUNDINGS} times what rounding does to the difference equation; {right}");
        let tolerance = ROUNDINGS * self.rounding;
        let judgement = Judgement { basis: Basis::DifferenceEquation, expected, found, tolerance, reason };
        let row = self.subject.row(&format!("{}{quantity}", self.prefix), judgement);
        row.against(exact, limit).with_floor(self.rounding)
    }

    /// Damping of an undamped mode against the closed formula.
    #[must_use]
    pub fn formula_row(&self, step: f64) -> Row {
        let formula = hook_damping(self.truth.angular_frequency, step, self.subject.configuration.substeps);
        let reason =
            "2 % of -ω² h (1 - (n+1)/(2n)), and what rounding does; right: amplitude within 1 % after ten periods";
        let judgement = Judgement {
            basis: Basis::Formula,
            expected: formula,
            found: self.found.damping,
            tolerance: FORMULA_TOLERANCE * formula.abs() + ROUNDINGS * self.rounding,
            reason: reason.to_owned(),
        };
        let limit = 2.0 * RIGHT / (10.0 * TAU / self.truth.angular_frequency);
        let row = self.subject.row(&format!("{}numerical_damping", self.prefix), judgement);
        row.against(0.0, limit).with_floor(self.rounding)
    }
}

/// Orders to expect of frequency and damping errors; none where the error is zero.
#[must_use]
pub fn expected_orders(configuration: Configuration, damped: bool) -> [Option<f64>; 2] {
    let recipe = configuration.scheme == Scheme::SecondOrder && configuration.substeps == 1;
    let frequency = if recipe || !damped { 2.0 } else { 1.0 };
    let damping = match (recipe, configuration.substeps, damped) {
        (_, 1, false) => None,
        (true, _, true) => Some(2.0),
        _ => Some(1.0),
    };
    [Some(frequency), damping]
}
