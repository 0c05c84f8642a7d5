//! Rows about the frequency and damping of a mode.

use super::experiment::{RIGHT, finish_ladder};
use super::ladder::{Ladder, ORDER_TOLERANCE};
use super::row::{Basis, Judgement, Row, Subject};
use super::theory::hook_damping;
use crate::model::LinearMode;
use std::f64::consts::TAU;

/// Numerical damping follows its formula within this part: the size of the next order at 32 steps per period, 0.9 %, and as much for
/// rounding.
pub const FORMULA_TOLERANCE: f64 = 0.02;

/// Eigenvalues of the matrix of a step are off by some 8 roundings, and the damping is `2/h` times their logarithm.
fn eigenvalue_rounding(step: f64) -> f64 {
    16.0 * f64::EPSILON / step
}

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
    /// Adds the errors of frequency and damping to their ladders.
    pub fn climb(&self, ladders: &mut [Ladder], step: f64) {
        let Self { found, predicted, truth, rounding, .. } = self;
        let parts = |mode: &LinearMode| [mode.angular_frequency, mode.damping];
        for (i, ladder) in ladders.iter_mut().take(2).enumerate() {
            let error = |mode| (parts(mode)[i] - parts(truth)[i]).abs();
            ladder.push(step, error(found), *rounding, Some(error(predicted)));
        }
    }

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
                (2.0 * RIGHT / (10.0 * period)).max(RIGHT * truth.damping.abs()),
                "right: amplitude within 1 % after ten periods, or damping within 1 %",
            ),
        ]
    }

    fn row(&self, quantity: &str, (found, expected, exact): (f64, f64, f64), limit: f64, right: &str) -> Row {
        let reason = format!(
            "2 % of the error that the difference equation has, and {ROUNDINGS} times what rounding does to it; {right}"
        );
        let tolerance = FORMULA_TOLERANCE * (expected - exact).abs()
            + ROUNDINGS * self.rounding
            + self.subject.dt.map_or(0.0, eigenvalue_rounding);
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
            tolerance: FORMULA_TOLERANCE * formula.abs() + ROUNDINGS * self.rounding + eigenvalue_rounding(step),
            reason: reason.to_owned(),
        };
        let limit = 2.0 * RIGHT / (10.0 * TAU / self.truth.angular_frequency);
        let row = self.subject.row(&format!("{}numerical_damping", self.prefix), judgement);
        row.against(0.0, limit).with_floor(self.rounding)
    }
}

/// Adds the ladder rows about frequency and damping; none about a damping whose error is zero.
pub fn finish_modes(rows: &mut Vec<Row>, subject: &Subject, prefix: &str, ladders: [&Ladder; 2], damped: bool) {
    finish_ladder(rows, subject, &format!("{prefix}angular_frequency"), ladders[0], ORDER_TOLERANCE);
    if damped || subject.configuration.substeps > 1 {
        finish_ladder(rows, subject, &format!("{prefix}damping"), ladders[1], ORDER_TOLERANCE);
    }
}
