//! How well a motion of another engine meets the reference of a set-up.
//!
//! ```text
//! state error     max over t_n <= state_until, i of |y_i(t_n) - exact|, y = x and, where given, v and f;  right within 1 % of the motion
//! maxima          largest difference of a maximum of x1 from the exact one nearest in time;               right within 1 % of the motion
//! other numbers   taken from both motions in the same way from the time `from` on;                        right within 1 % of the exact one
//! ```
//!
//! Mean maximum and frequency of a modulated or chaotic motion are means over a record of finite length: four standard errors of the difference of
//! two such means are right too. Standard errors are those of the reference, so that no motion widens its own limit.

use super::setup::{Quantity, Setup};
use super::table::{Table, motion_of};
use crate::compare::Cycles;
use crate::conformance::ConformanceError;
use crate::conformance::experiment::RIGHT;
use crate::dynamics::{State, Trajectory};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::SQRT_2;
use std::path::Path;

/// Sample times may be off by the rounding of another program's output.
const SAME_TIME: f64 = 1e-6;
/// Standard errors of a difference: one in 16000 lies beyond by chance.
const DEVIATIONS: f64 = 4.0;
/// With fewer maxima there is no oscillation to take numbers from.
const FEWEST_MAXIMA: usize = 3;

/// How well a motion of another engine meets the reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Score {
    pub file: String,
    pub setup: String,
    pub checks: Vec<ScoreCheck>,
    /// What the file does not hold, so that it was not looked at.
    pub not_judged: Vec<String>,
    pub right: bool,
}

/// One measure of a score.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScoreCheck {
    pub quantity: String,
    /// Distance from the reference; none where the motion has no such quantity, which is wrong since the reference has it.
    pub error: Option<f64>,
    pub limit: f64,
    pub right: bool,
}

impl Setup {
    /// Scores the trajectory in a CSV file.
    ///
    /// # Errors
    /// [`ConformanceError::File`] if the file is not a table of numbers with the columns and times of this set-up.
    pub fn judge(&self, path: &Path) -> Result<Score, ConformanceError> {
        let table = Table::read(path, self.mass.len(), self.jenkins.len())?;
        self.check_times(&table)?;
        let given = |count: fn(&State) -> usize| table.points.iter().all(|(_, state)| count(state) > 0);
        let (velocities, forces) =
            (given(|s| s.velocities.len()), self.jenkins.is_empty() || given(|s| s.slider_forces.len()));
        if self.prescribed.is_some() && !forces {
            return Err(
                table.bad("has no slider forces f1, ..., which is all that this motion is judged by".to_owned())
            );
        }
        let (motion, exact) = (motion_of(&table.points), motion_of(&self.reference));
        let mut checks: Vec<ScoreCheck> = self.state_check(&motion, &exact).into_iter().collect();
        let mut not_judged = Vec::new();
        for quantity in &self.judged.quantities {
            let name = name(*quantity);
            if !velocities && *quantity != Quantity::LoopArea {
                not_judged.push(format!("{name}: needs velocities"));
            } else if let Some((error, limit)) = self.error_and_limit(*quantity, &motion, &exact) {
                checks.push(check(&name, error, limit));
            }
        }
        if !velocities {
            not_judged.push("velocities".to_owned());
        }
        if !forces {
            not_judged.push("slider forces".to_owned());
        }
        let right = !checks.is_empty() && checks.iter().all(|check| check.right);
        Ok(Score { file: path.display().to_string(), setup: self.name.clone(), checks, not_judged, right })
    }

    fn check_times(&self, table: &Table) -> Result<(), ConformanceError> {
        let (found, expected) = (table.points.len(), self.reference.len());
        if found != expected {
            return Err(table.bad(format!("has {found} samples, expected the {expected} of {}.csv", self.name)));
        }
        let pairs = table.points.iter().zip(&self.reference);
        match pairs.enumerate().find(|(_, ((a, _), (b, _)))| (a - b).abs() > SAME_TIME) {
            Some((i, ((a, _), (b, _)))) => Err(table.bad(format!("row {}: t = {a}, expected {b}", i + 1))),
            None => Ok(()),
        }
    }

