//! The engine's own secondary Hopf point, at several phases of the steps within the oscillation.
//!
//! In the nominal two-mass rig a pair of multipliers of the limit cycle leaves the unit circle at xi1 = -0.0345753708. The engine's limit cycle
//! is a periodic orbit of the map that n of its steps are (`hopf`), one for each phase, and does so elsewhere.
//!
//! How far off a phase is: with friction sampled at the steps the state is of second order, but a perturbation of it feels the spring of the element
//! in a whole number N of steps, not over the time t_s of the stick phase. For the multipliers this is a stick phase too long by
//! `e = (N + 1/2) h - t_s`, between -h and h. In the exact solution, a stick phase that is longer by e for perturbations alone moves
//! the modulus of the half-period pair at the Hopf point by `7.1e-5 e - 0.0672 e^2`, and the Hopf point by
//!
//! ```text
//! xi1 - exact = c h^2 + (1.76e-4 e - 0.167 e^2),       c h^2 n^2 = 0.2 ... 1.5 for n = 64 ... 2048
//! ```
//!
//! so that the error times n^2 is bounded by `1.5 + 0.167 (2 pi)^2 + 1.76e-4 (2 pi) n = 8.1 + 1.1e-3 n` (c is measured, the rest computed from the exact
//! solution): of first order in the end, with a small coefficient. N takes two values as the phase varies, the less likely one with the larger |e|. At
//! other xi1 the linear coefficient is larger, 0.023 at xi1 = -0.06: there multipliers at a single phase are of first order, and only their
//! mean over the phases is of second.
//!
//! With friction averaged over the step a perturbation sticks for as long as the motion does, to higher order, and the Hopf point is of second order at
//! every phase. Its leading terms follow from the exact flow and the scheme's modified equation (derived and solved in the tests):
//!
//! ```text
//! xi1 - exact = -(0.0422 + p)/n^2 - 15.0/n^3,     -0.0084 < p < 0.0042
//! ```
//!
//! The third order is the friction force's: its path is predicted with the acceleration of the step before, which leaves `-(h^3/6) v1''` in stick,
//! a positive damping. p is the phase of the end of stick within a step. At 2048 steps it is a hundredth of the above.

use crate::compare::observed_order;
use crate::conformance::experiment::{RIGHT, friction_cases};
use crate::conformance::hopf::{CycleProblem, HopfError, HopfPoint, Source, at_step, pairs_over_phases, phases};
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{
    Basis, Configuration, ConformanceError, HOPF_QUANTITY, Judgement, ORDER_TOLERANCE, Row, Subject,
};
use crate::engine::{Precision, Scheme};
use crate::exact::TwoMassFlow;
use crate::model::{RigParameter, RigParameters, TwoMassRig};
use crate::orbit::{Bifurcation, Branch, Heading, Mode, OrbitError, PseudoArclength, limit_cycle};

/// Secondary Hopf point of the engine.
#[derive(Debug, Clone, Copy)]
pub struct SecondaryHopf;

const ID: &str = "secondary_hopf";
/// Even numbers: half a period is half of them. With first-order configurations there is no such point with xi1 < 0 below 256 steps.
const FULL: [u32; 7] = [64, 128, 256, 384, 512, 1024, 2048];
const QUICK: [u32; 2] = [256, 512];
const FEWEST_FOR_FIRST_ORDER: u32 = 256;
/// Every phase is to be this near at 2048 steps.
const WANTED: (u32, f64) = (2048, 1e-6);
/// The engine's default step, in units of 1/angular frequency.
const DEFAULT_STEP: f64 = 1.0 / 60.0;
/// Steps per period near it, from where the number is sought.
const NEAR_DEFAULT: u64 = 376;
/// Engine and difference equation round differently: |mu| by 1e-10, and xi1 by 2.5 to 5 times that. A tenfold margin.
const ROUNDING: f64 = 5e-9;
/// Larger errors are not used for the order of first-order configurations. Here the shift is bent by a tenth (error times n: 9.2 at 512
/// steps, 10.3 at 8192, four substeps), which changes the slope by 0.06.
const LARGEST: f64 = 0.02;
/// Fewer points show no order.
const FEWEST: usize = 3;

