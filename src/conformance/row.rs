//! One number of the report and what is thought of it. Two questions are asked, and never mixed:
//!
//! ```text
//! verdict   is it what the theory of this configuration predicts?   |found - expected| <= tolerance
//! physics   is it what the equations of motion say?                 |found - exact| <= limit
//! ```
//!
//! A configuration that pumps energy in exactly as its formula says passes, and is physically wrong. One that does anything else
//! fails, even where it happens to be closer to the truth.

use super::configuration::Configuration;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Whether a number is what was predicted. What was not computed never passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    Passed,
    Failed,
    NotRun,
}

/// Whether a number is what the equations of motion say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Physics {
    Right,
    Wrong,
    /// The number has no counterpart in the equations of motion (an order of convergence), or was not computed.
    NotJudged,
}

/// Where an expected value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Basis {
    /// A closed formula for the error of the configuration, such as that of numerical damping.
    Formula,
    /// The difference equation that the configuration should be, iterated or solved for its eigenvalues (`theory`).
    DifferenceEquation,
    /// The exact solution of the equations of motion.
    Exact,
    /// The order of convergence that theory gives.
    Order,
}

/// A row of the report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Row {
    pub scenario: String,
    /// Which of the cases of the scenario, such as `damping ratio 0.1`; empty if there is one only.
    pub variant: String,
    /// Name and version of the engine.
    pub engine: String,
    #[serde(flatten)]
    pub configuration: Configuration,
    /// Steps per period of the motion; none for rows about a whole ladder of steps.
    pub steps_per_period: Option<u32>,
    /// Step, in units of 1/angular frequency of the sticking rig.
    pub dt: Option<f64>,
    pub quantity: String,
    pub basis: Option<Basis>,
    pub expected: Option<f64>,
    pub found: Option<f64>,
    /// Largest |found - expected| that passes.
    pub tolerance: Option<f64>,
    pub verdict: Verdict,
    /// What the equations of motion say.
    pub exact: Option<f64>,
    /// |found - exact|.
    pub deviation: Option<f64>,
    /// Largest deviation that counts as physically right.
    pub limit: Option<f64>,
    pub physics: Physics,
    /// Observed order: against the next coarser step in rows with a step, fitted in rows about a ladder.
    pub order: Option<f64>,
    pub expected_order: Option<f64>,
    /// Level below which rounding hides the discretisation.
    pub floor: Option<f64>,
    /// Why the tolerance is what it is, or why there is no number.
    pub reason: String,
    /// What the exact value comes from.
    pub reference: String,
    /// SHA-256 of the engine's trajectory.
    pub trajectory: Option<String>,
}

/// What a row is about.
#[derive(Debug, Clone, PartialEq)]
pub struct Subject {
    pub scenario: String,
    pub variant: String,
    pub configuration: Configuration,
    pub reference: String,
    pub steps_per_period: Option<u32>,
    pub dt: Option<f64>,
}

/// A found number beside the one that was predicted.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    pub basis: Basis,
    pub expected: f64,
    pub found: f64,
    pub tolerance: f64,
    /// Why the tolerance is what it is.
    pub reason: String,
}

impl Subject {
    /// The same at a step: `steps` per period of length `period`.
    #[must_use]
    pub fn at(&self, steps: u32, period: f64) -> Self {
        Self { steps_per_period: Some(steps), dt: Some(period / f64::from(steps)), ..self.clone() }
    }

    /// A row with a number in it. Numbers that are not finite fail.
    #[must_use]
    pub fn row(&self, quantity: &str, judgement: Judgement) -> Row {
        let Judgement { basis, expected, found, tolerance, reason } = judgement;
        let passed = (found - expected).abs() <= tolerance;
        let mut row = self.empty(quantity, Verdict::Failed, &reason);
        if !found.is_finite() {
            row.reason = format!("found {found}, which is no number to judge");
        }
        row.basis = Some(basis);
        row.expected = finite(expected);
        row.found = finite(found);
        row.tolerance = finite(tolerance);
        row.verdict = if passed { Verdict::Passed } else { Verdict::Failed };
        row
    }

    /// A row without a number, because something went wrong.
    #[must_use]
    pub fn failed(&self, quantity: &str, reason: &str) -> Row {
        self.empty(quantity, Verdict::Failed, reason)
    }

    /// A row without a number, because nobody computed it.
    #[must_use]
    pub fn not_run(&self, quantity: &str, reason: &str) -> Row {
        self.empty(quantity, Verdict::NotRun, reason)
    }

    fn empty(&self, quantity: &str, verdict: Verdict, reason: &str) -> Row {
        Row {
            scenario: self.scenario.clone(),
            variant: self.variant.clone(),
            engine: self.configuration.engine(),
            configuration: self.configuration,
            steps_per_period: self.steps_per_period,
            dt: self.dt,
            quantity: quantity.to_owned(),
            basis: None,
            expected: None,
            found: None,
            tolerance: None,
            verdict,
            exact: None,
            deviation: None,
            limit: None,
            physics: Physics::NotJudged,
            order: None,
            expected_order: None,
            floor: None,
            reason: reason.to_owned(),
            reference: self.reference.clone(),
            trajectory: None,
        }
    }
}