    fn state_check(&self, motion: &Trajectory, exact: &Trajectory) -> Option<ScoreCheck> {
        let until = self.judged.state_until?;
        let pairs = motion.samples.iter().zip(&exact.samples).filter(|(_, b)| b.time <= until + SAME_TIME);
        let error = pairs.fold(0.0, |error: f64, (a, b)| {
            let (a, b) = (&a.state, &b.state);
            let x = a.positions.iter().zip(&b.positions);
            let v = a.velocities.iter().zip(&b.velocities);
            let f = a.slider_forces.iter().zip(&b.slider_forces);
            x.chain(v).chain(f).fold(error, |error, (a, b)| error.max((a - b).abs()))
        });
        Some(check("state", Some(error), RIGHT * scale(exact)))
    }

    /// None if the reference has no such quantity.
    fn error_and_limit(
        &self,
        quantity: Quantity,
        motion: &Trajectory,
        exact: &Trajectory,
    ) -> Option<(Option<f64>, f64)> {
        if quantity == Quantity::LoopArea {
            let period = std::f64::consts::TAU / self.prescribed?.angular_frequency;
            let [found, expected] = [motion, exact].map(|motion| loop_area(motion, self.t_end - period));
            return Some((Some((found - expected).abs()), RIGHT * expected.abs()));
        }
        let [found, reference] = [motion, exact].map(|motion| self.settled(motion));
        if reference.maxima.len() < FEWEST_MAXIMA {
            return None;
        }
        if quantity == Quantity::Maxima {
            return Some((reference.inner(exact).amplitude_error(&found), RIGHT * scale(exact)));
        }
        let expected = number(quantity, &reference)?;
        let chance = match quantity {
            Quantity::MeanMaximum => reference.standard_error_of_mean(),
            Quantity::AngularFrequency => reference.standard_error_of_frequency(),
            _ => None,
        };
        let limit = (RIGHT * expected.abs()).max(DEVIATIONS * SQRT_2 * chance.unwrap_or(0.0));
        Some((number(quantity, &found).map(|found| (found - expected).abs()), limit))
    }

    fn settled(&self, motion: &Trajectory) -> Cycles {
        let mut cycles = Cycles::of(motion, 0);
        cycles.maxima.retain(|maximum| maximum.time >= self.judged.from);
        cycles.upward_zeros.retain(|time| *time >= self.judged.from);
        cycles
    }
}

/// Of all that is not [`Quantity::Maxima`] or [`Quantity::LoopArea`].
fn number(quantity: Quantity, cycles: &Cycles) -> Option<f64> {
    let values = || cycles.maxima.iter().map(|maximum| maximum.value);
    match quantity {
        Quantity::MeanMaximum => cycles.mean_maximum(),
        Quantity::LargestMaximum => values().reduce(f64::max),
        Quantity::SmallestMaximum => values().reduce(f64::min),
        Quantity::AngularFrequency => cycles.angular_frequency(),
        Quantity::ModulationFrequency => cycles.modulation_frequency(),
        Quantity::Maxima | Quantity::LoopArea => None,
    }
}

/// Area under f1 over x1 from a time on, by the trapezoidal rule.
fn loop_area(motion: &Trajectory, from: f64) -> f64 {
    let first = |values: &[f64]| values.first().copied().unwrap_or(f64::NAN);
    let pairs = motion.samples.windows(2).filter(|pair| pair[0].time >= from - SAME_TIME);
    pairs
        .map(|pair| {
            let (a, b) = (&pair[0].state, &pair[1].state);
            0.5 * (first(&a.slider_forces) + first(&b.slider_forces)) * (first(&b.positions) - first(&a.positions))
        })
        .sum()
}

/// Largest position.
fn scale(exact: &Trajectory) -> f64 {
    exact.samples.iter().flat_map(|sample| &sample.state.positions).fold(0.0, |scale: f64, x| scale.max(x.abs()))
}

fn name(quantity: Quantity) -> String {
    let word = match quantity {
        Quantity::Maxima => "maxima",
        Quantity::MeanMaximum => "mean maximum",
        Quantity::LargestMaximum => "largest maximum",
        Quantity::SmallestMaximum => "smallest maximum",
        Quantity::AngularFrequency => "angular frequency",
        Quantity::ModulationFrequency => "modulation frequency",
        Quantity::LoopArea => "loop area",
    };
    word.to_owned()
}

fn check(quantity: &str, error: Option<f64>, limit: f64) -> ScoreCheck {
    let right = error.is_some_and(|error| error <= limit);
    ScoreCheck { quantity: quantity.to_owned(), error, limit, right }
}
