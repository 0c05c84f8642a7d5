//! The rig as 3D bodies in the physics engine Rapier: N carriages on prismatic joints, moved by force laws; and a bladed disk, N blades
//! round a hub ([`DiskFlow`]).
//!
//! ```text
//! M x'' = -K x - (D + S) x' - sum_j R_j f_j b_j
//! ```
//!
//! In its second-order configuration, the default, one step of length h from `x_n` and the engine's velocity `w_n ~ v_(n-1/2)` is
//!
//! ```text
//! f_n     = clamp(f_(n-1) + (k/R)(u_n - u_(n-1)), -1, 1)        our return mapping
//! v~_n    = w_n + (h/2) a_(n-1)                                 our prediction for the damping laws
//! a_n     = M^-1 F(x_n, v~_n, f_n)                              our force laws
//! w_(n+1) = w_n + h a_n,   x_(n+1) = x_n + h w_(n+1)            Rapier, one substep
//! v_n     = w_n + (h/2) a_n                                     recorded, w_0 = v_0 - (h/2) a_0
//! ```
//!
//! with an error of order h^2, since the friction force is continuous. [`Scheme`] says what other configurations do.
//!
//! Assumptions: small joint drift (recorded); no collisions; gravity along -y is carried by the joints; all force laws are evaluated in
//! f64, and only what Rapier stores and integrates is rounded in the f32 build.

mod disk;
mod double;
mod error;
mod events;
mod flow;
mod force_law;
mod geometry;
mod hash;
mod info;
mod instant;
mod layout;
mod linear;
pub mod mechanism;
mod plant;
mod prescribed;
mod recorder;
mod settings;
#[expect(clippy::duplicate_mod, reason = "one source for both precisions; see world.rs")]
mod single;
mod step_map;
mod step_path;
mod work;

pub use disk::{BladeMotion, DiskArrival, DiskFlow, DiskGeometry};
pub use error::EngineError;
pub use flow::{DEFAULT_AMPLITUDE_BOUND, EngineFlow};
pub use force_law::{Dampers, ForceLaw, JenkinsElements, Known, SelfExcitation, Springs, laws_of};
pub use geometry::{BodyPose, BodyRole, JointDrift, RigGeometry};
pub use hash::trajectory_hash;
pub use info::EngineInfo;
pub use linear::LinearForces;
pub use prescribed::PrescribedFlow;
pub use recorder::Recording;
pub use settings::{EngineSettings, Joints, Precision, Scheme};
pub use step_map::{DiscreteState, Stepped};
pub use step_path::StepPath;
