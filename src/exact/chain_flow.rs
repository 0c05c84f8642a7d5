//! The exact flow of any chain.

use super::bound::{DEFAULT_AMPLITUDE_BOUND, admitted, checked_bound};
use super::chain_walk::{ChainLeg, ChainWalk, Stop};
use super::error::ExactError;
use super::piece::{Law, Piece, state_of};
use super::trajectory::{ExactTrajectory, check_sampling, check_t_end};
use super::two_mass::is_switch;
use crate::dynamics::{DenseFlow, Event, Flow, Outcome, Sampling, State, Trajectory};
use crate::model::OscillatorChain;

/// Closed form of a chain with any number of oscillators and Jenkins elements, with certified event location.
///
/// Clear rather than fast: each cell of about half a radian of the fastest frequency costs one Taylor expansion. For the
/// two-mass rig [`super::TwoMassFlow`] gives the same motion some hundred times faster.
#[derive(Debug, Clone)]
pub struct ChainFlow {
    chain: OscillatorChain,
    amplitude_bound: f64,
}

impl ChainFlow {
    /// With an amplitude bound of 1000.
    #[must_use]
    pub fn new(chain: &OscillatorChain) -> Self {
        Self { chain: chain.clone(), amplitude_bound: DEFAULT_AMPLITUDE_BOUND }
    }

    /// A motion in which some |x| exceeds the bound has diverged.
    ///
    /// # Errors
    /// [`ExactError::OutOfRange`] unless the bound is positive and at most 1e9.
    pub fn with_amplitude_bound(self, bound: f64) -> Result<Self, ExactError> {
        Ok(Self { amplitude_bound: checked_bound(bound)?, ..self })
    }

    #[must_use]
    pub fn chain(&self) -> &OscillatorChain {
        &self.chain
    }

    /// The motion from `initial` at time 0 to `t_end`.
    ///
    /// # Errors
    /// [`ExactError`] for an initial state or time that cannot be used, and [`ExactError::Stalled`].
    pub fn solve(&self, initial: &State, t_end: f64) -> Result<ExactTrajectory, ExactError> {
        check_t_end(t_end)?;
        let initial = admitted(initial, &self.chain, self.amplitude_bound)?;
        let (mut pieces, mut events, mut outcome) = (Vec::new(), Vec::new(), Outcome::Completed);
        for leg in ChainWalk::new(&self.chain, &initial, t_end, self.amplitude_bound) {
            let leg = leg?;
            events.extend(self.event_of(&leg));
            if leg.stop == Stop::Bound {
                outcome = Outcome::Diverged { time: leg.end_time(), bound: self.amplitude_bound };
            }
            let law = Law::Series { pattern: leg.pattern, start: leg.y };
            pieces.push(Piece { start: leg.start, duration: leg.duration, contacts: leg.contacts, law });
        }
        Ok(ExactTrajectory::new(self.chain.clone(), pieces, events, outcome, t_end))
    }

    /// The first `count` changes of contact state up to `t_end`, fewer if there are no more.
    pub(super) fn first_switches(&self, initial: &State, t_end: f64, count: usize) -> Result<Vec<Event>, ExactError> {
        check_t_end(t_end)?;
        let initial = admitted(initial, &self.chain, self.amplitude_bound)?;
        let walk = ChainWalk::new(&self.chain, &initial, t_end, self.amplitude_bound);
        let events = walk.filter_map(|leg| leg.map(|leg| self.event_of(&leg)).transpose());
        events.filter(|event| event.as_ref().map_or(true, is_switch)).take(count).collect()
    }

    fn event_of(&self, leg: &ChainLeg) -> Option<Event> {
        let Stop::Event { element, kind } = leg.stop else {
            return None;
        };
        Some(Event { time: leg.end_time(), element, kind, state: state_of(&self.chain, &leg.end) })
    }
}

impl Flow for ChainFlow {
    type Error = ExactError;

    fn name(&self) -> String {
        "exact-chain".to_owned()
    }

    fn trajectory(&self, initial: &State, sampling: Sampling) -> Result<Trajectory, ExactError> {
        check_sampling(sampling)?;
        self.solve(initial, sampling.t_end)?.sampled(sampling)
    }
}

impl DenseFlow for ChainFlow {
    type Motion = ExactTrajectory;

    fn motion(&self, initial: &State, t_end: f64) -> Result<ExactTrajectory, ExactError> {
        self.solve(initial, t_end)
    }
}
