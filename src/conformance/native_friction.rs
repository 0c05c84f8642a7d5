//! What a Jenkins element realised by Rapier's own means gets wrong, each measured on a small motion with an exact counterpart.
//!
//! The element has stiffness kt = 1 and slip force R = 1; where its slider is a body, of mass ms, its own angular frequency is
//! `ws = sqrt(kt/ms)`.
//!
//! ```text
//! hysteresis  x = 1.5 sin t:   loop area 4 R (a - R/kt) = 2 (slider bodies: see `slider_body`),   slip from x = a - 2
//! R/kt after a reversal until the next reversal hold        x = 0.5, f = 0.5:   the slider stays where it is
//! stick       x'' + x + f = 0 from x = 0.5:   f = x,   angular frequency sqrt 2, no damping
//! slip        x'' + x + f = 0 with R = 0.001 from x = 1:   the slider rides along, angular frequency 1
//! decay       x'' + x + f = 0 from x = 3:   the third maximum after the start, by the exact flow
//! ```

use super::ConformanceError;
use super::oscillation::{Oscillation, maxima, upward_zeros};
use super::scenario::Bench;
use super::slider_map::{SliderMap, Start};
use crate::dynamics::{DenseFlow, Motion, Outcome, State};
use crate::engine::EngineSettings;
use crate::engine::mechanism::{
    Drive, ElementSpring, FrictionElement, FrictionMechanism, InnerSolver, MechanismFlow, MechanismMotion,
    MechanismRig, MechanismSample,
};
use crate::exact::ChainFlow;
use crate::model::{
    Attachment, ChainBuilder, JenkinsElement, OscillatorChain, PrescribedMotion, RigParameters, TwoMassRig,
};
use crate::orbit::PeriodicOrbit;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Amplitude of the prescribed motion.
pub const AMPLITUDE: f64 = 1.5;
/// A slider slower than this part of the largest speed of the carriage has stopped.
const STOPPED: f64 = 0.01;
/// Force under which a slider is held, and for how long.
pub const HELD_FORCE: f64 = 0.5;
pub const HOLDING_TIME: f64 = 4.0;
/// Length of the free oscillation of a carriage that takes its light slider with it.
pub const RIDING_TIME: f64 = 40.0;
/// Length of a decay.
const DECAY_TIME: f64 = 20.0;
/// Length of a run of the two-mass rig, of which the last fifth is measured.
pub const RIG_TIME: f64 = 1000.0;
/// Cycles that are run, of which the last is measured.
const CYCLES: u64 = 3;

/// How the element is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Making {
    pub mechanism: FrictionMechanism,
    pub slider_mass: f64,
    pub spring: ElementSpring,
    pub solver: InnerSolver,
}

impl Making {
    /// With Rapier's default solver.
    #[must_use]
    pub fn new(mechanism: FrictionMechanism, slider_mass: f64, spring: ElementSpring) -> Self {
        Self { mechanism, slider_mass, spring, solver: InnerSolver::default() }
    }

    fn element(self, stiffness: f64, slip_force: f64) -> FrictionElement {
        let Self { mechanism, slider_mass, spring, .. } = self;
        FrictionElement { carriage: 0, stiffness, slip_force, mechanism, slider_mass, spring }
    }

    fn rig(self, chain: OscillatorChain, element: FrictionElement, drive: Drive) -> MechanismRig {
        MechanismRig { friction: Some(element), drive, solver: self.solver, ..MechanismRig::of(chain) }
    }

    /// A carriage of unit mass on a unit spring.
    fn oscillator(
        self,
        bench: &dyn Bench,
        settings: EngineSettings,
        slip_force: f64,
        drive: Drive,
    ) -> Result<MechanismFlow, ConformanceError> {
        let chain = ChainBuilder::new(vec![1.0]).ground_spring(0, 1.0).build()?;
        bench.native(self.rig(chain, self.element(1.0, slip_force), drive), settings)
    }
}

/// One cycle of prescribed motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hysteresis {
    /// Exact: 2.
    pub loop_area: f64,
    /// Mean, least and largest force over the second half of a slip phase, in its direction. Exact: 1.
    pub slip_force: [f64; 3],
    /// Largest force of the cycle. Exact: 1.
    pub largest_force: f64,
    /// Times found minus exact: the slider runs faster than half the carriage; it runs slower than 1 % of the largest speed.
    /// None where it never does.
    pub slip_start_delay: Option<f64>,
    pub slip_stop_delay: Option<f64>,
}

