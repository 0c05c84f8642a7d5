//! The interface all solvers share: states, trajectories with events, flows and maps.

mod flow;
mod state;
mod tangent;
mod trajectory;

pub use flow::{Flow, HalfPeriodMap, HalfReturn, ReversalPoint};
pub use state::{State, StateError};
pub use tangent::TangentFlow;
pub use trajectory::{Event, EventKind, Outcome, Sample, Sampling, Trajectory};
