//! The rig as Rapier bodies: a fixed base, and carriages (or blades) on prismatic joints along their local x axes.
//!
//! This file is compiled twice, as a child of `double` and of `single`, which say what `rapier` is. Rapier's two builds are two
//! crates with equally named but unrelated types, so that no generic parameter can stand for both; a macro could, at the price of
//! readable errors and formatting. Numbers cross the boundary of this file as f64.

use super::PRECISION;
use super::rapier::prelude::*;
use crate::engine::EngineError;
use crate::engine::geometry::{BodyPose, BodyRole, JointDrift};
use crate::engine::layout::{Shape, Stand};
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
    rest: Pose,
    /// Direction of motion.
    axis: Vector,
    role: BodyRole,
}

pub(in crate::engine) struct World {
    physics: PhysicsWorld,
    base: (RigidBodyHandle, ColliderHandle),
    base_role: BodyRole,
    carriages: Vec<Carriage>,
}

impl World {
    pub(in crate::engine) fn new(blueprint: &Blueprint<'_>) -> Result<Self, EngineError> {
        let layout = blueprint.layout;
        let mut physics = PhysicsWorld {
            gravity: vector("gravity", layout.gravity)?,
            integration_parameters: integration_parameters(&blueprint.settings)?,
            ..PhysicsWorld::default()
        };
        let base_pose = pose("base", &layout.base)?;
        let base = physics.insert(RigidBodyBuilder::fixed().pose(base_pose), collider("base", layout.base.shape)?);
        let mut world = Self { physics, base, base_role: layout.base.role, carriages: Vec::new() };
        for (index, stand) in layout.movers.iter().enumerate() {
            world.add_carriage(blueprint, index, stand)?;
        }
        if blueprint.carriages == Carriages::Free {
            match blueprint.settings.joints {
                Joints::Impulse => world.join_by_impulses(&base_pose),
                Joints::Multibody => world.join_as_multibody(&base_pose, blueprint)?,
            }
        }
        Ok(world)
    }

    fn add_carriage(&mut self, blueprint: &Blueprint<'_>, index: usize, stand: &Stand) -> Result<(), EngineError> {
        let rest = pose("rest position", stand)?;
        let axis = rest.rotation * Vector::X;
        let body = match blueprint.carriages {
            Carriages::Free => RigidBodyBuilder::dynamic(),
            Carriages::Kinematic => RigidBodyBuilder::kinematic_position_based(),
        };
        let position = real(format!("positions[{index}]"), blueprint.positions[index])?;
        let velocity = real(format!("velocities[{index}]"), blueprint.velocities[index])?;
        let body = body
            .pose(rest.append_translation(axis * position))
            .linvel(axis * velocity)
            .linear_damping(0.0)
            .angular_damping(0.0)
            .can_sleep(false);
        let mass = real(format!("mass[{index}]"), blueprint.masses[index])?;
        let shape = collider("carriage", stand.shape)?.mass(mass);
        let (body, collider) = self.physics.insert(body, shape);
        let role = stand.role;
        self.carriages.push(Carriage { body, collider, coordinate: Coordinate::Body, rest, axis, role });
        Ok(())
    }

    fn join_by_impulses(&mut self, base: &Pose) {
        for carriage in &self.carriages {
            self.physics.insert_impulse_joint(self.base.0, carriage.body, slider(base, &carriage.rest));
        }
    }

    /// All carriages hang on one fixed root and so form one multibody. Its coordinates start at zero whatever the bodies' poses,
    /// and velocities set on the bodies are ignored: both are set here.
    fn join_as_multibody(&mut self, base: &Pose, blueprint: &Blueprint<'_>) -> Result<(), EngineError> {
        let mut joints = Vec::new();
        for (oscillator, carriage) in self.carriages.iter().enumerate() {
            let joint = slider(base, &carriage.rest);
            let joint = self.physics.insert_multibody_joint(self.base.0, carriage.body, joint);
            joints.push(joint.ok_or(EngineError::JointRefused { oscillator })?);
        }
        let PhysicsWorld { multibody_joints, bodies, .. } = &mut self.physics;
        for (oscillator, joint) in joints.into_iter().enumerate() {
            let refused = EngineError::JointRefused { oscillator };
            let (multibody, link) = multibody_joints.get_mut(joint).ok_or(refused.clone())?;
            // The root counts as free, with six more coordinates, until this call sees that the base is fixed.
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
        let place = |body| self.carriages.iter().find(|carriage| carriage.body == body);
        let bodies = quarantine.bodies().iter().map(|&body| place(body).map_or(self.base_role, |c| c.role).to_string());
        let colliders = quarantine.colliders().iter().map(|collider| format!("collider {collider:?}"));
        Err(bodies.chain(colliders).collect())
    }

    fn pose(&self, body: RigidBodyHandle, collider: ColliderHandle, role: BodyRole) -> BodyPose {
        let body = &self.physics.bodies[body];
        let (t, r) = (body.translation(), body.rotation());
        let shape = self.physics.colliders[collider].shape();
        let cylinder = || shape.as_cylinder().map(|c| Vector::new(c.radius, c.half_height, c.radius));
        // Every collider here is a cuboid or a cylinder; any other shape would have no extent.
        let half = shape.as_cuboid().map(|shape| shape.half_extents).or_else(cylinder).unwrap_or(Vector::ZERO);
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
            *position = carriage.displacement(self.physics.bodies[carriage.body].translation());
        }
    }

