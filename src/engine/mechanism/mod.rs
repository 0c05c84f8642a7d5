//! Springs, dampers and Jenkins elements realised by what Rapier offers itself, to measure what each gets wrong.
//!
//! ```text
//! linear     F = -k x - c v            hook, joint motor, spring joint, spring of a multibody joint      (LinearMechanism)
//! Jenkins    ground -|R|- s --kt-- x   hook, or a slider body s of mass ms held by dry friction R        (FrictionMechanism)
//! ```
//!
//! Everything of the chain that is not handed to a native mechanism stays a force law, evaluated before each step. Over one substep of
//! length `d = h/n` Rapier's own springs are backward Euler,
//!
//! ```text
//! w+ = w - (d/m)(k (x + d w+) + c w+),   x+ = x + d w+.
//! ```
//!
//! Assumptions: as in the parent module; a slider body is free along the rail and weightless, so that its friction limit is `R` alone.

mod flow;
mod kind;
mod plan;
mod rig;

pub(super) use plan::{CarriagePlan, NativeBlueprint, NativeWorld, SliderPlan, SpringPlan};

pub use flow::{MechanismFlow, MechanismMotion, MechanismSample, SliderSample};
pub use kind::{ElementSpring, FrictionMechanism, LinearMechanism};
pub use rig::{Drive, FrictionElement, GroundSpring, InnerSolver, MechanismRig};
