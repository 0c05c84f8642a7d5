//! Motions known at every time, as sections and envelopes need them.

use super::flow::Flow;
use super::state::State;
use super::trajectory::{Event, Outcome};

/// A motion from time 0 to [`Self::end`] that can be evaluated anywhere in between.
pub trait Motion {
    type Error: std::error::Error + Send + Sync + 'static;

    /// Last time at which the motion is known: the one asked for, or the one at which it diverged.
    fn end(&self) -> f64;

    fn outcome(&self) -> Outcome;

    /// All events in order of time.
    fn events(&self) -> &[Event];

    /// # Errors
    /// For times outside `[0, end]`.
    fn state(&self, time: f64) -> Result<State, Self::Error>;
}

/// A flow that gives its motions with dense output.
pub trait DenseFlow: Flow {
    type Motion: Motion<Error = Self::Error>;

    /// The motion from `initial` at time 0 to `t_end`. Divergence is an outcome, not an error.
    ///
    /// # Errors
    /// If the initial state or the time cannot be used, or the solver fails.
    fn motion(&self, initial: &State, t_end: f64) -> Result<Self::Motion, Self::Error>;

    /// Whether a motion goes on unchanged, but for rounding, when it is started again at one of its states. Not so where the solver remembers
    /// more than the state.
    fn restarts_exactly(&self) -> bool {
        true
    }
}
