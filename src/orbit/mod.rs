//! Periodic orbits of a flow, seen only through its maps and their derivatives.

mod error;
mod limit_cycle;
mod shooting;

pub use error::OrbitError;
pub use limit_cycle::limit_cycle;
pub use shooting::{PeriodicOrbit, shoot};
