//! Bifurcations of the engine itself: its limit cycle as a periodic orbit of the map that n steps are, the multipliers of that
//! map, and the parameter at which a pair of them leaves the unit circle (secondary Hopf point).
//!
//! ```text
//! G_h^(n/2)(z) = -z,     (1 - phi) v1_0 + phi v1_1 = 0        unknown: z, h
//! |mu(xi1)| = 1                                               unknown: xi1
//! ```
//!
//! z is the engine's complete discrete state, n the number of steps per period, h the step length. The second equation says that mass 1
//! reverses at the fraction phi of the first step: for given n there is one orbit for each phi in [0, 1), with its own h, because
//! the friction law samples the largest displacement at the steps. Multipliers are those of the map at fixed h and n. They depend on where
//! the switches between stick and slip lie within a step; the spread over phi says how much.
//!
//! Assumptions: the nominal rig or one near it (a symmetric limit cycle with one stick and one slip phase per half period); odd symmetry of
//! the engine, which the orbit over the full period confirms ([`CycleProblem::closure`]).

mod discrete_map;
mod discrete_orbit;
mod error;
mod secondary_hopf;

pub use discrete_map::Source;
pub use discrete_orbit::{CycleProblem, DiscreteOrbit};
pub use error::HopfError;
pub use secondary_hopf::{
    HopfPoint, at_step, over_phases, pairs_over_phases, phases, secondary_hopf, secondary_hopf_near,
};
