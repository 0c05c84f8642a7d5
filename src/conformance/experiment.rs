//! What most scenarios share: a motion of some periods in the engine, beside the difference equation and the exact solution, at a step.

use super::ConformanceError;
use super::configuration::Configuration;
use super::ladder::{Ladder, rounding_floor};
use super::row::{Basis, Judgement, Physics, Row, Subject, Verdict};
use super::scenario::{Bench, Case, Depth};
use super::theory::DifferenceEquation;
use crate::dynamics::{Flow, Sampling, State, Trajectory};
use crate::engine::trajectory_hash;
use crate::model::OscillatorChain;

/// Samples per period where states are compared: enough to see every extreme, few enough for long ladders.
pub const SAMPLES_PER_PERIOD: u32 = 32;

/// Steps per period of the full report. 377 is the engine's default step of 1/60 for an angular frequency of 1.
pub const FULL_LADDER: [u32; 10] = [32, 64, 128, 256, 377, 512, 1024, 2048, 4096, 8192];
/// Those of the quick one.
pub const QUICK_LADDER: [u32; 6] = [64, 128, 256, 377, 512, 1024];

/// Configurations that tell less end here: the two finer steps cost three times as much as all others together.
pub const FINEST_OF_MOST: u32 = 2048;

/// 1 % of the motion: the limit of what counts as physically right.
pub const RIGHT: f64 = 0.01;

/// Rounding may differ between the engine and the difference equation by this many floors. The engine rounds a few times a step, in
/// positions, velocities and forces; and the floor is a standard deviation, of which the largest of some hundred samples is looked at.
pub const ROUNDINGS: f64 = 16.0;

/// A chain, where it starts, and how long it is watched.
#[derive(Debug, Clone)]
pub struct Experiment {
    pub scenario: &'static str,
    pub chain: OscillatorChain,
    pub start: State,
    pub period: f64,
    pub periods: u32,
    /// Samples per period at least, if there are as many steps.
    pub samples: u32,
}

/// A motion at one step.
#[derive(Debug, Clone)]
pub struct Measured {
    pub trajectory: Trajectory,
    /// The difference equation at the same times.
    pub predicted: Trajectory,
    pub hash: String,
    pub floor: f64,
    /// Largest component of the motion.
    pub scale: f64,
}

/// Largest state errors at one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateError {
    pub found: f64,
    pub expected: f64,
    /// Largest distance from the difference equation, sample by sample.
    pub departure: f64,
    pub tolerance: f64,
}

impl Experiment {
    /// Runs the engine and the difference equation with `steps` steps per period.
    ///
    /// # Errors
    /// Whatever the engine refuses. Divergence is an outcome of the trajectories.
    pub fn measure(
        &self,
        bench: &dyn Bench,
        configuration: Configuration,
        steps: u32,
    ) -> Result<Measured, ConformanceError> {
        let step = self.period / f64::from(steps);
        let (stride, total) = self.grid(steps);
        let sampling = Sampling { interval: step * f64::from(stride), t_end: step * f64::from(total) };
        let trajectory = bench.free(&self.chain, configuration, step)?.trajectory(&self.start, sampling)?;
        let predicted = DifferenceEquation::new(&self.chain, configuration, step).motion(&self.start, total, stride);
        let components = trajectory.samples.iter().flat_map(|sample| sample.state.components());
        let scale = components.fold(0.0, |scale: f64, y| scale.max(y.abs()));
        let floor = rounding_floor(configuration, scale, sampling.t_end, step);
        Ok(Measured { hash: trajectory_hash(&trajectory), trajectory, predicted, floor, scale })
    }

    /// Steps between samples, and of the whole record. Samples fall on steps, so that nothing is interpolated.
    fn grid(&self, steps: u32) -> (u32, u32) {
        let stride = (steps / self.samples).max(1);
        (stride, steps * self.periods / stride * stride)
    }

