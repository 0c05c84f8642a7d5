//! The interface all solvers share: states, trajectories with events, flows and maps.

mod flow;
mod motion;
mod state;
mod trajectory;

pub use flow::{Flow, HalfPeriodMap, HalfReturn, ReversalPoint};
pub use motion::{DenseFlow, Motion};
pub use state::{State, StateError};
pub use trajectory::{Event, EventKind, Outcome, Sample, Sampling, Trajectory};
