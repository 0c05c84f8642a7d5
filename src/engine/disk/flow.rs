//! A bladed disk in Rapier as a [`Flow`]: the chain of oscillators of [`crate::model::BladedDisk`] as bodies round a hub.
//!
//! Step, scheme and errors are those of [`EngineFlow`]. Contacts to ground, between blades and between blade and segment are force laws by return
//! mapping; stiffness and damping may be non-symmetric, as influence coefficients are, and are kept sparse: the cost of a step grows linearly
//! with the number of blades.
//!
//! Choose impulse joints for many blades: multibody joints on one hub form a single multibody, whose mass matrix is dense.

use super::geometry::DiskGeometry;
use crate::dynamics::{Flow, Outcome, Sampling, State, Trajectory};
use crate::engine::flow::{EngineFlow, Run, steps_for};
use crate::engine::recorder::{Recording, SAME_TIME};
use crate::engine::{EngineError, EngineInfo, EngineSettings, JenkinsElements, LinearForces, events};
use crate::model::{BladedDisk, ContactState, OscillatorChain};
use std::sync::Arc;

/// N blades round a hub in Rapier.
#[derive(Debug, Clone)]
pub struct DiskFlow {
    disk: BladedDisk,
    flow: EngineFlow,
}

/// Where an observed motion ended.
#[derive(Debug, Clone, PartialEq)]
pub struct DiskArrival {
    /// At the last step.
    pub state: State,
    /// Changes of contact state.
    pub switches: usize,
    /// Steps taken.
    pub steps: u64,
    pub outcome: Outcome,
}

impl DiskFlow {
    /// With bodies of the default sizes.
    ///
    /// # Errors
    /// [`EngineError::Parameter`] for a disk that cannot be built and settings outside their range.
    pub fn new(disk: &BladedDisk, settings: EngineSettings) -> Result<Self, EngineError> {
        let chain = disk.chain()?;
        let flow = EngineFlow::new(&chain, settings)?;
        let flow = flow
            .with_laws(vec![Arc::new(LinearForces::of(&chain)), Arc::new(JenkinsElements(chain.jenkins().to_vec()))])?;
        Self { disk: disk.clone(), flow }.with_geometry(DiskGeometry::default())
    }

    /// With other sizes, or blades that move along the axis.
    ///
    /// # Errors
    /// [`EngineError::Parameter`] for sizes outside their range.
    pub fn with_geometry(self, geometry: DiskGeometry) -> Result<Self, EngineError> {
        let layout = geometry.validated()?.layout(&self.disk);
        Ok(Self { flow: self.flow.with_layout(layout), ..self })
    }

    /// With another bound on |x|, finite and positive.
    ///
    /// # Errors
    /// [`EngineError::Parameter`] otherwise.
    pub fn with_amplitude_bound(self, bound: f64) -> Result<Self, EngineError> {
        Ok(Self { flow: self.flow.with_amplitude_bound(bound)?, ..self })
    }

    #[must_use]
    pub fn chain(&self) -> &OscillatorChain {
        self.flow.chain()
    }

    #[must_use]
    pub fn settings(&self) -> EngineSettings {
        self.flow.settings()
    }

    /// Name and version of the engine in use.
    #[must_use]
    pub fn engine(&self) -> EngineInfo {
        self.flow.engine()
    }

    /// The motion with the engine's poses at each sample: hub first, then the blades, then the segments if there are any.
    ///
    /// # Errors
    /// As [`EngineFlow::record`].
    pub fn record(&self, initial: &State, sampling: Sampling) -> Result<Recording, EngineError> {
        self.flow.record(initial, sampling)
    }

    /// Follows the motion and shows it at the times of `sampling`, up to divergence: time, state, contact states just after. Keeps nothing,
    /// unlike [`Self::record`], whose events hold a state each.
    ///
    /// # Errors
    /// As [`EngineFlow::record`].
    pub fn observe(
        &self,
        initial: &State,
        sampling: Sampling,
        mut see: impl FnMut(f64, &State, &[ContactState]),
    ) -> Result<DiskArrival, EngineError> {
        let chain = self.chain();
        let steps = steps_for(sampling, self.settings().step)?;
        let mut run = Run::start(&self.flow, initial.clone().validated(chain)?)?;
        let mut times = sampling.times().peekable();
        while times.next_if(|&time| time <= 0.0).is_some() {
            see(0.0, &run.now.state, &run.now.contacts);
        }
        let (mut switches, mut taken, mut outcome) = (0, 0, Outcome::Completed);
        while taken < steps && outcome == Outcome::Completed {
            run.step(taken)?;
            taken += 1;
            if run.largest_amplitude() > self.flow.amplitude_bound() {
                outcome = Outcome::Diverged { time: run.now.time, bound: self.flow.amplitude_bound() };
                break;
            }
            switches += events::count(chain, &run.before, &run.now);
            // Exactly as the recorder does it, so that both show the same numbers.
            let step = run.now.time - run.before.time;
            while let Some(time) = times.next_if(|&time| time <= run.now.time + SAME_TIME * step) {
                if time < run.now.time - SAME_TIME * step {
                    let at = run.before.towards(&run.now, (time - run.before.time) / step, chain);
                    see(time, &at.state, &at.contacts);
                } else {
                    see(time, &run.now.state, &run.now.contacts);
                }
            }
        }
        Ok(DiskArrival { state: run.now.state, switches, steps: taken, outcome })
    }
}

impl Flow for DiskFlow {
    type Error = EngineError;

    fn name(&self) -> String {
        self.flow.name()
    }

    fn trajectory(&self, initial: &State, sampling: Sampling) -> Result<Trajectory, EngineError> {
        self.flow.trajectory(initial, sampling)
    }
}