    /// The difference equation at every step, and the number of steps between samples.
    #[must_use]
    pub fn step_by_step(&self, configuration: Configuration, steps: u32) -> (Trajectory, usize) {
        let (stride, total) = self.grid(steps);
        let equation = DifferenceEquation::new(&self.chain, configuration, self.period / f64::from(steps));
        (equation.motion(&self.start, total, 1), stride as usize)
    }

    /// Started where the difference equation has come after `periods` periods: its transient need not be waited for in the engine. As it was,
    /// if the motion diverges.
    #[must_use]
    pub fn settled(mut self, configuration: Configuration, steps: u32, periods: u32) -> Self {
        let equation = DifferenceEquation::new(&self.chain, configuration, self.period / f64::from(steps));
        let total = steps * periods;
        let motion = equation.motion(&self.start, total, total);
        if !motion.diverged()
            && let Some(last) = motion.samples.last()
        {
            self.start = last.state.clone();
        }
        self
    }

    /// Length of the record.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.period * f64::from(self.periods)
    }
}

impl Measured {
    /// Whether the engine's motion or the predicted one left all bounds.
    #[must_use]
    pub fn diverged(&self) -> bool {
        self.trajectory.diverged() || self.predicted.diverged()
    }

    /// Largest distance from the difference equation at any sample.
    fn departure(&self) -> f64 {
        let pairs = self.trajectory.samples.iter().zip(&self.predicted.samples);
        pairs.map(|(a, b)| a.state.max_difference(&b.state)).fold(0.0, f64::max)
    }

    /// Errors against exact states at the sample times.
    #[must_use]
    pub fn state_error(&self, exact: &[State]) -> StateError {
        let largest = |errors: &mut dyn Iterator<Item = f64>| errors.fold(0.0, f64::max);
        let samples = || self.trajectory.samples.iter().map(|sample| &sample.state);
        StateError {
            found: largest(&mut samples().zip(exact).map(|(a, b)| a.max_difference(b))),
            expected: largest(&mut self.predicted.samples.iter().zip(exact).map(|(a, b)| a.state.max_difference(b))),
            departure: self.departure(),
            tolerance: ROUNDINGS * self.floor,
        }
    }

    /// Positions of an oscillator at the sample times.
    #[must_use]
    pub fn positions(&self, oscillator: usize) -> Vec<f64> {
        self.trajectory.samples.iter().map(|sample| sample.state.positions[oscillator]).collect()
    }

    /// Time between samples.
    #[must_use]
    pub fn interval(&self) -> f64 {
        self.trajectory.samples[1].time
    }

    #[must_use]
    pub fn times(&self) -> Vec<f64> {
        self.trajectory.samples.iter().map(|sample| sample.time).collect()
    }
}

impl StateError {
    /// The row about it; right within 1 % of a motion of size `scale`.
    #[must_use]
    pub fn row(self, subject: &Subject, measured: &Measured, scale: f64) -> Row {
        let Self { found, expected, departure, tolerance } = self;
        let reason = format!(
            "{ROUNDINGS} floors of rounding between the engine and the difference equation at every sample, found {departure:.1e}; right: within 1 % of the motion"
        );
        let judgement = Judgement { basis: Basis::DifferenceEquation, expected, found, tolerance, reason };
        let mut row = subject.row("state_error", judgement).against(0.0, RIGHT * scale);
        // Two maxima may agree while the motions do not. What is no number fails as well.
        let follows = departure <= tolerance;
        if !follows && row.verdict == Verdict::Passed {
            row.verdict = Verdict::Failed;
        }
        row.with_floor(measured.floor).with_trajectory(&measured.hash)
    }
}

/// Hooked configurations as cases: those that tell most in the quick run, all in the full one.
#[must_use]
pub fn hook_cases(scenario: &str, variant: &str, depth: Depth) -> Vec<Case> {
    cases_of(Configuration::hooks(), scenario, variant, depth)
}

