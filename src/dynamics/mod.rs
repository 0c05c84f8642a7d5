//! The interface all solvers share: states, trajectories with events, flows and maps.

mod first_motion;
mod flow;
mod motion;
mod sampled;
mod section;
mod state;
mod tangent;
mod trajectory;

pub use flow::{Flow, HalfPeriodMap, HalfReturn, ReversalPoint};
pub use motion::{DenseFlow, Motion};
pub use sampled::{Sampled, SampledError, SampledMotion};
pub use section::{Closure, SectionMap, SectionReturn};
pub use state::{State, StateError};
pub use tangent::{ParameterTangent, TangentFlow};
pub use trajectory::{Event, EventKind, Outcome, Sample, Sampling, Trajectory};
