//! Integration tests: one binary, a file per concern.

mod chain;
#[cfg(feature = "engine")]
mod compare;
#[cfg(feature = "engine")]
mod convergence;
mod derivatives;
#[cfg(feature = "engine")]
mod engine_rig;
mod events;
mod exact_energy;
mod general_solver;
#[cfg(feature = "engine")]
mod hysteresis;
mod independent;
#[cfg(feature = "engine")]
mod numerical_damping;
mod prescribed;
mod reference_trajectory;
mod symmetry;
