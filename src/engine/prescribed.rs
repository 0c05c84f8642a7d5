//! Prescribed motion in the engine: the carriage of oscillator 0 is a kinematic body that follows `x_0 = a sin(w t)`, the others
//! are kinematic and stand still. The Jenkins elements follow by the same return mapping as in free motion.
//!
//! The force that the drive needs is `F = m_0 x_0'' - F_laws`, and its work is in the ledger, which so closes with second order.

use super::flow::{evaluate, steps_for};
use super::instant::Instant;
use super::plant::{self, Blueprint, Carriages};
use super::recorder::{Poses, Recorder, Recording};
use super::{EngineError, EngineFlow, EngineInfo, EngineSettings};
use crate::dynamics::{Flow, Outcome, Sampling, State, Trajectory};
use crate::model::{ContactState, OscillatorChain, PrescribedMotion};

/// A chain whose oscillator 0 is moved by hand.
#[derive(Debug, Clone)]
pub struct PrescribedFlow {
    chain: OscillatorChain,
    motion: PrescribedMotion,
    flow: EngineFlow,
}

impl PrescribedFlow {
    /// Of the settings, joints, substeps and scheme have no influence: nothing is free to move.
    ///
    /// # Errors
    /// [`EngineError::Parameter`] for settings or a motion outside their range.
    pub fn new(
        chain: &OscillatorChain,
        motion: PrescribedMotion,
        settings: EngineSettings,
    ) -> Result<Self, EngineError> {
        let flow = EngineFlow::new(chain, settings)?;
        Ok(Self { chain: chain.clone(), motion: motion.validated()?, flow })
    }

    /// Name and version of the engine in use.
    #[must_use]
    pub fn engine(&self) -> EngineInfo {
        self.flow.engine()
    }

    /// The motion with the engine's poses. `initial` gives the slider forces and where the other oscillators are held.
    ///
    /// # Errors
    /// As [`Flow::trajectory`]; [`EngineError::OffPrescribedMotion`] unless oscillator 0 starts at 0 with the velocity `a w`, and the
    /// others at rest.
    pub fn record(&self, initial: &State, sampling: Sampling) -> Result<Recording, EngineError> {
        self.run(initial, sampling, Poses::Keep)
    }

    fn run(&self, initial: &State, sampling: Sampling, poses: Poses) -> Result<Recording, EngineError> {
        let step = self.flow.settings().step;
        let steps = steps_for(sampling, step)?;
        let mut now = self.start(initial)?;
        let mut plant = plant::build(&Blueprint {
            masses: self.chain.mass().as_slice(),
            positions: &now.state.positions,
            velocities: &vec![0.0; self.chain.oscillators()],
            layout: self.flow.layout(),
            settings: self.flow.settings(),
            carriages: Carriages::Kinematic,
        })?;
        let mut recorder = Recorder::new(&self.chain, sampling, poses, &now, plant.as_ref());
        let mut before = now.clone();
        let mut target = now.state.positions.clone();
        for n in 0..steps {
            let time = (n + 1) as f64 * step;
            target[0] = self.motion.position(time);
            plant.step_to(&target).map_err(|found| EngineError::Quarantined { time, found })?;
            std::mem::swap(&mut before, &mut now);
            now.time = time;
            plant.read_positions(&mut now.state.positions);
            self.flow.move_sliders(&before.state, &mut now.state);
            self.complete(&mut now)?;
            recorder.advance(&before, &now, plant.as_ref());
        }
        Ok(recorder.finish(Outcome::Completed))
    }

    fn start(&self, initial: &State) -> Result<Instant, EngineError> {
        let state = initial.clone().validated(&self.chain)?;
        Self::agree("positions", 0, state.positions[0], 0.0, self.motion.amplitude)?;
        let speed = self.motion.velocity(0.0);
        for (index, &velocity) in state.velocities.iter().enumerate() {
            let expected = if index == 0 { speed } else { 0.0 };
            Self::agree("velocities", index, velocity, expected, speed)?;
        }
        let contacts = vec![ContactState::Stick; self.chain.sliders()];
        let mut start = Instant { time: 0.0, state, contacts, drive_force: 0.0 };
        self.complete(&mut start)?;
        Ok(start)
    }

    /// Room for rounding: the state may have been computed in another way.
    fn agree(field: &'static str, index: usize, found: f64, expected: f64, scale: f64) -> Result<(), EngineError> {
        if (found - expected).abs() <= 1e-12 * scale {
            return Ok(());
        }
        Err(EngineError::OffPrescribedMotion { field, index, found, expected })
    }

    /// Fills in what the motion prescribes (velocity) and what follows from it (contacts, force of the drive).
    fn complete(&self, now: &mut Instant) -> Result<(), EngineError> {
        now.state.velocities[0] = self.motion.velocity(now.time);
        now.find_contacts(&self.chain);
        let mut force = vec![0.0; self.chain.oscillators()];
        evaluate(&self.flow, now, &now.state.velocities, &mut force)?;
        let acceleration = -self.motion.angular_frequency.powi(2) * self.motion.position(now.time);
        now.drive_force = self.chain.mass()[0] * acceleration - force[0];
        Ok(())
    }
}

impl Flow for PrescribedFlow {
    type Error = EngineError;

    fn name(&self) -> String {
        format!("{}-prescribed", self.flow.name())
    }

    fn trajectory(&self, initial: &State, sampling: Sampling) -> Result<Trajectory, EngineError> {
        Ok(self.run(initial, sampling, Poses::Drop)?.trajectory)
    }
}
