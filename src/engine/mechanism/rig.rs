//! What is simulated: a chain of force laws with some of its elements handed to native mechanisms.

use super::kind::{ElementSpring, FrictionMechanism, LinearMechanism};
use crate::engine::EngineError;
use crate::engine::settings::Joints;
use crate::model::{OscillatorChain, ParameterError, PrescribedMotion, Range};

/// A spring with a damper between a carriage and ground, `F = -k x - c v`; `c` may be negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundSpring {
    pub carriage: usize,
    pub stiffness: f64,
    pub damping: f64,
    pub mechanism: LinearMechanism,
}

/// A Jenkins element between a carriage and ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionElement {
    pub carriage: usize,
    /// `kt`, force per length.
    pub stiffness: f64,
    /// `R`, force.
    pub slip_force: f64,
    pub mechanism: FrictionMechanism,
    /// Mass of the slider, where it is a body.
    pub slider_mass: f64,
    /// The spring between slider and carriage, where the slider is a body.
    pub spring: ElementSpring,
}

/// What moves carriage 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// The forces.
    Free,
    /// A kinematic body carries it along.
    Prescribed(PrescribedMotion),
    /// A kinematic body holds it where it starts.
    Held,
}

/// How hard Rapier tries within a substep. `Default` is Rapier's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InnerSolver {
    /// `num_internal_pgs_iterations`.
    pub iterations: usize,
    /// `warmstart_joints`.
    pub warmstart_joints: bool,
}

impl Default for InnerSolver {
    fn default() -> Self {
        Self { iterations: 1, warmstart_joints: false }
    }
}

/// A chain with native elements.
#[derive(Debug, Clone)]
pub struct MechanismRig {
    /// Masses, and everything that stays a force law. No Jenkins elements: these are in `friction`.
    pub chain: OscillatorChain,
    /// At most one per carriage.
    pub springs: Vec<GroundSpring>,
    pub friction: Option<FrictionElement>,
    pub drive: Drive,
    pub solver: InnerSolver,
}

impl MechanismRig {
    /// Free motion without native elements.
    #[must_use]
    pub fn of(chain: OscillatorChain) -> Self {
        Self { chain, springs: Vec::new(), friction: None, drive: Drive::Free, solver: InnerSolver::default() }
    }

    pub(super) fn validated(self, joints: Joints) -> Result<Self, EngineError> {
        let count = self.chain.oscillators();
        let exists = |field: String, found: usize| {
            let missing = ParameterError::NoSuchOscillator { field, found, count };
            if found < count { Ok(()) } else { Err(EngineError::Parameter(missing)) }
        };
        for (i, spring) in self.springs.iter().enumerate() {
            exists(format!("springs[{i}].carriage"), spring.carriage)?;
            Range::NonNegative.check(format!("springs[{i}].stiffness"), spring.stiffness)?;
            Range::Finite.check(format!("springs[{i}].damping"), spring.damping)?;
            spring.mechanism.available_on(joints)?;
            self.axis_is_free(i, joints)?;
        }
        if let Some(element) = &self.friction {
            exists("friction.carriage".to_owned(), element.carriage)?;
            Range::Positive.check("friction.stiffness", element.stiffness)?;
            Range::Positive.check("friction.slip_force", element.slip_force)?;
            Range::Positive.check("friction.slider_mass", element.slider_mass)?;
            element.mechanism.available_on(joints)?;
            self.saturating_motor_works(element, joints)?;
        }
        if self.chain.sliders() > 0 {
            let (found, expected) = (self.chain.sliders(), 0);
            let field = "chain.jenkins".to_owned();
            return Err(ParameterError::WrongLength { field, found, expected, per: "element: use friction" }.into());
        }
        if let Drive::Prescribed(motion) = self.drive {
            motion.validated()?;
        }
        Range::Positive.check("solver.iterations", self.solver.iterations as f64)?;
        Ok(self)
    }

    /// One joint axis has one motor.
    fn axis_is_free(&self, spring: usize, joints: Joints) -> Result<(), EngineError> {
        let carriage = self.springs[spring].carriage;
        let mechanism = self.springs[spring].mechanism.words();
        if self.springs[..spring].iter().any(|other| other.carriage == carriage) {
            let reason = "a joint axis has one motor: two springs cannot share it";
            return Err(EngineError::Unavailable { mechanism, joints: joints.word(), reason });
        }
        Ok(())
    }

    fn saturating_motor_works(&self, element: &FrictionElement, joints: Joints) -> Result<(), EngineError> {
        if element.mechanism != FrictionMechanism::SaturatingMotor {
            return Ok(());
        }
        let refused = |reason| {
            Err(EngineError::Unavailable { mechanism: element.mechanism.words(), joints: joints.word(), reason })
        };
        if self.springs.iter().any(|spring| spring.carriage == element.carriage) {
            return refused("a joint axis has one motor: it cannot be spring and limited motor");
        }
        if self.drive != Drive::Free {
            return refused("Rapier solves no joint between two bodies that no force can move");
        }
        Ok(())
    }
}
