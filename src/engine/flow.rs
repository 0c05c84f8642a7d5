//! The rig in Rapier as a [`Flow`].

use super::force_law::{ForceLaw, Known, laws_of};
use super::geometry::RigGeometry;
use super::instant::Instant;
use super::layout::Layout;
use super::plant::{self, Blueprint, Carriages, Plant};
use super::recorder::{Poses, Recorder, Recording};
use super::settings::{EngineSettings, Scheme};
use super::step_map::DiscreteState;
use super::step_path::StepPath;
use super::{EngineError, EngineInfo};
use crate::dynamics::{Flow, Outcome, Sampling, State, Trajectory};
use crate::model::{JenkinsElement, OscillatorChain, Range};
use std::sync::Arc;

/// Beyond this |x| a motion counts as diverged, unless told otherwise.
pub const DEFAULT_AMPLITUDE_BOUND: f64 = 1000.0;

/// A chain of oscillators as carriages in Rapier, moved by its force laws.
#[derive(Debug, Clone)]
pub struct EngineFlow {
    chain: OscillatorChain,
    settings: EngineSettings,
    layout: Arc<Layout>,
    laws: Vec<Arc<dyn ForceLaw>>,
    amplitude_bound: f64,
}

impl EngineFlow {
    /// # Errors
    /// [`EngineError::Parameter`] for settings outside their range.
    pub fn new(chain: &OscillatorChain, settings: EngineSettings) -> Result<Self, EngineError> {
        Ok(Self {
            chain: chain.clone(),
            settings: settings.validated()?,
            layout: Arc::new(Layout::rig(&RigGeometry::default(), chain.oscillators())),
            laws: laws_of(chain),
            amplitude_bound: DEFAULT_AMPLITUDE_BOUND,
        })
    }

    /// With other sizes and rest positions; the motion does not depend on them but for rounding.
    ///
    /// # Errors
    /// [`EngineError::Parameter`] for sizes outside their range.
    pub fn with_geometry(self, geometry: RigGeometry) -> Result<Self, EngineError> {
        let layout = Layout::rig(&geometry.validated()?, self.chain.oscillators());
        Ok(self.with_layout(layout))
    }

    /// With a mover for every oscillator.
    pub(super) fn with_layout(self, layout: Layout) -> Self {
        Self { layout: Arc::new(layout), ..self }
    }

    /// With another bound on |x|, finite and positive.
    ///
    /// # Errors
    /// [`EngineError::Parameter`] otherwise.
    pub fn with_amplitude_bound(self, bound: f64) -> Result<Self, EngineError> {
        Ok(Self { amplitude_bound: Range::Positive.check("amplitude_bound", bound)?, ..self })
    }

    /// With other force laws in place of the chain's own ([`laws_of`]). The energy ledger still measures the works of the chain.
    ///
    /// # Errors
    /// [`EngineError::Parameter`] if a law does not fit the chain.
    pub fn with_laws(self, laws: Vec<Arc<dyn ForceLaw>>) -> Result<Self, EngineError> {
        for law in &laws {
            law.check(&self.chain)?;
        }
        Ok(Self { laws, ..self })
    }

    #[must_use]
    pub fn settings(&self) -> EngineSettings {
        self.settings
    }

    /// Name and version of the engine in use.
    #[must_use]
    pub fn engine(&self) -> EngineInfo {
        EngineInfo::of(self.settings.precision)
    }

    /// The motion with the engine's poses at each sample, joint drift and number of steps.
    ///
    /// # Errors
    /// As [`Flow::trajectory`].
    pub fn record(&self, initial: &State, sampling: Sampling) -> Result<Recording, EngineError> {
        self.run(initial, sampling, Poses::Keep)
    }

    pub(super) fn amplitude_bound(&self) -> f64 {
        self.amplitude_bound
    }

    pub(super) fn chain(&self) -> &OscillatorChain {
        &self.chain
    }

    pub(super) fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Slider forces of `to` from those of `from` and the positions of both.
    pub(super) fn move_sliders(&self, from: &State, to: &mut State) {
        to.slider_forces.copy_from_slice(&from.slider_forces);
        for law in &self.laws {
            law.move_sliders(&from.positions, &to.positions, &mut to.slider_forces);
        }
    }

