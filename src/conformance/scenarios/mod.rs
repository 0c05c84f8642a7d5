//! The scenarios, one file each.

pub(super) mod amplitude_diagram;
mod chaos;
mod coupled_oscillators;
mod energy_ledger;
mod free_flight;
mod friction_decay;
mod friction_theory;
mod hysteresis;
mod invariants;
mod joint_drift;
mod limit_cycle;
mod linear_oscillator;
mod mechanism_friction;
mod mechanism_linear;
mod near_motion;
mod negative_damping;
mod rig_motion;
mod secondary_hopf;
mod settled;
mod torus;

pub use amplitude_diagram::AmplitudeDiagram;
pub use chaos::Chaos;
pub use coupled_oscillators::CoupledOscillators;
pub use energy_ledger::EnergyLedger;
pub use free_flight::FreeFlight;
pub use friction_decay::FrictionDecay;
pub use hysteresis::Hysteresis;
pub use joint_drift::JointDrift;
pub use limit_cycle::LimitCycle;
pub use linear_oscillator::LinearOscillator;
pub use mechanism_friction::MechanismFriction;
pub use mechanism_linear::MechanismLinear;
pub use negative_damping::NegativeDamping;
pub use secondary_hopf::SecondaryHopf;
pub use torus::Torus;
