//! What the system is: chain of oscillators, bladed disk, Jenkins elements, self-excitation, units, linear modes, energy.
//!
//! Parameters and definitions only; nothing here evolves in time.

mod chain;
mod chain_builder;
mod disk;
mod energy;
mod harmonic;
mod jenkins;
mod modes;
mod parameter;
mod perturbation;
mod prescribed;
mod quantity;
mod rig;
mod scaling;
mod sparse;

pub use chain::OscillatorChain;
pub use chain_builder::ChainBuilder;
pub(crate) use disk::sector_eigenvalues;
pub use disk::{
    Aerodynamics, BladedDisk, ContactPlace, DiskSegments, FrictionContacts, Harmonic, InfluenceCoefficient,
    InfluenceCoefficients, Mistuning, ModeShape, NodalDiameter, Spectrum, Topology, TravelDirection, TunedMode,
};
pub use energy::{EnergyLedger, Works};
pub use harmonic::{HarmonicEstimate, sticking_angle};
pub use jenkins::{Attachment, ContactState, Direction, JenkinsElement};
pub use modes::{LinearMode, ModesError, Stability};
pub use parameter::RigParameter;
pub use perturbation::AnalyticHopf;
pub use prescribed::PrescribedMotion;
pub use quantity::{ParameterError, Range};
pub use rig::{RigParameters, TwoMassRig};
pub use scaling::{DimensionalRig, Scales};
pub use sparse::SparseMatrix;
