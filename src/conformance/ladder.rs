//! Errors over a ladder of steps, and the order they show.
//!
//! ```text
//! error(h) ~ C h^p + floor
//! ```
//!
//! The order p is fitted over the steps whose error lies between [`ABOVE_FLOOR`] times the floor of rounding and [`SMALL`] of the
//! motion: below, rounding decides; above, higher powers of h do. The floor is that of the theory of rounding,
//! [`rounding_floor`], not one read off the errors.

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
    /// Step, error, and floor of rounding there.
    pub points: Vec<(f64, f64, f64)>,
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
    /// Steps and errors in the range in which discretisation decides.
    #[must_use]
    pub fn fitted(&self) -> Vec<(f64, f64)> {
        let inside = |(_, error, floor): &&(f64, f64, f64)| *error > ABOVE_FLOOR * floor && *error < SMALL * self.scale;
        self.points.iter().filter(inside).map(|(step, error, _)| (*step, *error)).collect()
    }

    /// The row about the order of `quantity`; marked as not run where too few errors lie between rounding and coarseness.
    #[must_use]
    pub fn row(&self, subject: &Subject, quantity: &str, expected: f64, tolerance: f64) -> Row {
        let fitted = self.fitted();
        let order = if fitted.len() < FEWEST { None } else { observed_order(&fitted).ok() };
        let floor = self.points.iter().map(|point| point.2).fold(0.0, f64::max);
        let Some(order) = order else {
            let reason = format!(
                "no order to fit: {} of {} errors lie between {ABOVE_FLOOR} times the floor of rounding and {} of the motion, {FEWEST} are needed",
                fitted.len(),
                self.points.len(),
                SMALL
            );
            return Row { expected_order: Some(expected), ..subject.not_run(quantity, &reason).with_floor(floor) };
        };
        let reason = format!(
            "order within {tolerance} over {} steps, errors from {:.1e} to {:.1e}: above, higher powers of h enter, below, rounding",
            fitted.len(),
            fitted[0].1,
            fitted[fitted.len() - 1].1
        );
        let judgement = Judgement { basis: Basis::Order, expected, found: order.slope, tolerance, reason };
        let row = subject.row(quantity, judgement).with_floor(floor);
        Row { order: Some(order.slope), expected_order: Some(expected), ..row }
    }

    /// Order of each error against that of the next coarser step, above the floor.
    #[must_use]
    pub fn local_orders(&self) -> Vec<Option<f64>> {
        let pair = |i: usize| {
            let ((h, e, floor), (h0, e0, _)) = (self.points[i], *self.points.get(i.checked_sub(1)?)?);
            (e > ABOVE_FLOOR * floor && e0 > 0.0).then(|| (e0 / e).ln() / (h0 / h).ln())
        };
        (0..self.points.len()).map(pair).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ladder(power: i32, floor: f64) -> Ladder {
        let points = (0..10).map(|k| 0.2 / f64::from(1 << k)).map(|h| (h, h.powi(power) + 0.5 * floor, floor));
        Ladder { scale: 1.0, points: points.collect() }
    }

    fn subject() -> Subject {
        Subject {
            scenario: "test".to_owned(),
            variant: String::new(),
            configuration: Configuration::RECIPE,
            reference: String::new(),
            steps_per_period: None,
            dt: None,
        }
    }

    #[test]
    fn the_order_is_found_down_to_the_floor_and_a_lost_half_step_is_noticed() {
        use super::super::Verdict;
        let row = ladder(2, 1e-5).row(&subject(), "state_error", 2.0, ORDER_TOLERANCE);
        assert_eq!(row.verdict, Verdict::Passed, "{row:?}");
        let row = ladder(1, 1e-5).row(&subject(), "state_error", 2.0, ORDER_TOLERANCE);
        assert_eq!(row.verdict, Verdict::Failed);
        let row = ladder(2, 1.0).row(&subject(), "state_error", 2.0, ORDER_TOLERANCE);
        assert_eq!(row.verdict, Verdict::NotRun, "an order that nobody saw does not pass");
    }
}