impl Scenario for SecondaryHopf {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Secondary Hopf point"
    }

    fn description(&self) -> &'static str {
        "The nominal two-mass rig. The engine's limit cycle as a periodic orbit of the map that n steps are, its step unknown, at several phases of the steps; measured: ξ1 where a pair of its multipliers leaves the unit circle."
    }

    fn reference(&self) -> &'static str {
        "multipliers of the exact limit cycle, by shooting with exact derivatives"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        let (variant, steps) = match depth {
            Depth::Quick => (variant_of(2), QUICK.to_vec()),
            Depth::Full => (variant_of(8), FULL.to_vec()),
        };
        let mut cases = friction_cases(ID, &variant, depth);
        for case in &mut cases {
            let lowest = if exists_at_coarse_steps(case.configuration) { 0 } else { FEWEST_FOR_FIRST_ORDER };
            case.steps = steps.iter().copied().filter(|n| *n >= lowest).collect();
        }
        cases
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let subject = subject(self, case);
        if case.configuration.precision == Precision::Single {
            return Ok(vec![subject.not_run(HOPF_QUANTITY, NOT_IN_F32)]);
        }
        let count = phases_of(&case.variant)
            .ok_or_else(|| ConformanceError::UnknownScenario { found: case.variant.clone(), known: variant_of(8) })?;
        let study = Study { subject, configuration: case.configuration, bench, count, exact: exact_hopf()? };
        Ok(study.rows(&case.steps))
    }
}

const NOT_IN_F32: &str = "below the floor of f32: n/2 steps round the state by 6e-8 sqrt(n/2), 1e-6 at 512 steps, so that a difference of 1e-4, about the longest that moves no switch to another step, knows a derivative and with it a multiplier to 1 %, and ξ₁ to 1 %/0.3 = 0.03, as large as the number sought; at 64 steps, where a hundredfold difference would do, the orbit itself is known to 1e-6 only, and the second-order scheme is off by 2e-4 anyway";

/// The acceptance of the finest step: every phase by itself.
const EVERY_PHASE: &str = "secondary_hopf_every_phase";

/// On the largest error over the phases times n², by the formula above.
fn bound(n: f64) -> f64 {
    8.1 + 1.1e-3 * n
}

/// On the same where friction is averaged: the leading terms of the modified equation at the worst phase, a tenth more for the next order (smaller
/// by h, 0.1 at 64 steps), and rounding.
fn averaged_bound(n: f64) -> f64 {
    1.1 * (0.0464 + 15.0 / n) + ROUNDING * n * n
}

fn variant_of(phases: usize) -> String {
    format!("{phases} phases")
}

fn phases_of(variant: &str) -> Option<usize> {
    variant.split(' ').next()?.parse().ok()
}

/// With one substep positions are right to second order under a given force, whatever is done about velocities.
fn exists_at_coarse_steps(configuration: Configuration) -> bool {
    configuration.substeps == 1
}

/// xi1 at the secondary Hopf point of the exact limit cycle.
fn exact_hopf() -> Result<f64, OrbitError> {
    let at = |p: RigParameters| Ok::<_, OrbitError>(TwoMassFlow::new(&TwoMassRig::new(p)?));
    let start = RigParameters { xi1: -0.03, ..RigParameters::default() };
    let orbit = limit_cycle(start, at)?;
    let branch = PseudoArclength::new(at, start, &orbit, RigParameter::Xi1, Heading::Decreasing)?;
    let found = |branch: &Branch| branch.special_of(Bifurcation::NeimarkSacker).next().map(|p| p.parameters.xi1);
    let branch = Branch::follow(branch.up_to_amplitude(2.0), |so_far| found(so_far).is_some())?;
    found(&branch).ok_or(OrbitError::NoGuess {
        mode: Mode::InPhase,
        xi1: start.xi1,
        xi2: start.xi2,
        kappa: start.kappa,
    })
}

