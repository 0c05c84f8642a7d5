//! Self-excited, friction-damped oscillators: exact solution, Rapier simulation, cross-check and film.

#![forbid(unsafe_code)]
#![warn(missing_debug_implementations)]

pub mod compare;
pub mod dynamics;
#[cfg(feature = "engine")]
pub mod engine;
pub mod exact;
pub mod model;
#[cfg(feature = "render")]
pub mod render;
