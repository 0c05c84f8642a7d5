//! Carriages, and at most one slider body, with Rapier's own springs and friction. Compiled twice, like `../world.rs`.

use super::rapier::prelude::*;
use super::world::{cuboid, integration_parameters, narrow, prismatic, real, wide};
use crate::engine::EngineError;
use crate::engine::geometry::JointDrift;
use crate::engine::layout::GRAVITY;
use crate::engine::mechanism::{
    CarriagePlan, FrictionMechanism, LinearMechanism, NativeBlueprint, NativeWorld, SliderPlan, SpringPlan,
};
use crate::engine::settings::Joints;

/// Rest length of spring joints: longer than any elongation measured here, since the distance has no sign.
const REST_LENGTH: f64 = 4.0;
/// Coefficient of friction of pad and block. Only its product with the normal force matters.
const FRICTION_COEFFICIENT: f64 = 0.5;
/// Half edge of carriages and sliders.
const HALF_EDGE: f64 = 0.2;
/// Force per speed with which a limited motor holds its slider: a slider under the force F creeps at F/1e6.
const HOLDING_DAMPING: f64 = 1e6;

struct Moving {
    body: RigidBodyHandle,
    rest: Vector,
    /// Where its generalized velocity is, on a multibody joint.
    link: Option<(MultibodyJointHandle, usize)>,
    /// Force across the rail that presses a pad on its block.
    pressed: Real,
    driven: bool,
}

pub(in crate::engine) struct MechanismWorld {
    physics: PhysicsWorld,
    rail: RigidBodyHandle,
    moving: Vec<Moving>,
    carriages: usize,
}

impl MechanismWorld {
    pub(in crate::engine) fn new(blueprint: &NativeBlueprint<'_>) -> Result<Self, EngineError> {
        let mut parameters = integration_parameters(&blueprint.settings)?;
        parameters.num_internal_pgs_iterations = blueprint.solver.iterations;
        parameters.warmstart_joints = blueprint.solver.warmstart_joints;
        if blueprint.slider.is_some_and(|slider| slider.mechanism == FrictionMechanism::CoulombContact) {
            parameters.friction_model = FrictionModel::Coulomb;
        }
        let mut physics = PhysicsWorld {
            gravity: Vector::new(0.0, -narrow(GRAVITY), 0.0),
            integration_parameters: parameters,
            ..PhysicsWorld::default()
        };
        let rail = physics.insert_body(RigidBodyBuilder::fixed());
        let mut world = Self { physics, rail, moving: Vec::new(), carriages: blueprint.carriages.len() };
        let mut joints = Vec::new();
        for (index, plan) in blueprint.carriages.iter().enumerate() {
            joints.push(world.add_carriage(index, plan)?);
        }
        if let Some(plan) = &blueprint.slider {
            joints.push(world.add_slider(plan)?);
        }
        match blueprint.settings.joints {
            Joints::Impulse => world.join_by_impulses(&joints),
            Joints::Multibody => world.join_as_multibody(&joints, blueprint)?,
        }
        world.add_spring_joints(blueprint)?;
        Ok(world)
    }

    /// The body, and the joint it is to hang on unless it is driven.
    fn add_carriage(&mut self, index: usize, plan: &CarriagePlan) -> Result<Option<PrismaticJoint>, EngineError> {
        let rest = Vector::Z * index as Real;
        let body = if plan.driven { RigidBodyBuilder::kinematic_position_based() } else { RigidBodyBuilder::dynamic() };
        self.insert(body, rest, [plan.mass, plan.position, plan.velocity], plan.driven)?;
        if plan.driven {
            return Ok(None);
        }
        let mut joint = prismatic(rest);
        if let Some(spring) = &plan.spring {
            set_motor(&mut joint, spring, plan.mass)?;
        }
        Ok(Some(joint))
    }

    fn add_slider(&mut self, plan: &SliderPlan) -> Result<Option<PrismaticJoint>, EngineError> {
        let rest = Vector::Z * plan.carriage as Real - Vector::X * narrow(REST_LENGTH);
        let body = RigidBodyBuilder::dynamic().gravity_scale(0.0);
        let numbers = [plan.mass, plan.position, plan.velocity];
        let slip_force = real("slip_force".to_owned(), plan.slip_force)?;
        let mut joint = prismatic(rest);
        match plan.mechanism {
            FrictionMechanism::CoulombContact | FrictionMechanism::SimplifiedContact => {
                self.add_pad(body, rest, numbers, plan.slip_force)?;
                return Ok(None);
            }
            FrictionMechanism::LimitedMotor => {
                joint.set_motor_model(MotorModel::ForceBased).set_motor_velocity(0.0, narrow(HOLDING_DAMPING));
                joint.set_motor_max_force(slip_force);
            }
            FrictionMechanism::JointFriction | FrictionMechanism::Hook | FrictionMechanism::SaturatingMotor => {}
        }
        self.insert(body, rest, numbers, false)?;
        Ok(Some(joint))
    }