/// Loop area that the element should have.
pub const EXACT_LOOP_AREA: f64 = 4.0 * (AMPLITUDE - 1.0);

/// A point of a driven motion: position of the carriage, of the slider, and the force in the element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Driven {
    pub x: f64,
    pub slider: f64,
    pub force: f64,
}

/// The same settings with a whole number of steps per cycle, and that number.
fn whole(settings: EngineSettings) -> (EngineSettings, u64) {
    let steps = (TAU / settings.step).round();
    (EngineSettings { step: TAU / steps, ..settings }, steps as u64)
}

const PRESCRIBED: PrescribedMotion = PrescribedMotion { amplitude: AMPLITUDE, angular_frequency: 1.0 };

/// In the engine.
///
/// # Errors
/// Whatever stops it. The step is rounded to a whole number of steps per cycle.
pub fn hysteresis(bench: &dyn Bench, making: Making, settings: EngineSettings) -> Result<Hysteresis, ConformanceError> {
    let (settings, steps) = whole(settings);
    let start = MechanismSample::single(0.0, AMPLITUDE);
    let flow = making.oscillator(bench, settings, 1.0, Drive::Prescribed(PRESCRIBED))?;
    let motion = flow.run(&start, CYCLES * steps, 1)?;
    let point = |sample: &MechanismSample| {
        let slider = sample.slider?;
        Some(Driven { x: sample.positions[0], slider: slider.position, force: slider.force })
    };
    Ok(Hysteresis::of(&motion.samples.iter().filter_map(point).collect::<Vec<_>>(), settings.step))
}

/// By the difference equation, where one is known of a slider body. The step is rounded as in [`hysteresis`].
///
/// # Errors
/// [`ConformanceError`] if the oscillator cannot be built.
pub fn predicted_hysteresis(making: Making, settings: EngineSettings) -> Result<Option<Hysteresis>, ConformanceError> {
    if !making.mechanism.has_slider_body() {
        return Ok(None);
    }
    let (settings, steps) = whole(settings);
    let chain = ChainBuilder::new(vec![1.0]).ground_spring(0, 1.0).build()?;
    let map = SliderMap { chain: &chain, stiffness: 1.0, slip_force: 1.0, making, settings };
    Ok(map.driven(PRESCRIBED, CYCLES * steps).map(|points| Hysteresis::of(&points, settings.step)))
}

impl Hysteresis {
    /// Of the last of [`CYCLES`] cycles from time 0 on, a point per step.
    fn of(points: &[Driven], step: f64) -> Self {
        let steps = (TAU / step).round() as u64;
        // From the lower reversal before the last cycle, where the force is -1, on.
        let first = ((CYCLES - 1) * steps - steps / 4) as usize;
        let cycle = &points[first..first + steps as usize];
        let next = |n: usize| cycle[(n + 1) % cycle.len()];
        let area = |n: usize| 0.5 * (cycle[n].force + next(n).force) * (next(n).x - cycle[n].x);
        let half = cycle.len() / 2;
        // Rising from -a, the force reaches +R after the way 2 R/kt.
        let corner = 2.0 - AMPLITUDE;
        let phase = |time: f64| (time + FRAC_PI_2) / step;
        let slip_from = phase((corner / AMPLITUDE).asin());
        let late: Vec<f64> =
            cycle[(0.5 * (slip_from + half as f64)) as usize..half].iter().map(|point| point.force).collect();
        let mean = late.iter().sum::<f64>() / late.len() as f64;
        let slip_force =
            [mean, late.iter().copied().fold(f64::MAX, f64::min), late.iter().copied().fold(f64::MIN, f64::max)];
        let speed = |n: usize| (cycle[n + 1].slider - cycle[n].slider) / step;
        let starts =
            |n: &usize| speed(*n) > 0.5 * (cycle[n + 1].x - cycle[*n].x) / step && speed(*n) > STOPPED * AMPLITUDE;
        let start = (1..half - 1).find(starts);
        let stop = start.and_then(|start| {
            let runs = |n: &usize| speed(*n) > STOPPED * AMPLITUDE;
            (start..cycle.len() - 1).take_while(|n| *n < half + half / 2).filter(runs).last()
        });
        // The carriage itself is slower than the threshold this long before its reversal.
        let exact_stop = half as f64 - STOPPED.asin() / step;
        let offset = phase(first as f64 * step - TAU * (CYCLES - 1) as f64);
        let delay = |n: Option<usize>, lead: f64, exact: f64| n.map(|n| (n as f64 + lead + offset - exact) * step);
        Self {
            loop_area: (0..cycle.len()).map(area).sum(),
            slip_force,
            largest_force: cycle.iter().fold(0.0, |largest: f64, point| largest.max(point.force.abs())),
            slip_start_delay: delay(start, 0.0, slip_from),
            slip_stop_delay: delay(stop, 1.0, exact_stop),
        }
    }
}

