//! The exact flow of a large chain.

use super::super::bound::{DEFAULT_AMPLITUDE_BOUND, admitted, checked_bound};
use super::super::error::ExactError;
use super::super::piece::{Law, Piece, state_of};
use super::super::trajectory::{ExactTrajectory, check_sampling, check_t_end};
use super::super::two_mass::Arrival;
use super::system::SparseSystem;
use super::walk::{SparseLeg, SparseWalk, Stop};
use crate::dynamics::{DenseFlow, Event, EventKind, Flow, Outcome, Sampling, State, Trajectory};
use crate::model::{ContactState, OscillatorChain};
use nalgebra::DVector;
use std::sync::Arc;

/// Exact motion of a chain with many oscillators and Jenkins elements; see the module head for method and error control.
///
/// [`Self::solve`] keeps the whole motion, some 50 bytes per oscillator and event; long motions of large chains are better followed with
/// [`Self::advance`] and [`Self::observe`], which keep nothing.
#[derive(Debug, Clone)]
pub struct SparseFlow {
    chain: OscillatorChain,
    pub(super) system: Arc<SparseSystem>,
    pub(super) amplitude_bound: f64,
}

/// Bytes that the pieces of a motion may take.
const MEMORY: usize = 400 << 20;

impl SparseFlow {
    /// With an amplitude bound of 1000.
    #[must_use]
    pub fn new(chain: &OscillatorChain) -> Self {
        let system = Arc::new(SparseSystem::new(chain));
        Self { chain: chain.clone(), system, amplitude_bound: DEFAULT_AMPLITUDE_BOUND }
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

    pub(super) fn walk(&self, initial: &State, t_end: f64) -> Result<SparseWalk<'_>, ExactError> {
        check_t_end(t_end)?;
        let initial = admitted(initial, &self.chain, self.amplitude_bound)?;
        Ok(SparseWalk::new(&self.chain, &self.system, &initial, t_end, self.amplitude_bound))
    }

    /// The motion from `initial` at time 0 to `t_end`, with dense output.
    ///
    /// # Errors
    /// [`ExactError`] for an initial state or time that cannot be used, [`ExactError::Stalled`], and
    /// [`ExactError::TooManyPieces`]: rates far faster than the others cut the motion small.
    pub fn solve(&self, initial: &State, t_end: f64) -> Result<ExactTrajectory, ExactError> {
        let (mut pieces, mut events, mut outcome) = (Vec::new(), Vec::new(), Outcome::Completed);
        let mut walk = self.walk(initial, t_end)?;
        let mut contacts = Arc::clone(&walk.contacts);
        let most = MEMORY / (self.system.length() * size_of::<f64>() + size_of::<Piece>());
        while let Some(leg) = walk.advance()? {
            if pieces.len() >= most {
                let time = leg.end_time();
                return Err(ExactError::TooManyPieces { time, asked: t_end, found: pieces.len() });
            }
            if let Stop::Event { element, kind } = leg.stop {
                events.push(Event { time: leg.end_time(), element, kind, state: self.state(&walk.y) });
            }
            outcome = self.outcome(&leg);
            let start = DVector::from_column_slice(&walk.start);
            let law = Law::Taylor { system: Arc::clone(&self.system), start };
            pieces.push(Piece { start: leg.start, duration: leg.duration, contacts, law });
            contacts = Arc::clone(&walk.contacts);
        }
        Ok(ExactTrajectory::new(self.chain.clone(), pieces, events, outcome, t_end))
    }

    /// Follows the motion and keeps its end alone.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn advance(&self, initial: &State, t_end: f64) -> Result<Arrival, ExactError> {
        self.follow(initial, t_end, |_, _, _| {})
    }

    /// Follows the motion and shows it at the times of `sampling`, up to divergence: time, state, contact states just after.
    ///
    /// # Errors
    /// As [`Self::solve`], and for samplings that cannot be used.
    pub fn observe(
        &self,
        initial: &State,
        sampling: Sampling,
        mut see: impl FnMut(f64, &State, &[ContactState]),
    ) -> Result<Arrival, ExactError> {
        check_sampling(sampling)?;
        let mut times = sampling.times().peekable();
        let mut y = vec![0.0; self.system.length()];
        let mut before = self.walk(initial, 0.0)?.contacts;
        self.follow(initial, sampling.t_end, |leg, walk, last| {
            while let Some(time) = times.next_if(|time| last || leg.start.advanced(leg.duration).until(*time) < 0.0) {
                // Of a motion that ends by divergence nothing is known later.
                let since = leg.start.until(time);
                if since > leg.duration && leg.stop == Stop::Bound {
                    break;
                }
                walk.series.state(since.clamp(0.0, leg.duration), &mut y);
                see(time, &self.state(&y), &before);
            }
            before = Arc::clone(&walk.contacts);
        })
    }

    /// `each` sees every leg, the walk at its end, and whether it is the last.
    fn follow(
        &self,
        initial: &State,
        t_end: f64,
        mut each: impl FnMut(&SparseLeg, &SparseWalk<'_>, bool),
    ) -> Result<Arrival, ExactError> {
        let mut walk = self.walk(initial, t_end)?;
        let (mut switches, mut outcome) = (0, Outcome::Completed);
        while let Some(leg) = walk.advance()? {
            switches += usize::from(is_switch(&leg));
            outcome = self.outcome(&leg);
            each(&leg, &walk, matches!(leg.stop, Stop::Bound | Stop::Limit));
        }
        Ok(Arrival { state: self.state(&walk.y), switches, outcome })
    }

    pub(super) fn outcome(&self, leg: &SparseLeg) -> Outcome {
        match leg.stop {
            Stop::Bound => Outcome::Diverged { time: leg.end_time(), bound: self.amplitude_bound },
            _ => Outcome::Completed,
        }
    }

    fn state(&self, y: &[f64]) -> State {
        state_of(&self.chain, &DVector::from_column_slice(y))
    }
}

fn is_switch(leg: &SparseLeg) -> bool {
    matches!(leg.stop, Stop::Event { kind, .. } if kind != EventKind::Grazing)
}

impl Flow for SparseFlow {
    type Error = ExactError;

    fn name(&self) -> String {
        "exact-sparse".to_owned()
    }

    fn trajectory(&self, initial: &State, sampling: Sampling) -> Result<Trajectory, ExactError> {
        check_sampling(sampling)?;
        self.solve(initial, sampling.t_end)?.sampled(sampling)
    }
}

impl DenseFlow for SparseFlow {
    type Motion = ExactTrajectory;

    fn motion(&self, initial: &State, t_end: f64) -> Result<ExactTrajectory, ExactError> {
        self.solve(initial, t_end)
    }
}
