//! The exact flow of the paper's two-mass rig.

use super::bound::{DEFAULT_AMPLITUDE_BOUND, admitted, checked_bound};
use super::chain_flow::ChainFlow;
use super::error::ExactError;
use super::modal_phase::{End, ModalPair};
use super::piece::{Law, Piece};
use super::trajectory::{ExactTrajectory, check_sampling, check_t_end};
use super::walk::{Leg, ModalWalk};
use crate::dynamics::{DenseFlow, Event, EventKind, Flow, Outcome, Sampling, State, Trajectory};
use crate::model::{ContactState, TwoMassRig};
use std::sync::Arc;

/// Closed form of the two-mass rig in modal coordinates, with certified event location.
///
/// Where modal coordinates degenerate (overdamped or nearly repeated eigenvalues, a mode that mass 1 does not see) the motion
/// comes from [`ChainFlow`]; see [`Self::representation`].
#[derive(Debug, Clone)]
pub struct TwoMassFlow {
    rig: TwoMassRig,
    amplitude_bound: f64,
    modal: Option<Arc<ModalPair>>,
    series: ChainFlow,
}

/// How the closed form is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Representation {
    /// Complex modal coordinates.
    Modal,
    /// Series of the matrix exponential.
    Series,
}

/// The end of a motion followed without keeping it.
#[derive(Debug, Clone, PartialEq)]
pub struct Arrival {
    /// State at the end: at the time asked for, or at that of divergence.
    pub state: State,
    /// Changes of contact state on the way, grazing not counted.
    pub switches: usize,
    pub outcome: Outcome,
}

impl TwoMassFlow {
    /// With an amplitude bound of 1000.
    #[must_use]
    pub fn new(rig: &TwoMassRig) -> Self {
        Self {
            rig: rig.clone(),
            amplitude_bound: DEFAULT_AMPLITUDE_BOUND,
            modal: ModalPair::new(&rig.parameters()).map(Arc::new),
            series: ChainFlow::new(rig.chain()),
        }
    }

    /// A motion in which some |x| exceeds the bound has diverged.
    ///
    /// # Errors
    /// [`ExactError::OutOfRange`] unless the bound is positive and at most 1e9.
    pub fn with_amplitude_bound(self, bound: f64) -> Result<Self, ExactError> {
        let amplitude_bound = checked_bound(bound)?;
        Ok(Self { amplitude_bound, series: self.series.with_amplitude_bound(bound)?, ..self })
    }

    #[must_use]
    pub fn rig(&self) -> &TwoMassRig {
        &self.rig
    }

    #[must_use]
    pub fn representation(&self) -> Representation {
        if self.modal.is_some() { Representation::Modal } else { Representation::Series }
    }

    /// The motion from `initial` at time 0 to `t_end`.
    ///
    /// # Errors
    /// [`ExactError`] for an initial state or time that cannot be used, and [`ExactError::Stalled`].
    pub fn solve(&self, initial: &State, t_end: f64) -> Result<ExactTrajectory, ExactError> {
        let Some(pair) = &self.modal else {
            return self.series.solve(initial, t_end);
        };
        let (mut pieces, mut events, mut outcome) = (Vec::new(), Vec::new(), Outcome::Completed);
        let mut walk = self.walk(pair, initial, t_end)?;
        for leg in walk.by_ref() {
            let Leg { start, phase, exit } = leg;
            events.extend(event_of(pair, &leg));
            outcome = self.outcome(&leg);
            let contacts = Arc::from([ModalPair::contact_state(&phase)]);
            let law = Law::Modal { pair: Arc::clone(pair), phase };
            pieces.push(Piece { start, duration: exit.time, contacts, law });
        }
        walk.completed()?;
        Ok(ExactTrajectory::new(self.rig.chain().clone(), pieces, events, outcome, t_end))
    }

    /// Follows the motion from `initial` at time 0 to `t_end` and keeps its end alone: no allocation per event.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn advance(&self, initial: &State, t_end: f64) -> Result<Arrival, ExactError> {
        let Some(pair) = &self.modal else {
            let motion = self.series.solve(initial, t_end)?;
            let switches = motion.events().iter().filter(|event| is_switch(event)).count();
            let state = motion.state_at(motion.end())?.state;
            return Ok(Arrival { state, switches, outcome: motion.outcome() });
        };
        let mut arrival = Arrival { state: initial.clone(), switches: 0, outcome: Outcome::Completed };
        let mut walk = self.walk(pair, initial, t_end)?;
        for leg in walk.by_ref() {
            match leg.exit.end {
                End::Upper | End::Lower => arrival.switches += 1,
                End::Graze => {}
                End::Limit | End::Bound => {
                    arrival.state = State::two_mass(pair.physical(&leg.phase, &leg.exit.c));
                    arrival.outcome = self.outcome(&leg);
                }
            }
        }
        walk.completed().map(|()| arrival)
    }

    /// The modal coordinates of both contact states, where they can be used.
    pub(super) fn modal(&self) -> Option<&ModalPair> {
        self.modal.as_deref()
    }

    pub(super) fn series(&self) -> &ChainFlow {
        &self.series
    }

    /// The first `count` changes of contact state up to `t_end`, fewer if there are no more.
    pub(super) fn first_switches(&self, initial: &State, t_end: f64, count: usize) -> Result<Vec<Event>, ExactError> {
        let Some(pair) = &self.modal else {
            return self.series.first_switches(initial, t_end, count);
        };
        let walk = self.walk(pair, initial, t_end)?;
        Ok(walk.filter_map(|leg| event_of(pair, &leg)).filter(is_switch).take(count).collect())
    }

    pub(super) fn outcome(&self, leg: &Leg) -> Outcome {
        match leg.exit.end {
            End::Bound => Outcome::Diverged { time: leg.end_time(), bound: self.amplitude_bound },
            _ => Outcome::Completed,
        }
    }

    pub(super) fn walk<'a>(
        &self,
        pair: &'a ModalPair,
        initial: &State,
        t_end: f64,
    ) -> Result<ModalWalk<'a>, ExactError> {
        check_t_end(t_end)?;
        let chain = self.rig.chain();
        let state = admitted(initial, chain, self.amplitude_bound)?;
        let contact = state.initial_contacts(chain).first().copied().unwrap_or(ContactState::Stick);
        let mut y = [0.0; 5];
        y.iter_mut().zip(state.components()).for_each(|(y, component)| *y = component);
        Ok(ModalWalk::new(pair, pair.start(y, contact), t_end, self.amplitude_bound))
    }
}

fn event_of(pair: &ModalPair, leg: &Leg) -> Option<Event> {
    let state = || State::two_mass(pair.physical_at_end(&leg.phase, leg.exit.end, &leg.exit.c));
    leg.event().map(|kind| Event { time: leg.end_time(), element: 0, kind, state: state() })
}

pub(super) fn is_switch(event: &Event) -> bool {
    event.kind != EventKind::Grazing
}

impl Flow for TwoMassFlow {
    type Error = ExactError;

    fn name(&self) -> String {
        "exact".to_owned()
    }

    fn trajectory(&self, initial: &State, sampling: Sampling) -> Result<Trajectory, ExactError> {
        check_sampling(sampling)?;
        self.solve(initial, sampling.t_end)?.sampled(sampling)
    }
}

impl DenseFlow for TwoMassFlow {
    type Motion = ExactTrajectory;

    fn motion(&self, initial: &State, t_end: f64) -> Result<ExactTrajectory, ExactError> {
        self.solve(initial, t_end)
    }
}