/// An element under a constant elongation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// How far the slider went until the middle of the time.
    pub settled: f64,
    /// Its mean speed over the rest.
    pub creep_rate: f64,
}

/// # Errors
/// Whatever stops the engine.
pub fn hold(bench: &dyn Bench, making: Making, settings: EngineSettings) -> Result<Hold, ConformanceError> {
    let half = (0.5 * HOLDING_TIME / settings.step).round() as u64;
    let flow = making.oscillator(bench, settings, 1.0, Drive::Held)?;
    let motion = flow.run(&MechanismSample::at(vec![HELD_FORCE], vec![0.0], HELD_FORCE), 2 * half, half)?;
    let sliders: Vec<f64> = motion.samples.iter().filter_map(|s| s.slider).map(|s| s.position).collect();
    let [start, middle, end] = sliders.as_slice() else {
        return Err(too_few("positions of the slider", sliders.len(), 3));
    };
    Ok(Hold { settled: middle - start, creep_rate: (end - middle) / (half as f64 * settings.step) })
}

/// Damping and frequency of an oscillation in the engine, and in the difference equation where one is known.
pub type Twofold = (Oscillation, Option<Oscillation>);

/// Damping and frequency while the element sticks. Exact: 0 and the square root of 2.
///
/// # Errors
/// Whatever stops the engine, and a motion that is no oscillation.
pub fn stick(bench: &dyn Bench, making: Making, settings: EngineSettings) -> Result<Twofold, ConformanceError> {
    oscillation(bench, making, settings, 1.0, Start { positions: vec![0.5], velocities: vec![0.0], force: 0.5 })
}

/// Damping and frequency while the slider rides along. Exact frequency: 1, but for less than 3e-5.
///
/// # Errors
/// Whatever stops the engine, and a motion that is no oscillation.
pub fn ride(bench: &dyn Bench, making: Making, settings: EngineSettings) -> Result<Twofold, ConformanceError> {
    oscillation(bench, making, settings, 1e-3, Start { positions: vec![1.0], velocities: vec![0.0], force: 1e-3 })
}

fn oscillation(
    bench: &dyn Bench,
    making: Making,
    settings: EngineSettings,
    slip_force: f64,
    start: Start,
) -> Result<Twofold, ConformanceError> {
    let chain = ChainBuilder::new(vec![1.0]).ground_spring(0, 1.0).build()?;
    let map = SliderMap { chain: &chain, stiffness: 1.0, slip_force, making, settings };
    let predicted = map.positions(&start, (RIDING_TIME / settings.step).round() as u64);
    let Start { positions, velocities, force } = start;
    let flow = making.oscillator(bench, settings, slip_force, Drive::Free)?;
    let motion = run_free(flow, &MechanismSample::at(positions, velocities, force), RIDING_TIME)?;
    let predicted = predicted.and_then(|positions| Oscillation::of(&positions, settings.step));
    Ok((of_carriage(&motion, settings.step)?, predicted))
}

/// A number found in the engine, given by the difference equation where one is known, and exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threefold {
    pub found: f64,
    pub predicted: Option<f64>,
    pub exact: f64,
}

/// The third maximum after a start at x = 3.
///
/// # Errors
/// Whatever stops the engine or the exact flow.
pub fn decay(bench: &dyn Bench, making: Making, settings: EngineSettings) -> Result<Threefold, ConformanceError> {
    let start = MechanismSample::at(vec![3.0], vec![0.0], 1.0);
    let motion = run_free(making.oscillator(bench, settings, 1.0, Drive::Free)?, &start, DECAY_TIME)?;
    let found = third_maximum(&of_positions(&motion), settings.step)?;
    let plain = ChainBuilder::new(vec![1.0]).ground_spring(0, 1.0);
    let start = Start { positions: vec![3.0], velocities: vec![0.0], force: 1.0 };
    let chain = plain.clone().build()?;
    let map = SliderMap { chain: &chain, stiffness: 1.0, slip_force: 1.0, making, settings };
    let predicted = map.positions(&start, (DECAY_TIME / settings.step).round() as u64);
    let predicted = predicted.map(|positions| third_maximum(&positions, settings.step)).transpose()?;
    let element = JenkinsElement { attachment: Attachment::Ground(0), stiffness: 1.0, slip_force: 1.0 };
    let state = State { positions: vec![3.0], velocities: vec![0.0], slider_forces: vec![1.0] };
    let exact = ChainFlow::new(&plain.jenkins(element).build()?).motion(&state, DECAY_TIME)?;
    let at = |n: u32| exact.state(f64::from(n) * 1e-3).map(|state| state.positions[0]);
    let positions: Result<Vec<f64>, _> = (0..=20_000).map(at).collect();
    Ok(Threefold { found, predicted, exact: third_maximum(&positions?, 1e-3)? })
}