    fn insert(
        &mut self,
        body: RigidBodyBuilder,
        rest: Vector,
        [mass, position, velocity]: [f64; 3],
        driven: bool,
    ) -> Result<ColliderHandle, EngineError> {
        let body = body
            .translation(rest + Vector::X * real("position".to_owned(), position)?)
            .linvel(Vector::X * real("velocity".to_owned(), velocity)?)
            .linear_damping(0.0)
            .angular_damping(0.0)
            .can_sleep(false);
        let shape = cuboid("body", [HALF_EDGE; 3])?.mass(real("mass".to_owned(), mass)?);
        let (body, collider) = self.physics.insert(body, shape);
        self.moving.push(Moving { body, rest, link: None, pressed: 0.0, driven });
        Ok(collider)
    }

    /// A pad that does not turn, lying on a fixed block. Its way along z stays free though nothing pushes there: with that translation
    /// locked as well, the two-by-two system that Rapier solves for the friction of a contact is singular, its inverse is set
    /// to zero, and there is no friction at all.
    fn add_pad(
        &mut self,
        body: RigidBodyBuilder,
        rest: Vector,
        numbers: [f64; 3],
        slip_force: f64,
    ) -> Result<(), EngineError> {
        let body = body.locked_axes(LockedAxes::ROTATION_LOCKED);
        let collider = self.insert(body, rest, numbers, false)?;
        let touching = InteractionGroups::all();
        let friction = narrow(FRICTION_COEFFICIENT);
        let pad = &mut self.physics.colliders[collider];
        pad.set_collision_groups(touching);
        pad.set_friction(friction);
        if let Some(moving) = self.moving.last_mut() {
            moving.pressed = real("normal force".to_owned(), slip_force / FRICTION_COEFFICIENT)?;
        }
        let half = [4.0 * REST_LENGTH, HALF_EDGE, HALF_EDGE];
        let block = cuboid("block", half)?.collision_groups(touching).friction(friction);
        let below = RigidBodyBuilder::fixed().translation(rest - Vector::Y * narrow(2.0 * HALF_EDGE));
        self.physics.insert(below, block);
        Ok(())
    }

    fn join_by_impulses(&mut self, joints: &[Option<PrismaticJoint>]) {
        for (moving, joint) in self.moving.iter().zip(joints) {
            if let Some(joint) = joint {
                self.physics.insert_impulse_joint(self.rail, moving.body, *joint);
            }
        }
    }

    /// As in `../world.rs`: all bodies hang on one root, and positions and velocities are set in generalized coordinates.
    fn join_as_multibody(
        &mut self,
        joints: &[Option<PrismaticJoint>],
        blueprint: &NativeBlueprint<'_>,
    ) -> Result<(), EngineError> {
        let mut handles = vec![None; joints.len()];
        for (oscillator, joint) in joints.iter().enumerate() {
            if let Some(joint) = joint {
                let handle = self.physics.insert_multibody_joint(self.rail, self.moving[oscillator].body, *joint);
                handles[oscillator] = Some(handle.ok_or(EngineError::JointRefused { oscillator })?);
            }
        }
        for (oscillator, handle) in handles.into_iter().enumerate() {
            if let Some(handle) = handle {
                self.set_up_link(oscillator, handle, blueprint)?;
            }
        }
        Ok(())
    }

    fn set_up_link(
        &mut self,
        oscillator: usize,
        handle: MultibodyJointHandle,
        blueprint: &NativeBlueprint<'_>,
    ) -> Result<(), EngineError> {
        let refused = || EngineError::JointRefused { oscillator };
        let PhysicsWorld { multibody_joints, bodies, .. } = &mut self.physics;
        let (multibody, link) = multibody_joints.get_mut(handle).ok_or_else(refused)?;
        multibody.forward_kinematics(bodies, true);
        let index = multibody.link(link).ok_or_else(refused)?.assembly_id();
        let (mut damping, mut friction) = (0.0, 0.0);
        let (position, velocity) = match blueprint.carriages.get(oscillator) {
            Some(plan) => {
                if let Some(spring) = plan.spring.filter(|s| s.mechanism == LinearMechanism::MultibodySpring) {
                    let joint = &mut multibody.link_mut(link).ok_or_else(refused)?.joint;
                    joint.set_spring(0, real("stiffness".to_owned(), spring.stiffness)?, 0.0);
                    damping = real("damping".to_owned(), spring.damping)?;
                }
                (plan.position, plan.velocity)
            }
            None => {
                let plan = blueprint.slider.ok_or_else(refused)?;
                if plan.mechanism == FrictionMechanism::JointFriction {
                    friction = real("slip_force".to_owned(), plan.slip_force)?;
                }
                (plan.position, plan.velocity)
            }
        };
        let mut displacement = vec![0.0; multibody.ndofs()];
        displacement[index] = narrow(position);
        multibody.apply_displacements(&displacement);
        multibody.damping_mut()[index] = damping;
        multibody.frictions_mut()[index] = friction;
        multibody.generalized_velocity_mut()[index] = narrow(velocity);
        multibody.forward_kinematics(bodies, true);
        multibody.update_rigid_bodies(bodies, true);
        self.moving[oscillator].link = Some((handle, index));
        Ok(())
    }

