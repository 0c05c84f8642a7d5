//! The rig as Rapier bodies: a fixed rail, and carriages on prismatic joints along x.
//!
//! This file is compiled twice, as a child of `double` and of `single`, which say what `rapier` is. Rapier's two builds are two
//! crates with equally named but unrelated types, so that no generic parameter can stand for both; a macro could, at the price of
//! readable errors and formatting. Numbers cross the boundary of this file as f64.

use super::PRECISION;
use super::rapier::prelude::*;
use crate::engine::EngineError;
use crate::engine::geometry::{BodyPose, BodyRole, GRAVITY, JointDrift};
use crate::engine::plant::{Blueprint, Carriages, Plant};
use crate::engine::settings::{EngineSettings, Joints};

/// Where the velocity of a carriage is to be found.
#[derive(Debug, Clone, Copy)]
enum Coordinate {
    /// In the body.
    Body,
    /// In the generalized velocity of the multibody. The body's own velocity is the one before the last substep there, which in a force
    /// law would spoil the order of any scheme.
    Multibody { joint: MultibodyJointHandle, index: usize },
}

struct Carriage {
    body: RigidBodyHandle,
    collider: ColliderHandle,
    coordinate: Coordinate,
    rest: Vector,
}

pub(in crate::engine) struct World {
    physics: PhysicsWorld,
    rail: (RigidBodyHandle, ColliderHandle),
    carriages: Vec<Carriage>,
}

impl World {
    pub(in crate::engine) fn new(blueprint: &Blueprint<'_>) -> Result<Self, EngineError> {
        let geometry = blueprint.geometry;
        let mut physics = PhysicsWorld {
            gravity: Vector::new(0.0, -narrow(GRAVITY), 0.0),
            integration_parameters: integration_parameters(&blueprint.settings)?,
            ..PhysicsWorld::default()
        };
        let rail_position = vector("rail", geometry.rail_position(blueprint.masses.len()))?;
        let rail_shape = cuboid("rail", geometry.rail)?;
        let rail = physics.insert(RigidBodyBuilder::fixed().translation(rail_position), rail_shape);
        let mut world = Self { physics, rail, carriages: Vec::new() };
        for index in 0..blueprint.masses.len() {
            world.add_carriage(blueprint, index)?;
        }
        if blueprint.carriages == Carriages::Free {
            match blueprint.settings.joints {
                Joints::Impulse => world.join_by_impulses(rail_position),
                Joints::Multibody => world.join_as_multibody(rail_position, blueprint)?,
            }
        }
        Ok(world)
    }

    fn add_carriage(&mut self, blueprint: &Blueprint<'_>, index: usize) -> Result<(), EngineError> {
        let rest = vector("rest position", blueprint.geometry.rest_position(index))?;
        let body = match blueprint.carriages {
            Carriages::Free => RigidBodyBuilder::dynamic(),
            Carriages::Kinematic => RigidBodyBuilder::kinematic_position_based(),
        };
        let position = real(format!("positions[{index}]"), blueprint.positions[index])?;
        let velocity = real(format!("velocities[{index}]"), blueprint.velocities[index])?;
        let body = body
            .translation(rest + Vector::X * position)
            .linvel(Vector::X * velocity)
            .linear_damping(0.0)
            .angular_damping(0.0)
            .can_sleep(false);
        let mass = real(format!("mass[{index}]"), blueprint.masses[index])?;
        let shape = cuboid("carriage", blueprint.geometry.carriage)?.mass(mass);
        let (body, collider) = self.physics.insert(body, shape);
        self.carriages.push(Carriage { body, collider, coordinate: Coordinate::Body, rest });
        Ok(())
    }

    fn join_by_impulses(&mut self, rail_position: Vector) {
        for carriage in &self.carriages {
            let joint = prismatic(carriage.rest - rail_position);
            self.physics.insert_impulse_joint(self.rail.0, carriage.body, joint);
        }
    }

