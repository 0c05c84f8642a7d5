//! What the flows need of a Rapier world, whatever its precision.

use super::geometry::{BodyPose, JointDrift};
use super::layout::Layout;
use super::settings::{EngineSettings, Precision};
use super::{EngineError, double, single};

/// How the carriages are moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Carriages {
    /// By forces: dynamic bodies on prismatic joints.
    Free,
    /// By hand: kinematic bodies.
    Kinematic,
}

/// All that decides the world that is built.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blueprint<'a> {
    pub masses: &'a [f64],
    pub positions: &'a [f64],
    /// The engine's velocities at the start, `w_0` of [`super::Scheme`].
    pub velocities: &'a [f64],
    pub layout: &'a Layout,
    pub settings: EngineSettings,
    pub carriages: Carriages,
}

/// A world of N carriages. Slices have length N, displacements count from the rest positions.
pub(super) trait Plant {
    fn read_positions(&self, positions: &mut [f64]);

    fn read_velocities(&self, velocities: &mut [f64]);

    /// One step under constant forces along the local x axis of each carriage. `Err` names the bodies that Rapier quarantined.
    fn step_with_forces(&mut self, forces: &[f64]) -> Result<(), Vec<String>>;

    /// One step that carries kinematic carriages to new positions.
    fn step_to(&mut self, positions: &[f64]) -> Result<(), Vec<String>>;

    /// Largest distance and rotation of a carriage off its rail now.
    fn drift(&self) -> JointDrift;

    /// The base first, then the carriages, moved along their local x axes from where they are to `positions`.
    fn poses_at(&self, positions: &[f64]) -> Vec<BodyPose>;
}

/// Builds the world in the precision of its settings.
pub(super) fn build(blueprint: &Blueprint<'_>) -> Result<Box<dyn Plant>, EngineError> {
    Ok(match blueprint.settings.precision {
        Precision::Double => Box::new(double::world::World::new(blueprint)?),
        Precision::Single => Box::new(single::world::World::new(blueprint)?),
    })
}
