//! The engine's amplitude diagram beside the exact one: largest and smallest maximum of x1, after the transient, over xi1.
//!
//! Whether the difference equation can predict a motion is asked of itself: a second motion starts [`SEPARATION`] beside the first. From
//! its largest distance, over the size of the motion, follows by what factor A the motion magnifies errors, and what rounding may do:
//!
//! ```text
//! |found - expected| <= 16 A floor,      A = max |y - y'|/(SEPARATION max(1, |y|))
//! ```
//!
//! Where A exceeds [`PARTED`] neighbours part: the motion is chaotic, or leaves through a chaotic transient. Then extremes and life time
//! hang on roundings, and all that can be compared is that a motion both neighbours of which stay bounded does so too.

use super::rig_motion::{orbit, rig};
use super::settled::Settled;
use crate::conformance::experiment::{RIGHT, bounded_row};
use crate::conformance::ladder::rounding_floor;
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::theory::DifferenceEquation;
use crate::conformance::{Basis, Configuration, ConformanceError, Judgement, Physics, Row, Subject, Verdict};
use crate::dynamics::{Flow, Sample, Sampling, State, Trajectory};
use crate::engine::{Precision, trajectory_hash};
use crate::exact::TwoMassFlow;
use std::f64::consts::TAU;

/// Amplitude diagram.
#[derive(Debug, Clone, Copy)]
pub struct AmplitudeDiagram;

pub const ID: &str = "amplitude_diagram";
/// Quantities.
pub const BOUNDED: &str = "bounded";
pub const LARGEST: &str = "largest_maximum";
pub const SMALLEST: &str = "smallest_maximum";
/// The engine's defaults but for f64, so that rounding has no part in what is seen.
pub const DEFAULTS: Configuration = Configuration { precision: Precision::Double, ..Configuration::ENGINE_DEFAULTS };
/// Configurations with their steps per period of the sticking in-phase mode, 2 pi.
const SETTINGS: [(Configuration, u32); 2] = [(Configuration::AVERAGED_FRICTION, 256), (DEFAULTS, DEFAULT_STEPS)];
/// So many of the engine's steps of 1/60 are a period within 2.4e-5.
const DEFAULT_STEPS: u32 = 377;
const DEFAULT_STEP: f64 = 1.0 / 60.0;
/// Values of xi1, `0, -0.005 ... -0.2`, as multiples of the spacing.
const COUNT: u32 = 41;
const SPACING: f64 = 0.005;
/// Those of the quick run: no excitation, between the secondary Hopf points of the defaults and of the exact solution, torus, chaos where the
/// defaults diverge already, divergence.
const QUICK: [u32; 5] = [0, 4, 12, 32, 40];
/// Of mass 2, off the limit cycle.
const PERTURBATION: f64 = 0.001;
const PERIODS: u32 = 600;
const TRANSIENT: f64 = 300.0;
const SAMPLES: u32 = 64;
/// Far above the rounding of a motion (1e-12) and far below the motion.
const SEPARATION: f64 = 1e-9;
/// A millionfold: neighbours are 0.001 apart, where their distance no longer grows in proportion.
const PARTED: f64 = 1e6;
const ROUNDINGS: f64 = 16.0;

impl Scenario for AmplitudeDiagram {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Amplitude diagram"
    }

    fn description(&self) -> &'static str {
        "The two-mass rig from ξ₁ = 0 to -0.2, started on the exact limit cycle with x2 moved by 0.001 and watched from 300 to 600 \
         periods. Measured: largest and smallest maximum of x1, equal on a limit cycle. Two ways to run the engine: the second-order scheme \
         with friction averaged at 256 steps per period, and Rapier's defaults (dt = 1/60, 4 substeps, velocity at face value) in f64. Where neighbouring motions \
         part, extremes are no prediction of anything, and only whether the motion stays bounded is compared."
    }

    fn reference(&self) -> &'static str {
        "exact solution by contact states (closed form in modal coordinates) from the same start, measured in the same way at the same times"
    }

    fn cases(&self, _: Depth) -> Vec<Case> {
        let case = |n: u32, (configuration, steps): (Configuration, u32)| Case {
            scenario: ID.to_owned(),
            variant: format!("{PREFIX}{:.3}", 0.0 - SPACING * f64::from(n)),
            configuration,
            steps: vec![steps],
            depth: if QUICK.contains(&n) { Depth::Quick } else { Depth::Full },
        };
        (0..COUNT).flat_map(|n| SETTINGS.map(|settings| case(n, settings))).collect()
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let known = || format!("{PREFIX}followed by a number");
        let xi1 = xi1_of(&case.variant)
            .ok_or_else(|| ConformanceError::UnknownScenario { found: case.variant.clone(), known: known() })?;
        let start = start(xi1)?;
        let mut rows = Vec::new();
        for &steps in &case.steps {
            let step = if steps == DEFAULT_STEPS { DEFAULT_STEP } else { TAU / f64::from(steps) };
            let at = Subject { steps_per_period: Some(steps), dt: Some(step), ..subject(self, case) };
            rows.extend(Motions::of(xi1, &start, case.configuration, steps, step, bench)?.rows(&at)?);
        }
        Ok(rows)
    }
}

const PREFIX: &str = "xi1 = ";

