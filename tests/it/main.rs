//! Integration tests: one binary, a file per concern.

#[cfg(feature = "cli")]
mod cli;
mod derivatives;
mod exact_energy;
#[cfg(feature = "render")]
mod film;
mod layering;
#[cfg(feature = "render")]
mod pictures;
mod reference_trajectory;
mod scenes;
#[cfg(feature = "render")]
mod shaders;
mod store;
mod symmetry;
