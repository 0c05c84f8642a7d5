//! What a scenario is: a motion that is set up in the engine, measured, and judged against a reference that shares with it the description of the
//! model, and no evolution in time.

use super::ConformanceError;
use super::configuration::{Configuration, Mechanism};
use super::exchange::Setup;
use super::row::{Row, Subject};
use crate::engine::mechanism::{MechanismFlow, MechanismRig};
use crate::engine::{EngineFlow, EngineSettings, PrescribedFlow};
use crate::model::{OscillatorChain, PrescribedMotion};
use serde::{Deserialize, Serialize};

/// How much is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Depth {
    /// A selection of configurations and steps, for every change of the code.
    Quick,
    /// Everything.
    Full,
}

/// A unit of work: one variant of one scenario in one configuration, over a ladder of steps. Saved when it is done.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Case {
    pub scenario: String,
    pub variant: String,
    pub configuration: Configuration,
    /// Steps per period, coarse to fine.
    pub steps: Vec<u32>,
    /// The least depth that asks for this case.
    pub depth: Depth,
}

/// Builds motions in the engine. The report uses [`Rapier`]; negative controls hand in benches with a fault.
pub trait Bench: Sync {
    /// A chain that moves freely.
    ///
    /// # Errors
    /// [`ConformanceError`] if the configuration cannot be built.
    fn free(
        &self,
        chain: &OscillatorChain,
        configuration: Configuration,
        step: f64,
    ) -> Result<EngineFlow, ConformanceError>;

    /// A chain whose oscillator 0 is moved by hand.
    ///
    /// # Errors
    /// [`ConformanceError`] if the configuration cannot be built.
    fn prescribed(
        &self,
        chain: &OscillatorChain,
        motion: PrescribedMotion,
        configuration: Configuration,
        step: f64,
    ) -> Result<PrescribedFlow, ConformanceError> {
        Ok(PrescribedFlow::new(chain, motion, configuration.settings(step))?)
    }

    /// A rig with some of its elements realised by the engine itself.
    ///
    /// # Errors
    /// [`ConformanceError`] if the engine has no such mechanism.
    fn native(&self, rig: MechanismRig, settings: EngineSettings) -> Result<MechanismFlow, ConformanceError> {
        Ok(MechanismFlow::new(rig, settings)?)
    }
}

/// The engine as it is.
#[derive(Debug, Clone, Copy, Default)]
pub struct Rapier;

impl Bench for Rapier {
    fn free(
        &self,
        chain: &OscillatorChain,
        configuration: Configuration,
        step: f64,
    ) -> Result<EngineFlow, ConformanceError> {
        match configuration.mechanism {
            Mechanism::Hook => Ok(EngineFlow::new(chain, configuration.settings(step))?),
            native => Err(ConformanceError::NoMechanism { mechanism: native.word() }),
        }
    }
}

/// A motion with its reference and what is measured on it. One file each in `scenarios`, registered in `registry`.
pub trait Scenario: Send + Sync {
    /// Name in rows and file names, in `snake_case`.
    fn id(&self) -> &'static str;

    fn title(&self) -> &'static str;

    /// What moves, with its equation, and what is measured.
    fn description(&self) -> &'static str;

    /// What the exact values come from. It shares the description of the model with the engine side, and no evolution in time.
    fn reference(&self) -> &'static str;

    /// All cases of the full report, each with the depth that asks for it. `steps` of quick cases are those of `depth`.
    fn cases(&self, depth: Depth) -> Vec<Case>;

    /// Computes the rows of one case.
    ///
    /// # Errors
    /// [`ConformanceError`] if the motion cannot be computed or measured; the case then is one failed row with the message.
    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError>;

    /// Motions with their references, for other engines to be judged by; none if there is nothing another engine could be given.
    ///
    /// # Errors
    /// [`ConformanceError`] if a reference cannot be computed.
    fn setups(&self) -> Result<Vec<Setup>, ConformanceError> {
        Ok(Vec::new())
    }
}

/// What the rows of a case are about.
#[must_use]
pub fn subject(scenario: &dyn Scenario, case: &Case) -> Subject {
    Subject {
        scenario: case.scenario.clone(),
        variant: case.variant.clone(),
        configuration: case.configuration,
        reference: scenario.reference().to_owned(),
        steps_per_period: None,
        dt: None,
    }
}
