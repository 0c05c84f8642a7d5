//! Integration tests: one binary, a file per concern.

#[cfg(feature = "render")]
mod back_ends;
#[cfg(feature = "render")]
mod demonstration;
#[cfg(feature = "render")]
mod overlays;
#[cfg(feature = "render")]
mod pictures;
#[cfg(feature = "render")]
mod shaders;
#[cfg(feature = "render")]
mod small_scene;
