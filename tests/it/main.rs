//! Integration tests: one binary, a file per concern.

#[cfg(feature = "engine")]
mod compare;
#[cfg(feature = "engine")]
mod convergence;
mod derivatives;
#[cfg(feature = "engine")]
mod engine_rig;
mod exact_energy;
#[cfg(feature = "engine")]
mod hysteresis;
#[cfg(feature = "engine")]
mod numerical_damping;
mod reference_trajectory;
mod symmetry;