/// The parameter of a variant.
pub fn xi1_of(variant: &str) -> Option<f64> {
    variant.strip_prefix(PREFIX)?.parse().ok()
}

/// Beside the limit cycle; at xi1 = 0 beside the motion its branch begins with, both masses together up to the slip limit.
fn start(xi1: f64) -> Result<State, ConformanceError> {
    let mut start = if xi1 < 0.0 { orbit(xi1)?.reversal() } else { State::two_mass([1.0, 1.0, 0.0, 0.0, 1.0]) };
    start.positions[1] += PERTURBATION;
    Ok(start)
}

/// The same motion four times, at the same times.
struct Motions {
    found: Trajectory,
    predicted: Trajectory,
    neighbour: Trajectory,
    exact: Trajectory,
    floor: f64,
}

impl Motions {
    fn of(
        xi1: f64,
        start: &State,
        configuration: Configuration,
        steps: u32,
        step: f64,
        bench: &dyn Bench,
    ) -> Result<Self, ConformanceError> {
        let rig = rig(xi1)?;
        let stride = (steps / SAMPLES).max(1);
        let total = steps * PERIODS / stride * stride;
        let sampling = Sampling { interval: step * f64::from(stride), t_end: step * f64::from(total) };
        let equation = DifferenceEquation::new(rig.chain(), configuration, step);
        let mut beside = start.clone();
        beside.positions[1] += SEPARATION;
        let predicted = equation.motion(start, total, stride);
        let scale = predicted.samples.iter().map(size).fold(0.0, f64::max);
        Ok(Self {
            found: bench.free(rig.chain(), configuration, step)?.trajectory(start, sampling)?,
            neighbour: equation.motion(&beside, total, stride),
            exact: TwoMassFlow::new(&rig).trajectory(start, sampling)?,
            floor: rounding_floor(configuration, scale, sampling.t_end, step),
            predicted,
        })
    }

    fn rows(&self, at: &Subject) -> Result<Vec<Row>, ConformanceError> {
        let magnification = self.magnification();
        let parted = magnification > PARTED;
        let exact_bounded = f64::from(u8::from(!self.exact.diverged()));
        let bounded = bounded_row(at, &self.found, &self.predicted).against(exact_bounded, 0.0);
        let leaves = self.predicted.diverged() || self.neighbour.diverged();
        let mut rows = vec![if parted && leaves { unpredicted(bounded) } else { bounded }];
        let [found, predicted, exact] = [&self.found, &self.predicted, &self.exact].map(extremes);
        let (found, predicted, exact) = (found?, predicted?, exact?);
        let hash = trajectory_hash(&self.found);
        let reason = format!(
            "{ROUNDINGS} floors of rounding, magnified {magnification:.1e} times as neighbouring motions are; right: 1 %"
        );
        for (i, quantity) in [LARGEST, SMALLEST].into_iter().enumerate() {
            let row = match found {
                Some(found) => {
                    // An amplitude where none was predicted is a failure.
                    let expected = predicted.map_or(f64::NAN, |predicted| predicted[i]);
                    let (basis, tolerance) = (Basis::DifferenceEquation, ROUNDINGS * magnification * self.floor);
                    let judgement = Judgement { basis, expected, found: found[i], tolerance, reason: reason.clone() };
                    at.row(quantity, judgement).with_floor(self.floor).with_trajectory(&hash)
                }
                None => at.not_run(quantity, "the motion diverges and has no amplitude"),
            };
            let row = if parted && found.is_some() { unpredicted(row) } else { row };
            match exact {
                Some(exact) => rows.push(beside_exact(row, exact[i])),
                None if found.is_some() => rows.push(row),
                None => {}
            }
        }
        Ok(rows)
    }

    /// A of the module.
    fn magnification(&self) -> f64 {
        let pairs = self.predicted.samples.iter().zip(&self.neighbour.samples);
        let distance = |(a, b): (&Sample, &Sample)| a.state.max_difference(&b.state) / size(a).max(1.0);
        pairs.map(distance).fold(0.0, f64::max) / SEPARATION
    }
}

fn size(sample: &Sample) -> f64 {
    sample.state.components().fold(0.0, |size, y| size.max(y.abs()))
}

/// Largest and smallest maximum of x1 after the transient; none for a motion that diverged.
fn extremes(motion: &Trajectory) -> Result<Option<[f64; 2]>, ConformanceError> {
    if motion.diverged() {
        return Ok(None);
    }
    let settled = Settled::of(ID, motion, TRANSIENT * TAU)?;
    Ok(Some([settled.largest, settled.smallest]))
}

/// What is predicted is judged; of the rest the exact number is only shown.
fn beside_exact(row: Row, exact: f64) -> Row {
    let judged = row.verdict != Verdict::NotRun;
    let row = row.against(exact, RIGHT * exact.abs());
    if judged { row } else { Row { physics: Physics::NotJudged, limit: None, ..row } }
}

/// A number that hangs on roundings: shown, not judged.
fn unpredicted(row: Row) -> Row {
    let reason = "neighbouring motions part: the number hangs on roundings, and there is nothing to compare it with";
    Row {
        verdict: Verdict::NotRun,
        physics: Physics::NotJudged,
        expected: None,
        tolerance: None,
        reason: reason.to_owned(),
        ..row
    }
}
