//! Periodic orbits of a flow, seen only through its maps and their derivatives: [`shoot`] finds them, [`FloquetMultipliers`]
//! decide their stability, [`PseudoArclength`] follows them over a parameter, [`Branch`] locates the bifurcations on the way.

mod bifurcation;
mod branch;
mod criticality;
mod curve;
mod error;
mod family;
mod floquet;
mod flow_orbit;
mod limit_cycle;
mod measures;
mod search;
mod shooting;
mod special;
mod special_curve;

pub use bifurcation::{Bifurcation, Passage};
pub use branch::{Branch, BranchEnd, BranchPoint, Heading, PseudoArclength};
pub use criticality::{Criticality, NormalForm};
pub use error::OrbitError;
pub use floquet::FloquetMultipliers;
pub use flow_orbit::{FlowOrbit, SpatialClosure, shoot_flow};
pub use limit_cycle::{Mode, limit_cycle, limit_cycle_of};
pub use measures::OrbitMeasures;
pub use shooting::{PeriodicOrbit, shoot, shoot_section};
pub use special::SpecialPoint;
pub use special_curve::SpecialCurve;
