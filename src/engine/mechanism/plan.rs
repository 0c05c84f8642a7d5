//! What the worlds of both precisions are built from, and what is asked of them.

use super::kind::{FrictionMechanism, LinearMechanism};
use super::rig::InnerSolver;
use crate::engine::geometry::JointDrift;
use crate::engine::settings::{EngineSettings, Precision};
use crate::engine::{EngineError, double, single};

/// All that decides the world that is built.
#[derive(Debug, Clone, Copy)]
pub(in crate::engine) struct NativeBlueprint<'a> {
    pub settings: EngineSettings,
    pub solver: InnerSolver,
    pub carriages: &'a [CarriagePlan],
    pub slider: Option<SliderPlan>,
}

#[derive(Debug, Clone, Copy)]
pub(in crate::engine) struct CarriagePlan {
    pub mass: f64,
    pub position: f64,
    pub velocity: f64,
    /// Moved by hand: a kinematic body.
    pub driven: bool,
    pub spring: Option<SpringPlan>,
}

/// A native spring to ground.
#[derive(Debug, Clone, Copy)]
pub(in crate::engine) struct SpringPlan {
    pub mechanism: LinearMechanism,
    pub stiffness: f64,
    pub damping: f64,
    pub max_force: Option<f64>,
}

#[derive(Debug, Clone, Copy)]
pub(in crate::engine) struct SliderPlan {
    /// The carriage it is connected to.
    pub carriage: usize,
    pub mass: f64,
    pub position: f64,
    pub velocity: f64,
    pub slip_force: f64,
    pub mechanism: FrictionMechanism,
    /// Stiffness of a native spring to the carriage.
    pub native_spring: Option<f64>,
}

/// A world of carriages and at most one slider, in this order in all slices.
pub(in crate::engine) trait NativeWorld {
    fn read(&self, positions: &mut [f64], velocities: &mut [f64]);

    /// One step under constant forces along x; `target` is the next position of the driven carriage. `Err` names the bodies that Rapier
    /// quarantined.
    fn step(&mut self, forces: &[f64], target: Option<f64>) -> Result<(), Vec<String>>;

    /// Largest distance and rotation of a carriage off its rail now.
    fn drift(&self) -> JointDrift;
}

pub(super) fn build(blueprint: &NativeBlueprint<'_>) -> Result<Box<dyn NativeWorld>, EngineError> {
    Ok(match blueprint.settings.precision {
        Precision::Double => Box::new(double::mechanism_world::MechanismWorld::new(blueprint)?),
        Precision::Single => Box::new(single::mechanism_world::MechanismWorld::new(blueprint)?),
    })
}