    fn add_spring_joints(&mut self, blueprint: &NativeBlueprint<'_>) -> Result<(), EngineError> {
        let length = narrow(REST_LENGTH);
        for (index, plan) in blueprint.carriages.iter().enumerate() {
            let Some(spring) = plan.spring.filter(|s| s.mechanism == LinearMechanism::SpringJoint) else { continue };
            let mut joint = spring_joint(spring.stiffness, spring.damping)?;
            joint.set_local_anchor1(self.moving[index].rest - Vector::X * length);
            self.physics.insert_impulse_joint(self.rail, self.moving[index].body, joint);
        }
        if let Some((plan, stiffness)) = blueprint.slider.and_then(|plan| Some((plan, plan.native_spring?))) {
            // The slider rests one rest length behind its carriage.
            let slider = self.moving[self.carriages].body;
            let carriage = self.moving[plan.carriage].body;
            self.physics.insert_impulse_joint(slider, carriage, spring_joint(stiffness, 0.0)?);
        }
        Ok(())
    }

    fn velocity(&self, moving: &Moving) -> Real {
        let in_body = self.physics.bodies[moving.body].linvel().x;
        let in_multibody = moving.link.and_then(|(handle, index)| {
            self.physics.multibody_joints.get(handle).map(|(multibody, _)| multibody.generalized_velocity()[index])
        });
        in_multibody.unwrap_or(in_body)
    }
}

impl NativeWorld for MechanismWorld {
    fn read(&self, positions: &mut [f64], velocities: &mut [f64]) {
        for (index, moving) in self.moving.iter().enumerate() {
            positions[index] = wide(self.physics.bodies[moving.body].translation().x) - wide(moving.rest.x);
            velocities[index] = wide(self.velocity(moving));
        }
    }

    fn step(&mut self, forces: &[f64], target: Option<f64>) -> Result<(), Vec<String>> {
        for (&force, moving) in forces.iter().zip(&self.moving) {
            let body = &mut self.physics.bodies[moving.body];
            match target.filter(|_| moving.driven) {
                Some(target) => body.set_next_kinematic_translation(moving.rest + Vector::X * narrow(target)),
                None => {
                    body.reset_forces(false);
                    body.add_force(Vector::new(narrow(force), -moving.pressed, 0.0), true);
                }
            }
        }
        self.physics.step();
        let found = self.physics.quarantine().bodies().iter();
        let place = |body| self.moving.iter().position(|moving| moving.body == body);
        let names: Vec<String> = found
            .map(|&body| place(body).map_or("a fixed body".to_owned(), |index| format!("moving body {index}")))
            .collect();
        if names.is_empty() { Ok(()) } else { Err(names) }
    }

    fn drift(&self) -> JointDrift {
        self.moving[..self.carriages].iter().fold(JointDrift::default(), |largest, moving| {
            let body = &self.physics.bodies[moving.body];
            let (off, r) = (body.translation() - moving.rest, body.rotation());
            let sine = wide(r.x * r.x + r.y * r.y + r.z * r.z).sqrt();
            largest.or_larger(JointDrift {
                lateral: wide(off.y).hypot(wide(off.z)),
                rotation: 2.0 * sine.atan2(wide(r.w).abs()),
            })
        })
    }
}

/// Motors of the carriage's own joint. The acceleration-based model multiplies by the mass, so it is divided by it here.
fn set_motor(joint: &mut PrismaticJoint, spring: &SpringPlan, mass: f64) -> Result<(), EngineError> {
    let (model, per) = match spring.mechanism {
        LinearMechanism::MotorForceBased => (MotorModel::ForceBased, 1.0),
        LinearMechanism::MotorAccelerationBased => (MotorModel::AccelerationBased, mass),
        LinearMechanism::Hook | LinearMechanism::SpringJoint | LinearMechanism::MultibodySpring => return Ok(()),
    };
    let stiffness = real("stiffness".to_owned(), spring.stiffness / per)?;
    let damping = real("damping".to_owned(), spring.damping / per)?;
    joint.set_motor_model(model).set_motor_position(0.0, stiffness, damping);
    if let Some(force) = spring.max_force {
        joint.set_motor_max_force(real("slip_force".to_owned(), force)?);
    }
    Ok(())
}

fn spring_joint(stiffness: f64, damping: f64) -> Result<SpringJoint, EngineError> {
    let stiffness = real("stiffness".to_owned(), stiffness)?;
    let mut joint = SpringJoint::new(narrow(REST_LENGTH), stiffness, real("damping".to_owned(), damping)?);
    joint.set_contacts_enabled(false);
    Ok(joint)
}