    /// All carriages hang on one fixed root and so form one multibody. Its coordinates start at zero whatever the bodies' poses,
    /// and velocities set on the bodies are ignored: both are set here.
    fn join_as_multibody(&mut self, rail_position: Vector, blueprint: &Blueprint<'_>) -> Result<(), EngineError> {
        let mut joints = Vec::new();
        for (oscillator, carriage) in self.carriages.iter().enumerate() {
            let joint = prismatic(carriage.rest - rail_position);
            let joint = self.physics.insert_multibody_joint(self.rail.0, carriage.body, joint);
            joints.push(joint.ok_or(EngineError::JointRefused { oscillator })?);
        }
        let PhysicsWorld { multibody_joints, bodies, .. } = &mut self.physics;
        for (oscillator, joint) in joints.into_iter().enumerate() {
            let refused = EngineError::JointRefused { oscillator };
            let (multibody, link) = multibody_joints.get_mut(joint).ok_or(refused.clone())?;
            // The root counts as free, with six more coordinates, until this call sees that the rail is fixed.
            multibody.forward_kinematics(bodies, true);
            let index = multibody.link(link).ok_or(refused)?.assembly_id();
            let mut displacement = vec![0.0; multibody.ndofs()];
            displacement[index] = narrow(blueprint.positions[oscillator]);
            multibody.apply_displacements(&displacement);
            multibody.damping_mut().fill(0.0);
            multibody.generalized_velocity_mut()[index] = narrow(blueprint.velocities[oscillator]);
            multibody.forward_kinematics(bodies, true);
            multibody.update_rigid_bodies(bodies, true);
            self.carriages[oscillator].coordinate = Coordinate::Multibody { joint, index };
        }
        Ok(())
    }

    fn step(&mut self) -> Result<(), Vec<String>> {
        self.physics.step();
        let quarantine = self.physics.quarantine();
        if quarantine.is_empty() {
            return Ok(());
        }
        let place = |body| self.carriages.iter().position(|carriage| carriage.body == body);
        let bodies = quarantine.bodies().iter().map(|&body| match place(body) {
            Some(oscillator) => format!("carriage {oscillator}"),
            None => "rail".to_owned(),
        });
        let colliders = quarantine.colliders().iter().map(|collider| format!("collider {collider:?}"));
        Err(bodies.chain(colliders).collect())
    }

    fn pose(&self, body: RigidBodyHandle, collider: ColliderHandle, role: BodyRole) -> BodyPose {
        let body = &self.physics.bodies[body];
        let (t, r) = (body.translation(), body.rotation());
        // Every collider here is a cuboid; any other shape would have no extent.
        let half =
            self.physics.colliders[collider].shape().as_cuboid().map_or(Vector::ZERO, |shape| shape.half_extents);
        BodyPose {
            role,
            translation: [t.x, t.y, t.z].map(wide),
            rotation: [r.x, r.y, r.z, r.w].map(wide),
            half_extents: [half.x, half.y, half.z].map(wide),
        }
    }
}

impl Plant for World {
    fn read_positions(&self, positions: &mut [f64]) {
        for (position, carriage) in positions.iter_mut().zip(&self.carriages) {
            *position = wide(self.physics.bodies[carriage.body].translation().x) - wide(carriage.rest.x);
        }
    }

    fn read_velocities(&self, velocities: &mut [f64]) {
        for (velocity, carriage) in velocities.iter_mut().zip(&self.carriages) {
            let in_body = || self.physics.bodies[carriage.body].linvel().x;
            *velocity = wide(match carriage.coordinate {
                Coordinate::Body => in_body(),
                Coordinate::Multibody { joint, index } => match self.physics.multibody_joints.get(joint) {
                    Some((multibody, _)) => multibody.generalized_velocity()[index],
                    None => in_body(),
                },
            });
        }
    }