    fn drag_sliders(&self, path: &StepPath<'_>, slider_forces: &mut [f64], means: &mut [f64]) {
        for law in &self.laws {
            law.drag_sliders(path, slider_forces, means);
        }
    }

    fn run(&self, initial: &State, sampling: Sampling, poses: Poses) -> Result<Recording, EngineError> {
        let steps = steps_for(sampling, self.settings.step)?;
        let start = initial.clone().validated(&self.chain)?;
        let mut run = Run::start(self, start)?;
        let mut recorder = Recorder::new(&self.chain, sampling, poses, &run.now, run.plant.as_ref());
        for n in 0..steps {
            run.step(n)?;
            if run.largest_amplitude() > self.amplitude_bound {
                let outcome = Outcome::Diverged { time: run.now.time, bound: self.amplitude_bound };
                return Ok(recorder.finish(outcome));
            }
            recorder.advance(&run.before, &run.now, run.plant.as_ref());
        }
        Ok(recorder.finish(Outcome::Completed))
    }
}

impl Flow for EngineFlow {
    type Error = EngineError;

    /// `rapier3d-f64` or `rapier3d`.
    fn name(&self) -> String {
        self.engine().name.to_owned()
    }

    /// Samples at multiples of the step are the engine's own positions. Others are interpolated inside the step, with errors of second
    /// order in the step: positions by cubic Hermite, velocities linearly, slider forces by the return mapping.
    fn trajectory(&self, initial: &State, sampling: Sampling) -> Result<Trajectory, EngineError> {
        Ok(self.run(initial, sampling, Poses::Drop)?.trajectory)
    }
}

/// Number of steps that cover the sampling.
pub(super) fn steps_for(sampling: Sampling, step: f64) -> Result<u64, EngineError> {
    Range::Positive.check("sampling.interval", sampling.interval)?;
    Range::NonNegative.check("sampling.t_end", sampling.t_end)?;
    Ok((sampling.t_end / step - super::recorder::SAME_TIME).ceil().max(0.0) as u64)
}

/// A motion under way. `force` and `acceleration` are those at `now`, which the next step will use; `past_acceleration` is that of the
/// step before.
pub(super) struct Run<'a> {
    flow: &'a EngineFlow,
    plant: Box<dyn Plant>,
    pub(super) before: Instant,
    pub(super) now: Instant,
    force: Vec<f64>,
    acceleration: Vec<f64>,
    pub(super) past_acceleration: Vec<f64>,
    /// The engine's velocities `w` and what the force laws are told, see [`Scheme`].
    pub(super) engine_velocities: Vec<f64>,
    known_velocities: Vec<f64>,
    /// Where friction is averaged: slider forces at the time of `engine_velocities`, those a step before, and their means over the step.
    sliders: [Vec<f64>; 2],
    mean_sliders: Vec<f64>,
}

impl<'a> Run<'a> {
    pub(super) fn start(flow: &'a EngineFlow, initial: State) -> Result<Self, EngineError> {
        let n = flow.chain.oscillators();
        let contacts = initial.initial_contacts(&flow.chain);
        let now = Instant { time: 0.0, state: initial, contacts, drive_force: 0.0 };
        let mut force = vec![0.0; n];
        let velocities = now.state.velocities.clone();
        evaluate(flow, &now, &velocities, &mut force)?;
        let acceleration: Vec<f64> = force.iter().zip(flow.chain.mass().iter()).map(|(f, m)| f / m).collect();
        let stagger = flow.settings.stagger();
        let engine_velocities: Vec<f64> = velocities.iter().zip(&acceleration).map(|(v, a)| v - stagger * a).collect();
        let sliders = sliders_before(flow, &now.state.slider_forces, &engine_velocities, &acceleration);
        let plant = build(flow, &now.state.positions, &engine_velocities)?;
        let mut run = Self {
            flow,
            plant,
            before: now.clone(),
            now,
            force,
            past_acceleration: acceleration.clone(),
            acceleration,
            engine_velocities,
            known_velocities: velocities,
            mean_sliders: sliders.clone(),
            sliders: [sliders.clone(), sliders],
        };
        if flow.settings.averages_friction() {
            run.see_forces()?;
            // What is recorded at the start is what was given.
            run.now = run.before.clone();
        }
        if flow.settings.scheme == Scheme::LaggingDamping {
            // No better velocity is known to this scheme than the engine's, from the first step on.
            evaluate(flow, &run.now, &run.engine_velocities, &mut run.force)?;
        }
        Ok(run)
    }

