//! The limit cycle of the rig: ten periods beside an unstable one, where errors show undisguised, and a stable one after its transient.

use super::near_motion::{self, Quantities};
use super::rig_motion::{beside_the_cycle, orbit, rig};
use super::settled::Settled;
use crate::conformance::exchange::Setup;
use crate::conformance::experiment::{Experiment, RIGHT, bounded_row, finish_ladder, friction_cases};
use crate::conformance::ladder::rounding_floor;
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{Basis, ConformanceError, Judgement, Ladder, ORDER_TOLERANCE, Row, Subject};

/// The limit cycle.
#[derive(Debug, Clone, Copy)]
pub struct LimitCycle;

const ID: &str = "limit_cycle";
const BESIDE: &str = "ten periods beside the cycle at xi1 = -0.06";
const SETTLED: &str = "settled at xi1 = -0.01";
const XI1: f64 = -0.01;
/// Perturbations fade with half the leading multiplier's rate, 0.0044: over 200 periods to 0.4 %.
const TRANSIENT: u32 = 200;
/// Periods in the engine, started where the difference equation has settled: two thirds of what it does otherwise shows in the last of them.
const PERIODS: u32 = 40;
/// Periods at the end over which amplitude and frequency are taken.
const WINDOW: u32 = 20;
const ROUNDINGS: f64 = 16.0;

impl Scenario for LimitCycle {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Limit cycle"
    }

    fn description(&self) -> &'static str {
        "The two-mass rig, (a) at ξ₁ = -0.06 ten periods beside its unstable limit cycle: state error, times of stick and slip; (b) at \
         ξ₁ = -0.01, where the cycle is stable, after a transient of 200 periods, which the difference equation goes through before the engine takes \
         over for 40: of the last 20 amplitude, angular frequency, and the spread of the maxima, which is zero on a limit cycle."
    }

    fn reference(&self) -> &'static str {
        "exact solution by contact states (closed form in modal coordinates); limit cycle by shooting on it"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        let mut cases = friction_cases(ID, BESIDE, depth);
        let settled = friction_cases(ID, SETTLED, depth).into_iter().map(|mut case| {
            // Long motions: four times the steps cost four times as much, and show no more.
            case.steps.retain(|steps| *steps <= if depth == Depth::Quick { 512 } else { 2048 });
            case
        });
        cases.extend(settled);
        cases
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let subject = subject(self, case);
        if case.variant == SETTLED {
            return settled(&subject, case, bench);
        }
        let (experiment, flow) = beside_the_cycle(ID)?;
        let motion = flow.solve(&experiment.start, experiment.duration())?;
        near_motion::rows(&subject, case, bench, &experiment, &motion, Quantities::StateAndSwitching)
    }

    fn setups(&self) -> Result<Vec<Setup>, ConformanceError> {
        let (experiment, flow) = beside_the_cycle(ID)?;
        let motion = flow.solve(&experiment.start, experiment.duration())?;
        Ok(vec![Setup::of(&experiment, ID, |t| {
            Ok(motion.state_at(t.min(crate::dynamics::Motion::end(&motion)))?.state)
        })?])
    }
}

fn settled(subject: &Subject, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
    let orbit = orbit(XI1)?;
    let chain = rig(XI1)?.chain().clone();
    let start = orbit.reversal();
    let experiment = Experiment { scenario: ID, chain, start, period: orbit.period, periods: PERIODS, samples: 128 };
    let (amplitude, frequency) = (orbit.amplitude(), orbit.angular_frequency());
    let (mut amplitudes, mut frequencies) = (Ladder::scattering(amplitude), Ladder::new(frequency));
    let mut rows = Vec::new();
    for &steps in &case.steps {
        let (at, step) = (subject.at(steps, orbit.period), orbit.period / f64::from(steps));
        let experiment = experiment.clone().settled(case.configuration, steps, TRANSIENT);
        let measured = experiment.measure(bench, case.configuration, steps)?;
        rows.push(bounded_row(&at, &measured.trajectory, &measured.predicted));
        if measured.diverged() {
            continue;
        }
        let from = experiment.duration() - f64::from(WINDOW) * orbit.period;
        let found = Settled::of(ID, &measured.trajectory, from)?;
        let predicted = Settled::of(ID, &measured.predicted, from)?;
        let floor = rounding_floor(case.configuration, amplitude, experiment.duration(), step);
        let mut row = |quantity: &str, expected: f64, found: f64, exact: f64, limit: f64, why: &str| {
            let reason = format!("{ROUNDINGS} floors of rounding over the motion; right: {why}");
            let judgement =
                Judgement { basis: Basis::DifferenceEquation, expected, found, tolerance: ROUNDINGS * floor, reason };
            rows.push(
                at.row(quantity, judgement).against(exact, limit).with_floor(floor).with_trajectory(&measured.hash),
            );
        };
        row("amplitude", predicted.mean, found.mean, amplitude, RIGHT * amplitude, "1 %");
        row(
            "angular_frequency",
            predicted.angular_frequency,
            found.angular_frequency,
            frequency,
            RIGHT * frequency,
            "1 %",
        );
        let why = "maxima that differ by less than 1 %; more is a torus in place of the limit cycle";
        row("spread_of_maxima", predicted.spread(), found.spread(), 0.0, RIGHT * amplitude, why);
        let error = |found: f64, exact: f64| (found - exact).abs();
        amplitudes.push(step, error(found.mean, amplitude), floor, Some(error(predicted.mean, amplitude)));
        let (found, predicted) = (found.angular_frequency, predicted.angular_frequency);
        frequencies.push(step, error(found, frequency), floor, Some(error(predicted, frequency)));
    }
    finish_ladder(&mut rows, subject, "amplitude", &amplitudes, ORDER_TOLERANCE);
    finish_ladder(&mut rows, subject, "angular_frequency", &frequencies, ORDER_TOLERANCE);
    Ok(rows)
}