    fn step_with_forces(&mut self, forces: &[f64]) -> Result<(), Vec<String>> {
        for (&force, carriage) in forces.iter().zip(&self.carriages) {
            let body = &mut self.physics.bodies[carriage.body];
            // Forces stay on a body until they are taken off.
            body.reset_forces(false);
            body.add_force(Vector::X * narrow(force), true);
        }
        self.step()
    }

    fn step_to(&mut self, positions: &[f64]) -> Result<(), Vec<String>> {
        for (&position, carriage) in positions.iter().zip(&self.carriages) {
            let target = carriage.rest + Vector::X * narrow(position);
            self.physics.bodies[carriage.body].set_next_kinematic_translation(target);
        }
        self.step()
    }

    fn drift(&self) -> JointDrift {
        self.carriages.iter().fold(JointDrift::default(), |largest, carriage| {
            let body = &self.physics.bodies[carriage.body];
            let (off, r) = (body.translation() - carriage.rest, body.rotation());
            let sine = wide(r.x * r.x + r.y * r.y + r.z * r.z).sqrt();
            largest.or_larger(JointDrift {
                lateral: wide(off.y).hypot(wide(off.z)),
                rotation: 2.0 * sine.atan2(wide(r.w).abs()),
            })
        })
    }

    fn poses(&self) -> Vec<BodyPose> {
        let rail = self.pose(self.rail.0, self.rail.1, BodyRole::Rail);
        let carriages = self.carriages.iter().enumerate();
        let carriages =
            carriages.map(|(i, carriage)| self.pose(carriage.body, carriage.collider, BodyRole::Carriage(i)));
        std::iter::once(rail).chain(carriages).collect()
    }
}

pub(super) fn integration_parameters(settings: &EngineSettings) -> Result<IntegrationParameters, EngineError> {
    let dt = real("step".to_owned(), settings.step)?;
    // A step that rounds to zero would make Rapier stand still without a word.
    if dt <= 0.0 {
        let found = settings.step;
        return Err(EngineError::NotRepresentable { field: "step".to_owned(), found, precision: PRECISION });
    }
    Ok(IntegrationParameters {
        dt,
        num_solver_iterations: settings.substeps,
        // The default cap of 400 units of length per unit of time would falsify a divergence.
        normalized_max_linear_velocity: Real::MAX,
        // Nothing collides.
        max_ccd_substeps: 0,
        ..IntegrationParameters::default()
    })
}

pub(super) fn prismatic(anchor_on_rail: Vector) -> PrismaticJoint {
    let mut joint = PrismaticJoint::new(Vector::X);
    joint.set_local_anchor1(anchor_on_rail).set_contacts_enabled(false);
    joint
}

pub(super) fn cuboid(field: &str, half_extents: [f64; 3]) -> Result<ColliderBuilder, EngineError> {
    let half = vector(field, half_extents)?;
    Ok(ColliderBuilder::cuboid(half.x, half.y, half.z).collision_groups(InteractionGroups::none()))
}

pub(super) fn vector(field: &str, [x, y, z]: [f64; 3]) -> Result<Vector, EngineError> {
    let component = |axis: usize, value| real(format!("{field}[{axis}]"), value);
    Ok(Vector::new(component(0, x)?, component(1, y)?, component(2, z)?))
}

pub(super) fn real(field: String, value: f64) -> Result<Real, EngineError> {
    let rounded = narrow(value);
    if rounded.is_finite() {
        return Ok(rounded);
    }
    Err(EngineError::NotRepresentable { field, found: value, precision: PRECISION })
}

#[allow(
    clippy::unnecessary_cast,
    reason = "in f32 this rounds, beyond its range to infinity, which Rapier quarantines"
)]
pub(super) fn narrow(value: f64) -> Real {
    value as Real
}

#[allow(clippy::useless_conversion, reason = "in f32 this widens")]
pub(super) fn wide(value: Real) -> f64 {
    f64::from(value)
}