    /// Goes on from a complete discrete state, as if the steps before had been made in this run; time counts from here.
    pub(super) fn resume(flow: &'a EngineFlow, from: &DiscreteState) -> Result<Self, EngineError> {
        let engine_velocities = from.engine_velocities.clone();
        let state = State {
            positions: from.positions.clone(),
            velocities: engine_velocities.clone(),
            slider_forces: from.slider_forces.clone(),
        };
        let state = state.validated(&flow.chain)?;
        let contacts = state.initial_contacts(&flow.chain);
        let now = Instant { time: 0.0, state, contacts, drive_force: 0.0 };
        let zeros = vec![0.0; flow.chain.oscillators()];
        let mut past_acceleration = zeros.clone();
        past_acceleration[..from.past_accelerations.len()].copy_from_slice(&from.past_accelerations);
        let sliders = from.slider_forces.clone();
        let mut run = Self {
            flow,
            plant: build(flow, &now.state.positions, &engine_velocities)?,
            mean_sliders: sliders.clone(),
            sliders: [sliders.clone(), sliders],
            before: now.clone(),
            now,
            force: zeros.clone(),
            acceleration: zeros.clone(),
            past_acceleration,
            engine_velocities,
            known_velocities: zeros,
        };
        run.see_forces()?;
        Ok(run)
    }

    /// Step number `n`, from `n h` to `(n + 1) h`.
    pub(super) fn step(&mut self, n: u64) -> Result<(), EngineError> {
        let settings = &self.flow.settings;
        let time = (n + 1) as f64 * settings.step;
        self.plant.step_with_forces(&self.force).map_err(|found| EngineError::Quarantined { time, found })?;
        std::mem::swap(&mut self.before, &mut self.now);
        self.now.time = time;
        self.plant.read_positions(&mut self.now.state.positions);
        if settings.averages_friction() {
            // With the velocities at the beginning of the step, which are read anew below.
            self.carry_sliders();
        }
        self.plant.read_velocities(&mut self.engine_velocities);
        self.check_finite()?;
        if !settings.averages_friction() {
            self.flow.move_sliders(&self.before.state, &mut self.now.state);
        }
        std::mem::swap(&mut self.past_acceleration, &mut self.acceleration);
        self.see_forces()
    }

    /// Forces at `now`: velocities are predicted with the acceleration of the step that led here, then corrected with the one found.
    fn see_forces(&mut self) -> Result<(), EngineError> {
        let settings = &self.flow.settings;
        let stagger = settings.stagger();
        let prediction = if settings.scheme == Scheme::LaggingDamping { 0.0 } else { stagger };
        for (i, known) in self.known_velocities.iter_mut().enumerate() {
            *known = self.engine_velocities[i] + prediction * self.past_acceleration[i];
        }
        let averages = settings.averages_friction();
        if averages {
            self.average_sliders();
        }
        evaluate(self.flow, &self.now, &self.known_velocities, &mut self.force)?;
        for (i, mass) in self.flow.chain.mass().iter().enumerate() {
            self.acceleration[i] = self.force[i] / mass;
            self.now.state.velocities[i] = self.engine_velocities[i] + stagger * self.acceleration[i];
        }
        if averages {
            self.record_sliders();
        }
        self.now.find_contacts(&self.flow.chain);
        Ok(())
    }

