//! Ways to run the engine: what the rows of the report differ in.

use crate::engine::{EngineInfo, EngineSettings, Joints, Precision, Scheme};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// By what the engine exerts the forces of springs, dampers and friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mechanism {
    /// Our own force laws, evaluated before each step, their forces held constant over it.
    Hook,
    /// Motor of the prismatic joint, force based.
    MotorForceBased,
    /// Motor of the prismatic joint, acceleration based.
    MotorAccelerationBased,
    SpringJoint,
    /// Spring and damping of a multibody joint.
    MultibodySpring,
    /// Motor of limited force as a whole Jenkins element, without a slider.
    SaturatingMotor,
    /// Slider body held by a motor of limited force.
    LimitedMotor,
    /// Slider body held by the dry friction of a multibody joint.
    JointFriction,
    /// Slider body pressed on a block, `FrictionModel::Coulomb`.
    CoulombContact,
    /// Slider body pressed on a block, `FrictionModel::Simplified`.
    SimplifiedContact,
}

impl Mechanism {
    /// As in the JSON.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Hook => "hook",
            Self::MotorForceBased => "motor_force_based",
            Self::MotorAccelerationBased => "motor_acceleration_based",
            Self::SpringJoint => "spring_joint",
            Self::MultibodySpring => "multibody_spring",
            Self::SaturatingMotor => "saturating_motor",
            Self::LimitedMotor => "limited_motor",
            Self::JointFriction => "joint_friction",
            Self::CoulombContact => "coulomb_contact",
            Self::SimplifiedContact => "simplified_contact",
        }
    }
}

/// All that decides the engine's numbers beside the system, its start and the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct Configuration {
    pub precision: Precision,
    pub joints: Joints,
    pub mechanism: Mechanism,
    /// Rapier's `num_solver_iterations`.
    pub substeps: usize,
    pub scheme: Scheme,
}

impl Configuration {
    /// The second-order scheme with friction sampled at the steps: f64, impulse joints, own force laws, one substep, velocities predicted. Where
    /// nothing rubs it is the same as [`Self::AVERAGED_FRICTION`], and stands for both.
    pub const SAMPLED_FRICTION: Self = Self {
        precision: Precision::Double,
        joints: Joints::Impulse,
        mechanism: Mechanism::Hook,
        substeps: 1,
        scheme: Scheme::SecondOrder,
    };

    /// The second-order scheme as it is used unless told otherwise: friction averaged over the step.
    pub const AVERAGED_FRICTION: Self = Self { scheme: Scheme::AveragedFriction, ..Self::SAMPLED_FRICTION };

    /// What a user of the engine gets without thinking: f32, four substeps, velocities at face value.
    pub const ENGINE_DEFAULTS: Self = Self {
        precision: Precision::Single,
        joints: Joints::Impulse,
        mechanism: Mechanism::Hook,
        substeps: 4,
        scheme: Scheme::Plain,
    };

    /// Every combination with the force laws as hooks: 2 precisions, 2 kinds of joints, 4 numbers of substeps, 3 schemes.
    pub fn hooks() -> impl Iterator<Item = Self> {
        let precisions = [Precision::Double, Precision::Single];
        let joints = [Joints::Impulse, Joints::Multibody];
        let schemes = [Scheme::SecondOrder, Scheme::LaggingDamping, Scheme::Plain];
        precisions.into_iter().flat_map(move |precision| {
            joints.into_iter().flat_map(move |joints| {
                [1, 2, 4, 8].into_iter().flat_map(move |substeps| {
                    let of = move |scheme| Self { precision, joints, mechanism: Mechanism::Hook, substeps, scheme };
                    schemes.into_iter().map(of)
                })
            })
        })
    }

    /// Those with friction averaged over the step, which is made for one substep and changes nothing where there is no friction.
    pub fn averaged() -> impl Iterator<Item = Self> {
        let all = Self::hooks().filter(|c| c.substeps == 1 && c.scheme == Scheme::SecondOrder);
        all.map(|c| Self { scheme: Scheme::AveragedFriction, ..c })
    }

