//! Chaos at xi1 = -0.155: trajectories part, averages agree.
//!
//! The record of the difference equation starts elsewhere on the attractor than the engine's, so that nothing but averages can agree. That the motion is
//! chaotic is shown first, by the largest Lyapunov exponent of the step map: a neighbour at the distance d is carried along, and pulled back to d every
//! two periods (G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn, Meccanica 15 (1980) 9-30),
//!
//! ```text
//! exponent = mean of ln(distance/d) per unit of time
//! ```
//!
//! A number whose statistical error does not let 1 % be told is not judged.

use super::invariants::{Estimate, QUANTITIES, invariants, mean};
use super::rig_motion::{orbit, rig};
use crate::chaos::{LyapunovPlan, Window, lyapunov_spectrum};
use crate::conformance::experiment::{Experiment, RIGHT, bounded_row, friction_cases, is_notable};
use crate::conformance::hopf::Source;
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::theory::DifferenceEquation;
use crate::conformance::{Basis, Configuration, ConformanceError, Judgement, Physics, Row, Subject};
use crate::dynamics::{Flow, Sampling, State};
use crate::engine::{DiscreteState, Precision, trajectory_hash};
use crate::exact::TwoMassFlow;
use crate::model::TwoMassRig;

/// Chaos.
#[derive(Debug, Clone, Copy)]
pub struct Chaos;

const ID: &str = "chaos";
const XI1: f64 = -0.155;
/// Of mass 2, off the unstable limit cycle: for the engine, and for the difference equation's own record.
const PERTURBATIONS: [f64; 2] = [0.01, 0.02];
const TRANSIENT: u32 = 500;
/// Periods of the engine's record; the others are watched twice as long, since they cost less.
const PERIODS: u32 = 4000;
const REFERENCE_PERIODS: u32 = 8000;
const SAMPLES: u32 = 32;
/// Steps per period.
const FULL: [u32; 2] = [128, 377];
const QUICK: [u32; 1] = [128];
/// Standard errors of a difference. With 25 batches, one number in 7000 lies beyond by chance, of some two hundred.
const DEVIATIONS: f64 = 4.5;
/// Of the exponent: intervals, and periods in each.
const INTERVALS: usize = 1000;
const INTERVAL: u32 = 2;
/// Time units over which the exact exponent is averaged.
const EXACT_TIME: f64 = 20_000.0;

impl Scenario for Chaos {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Chaos"
    }

    fn description(&self) -> &'static str {
        "The two-mass rig at ξ₁ = -0.155, 4000 periods on its chaotic attractor. Trajectories part; compared are, with their statistical errors, the \
         largest Lyapunov exponent of the step map (2000 periods, a neighbour pulled back every second one), and averages: maxima of x1 (mean, \
         10 %, 50 %, 90 %), angular frequency, share of the time in stick, energy. The difference equation's record starts elsewhere. What the \
         record cannot tell to 1 % is not judged."
    }

    fn reference(&self) -> &'static str {
        "exact solution by contact states over 8000 periods; its largest Lyapunov exponent from exact tangents"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        let mut cases = friction_cases(ID, "", depth);
        for case in &mut cases {
            let quick = [Configuration::SAMPLED_FRICTION, Configuration::ENGINE_DEFAULTS].contains(&case.configuration);
            case.depth = if quick { Depth::Quick } else { Depth::Full };
            let notable = is_notable(case.configuration);
            case.steps = match depth {
                Depth::Quick => QUICK.to_vec(),
                Depth::Full if notable => FULL.to_vec(),
                Depth::Full => Vec::new(),
            };
        }
        cases
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let (orbit, rig) = (orbit(XI1)?, rig(XI1)?);
        let beside = |perturbation: f64| {
            let mut start = orbit.reversal();
            start.positions[1] += perturbation;
            start
        };
        let starts = PERTURBATIONS.map(beside);
        let mut rows = Vec::new();
        if case.steps.is_empty() {
            return Ok(rows);
        }
        let exact = Motion::exact(&rig, &starts[0], orbit.period)?;
        for &steps in &case.steps {
            let at = subject(self, case).at(steps, orbit.period);
            let [here, elsewhere] = starts.each_ref().map(|start| {
                let (scenario, chain) = (ID, rig.chain().clone());
                let start = start.clone();
                let of =
                    Experiment { scenario, chain, start, period: orbit.period, periods: PERIODS, samples: SAMPLES };
                of.settled(case.configuration, steps, TRANSIENT).start
            });
            let study = Study { rig: &rig, configuration: case.configuration, bench, steps, period: orbit.period };
            rows.extend(study.rows(&at, &here, &elsewhere, &exact)?);
        }
        Ok(rows)
    }
}