    /// Puts the means of the friction forces over the predicted step in the place of the slider forces, for the force laws to see.
    fn average_sliders(&mut self) {
        self.mean_sliders.copy_from_slice(&self.sliders[1]);
        let mut end = self.sliders[1].clone();
        let (velocities, duration) = (&self.engine_velocities, self.flow.settings.step);
        let path = StepPath { velocities, accelerations: &self.past_acceleration, duration };
        self.flow.drag_sliders(&path, &mut end, &mut self.mean_sliders);
        self.now.state.slider_forces.copy_from_slice(&self.mean_sliders);
    }

    /// Puts the slider forces in the middle of the step in the place of their means.
    fn record_sliders(&mut self) {
        self.now.state.slider_forces.copy_from_slice(&self.sliders[1]);
        let duration = 0.5 * self.flow.settings.step;
        let path = StepPath { velocities: &self.engine_velocities, accelerations: &self.acceleration, duration };
        self.flow.drag_sliders(&path, &mut self.now.state.slider_forces, &mut self.mean_sliders);
    }

    /// Moves the sliders along the step that was made.
    fn carry_sliders(&mut self) {
        let [before, now] = &mut self.sliders;
        before.copy_from_slice(now);
        let (velocities, duration) = (&self.engine_velocities, self.flow.settings.step);
        let path = StepPath { velocities, accelerations: &self.acceleration, duration };
        self.flow.drag_sliders(&path, now, &mut self.mean_sliders);
    }

    /// The slider forces that the coming steps depend on.
    pub(super) fn carried_sliders(&self) -> &[f64] {
        if self.flow.settings.averages_friction() { &self.sliders[1] } else { &self.now.state.slider_forces }
    }

    /// Whether an element reached or left its limit in the last step.
    pub(super) fn slider_switched(&self) -> bool {
        let averages = self.flow.settings.averages_friction();
        let before = if averages { &self.sliders[0] } else { &self.before.state.slider_forces };
        let forces = before.iter().zip(self.carried_sliders());
        forces.into_iter().any(|(before, now)| (before.abs() >= 1.0) != (now.abs() >= 1.0))
    }

    fn check_finite(&self) -> Result<(), EngineError> {
        let time = self.now.time;
        for values in [&self.now.state.positions, &self.engine_velocities] {
            if let Some(oscillator) = values.iter().position(|value| !value.is_finite()) {
                return Err(EngineError::MotionNotFinite { time, oscillator, found: values[oscillator] });
            }
        }
        Ok(())
    }

    pub(super) fn largest_amplitude(&self) -> f64 {
        self.now.state.positions.iter().fold(0.0, |largest, x| largest.max(x.abs()))
    }
}

/// Slider forces half a step before the start: those that stick there have come from where the path led them.
fn sliders_before(flow: &EngineFlow, forces: &[f64], velocities: &[f64], accelerations: &[f64]) -> Vec<f64> {
    let path = StepPath { velocities, accelerations, duration: 0.5 * flow.settings.step };
    let before = |(element, &f): (&JenkinsElement, &f64)| {
        let moved = element.normalised_stiffness() * path.elongation(element.attachment);
        if f.abs() < 1.0 { (f - moved).clamp(-1.0, 1.0) } else { f }
    };
    flow.chain.jenkins().iter().zip(forces).map(before).collect()
}

fn build(flow: &EngineFlow, positions: &[f64], velocities: &[f64]) -> Result<Box<dyn Plant>, EngineError> {
    plant::build(&Blueprint {
        masses: flow.chain.mass().as_slice(),
        positions,
        velocities,
        layout: &flow.layout,
        settings: flow.settings,
        carriages: Carriages::Free,
    })
}

/// The forces of all laws at an instant, seen with the given velocities.
pub(super) fn evaluate(
    flow: &EngineFlow,
    at: &Instant,
    velocities: &[f64],
    force: &mut [f64],
) -> Result<(), EngineError> {
    force.fill(0.0);
    let Instant { time, state, .. } = at;
    let known = Known { time: *time, positions: &state.positions, velocities, slider_forces: &state.slider_forces };
    for law in &flow.laws {
        law.add_force(&known, force);
    }
    match force.iter().position(|f| !f.is_finite()) {
        Some(oscillator) => Err(EngineError::ForceNotFinite { time: *time, oscillator, found: force[oscillator] }),
        None => Ok(()),
    }
}
