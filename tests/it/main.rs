//! Integration tests: one binary, a file per concern.

mod asymmetric;
#[cfg(feature = "render")]
mod back_ends;
mod branches;
mod chain;
#[cfg(feature = "cli")]
mod cli;
#[cfg(feature = "cli")]
mod cli_analysis;
#[cfg(feature = "engine")]
mod compare;
#[cfg(feature = "cli")]
mod conformance;
#[cfg(feature = "cli")]
mod conformance_controls;
#[cfg(feature = "cli")]
mod conformance_exchange;
#[cfg(feature = "engine")]
mod convergence;
#[cfg(feature = "render")]
mod demonstration;
mod derivatives;
mod diagram;
#[cfg(feature = "cli")]
mod engine_map;
#[cfg(feature = "engine")]
mod engine_rig;
mod events;
mod exact_energy;
#[cfg(feature = "render")]
mod film;
mod general_solver;
mod harmonic_balance;
mod hopf;
#[cfg(feature = "engine")]
mod hysteresis;
mod independent;
mod layering;
mod lyapunov;
#[cfg(feature = "cli")]
mod mechanisms;
#[cfg(feature = "engine")]
mod numerical_damping;
mod orbits;
#[cfg(feature = "render")]
mod overlays;
#[cfg(feature = "render")]
mod pictures;
mod poincare;
mod prescribed;
mod reference_trajectory;
mod scenes;
#[cfg(feature = "render")]
mod shaders;
mod small_disk;
#[cfg(feature = "render")]
mod small_scene;
mod special_curves;
mod store;
mod symmetry;
mod tangent;