    fn read_velocities(&self, velocities: &mut [f64]) {
        for (velocity, carriage) in velocities.iter_mut().zip(&self.carriages) {
            let in_body = || carriage.along(self.physics.bodies[carriage.body].linvel());
            *velocity = match carriage.coordinate {
                Coordinate::Body => in_body(),
                Coordinate::Multibody { joint, index } => match self.physics.multibody_joints.get(joint) {
                    Some((multibody, _)) => wide(multibody.generalized_velocity()[index]),
                    None => in_body(),
                },
            };
        }
    }

    fn step_with_forces(&mut self, forces: &[f64]) -> Result<(), Vec<String>> {
        for (&force, carriage) in forces.iter().zip(&self.carriages) {
            let body = &mut self.physics.bodies[carriage.body];
            // Forces stay on a body until they are taken off.
            body.reset_forces(false);
            body.add_force(carriage.axis * narrow(force), true);
        }
        self.step()
    }

    fn step_to(&mut self, positions: &[f64]) -> Result<(), Vec<String>> {
        for (&position, carriage) in positions.iter().zip(&self.carriages) {
            let target = carriage.rest.translation + carriage.axis * narrow(position);
            self.physics.bodies[carriage.body].set_next_kinematic_translation(target);
        }
        self.step()
    }

    fn drift(&self) -> JointDrift {
        self.carriages.iter().fold(JointDrift::default(), |largest, carriage| {
            let body = &self.physics.bodies[carriage.body];
            let off = body.translation() - carriage.rest.translation;
            let [up, side] = [Vector::Y, Vector::Z].map(|axis| carriage.rest.rotation * axis);
            let r = carriage.rest.rotation.inverse() * body.rotation();
            let sine = wide(r.x * r.x + r.y * r.y + r.z * r.z).sqrt();
            largest.or_larger(JointDrift {
                lateral: wide(off.dot(up)).hypot(wide(off.dot(side))),
                rotation: 2.0 * sine.atan2(wide(r.w).abs()),
            })
        })
    }

    fn poses_at(&self, positions: &[f64]) -> Vec<BodyPose> {
        let mut now = vec![0.0; self.carriages.len()];
        self.read_positions(&mut now);
        let base = self.pose(self.base.0, self.base.1, self.base_role);
        let carriages = self.carriages.iter().zip(positions.iter().zip(now)).map(|(carriage, (wanted, now))| {
            let mut pose = self.pose(carriage.body, carriage.collider, carriage.role);
            let axis = [carriage.axis.x, carriage.axis.y, carriage.axis.z].map(wide);
            pose.translation.iter_mut().zip(axis).for_each(|(t, a)| *t += a * (wanted - now));
            pose
        });
        std::iter::once(base).chain(carriages).collect()
    }
}

impl Carriage {
    /// In f64: the difference of two places may need more digits than a place.
    fn displacement(&self, place: Vector) -> f64 {
        let [place, rest] = [place, self.rest.translation].map(|v| [v.x, v.y, v.z].map(wide));
        self.component([place[0] - rest[0], place[1] - rest[1], place[2] - rest[2]])
    }

    fn along(&self, vector: Vector) -> f64 {
        self.component([vector.x, vector.y, vector.z].map(wide))
    }

    fn component(&self, [x, y, z]: [f64; 3]) -> f64 {
        wide(self.axis.x) * x + wide(self.axis.y) * y + wide(self.axis.z) * z
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

/// The joint on which a body slides along its local x axis, from where both stand at rest.
fn slider(base: &Pose, rest: &Pose) -> GenericJoint {
    let mut joint = PrismaticJoint::new(Vector::X);
    joint.set_contacts_enabled(false);
    joint.data.set_local_frame1(base.inv_mul(rest));
    joint.data
}

fn pose(field: &str, stand: &Stand) -> Result<Pose, EngineError> {
    let translation = vector(field, stand.position)?;
    let [x, y, z, w] = stand.rotation.map(narrow);
    Ok(Pose::from_parts(translation, Rotation::from_xyzw(x, y, z, w).normalize()))
}

fn collider(field: &str, shape: Shape) -> Result<ColliderBuilder, EngineError> {
    match shape {
        Shape::Cuboid(half) => cuboid(field, half),
        Shape::Cylinder { radius, half_height } => {
            let [radius, half_height] =
                [real(format!("{field}.radius"), radius)?, real(format!("{field}.half_height"), half_height)?];
            Ok(ColliderBuilder::cylinder(half_height, radius).collision_groups(InteractionGroups::none()))
        }
    }
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