    /// For readers: `f64, impulse joints, 1 substep, velocity at face value`.
    #[must_use]
    pub fn label(self) -> String {
        let Self { precision, joints, mechanism, substeps, scheme } = self;
        let scheme = match scheme {
            Scheme::SecondOrder => "half-step start, predicted velocity, friction sampled",
            Scheme::AveragedFriction => "half-step start, predicted velocity, friction averaged",
            Scheme::LaggingDamping => "half-step start, late velocity",
            Scheme::Plain => "velocity at face value",
        };
        let mechanism = if mechanism == Mechanism::Hook {
            String::new()
        } else {
            format!("{}, ", mechanism.word().replace('_', " "))
        };
        let plural = if substeps == 1 { "" } else { "s" };
        format!("{}, {} joints, {mechanism}{substeps} substep{plural}, {scheme}", precision.word(), joints.word())
    }

    /// For legends, of the force laws as hooks: `friction sampled`, `face value, 4 substeps, f32`.
    #[must_use]
    pub fn short_name(self) -> String {
        let Self { precision, joints, substeps, scheme, .. } = self;
        let mut words = vec![scheme_name(scheme).to_owned()];
        if (substeps, self.is_staggered()) != (1, true) {
            words.push(format!("{substeps} substep{}", if substeps == 1 { "" } else { "s" }));
        }
        if joints == Joints::Multibody {
            words.push("multibody joints".to_owned());
        }
        if precision == Precision::Single {
            words.push("f32".to_owned());
        }
        words.join(", ")
    }

    /// What it has unlike another configuration: `multibody joints`.
    #[must_use]
    pub fn unlike(self, other: Self) -> String {
        if self.scheme != other.scheme || self.substeps != other.substeps {
            return self.short_name();
        }
        let mut words = Vec::new();
        if self.joints != other.joints {
            words.push(format!("{} joints", self.joints.word()));
        }
        if self.precision != other.precision {
            words.push(self.precision.word().to_owned());
        }
        words.join(", ")
    }

    /// Whether positions, forces and velocities are all told at the instants they belong to.
    fn is_staggered(self) -> bool {
        matches!(self.scheme, Scheme::SecondOrder | Scheme::AveragedFriction)
    }

    #[must_use]
    pub fn settings(self, step: f64) -> EngineSettings {
        let Self { precision, joints, substeps, scheme, .. } = self;
        EngineSettings { step, substeps, precision, joints, scheme }
    }

    /// Name and version of the engine, `rapier3d-f64 0.36.1`.
    #[must_use]
    pub fn engine(self) -> String {
        EngineInfo::of(self.precision).to_string()
    }

    /// Half the spacing of numbers at 1.
    #[must_use]
    pub fn unit_roundoff(self) -> f64 {
        match self.precision {
            Precision::Single => f64::from(f32::EPSILON) / 2.0,
            Precision::Double => f64::EPSILON / 2.0,
        }
    }

    /// Two where positions and forces are at the same instants, one otherwise: substeps move positions under a force that stands still.
    #[must_use]
    pub fn expected_order(self) -> f64 {
        if self.is_staggered() && self.substeps == 1 { 2.0 } else { 1.0 }
    }
}

fn scheme_name(scheme: Scheme) -> &'static str {
    match scheme {
        Scheme::SecondOrder => "friction sampled",
        Scheme::AveragedFriction => "friction averaged (default)",
        Scheme::LaggingDamping => "late velocity",
        Scheme::Plain => "face value",
    }
}

/// `f64 impulse hook 1 second_order`: names cases and sorts them.
impl fmt::Display for Configuration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { precision, joints, mechanism, substeps, scheme } = self;
        write!(f, "{} {} {} {substeps} {}", precision.word(), joints.word(), mechanism.word(), scheme.word())
    }
}