/// The same with friction averaged over the step, for motions that have any.
#[must_use]
pub fn friction_cases(scenario: &str, variant: &str, depth: Depth) -> Vec<Case> {
    cases_of(Configuration::hooks().chain(Configuration::averaged()), scenario, variant, depth)
}

fn cases_of(
    configurations: impl Iterator<Item = Configuration>,
    scenario: &str,
    variant: &str,
    depth: Depth,
) -> Vec<Case> {
    let case = |configuration| {
        let notable = is_notable(configuration);
        let mut steps = ladder(depth);
        if !notable {
            steps.retain(|steps| *steps <= FINEST_OF_MOST);
        }
        Case {
            scenario: scenario.to_owned(),
            variant: variant.to_owned(),
            configuration,
            steps,
            depth: if notable { Depth::Quick } else { Depth::Full },
        }
    };
    configurations.map(case).collect()
}

/// Steps per period at a depth.
#[must_use]
pub fn ladder(depth: Depth) -> Vec<u32> {
    match depth {
        Depth::Quick => QUICK_LADDER.to_vec(),
        Depth::Full => FULL_LADDER.to_vec(),
    }
}

/// Configurations that tell most: the second-order scheme in either precision and with either kind of joint, its two spoilt versions, and the engine's
/// defaults.
#[must_use]
pub fn is_notable(configuration: Configuration) -> bool {
    use crate::engine::{Joints, Precision, Scheme};
    let Configuration { precision, joints, substeps, scheme, .. } = configuration;
    match (scheme, substeps) {
        (Scheme::AveragedFriction, 1) => precision == Precision::Double && joints == Joints::Impulse,
        (Scheme::SecondOrder, 1) => precision == Precision::Double || joints == Joints::Impulse,
        (Scheme::LaggingDamping, 1) => precision == Precision::Double && joints == Joints::Impulse,
        (Scheme::Plain, 1) => precision == Precision::Double && joints == Joints::Impulse,
        (Scheme::Plain, 4) => joints == Joints::Impulse,
        _ => false,
    }
}

/// Adds local orders to the step rows of one quantity, and the ladder's own row.
pub fn finish_ladder(rows: &mut Vec<Row>, subject: &Subject, quantity: &str, ladder: &Ladder, tolerance: f64) {
    let mut orders = ladder.local_orders().into_iter();
    for row in rows.iter_mut().filter(|row| row.quantity == quantity && row.found.is_some()) {
        row.order = orders.next().flatten();
    }
    rows.extend(ladder.row(subject, quantity, tolerance));
}

/// Whether the motion stays bounded, as the difference equation says, and as it should.
#[must_use]
pub fn bounded_row(at: &Subject, found: &Trajectory, predicted: &Trajectory) -> Row {
    let bounded = |motion: &Trajectory| f64::from(u8::from(!motion.diverged()));
    let judgement = Judgement {
        basis: Basis::DifferenceEquation,
        expected: bounded(predicted),
        found: bounded(found),
        tolerance: 0.0,
        reason: "1: stays within |x| <= 1000, 0: diverges".to_owned(),
    };
    at.row("bounded", judgement).against(1.0, 0.0).with_trajectory(&trajectory_hash(found))
}

/// Whether all rows passed; what was not run is no failure, and no success either.
#[must_use]
pub fn tally(rows: &[Row]) -> Tally {
    let count = |verdict| rows.iter().filter(|row| row.verdict == verdict).count();
    Tally {
        passed: count(Verdict::Passed),
        failed: count(Verdict::Failed),
        not_run: count(Verdict::NotRun),
        right: rows.iter().filter(|row| row.physics == Physics::Right).count(),
        wrong: rows.iter().filter(|row| row.physics == Physics::Wrong).count(),
    }
}

/// Numbers of rows by verdict and by physics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
pub struct Tally {
    pub passed: usize,
    pub failed: usize,
    pub not_run: usize,
    pub right: usize,
    pub wrong: usize,
}