/// One configuration.
struct Study<'a> {
    subject: Subject,
    configuration: Configuration,
    bench: &'a dyn Bench,
    count: usize,
    exact: f64,
}

impl Study<'_> {
    fn rows(&self, ladder: &[u32]) -> Vec<Row> {
        let (mut blocks, mut errors) = (Vec::new(), Vec::new());
        // From fine to coarse, since the finest is nearest to the exact point.
        let mut guess = self.exact;
        for &steps in ladder.iter().rev() {
            let at = Subject { steps_per_period: Some(steps), ..self.subject.clone() };
            match self.points(steps, guess) {
                Ok(pairs) => {
                    let (found, expected): (Vec<_>, Vec<_>) = pairs.into_iter().map(|[a, b]| (a, b)).unzip();
                    // The shift is nearly proportional to the step, which doubles; one step beyond is left to the search.
                    guess = (self.exact + 1.8 * (mean(&expected) - self.exact)).min(-1e-3);
                    let error = |points: &[HopfPoint]| (mean(points) - self.exact).abs();
                    errors.push((expected[0].orbit.step, error(&found), error(&expected)));
                    blocks.push(self.rows_at(&at, steps, &found, &expected));
                }
                Err(error) => blocks.push(vec![at.failed(HOPF_QUANTITY, &error.to_string())]),
            }
        }
        let mut rows: Vec<Row> = blocks.into_iter().rev().flatten().collect();
        rows.push(self.ladder_row(&errors));
        if self.configuration.scheme == Scheme::Plain && self.configuration.substeps == 4 {
            rows.push(self.default_step_row());
        }
        rows
    }

    /// Hopf points of the engine and of the difference equation.
    fn points(&self, steps: u32, guess: f64) -> Result<Vec<[HopfPoint; 2]>, HopfError> {
        let of = |source| self.problem(source, steps.into());
        pairs_over_phases(&of(Source::Engine(self.bench)), &of(Source::Theory), self.count, guess)
    }

    fn problem<'b>(&self, source: Source<'b>, steps: u64) -> CycleProblem<'b> {
        CycleProblem::symmetric(source, self.configuration, steps, 0.0)
    }

    fn rows_at(&self, at: &Subject, steps: u32, found: &[HopfPoint], expected: &[HopfPoint]) -> Vec<Row> {
        let at = Subject { dt: Some(expected[0].orbit.step), ..at.clone() };
        let moved: Vec<String> = found
            .iter()
            .zip(phases(found.len()))
            .filter(|(point, phase)| point.phase != *phase)
            .map(|(point, phase)| format!("{phase:.3} to {:.3}", point.phase))
            .collect();
        let moved = if moved.is_empty() {
            String::new()
        } else {
            format!("; phases moved, since a switch lay on a grid time: {}", moved.join(", "))
        };
        let blurred = found.iter().chain(expected).map(|p| p.uncertainty).fold(0.0, f64::max);
        let judged = |found: f64, expected: f64, what: &str| Judgement {
            basis: Basis::DifferenceEquation,
            expected,
            found,
            tolerance: ROUNDING + 2.0 * blurred,
            reason: format!(
                "rounding of the multipliers, and the bracket around a jump of their modulus; {what}{moved}"
            ),
        };
        let row = |quantity: &str, value: &dyn Fn(&[HopfPoint]) -> f64, what: &str| {
            at.row(quantity, judged(value(found), value(expected), what))
        };
        let worst = |points: &[HopfPoint]| points.iter().map(|p| (p.xi1 - self.exact).abs()).fold(0.0, f64::max);
        let limit = RIGHT * self.exact.abs();
        let mut rows = vec![
            row(HOPF_QUANTITY, &mean, "mean over the phases; right: within 1 %").against(self.exact, limit),
            row("secondary_hopf_spread", &spread, "largest less smallest over the phases"),
            row("secondary_hopf_worst_error", &worst, "right: within 1 %").against(0.0, limit),
        ];
        if self.configuration.expected_order() == 2.0 {
            rows.push(self.scaled_row(&at, steps, found, expected, ROUNDING + 2.0 * blurred));
            if steps == WANTED.0 {
                rows.push(row(EVERY_PHASE, &worst, &self.every_phase(found)).against(0.0, WANTED.1));
            }
        }
        rows
    }

    /// Largest error times n²: bounded by a formula where friction is sampled, that of the difference equation where friction is averaged.
    fn scaled_row(&self, at: &Subject, steps: u32, found: &[HopfPoint], expected: &[HopfPoint], blur: f64) -> Row {
        let n = f64::from(steps);
        let scaled =
            |points: &[HopfPoint]| points.iter().map(|p| (p.xi1 - self.exact).abs() * n * n).fold(0.0, f64::max);
        let judgement = if self.configuration.scheme == Scheme::AveragedFriction {
            Judgement {
                basis: Basis::DifferenceEquation,
                expected: scaled(expected),
                found: scaled(found),
                tolerance: blur * n * n,
                reason: "largest error over the phases times n²; rounding of the multipliers times n²; right: at most a tenth and rounding above the leading terms of the scheme's modified equation, 0.0464 + 15/n".to_owned(),
            }
        } else {
            Judgement {
                basis: Basis::Formula,
                expected: 0.0,
                found: scaled(found),
                tolerance: bound(n),
                reason: "largest error over the phases times n², at most 8.1 + 0.0011 n: the smooth part 1.5, and a stick phase up to one step too short or too long for perturbations, 0.167 (2π)² + 1.76e-4 (2π) n".to_owned(),
            }
        };
        let averages = self.configuration.scheme == Scheme::AveragedFriction;
        let row = at.row("secondary_hopf_error_times_n2", judgement);
        if averages { row.against(0.0, averaged_bound(n)) } else { row }
    }

    /// What is to be said about single phases at the finest step.
    fn every_phase(&self, found: &[HopfPoint]) -> String {
        let errors: Vec<f64> = found.iter().map(|p| (p.xi1 - self.exact).abs()).collect();
        let within = errors.iter().filter(|e| **e <= WANTED.1).count();
        let largest_within = errors.iter().copied().filter(|e| *e <= WANTED.1).fold(0.0, f64::max);
        let worst = errors.iter().copied().fold(0.0, f64::max);
        let mut text = format!("right: every phase within {:e}", WANTED.1);
        text += &format!(
            "; {within} of {} phases are, by {largest_within:.2e}, the worst is off by {worst:.2e}",
            errors.len()
        );
        if within < errors.len() {
            text += ": perturbations stick for a whole number of steps, one fewer at some phases than at others, which moves the point by 1.76e-4 e - 0.167 e², |e| < h; the difference equation without the engine does the same, and friction averaged over the step does not";
        }
        text
    }

    /// What the ladder shows: an order for configurations whose error is plainly of one.
    fn ladder_row(&self, errors: &[(f64, f64, f64)]) -> Row {
        match (self.configuration.substeps, self.configuration.scheme) {
            (1, Scheme::SecondOrder) => {
                let reason = "no order to be seen: the error is bounded by (8.1 + 0.0011 n)/n² and scatters below that with the phases, of first order in the end with a small coefficient; see the rows about the error times n²";
                self.subject.not_run(HOPF_QUANTITY, reason)
            }
            (1, Scheme::LaggingDamping | Scheme::Plain) => {
                let reason = "first order by theory, but since the damping is weak only 0.003/n: hidden up to 2048 steps by the spread over the phases, no order to be seen";
                let row = self.subject.not_run(HOPF_QUANTITY, reason);
                Row { expected_order: Some(1.0), ..row }
            }
            (1, Scheme::AveragedFriction) => {
                let small: Vec<_> = errors.iter().filter(|(_, error, _)| *error > 8.0 * ROUNDING).collect();
                let expected = observed_order(&small.iter().map(|(h, _, error)| (*h, *error)).collect::<Vec<_>>());
                let expected = expected.map_or(f64::NAN, |order| order.slope);
                let reason = "order of the difference equation: second, and a part of third order that fades, over errors above eight roundings";
                self.order_row(&small.iter().map(|(h, error, _)| (*h, *error)).collect::<Vec<_>>(), expected, reason)
            }
            _ => {
                let small: Vec<_> =
                    errors.iter().map(|(h, error, _)| (*h, *error)).filter(|(_, e)| *e < LARGEST).collect();
                let reason = "numerical damping of first order, where the shift is bent by a tenth";
                self.order_row(&small, 1.0, reason)
            }
        }
    }

    fn order_row(&self, errors: &[(f64, f64)], expected: f64, why: &str) -> Row {
        let order = if errors.len() < FEWEST { None } else { observed_order(errors).ok() };
        let Some(order) = order else {
            let reason = format!("no order to fit: {} errors are neither too large nor rounding", errors.len());
            return self.subject.not_run(HOPF_QUANTITY, &format!("{reason}, {FEWEST} are needed"));
        };
        let reason = format!("{why}; over {} steps", errors.len());
        let basis = if expected == 1.0 { Basis::Order } else { Basis::DifferenceEquation };
        let (found, tolerance) = (order.slope, ORDER_TOLERANCE);
        let row = self.subject.row(HOPF_QUANTITY, Judgement { basis, expected, found, tolerance, reason });
        Row { order: Some(found), expected_order: Some(expected), ..row }
    }

    /// At the engine's default step, which is no whole part of the period: interpolated between two numbers of steps.
    fn default_step_row(&self) -> Row {
        let at = Subject { dt: Some(DEFAULT_STEP), ..self.subject.clone() };
        let quantity = "secondary_hopf_xi1_at_default_step";
        let of = |source| -> Result<f64, HopfError> {
            let points = phases(self.count).into_iter().map(|phase| {
                let problem = CycleProblem { phase, ..self.problem(source, NEAR_DEFAULT) };
                at_step(&problem, DEFAULT_STEP, DEFAULT_STEP_GUESS)
            });
            let points: Vec<f64> = points.collect::<Result<_, _>>()?;
            Ok(points.iter().sum::<f64>() / points.len() as f64)
        };
        match (of(Source::Engine(self.bench)), of(Source::Theory)) {
            (Ok(found), Ok(expected)) => {
                let reason =
                    "mean over the phases; rounding of the multipliers, and brackets around jumps; right: within 1 %";
                let (basis, tolerance) = (Basis::DifferenceEquation, JUMPS);
                let judgement = Judgement { basis, expected, found, tolerance, reason: reason.to_owned() };
                at.row(quantity, judgement).against(self.exact, RIGHT * self.exact.abs())
            }
            (Err(error), _) | (_, Err(error)) => at.failed(quantity, &error.to_string()),
        }
    }
}

/// Four substeps at 1/60 pump energy in like a damping of -0.375 h = -0.00625, which brings the Hopf point to about -0.01.
const DEFAULT_STEP_GUESS: f64 = -0.011;
/// Two brackets of at most 1e-5, of which the mean over the phases sees a part.
const JUMPS: f64 = 1e-5;

fn mean(points: &[HopfPoint]) -> f64 {
    points.iter().map(|p| p.xi1).sum::<f64>() / points.len() as f64
}

fn spread(points: &[HopfPoint]) -> f64 {
    let extreme = |pick: fn(f64, f64) -> f64, start: f64| points.iter().map(|p| p.xi1).fold(start, pick);
    extreme(f64::max, f64::NEG_INFINITY) - extreme(f64::min, f64::INFINITY)
}
