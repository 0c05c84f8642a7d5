//! The ways Rapier has of exerting a linear force and of holding a slider.

use crate::engine::EngineError;
use crate::engine::settings::Joints;

/// How a spring with a damper to ground is realised. `k` in force per length, `c` in force per speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LinearMechanism {
    /// Our own force law, evaluated before each step and held constant over its substeps.
    Hook,
    /// Motor of the prismatic joint, `MotorModel::ForceBased`.
    MotorForceBased,
    /// Motor of the prismatic joint, `MotorModel::AccelerationBased`, Rapier's default: `k` and `c` are per unit of mass there.
    /// This library hands over `k/m` and `c/m`.
    MotorAccelerationBased,
    /// An impulse joint of its own, `SpringJoint`, along the rail. Attached to a link of a multibody it acts along the frame's x
    /// axis instead of along the distance, which is the same here.
    SpringJoint,
    /// `MultibodyJoint::set_spring`, with the generalized damping of the multibody.
    MultibodySpring,
}

impl LinearMechanism {
    pub const ALL: [Self; 5] =
        [Self::Hook, Self::MotorForceBased, Self::MotorAccelerationBased, Self::SpringJoint, Self::MultibodySpring];

    /// Words for tables.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Hook => "hook",
            Self::MotorForceBased => "motor (force based)",
            Self::MotorAccelerationBased => "motor (acceleration based)",
            Self::SpringJoint => "spring joint",
            Self::MultibodySpring => "multibody spring",
        }
    }

    /// Can it be had on such a joint?
    ///
    /// # Errors
    /// [`EngineError::Unavailable`] with the reason.
    pub fn available_on(self, joints: Joints) -> Result<(), EngineError> {
        let reason = match (self, joints) {
            (Self::MultibodySpring, Joints::Impulse) => "only a multibody joint has a spring of its own",
            _ => return Ok(()),
        };
        Err(EngineError::Unavailable { mechanism: self.words(), joints: joints.word(), reason })
    }
}

/// How a Jenkins element is realised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FrictionMechanism {
    /// Our own force law with the slider as a number.
    Hook,
    /// Position motor of stiffness `kt` from the carriage to ground whose force is limited to `R`: a spring that saturates. It
    /// has no slider, so it unloads along the curve it was loaded on.
    SaturatingMotor,
    /// Slider body on a prismatic joint whose motor aims at speed zero with at most the force `R`.
    LimitedMotor,
    /// Slider body on a multibody joint with dry friction `R` (`Multibody::frictions_mut`).
    JointFriction,
    /// Slider body as a pad pressed on a fixed block by the normal force `R/mu`, `FrictionModel::Coulomb`, default softness.
    CoulombContact,
    /// As `CoulombContact` with Rapier's default, `FrictionModel::Simplified`.
    SimplifiedContact,
}

impl FrictionMechanism {
    pub const ALL: [Self; 6] = [
        Self::Hook,
        Self::SaturatingMotor,
        Self::LimitedMotor,
        Self::JointFriction,
        Self::CoulombContact,
        Self::SimplifiedContact,
    ];

    /// Words for tables.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Hook => "hook",
            Self::SaturatingMotor => "saturating motor",
            Self::LimitedMotor => "limited motor",
            Self::JointFriction => "joint friction",
            Self::CoulombContact => "Coulomb contact",
            Self::SimplifiedContact => "simplified contact",
        }
    }

    /// Is the slider a body of its own?
    #[must_use]
    pub fn has_slider_body(self) -> bool {
        !matches!(self, Self::Hook | Self::SaturatingMotor)
    }

    /// Can it be had on such a joint?
    ///
    /// # Errors
    /// [`EngineError::Unavailable`] with the reason.
    pub fn available_on(self, joints: Joints) -> Result<(), EngineError> {
        let reason = match (self, joints) {
            (Self::JointFriction, Joints::Impulse) => {
                "impulse joints have no dry friction; a limited motor is the nearest"
            }
            _ => return Ok(()),
        };
        Err(EngineError::Unavailable { mechanism: self.words(), joints: joints.word(), reason })
    }
}

/// How the spring between the carriage and a slider body is realised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ElementSpring {
    /// Our own force law on both bodies.
    Hook,
    /// A `SpringJoint` between them.
    SpringJoint,
}

impl ElementSpring {
    /// Words for tables.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Hook => "hook",
            Self::SpringJoint => "spring joint",
        }
    }
}