/// The two-mass rig with a native element, started on an orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigMotion {
    /// Least and largest maximum of x1 over the last fifth.
    pub maxima: [f64; 2],
    pub angular_frequency: f64,
}

/// What the engine does, and the difference equation where one is known.
///
/// # Errors
/// Whatever stops the engine, [`ConformanceError::Diverged`], and a motion that is no oscillation.
pub fn two_mass(
    bench: &dyn Bench,
    making: Making,
    parameters: RigParameters,
    start: &PeriodicOrbit,
    settings: EngineSettings,
) -> Result<(RigMotion, Option<RigMotion>), ConformanceError> {
    let rig = TwoMassRig::new(parameters)?;
    let whole = rig.chain();
    let chain = ChainBuilder::new(whole.mass().as_slice().to_vec())
        .add_stiffness(whole.stiffness())
        .add_damping(whole.damping())
        .add_self_excitation(whole.self_excitation())
        .build()?;
    let gamma = parameters.gamma;
    let State { positions, velocities, slider_forces } = start.reversal();
    let start = Start { positions, velocities, force: gamma * slider_forces[0] };
    let map = SliderMap { chain: &chain, stiffness: gamma, slip_force: gamma, making, settings };
    let predicted = map.positions(&start, (RIG_TIME / settings.step).round() as u64);
    let flow = bench.native(making.rig(chain.clone(), making.element(gamma, gamma), Drive::Free), settings)?;
    let Start { positions, velocities, force } = start;
    let motion = run_free(flow, &MechanismSample::at(positions, velocities, force), RIG_TIME)?;
    let predicted = predicted.map(|positions| RigMotion::of(&positions, settings.step)).transpose()?;
    Ok((RigMotion::of(&of_positions(&motion), settings.step)?, predicted))
}

impl RigMotion {
    fn of(positions: &[f64], step: f64) -> Result<Self, ConformanceError> {
        let last = &positions[positions.len() / 5 * 4..];
        let values: Vec<f64> = maxima(last, step).into_iter().map(|maximum| maximum.1).collect();
        let zeros = upward_zeros(last, step);
        let [first, .., end] = zeros.as_slice() else { return Err(too_few("upward zeros", zeros.len(), 2)) };
        Ok(Self {
            maxima: [values.iter().copied().fold(f64::MAX, f64::min), values.iter().copied().fold(f64::MIN, f64::max)],
            angular_frequency: TAU * (zeros.len() - 1) as f64 / (end - first),
        })
    }
}

fn run_free(flow: MechanismFlow, start: &MechanismSample, duration: f64) -> Result<MechanismMotion, ConformanceError> {
    let motion = flow.run(start, (duration / flow.settings().step).round() as u64, 1)?;
    match motion.outcome {
        Outcome::Completed => Ok(motion),
        Outcome::Diverged { time, bound } => Err(ConformanceError::Diverged { scenario: SCENARIO, time, bound }),
    }
}

fn of_positions(motion: &MechanismMotion) -> Vec<f64> {
    motion.samples.iter().map(|sample| sample.positions[0]).collect()
}

fn of_carriage(motion: &MechanismMotion, step: f64) -> Result<Oscillation, ConformanceError> {
    Oscillation::of(&of_positions(motion), step).ok_or_else(|| too_few("maxima", 2, 3))
}

fn third_maximum(positions: &[f64], step: f64) -> Result<f64, ConformanceError> {
    let found = maxima(positions, step);
    found.get(2).map(|maximum| maximum.1).ok_or_else(|| too_few("maxima", found.len(), 3))
}

const SCENARIO: &str = "native_friction";

fn too_few(what: &'static str, found: usize, expected: usize) -> ConformanceError {
    ConformanceError::TooFew { scenario: SCENARIO, what, found, expected }
}
