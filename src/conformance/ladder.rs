//! Errors over a ladder of steps, and the order they show.
//!
//! ```text
//! error(h) ~ C h^p + floor
//! ```
//!
//! Two orders are looked at. For the second-order scheme the order p must be 2, fitted over the steps whose error lies between
//! [`ABOVE_FLOOR`] times the floor of rounding and [`SMALL`] of the motion: below, rounding decides; above, higher powers of h do. In
//! every other configuration terms of first and second order mix, and the order must be that of the difference equation over the same
//! steps, above the floor. The floor is that of the theory of rounding, [`rounding_floor`], not one read off the errors.

use super::Configuration;
use super::row::{Basis, Judgement, Row, Subject};
use crate::compare::observed_order;

/// Errors below this many floors are not fitted: there rounding may change the slope by a tenth.
pub const ABOVE_FLOOR: f64 = 8.0;
/// Errors above this part of the motion are not fitted.
pub const SMALL: f64 = 0.1;
/// An order is right within this much.
pub const ORDER_TOLERANCE: f64 = 0.1;
/// Fewer points show no order.
const FEWEST: usize = 3;

/// Errors of one quantity in one configuration, coarse to fine.
#[derive(Debug, Clone, PartialEq)]
pub struct Ladder {
    /// Size of the quantity, against which an error is small.
    pub scale: f64,
    pub points: Vec<Rung>,
    /// Whether the order is that of the difference equation even for configurations of second order: for quantities that scatter with the place
    /// of a switch within a step.
    scatters: bool,
}

/// An error at one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rung {
    pub step: f64,
    pub error: f64,
    /// Floor of rounding.
    pub floor: f64,
    /// Error of the difference equation, where it is known.
    pub predicted: Option<f64>,
}

/// What rounding does to a motion of size `scale` over a time t in steps of h: each of t/h roundings moves the motion by the unit
/// roundoff u at random, and the rounding of h itself makes time run wrong by up to u.
///
/// ```text
/// u scale (sqrt(t/h) + t)
/// ```
#[must_use]
pub fn rounding_floor(configuration: Configuration, scale: f64, t: f64, step: f64) -> f64 {
    configuration.unit_roundoff() * scale * ((t / step).sqrt() + t)
}

impl Ladder {
    /// Without points.
    #[must_use]
    pub fn new(scale: f64) -> Self {
        Self { scale, points: Vec::new(), scatters: false }
    }

    /// Without points, of a quantity that scatters with the place of a switch within a step.
    #[must_use]
    pub fn scattering(scale: f64) -> Self {
        Self { scatters: true, ..Self::new(scale) }
    }

    /// Adds an error at a step.
    pub fn push(&mut self, step: f64, error: f64, floor: f64, predicted: Option<f64>) {
        self.points.push(Rung { step, error, floor, predicted });
    }

    /// The row about the order of `quantity`, none where theory says nothing about it. Marked as not run where too few errors lie
    /// between rounding and coarseness.
    #[must_use]
    pub fn row(&self, subject: &Subject, quantity: &str, tolerance: f64) -> Option<Row> {
        let second = subject.configuration.expected_order() == 2.0 && !self.scatters;
        let largest = if second { SMALL * self.scale } else { f64::INFINITY };
        let fitted: Vec<&Rung> =
            self.points.iter().filter(|p| p.error > ABOVE_FLOOR * p.floor && p.error < largest).collect();
        let order = |errors: Vec<(f64, f64)>| {
            if errors.len() < FEWEST { None } else { observed_order(&errors).ok().map(|order| order.slope) }
        };
        let predicted: Option<Vec<_>> = fitted.iter().map(|p| Some((p.step, p.predicted?))).collect();
        let floor = self.points.iter().map(|point| point.floor).fold(0.0, f64::max);
        let expected = if second { Some(2.0) } else { order(predicted?) };
        let found = order(fitted.iter().map(|p| (p.step, p.error)).collect());
        let (Some(expected), Some(found)) = (expected, found) else {
            let reason = format!(
                "no order to fit: {} of {} errors lie between {ABOVE_FLOOR} times the floor of rounding and coarseness, {FEWEST} are needed",
                fitted.len(),
                self.points.len()
            );
            return Some(subject.not_run(quantity, &reason).with_floor(floor));
        };
        let range = format!(
            "over {} steps, errors from {:.1e} to {:.1e}",
            fitted.len(),
            fitted[0].error,
            fitted[fitted.len() - 1].error
        );
        let (basis, reason) = if second {
            (
                Basis::Order,
                format!("order 2 within {tolerance} {range}: above, higher powers of h enter, below, rounding"),
            )
        } else {
            (Basis::DifferenceEquation, format!("order of the difference equation within {tolerance} {range}"))
        };
        let row = subject.row(quantity, Judgement { basis, expected, found, tolerance, reason }).with_floor(floor);
        Some(Row { order: Some(found), expected_order: Some(expected), ..row })
    }

    /// Order of each error against that of the next coarser step, above the floor.
    #[must_use]
    pub fn local_orders(&self) -> Vec<Option<f64>> {
        let pair = |i: usize| {
            let (fine, coarse) = (self.points[i], *self.points.get(i.checked_sub(1)?)?);
            let shown = fine.error > ABOVE_FLOOR * fine.floor && coarse.error > 0.0;
            shown.then(|| (coarse.error / fine.error).ln() / (coarse.step / fine.step).ln())
        };
        (0..self.points.len()).map(pair).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ladder(power: i32, floor: f64) -> Ladder {
        let mut ladder = Ladder::new(1.0);
        for h in (0..10).map(|k| 0.2 / f64::from(1 << k)) {
            ladder.push(h, h.powi(power) + 0.5 * floor, floor, None);
        }
        ladder
    }

    fn subject() -> Subject {
        Subject {
            scenario: "test".to_owned(),
            variant: String::new(),
            configuration: Configuration::SAMPLED_FRICTION,
            reference: String::new(),
            steps_per_period: None,
            dt: None,
        }
    }

    #[test]
    fn the_order_is_found_down_to_the_floor_and_a_lost_half_step_is_noticed() {
        use super::super::Verdict;
        let row = ladder(2, 1e-5).row(&subject(), "state_error", ORDER_TOLERANCE).unwrap();
        assert_eq!(row.verdict, Verdict::Passed, "{row:?}");
        let row = ladder(1, 1e-6).row(&subject(), "state_error", ORDER_TOLERANCE).unwrap();
        assert_eq!(row.verdict, Verdict::Failed);
        let row = ladder(2, 1.0).row(&subject(), "state_error", ORDER_TOLERANCE).unwrap();
        assert_eq!(row.verdict, Verdict::NotRun, "an order that nobody saw does not pass");
    }
}
