//! What the system is: chain of oscillators, Jenkins elements, self-excitation, units, linear modes, energy.
//!
//! Parameters and definitions only; nothing here evolves in time.

mod chain;
mod energy;
mod harmonic;
mod jenkins;
mod modes;
mod parameter;
mod prescribed;
mod quantity;
mod rig;
mod scaling;

pub use chain::{ChainBuilder, OscillatorChain};
pub use energy::{EnergyLedger, Works};
pub use harmonic::{HarmonicEstimate, sticking_angle};
pub use jenkins::{Attachment, ContactState, Direction, JenkinsElement};
pub use modes::{LinearMode, ModesError};
pub use parameter::RigParameter;
pub use prescribed::PrescribedMotion;
pub use quantity::{ParameterError, Range};
pub use rig::{RigParameters, TwoMassRig};
pub use scaling::{DimensionalRig, Scales};
