//! Integration tests: one binary, a file per concern.

mod chain;
#[cfg(feature = "cli")]
mod cli;
mod derivatives;
mod events;
mod exact_energy;
#[cfg(feature = "render")]
mod film;
mod general_solver;
mod independent;
mod layering;
#[cfg(feature = "render")]
mod pictures;
mod prescribed;
mod reference_trajectory;
mod scenes;
#[cfg(feature = "render")]
mod shaders;
#[cfg(feature = "cli")]
mod small_disk;
mod store;
mod symmetry;