/// Averages of a motion, and its largest exponent.
struct Motion {
    averages: Option<[Estimate; 7]>,
    exponent: Option<Estimate>,
}

impl Motion {
    fn exact(rig: &TwoMassRig, start: &State, period: f64) -> Result<Self, ConformanceError> {
        let flow = TwoMassFlow::new(rig);
        let transient = f64::from(TRANSIENT) * period;
        let settled = flow.trajectory(start, Sampling { interval: transient, t_end: transient })?;
        let start = settled.samples.last().map_or(start, |sample| &sample.state);
        let sampling = Sampling { interval: period / f64::from(SAMPLES), t_end: f64::from(REFERENCE_PERIODS) * period };
        let motion = flow.trajectory(start, sampling)?;
        let window = Window { transient: 100.0, length: EXACT_TIME };
        let outcome = lyapunov_spectrum(&flow, start, LyapunovPlan::new(window))?;
        let exponent = outcome.spectrum().and_then(|found| {
            Some(Estimate { value: *found.exponents.first()?, error: *found.standard_errors.first()? })
        });
        Ok(Self { averages: invariants(rig.chain(), &motion), exponent })
    }

    /// Whether the largest exponent is positive beyond doubt.
    fn is_chaotic(&self) -> bool {
        self.exponent.is_some_and(|exponent| exponent.value > DEVIATIONS * exponent.error)
    }
}

/// One configuration at one step.
struct Study<'a> {
    rig: &'a TwoMassRig,
    configuration: Configuration,
    bench: &'a dyn Bench,
    steps: u32,
    period: f64,
}

impl Study<'_> {
    fn rows(
        &self,
        at: &Subject,
        here: &State,
        elsewhere: &State,
        exact: &Motion,
    ) -> Result<Vec<Row>, ConformanceError> {
        let (step, stride) = (self.step(), self.steps / SAMPLES);
        let sampling = Sampling { interval: f64::from(stride) * step, t_end: f64::from(PERIODS) * self.period };
        let record = self.bench.free(self.rig.chain(), self.configuration, step)?.trajectory(here, sampling)?;
        let equation = DifferenceEquation::new(self.rig.chain(), self.configuration, step);
        let expected = equation.motion(elsewhere, self.steps * REFERENCE_PERIODS, stride);
        let mut rows = vec![bounded_row(at, &record, &expected)];
        if record.diverged() || expected.diverged() {
            return Ok(rows);
        }
        let found = Motion {
            averages: invariants(self.rig.chain(), &record),
            exponent: self.exponent(Source::Engine(self.bench), here)?,
        };
        let expected = Motion {
            averages: invariants(self.rig.chain(), &expected),
            exponent: self.exponent(Source::Theory, elsewhere)?,
        };
        rows.push(chaotic_row(at, &found, &expected, exact));
        if let (Some(a), Some(b), Some(c)) = (found.exponent, expected.exponent, exact.exponent) {
            rows.push(average_row(at, "lyapunov_exponent", a, b, c));
        }
        let (Some(a), Some(b), Some(c)) = (found.averages, expected.averages, exact.averages) else {
            rows.push(at.failed(QUANTITIES[0], "the record is too short for averages"));
            return Ok(rows);
        };
        let hash = trajectory_hash(&record);
        for (i, quantity) in QUANTITIES.into_iter().enumerate() {
            let row = average_row(at, quantity, a[i], b[i], c[i]).with_trajectory(&hash);
            let both = found.is_chaotic() && expected.is_chaotic();
            rows.push(if both { row } else { row.unresolved("the motion is not shown to be chaotic") });
        }
        Ok(rows)
    }

    fn step(&self) -> f64 {
        self.period / f64::from(self.steps)
    }

    /// Distance of neighbours: far above rounding, far below the motion.
    fn separation(&self) -> f64 {
        match self.configuration.precision {
            Precision::Double => 1e-6,
            Precision::Single => 1e-3,
        }
    }

    fn exponent(&self, source: Source<'_>, start: &State) -> Result<Option<Estimate>, ConformanceError> {
        let map = source.map(self.rig.chain(), self.configuration, self.step())?;
        let d = self.separation();
        let mut here = map.start(start)?;
        let mut beside = here.clone();
        beside.positions[0] += d;
        let mut growth = Vec::with_capacity(INTERVALS);
        for _ in 0..INTERVALS {
            let count = u64::from(INTERVAL * self.steps);
            (here, beside) = (map.steps(&here, count)?.end, map.steps(&beside, count)?.end);
            let distance = here.components().zip(beside.components()).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            if !(distance.is_finite() && distance > 0.0) {
                return Ok(None);
            }
            growth.push((distance / d).ln() / (f64::from(INTERVAL) * self.period));
            beside = pulled_back(&here, &beside, d / distance);
        }
        Ok(Estimate::of(&growth, &mean))
    }
}

