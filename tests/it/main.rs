//! Integration tests: one binary, a file per concern.

#[cfg(feature = "render")]
mod demonstration;
#[cfg(feature = "render")]
mod pictures;
#[cfg(feature = "render")]
mod shaders;