impl Row {
    /// With the number that the equations of motion give, and how far off still counts as right. A prediction that is looser than that and than the
    /// error it predicts says nothing: the row is not run. Of a formula that is the formula's fault, and the number found stays judged against the
    /// truth; of statistics and roundings it is the number's.
    #[must_use]
    pub fn against(mut self, exact: f64, limit: f64) -> Self {
        let deviation = self.found.map(|found| (found - exact).abs());
        self.exact = finite(exact);
        self.deviation = deviation.and_then(finite);
        self.limit = finite(limit);
        self.physics = match deviation {
            Some(deviation) if deviation <= limit => Physics::Right,
            Some(_) => Physics::Wrong,
            None => Physics::NotJudged,
        };
        match (self.tolerance, self.expected) {
            (Some(tolerance), Some(expected))
                if self.verdict == Verdict::Passed && tolerance > limit && tolerance >= (expected - exact).abs() =>
            {
                let physics = self.physics;
                let row = self.unresolved(&format!(
                    "the tolerance {tolerance:.1e} of the prediction is wider than what counts as right, {limit:.1e}, and than the predicted error"
                ));
                if row.basis == Some(Basis::Formula) { Self { physics, ..row } } else { row }
            }
            _ => self,
        }
    }

    /// A number that is shown but tells nothing about what was asked: it neither passes nor fails, and says nothing about the truth.
    #[must_use]
    pub fn unresolved(mut self, reason: &str) -> Self {
        self.verdict = Verdict::NotRun;
        self.physics = Physics::NotJudged;
        self.reason = format!("not resolved: {reason}");
        self
    }

    #[must_use]
    pub fn with_trajectory(mut self, hash: &str) -> Self {
        self.trajectory = Some(hash.to_owned());
        self
    }

    #[must_use]
    pub fn with_floor(mut self, floor: f64) -> Self {
        self.floor = finite(floor);
        self
    }

    /// Which number this is, whatever its value: rows of two reports are paired by it.
    #[must_use]
    pub fn identity(&self) -> String {
        let steps = self.steps_per_period.map_or_else(|| "ladder".to_owned(), |steps| steps.to_string());
        format!("{} | {} | {} | {steps} | {}", self.scenario, self.variant, self.configuration, self.quantity)
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn subject() -> Subject {
        Subject {
            scenario: "test".to_owned(),
            variant: String::new(),
            configuration: Configuration::SAMPLED_FRICTION,
            reference: "closed form".to_owned(),
            steps_per_period: None,
            dt: None,
        }
    }

    fn judged(expected: f64, found: f64) -> Row {
        let reason = "for the test".to_owned();
        subject().row("damping", Judgement { basis: Basis::Formula, expected, found, tolerance: 0.01, reason })
    }

    #[test]
    fn what_the_formula_predicts_passes_though_it_is_physically_wrong() {
        let row = judged(-0.5, -0.505).against(0.0, 0.01);
        assert_eq!((row.verdict, row.physics), (Verdict::Passed, Physics::Wrong));
        let lucky = judged(-0.5, 0.0).against(0.0, 0.01);
        assert_eq!((lucky.verdict, lucky.physics), (Verdict::Failed, Physics::Right));
    }

    #[test]
    fn what_could_have_been_anything_is_not_judged() {
        let loose = |basis, found| Row { basis: Some(basis), ..judged(0.0, found) }.against(0.0, 0.005);
        let row = loose(Basis::DifferenceEquation, 0.001);
        assert_eq!((row.verdict, row.physics), (Verdict::NotRun, Physics::NotJudged));
        assert!(row.reason.contains("not resolved"), "{row:?}");
        // A loose formula leaves the number itself to be judged.
        assert_eq!([0.001, 0.009].map(|found| loose(Basis::Formula, found).physics), [Physics::Right, Physics::Wrong]);
        // A predicted error that stands out of the tolerance is resolved, and a miss stays a miss.
        let row = judged(0.5, 0.501).against(0.0, 0.005);
        assert_eq!((row.verdict, row.physics), (Verdict::Passed, Physics::Wrong));
        assert_eq!(judged(0.0, 0.1).against(0.0, 0.005).verdict, Verdict::Failed);
    }

    #[test]
    fn what_is_no_number_or_was_not_computed_never_passes() {
        for found in [f64::NAN, f64::INFINITY] {
            let row = judged(0.0, found).against(0.0, 1.0);
            assert_eq!(row.verdict, Verdict::Failed);
            assert_ne!(row.physics, Physics::Right);
        }
        let row = subject().not_run("damping", "only in the full run").against(0.0, 1.0);
        assert_eq!((row.verdict, row.physics), (Verdict::NotRun, Physics::NotJudged));
    }
}