/// The neighbour at a fraction of its distance.
fn pulled_back(here: &DiscreteState, beside: &DiscreteState, part: f64) -> DiscreteState {
    let between = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + part * (b - a)).collect::<Vec<f64>>();
    let forces = between(&here.slider_forces, &beside.slider_forces);
    DiscreteState {
        positions: between(&here.positions, &beside.positions),
        engine_velocities: between(&here.engine_velocities, &beside.engine_velocities),
        slider_forces: forces.into_iter().map(|f| f.clamp(-1.0, 1.0)).collect(),
        past_accelerations: between(&here.past_accelerations, &beside.past_accelerations),
    }
}

fn chaotic_row(at: &Subject, found: &Motion, expected: &Motion, exact: &Motion) -> Row {
    let word = |motion: &Motion| f64::from(u8::from(motion.is_chaotic()));
    let told =
        |motion: &Motion| motion.exponent.map_or("none".to_owned(), |e| format!("{:.5} ± {:.5}", e.value, e.error));
    let reason = format!(
        "1 if the largest Lyapunov exponent exceeds zero by {DEVIATIONS} standard errors: engine {}, difference equation {}, exact {}",
        told(found),
        told(expected),
        told(exact)
    );
    let (basis, tolerance) = (Basis::DifferenceEquation, 0.0);
    let judgement = Judgement { basis, expected: word(expected), found: word(found), tolerance, reason };
    at.row("is_chaotic", judgement).against(word(exact), 0.0)
}

/// An average; right and wrong only where its statistical error leaves no doubt.
fn average_row(at: &Subject, quantity: &str, found: Estimate, expected: Estimate, exact: Estimate) -> Row {
    let tolerance = DEVIATIONS * found.error.hypot(expected.error);
    let reason = format!(
        "{DEVIATIONS} standard errors of the difference, by averages over batches; found ± {:.1e}, expected ± {:.1e}, exact ± {:.1e}; right: within 1 %",
        found.error, expected.error, exact.error
    );
    let basis = Basis::DifferenceEquation;
    let judgement = Judgement { basis, expected: expected.value, found: found.value, tolerance, reason };
    let limit = RIGHT * exact.value.abs();
    let row = at.row(quantity, judgement).against(exact.value, limit);
    let doubt = DEVIATIONS * found.error.hypot(exact.error);
    let deviation = (found.value - exact.value).abs();
    if (deviation + doubt <= limit) || deviation - doubt > limit {
        return row;
    }
    let reason = format!("{}; statistics do not tell whether it is right", row.reason);
    Row { physics: Physics::NotJudged, reason, ..row }
}
