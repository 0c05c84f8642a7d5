//! A whole motion in closed form: dense output, events, samples with the energy ledger.

use super::error::ExactError;
use super::piece::Piece;
use crate::dynamics::{Event, Motion, Outcome, Sample, Sampling, State, Trajectory};
use crate::model::{ContactState, EnergyLedger, OscillatorChain};

/// Samples beyond which a sampling is refused.
const MOST_SAMPLES: usize = 100_000_000;

/// The motion from 0 to [`Self::end`], known at every time to rounding.
#[derive(Debug, Clone)]
pub struct ExactTrajectory {
    chain: OscillatorChain,
    pieces: Vec<Piece>,
    events: Vec<Event>,
    outcome: Outcome,
    end: f64,
}

/// The state at one time, with the contact state of each element just after it.
#[derive(Debug, Clone, PartialEq)]
pub struct Instant {
    pub state: State,
    pub contacts: Vec<ContactState>,
}

impl ExactTrajectory {
    pub(super) fn new(
        chain: OscillatorChain,
        pieces: Vec<Piece>,
        events: Vec<Event>,
        outcome: Outcome,
        t_end: f64,
    ) -> Self {
        let end = match outcome {
            Outcome::Completed => t_end,
            Outcome::Diverged { time, .. } => time,
        };
        Self { chain, pieces, events, outcome, end }
    }

    /// Last time at which the motion is known: the one asked for, or the one at which it diverged.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.end
    }

    #[must_use]
    pub fn outcome(&self) -> Outcome {
        self.outcome
    }

    /// All events in order of time, grazing included.
    #[must_use]
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// The stretches of constant contact state in order: state at the start, contact state of each element, duration.
    pub(super) fn phases(&self) -> impl Iterator<Item = (State, &[ContactState], f64)> {
        self.pieces.iter().map(|piece| (piece.evaluator(&self.chain).state(0.0), &*piece.contacts, piece.duration))
    }

    /// The state at any time from 0 to [`Self::end`].
    ///
    /// # Errors
    /// [`ExactError::OutsideSpan`] for other times.
    pub fn state_at(&self, time: f64) -> Result<Instant, ExactError> {
        let piece = self.piece_at(time)?;
        let state = piece.evaluator(&self.chain).state(since_start(piece, time));
        Ok(Instant { state, contacts: piece.contacts.to_vec() })
    }

    fn piece_at(&self, time: f64) -> Result<&Piece, ExactError> {
        if !(0.0..=self.end).contains(&time) {
            return Err(ExactError::OutsideSpan { found: time, end: self.end });
        }
        Ok(&self.pieces[self.index_at(time)])
    }

    /// The last piece that has begun by `time`.
    fn index_at(&self, time: f64) -> usize {
        self.pieces.partition_point(|piece| piece.start.until(time) >= 0.0).saturating_sub(1)
    }

    /// Samples with contact states and energy ledger. Of a diverged motion, those before the time of divergence.
    ///
    /// # Errors
    /// [`ExactError::OutOfRange`] and [`ExactError::TooManySamples`] for samplings that cannot be used,
    /// [`ExactError::OutsideSpan`] if one goes beyond the time solved for.
    pub fn sampled(&self, sampling: Sampling) -> Result<Trajectory, ExactError> {
        check_sampling(sampling)?;
        if sampling.t_end > self.end && self.outcome == Outcome::Completed {
            return Err(ExactError::OutsideSpan { found: sampling.t_end, end: self.end });
        }
        let last = match self.outcome {
            Outcome::Completed => f64::INFINITY,
            Outcome::Diverged { time, .. } => time,
        };
        let mut ledger = Bookkeeper::new(self);
        let samples = sampling.times().take_while(|time| *time < last).map(|time| ledger.sample(time)).collect();
        let events = self.events.iter().filter(|event| event.time <= sampling.t_end).cloned().collect();
        let outcome = match self.outcome {
            Outcome::Diverged { time, .. } if time > sampling.t_end => Outcome::Completed,
            outcome => outcome,
        };
        Ok(Trajectory { samples, events, outcome })
    }
}

impl Motion for ExactTrajectory {
    type Error = ExactError;

    fn end(&self) -> f64 {
        self.end
    }

    fn outcome(&self) -> Outcome {
        self.outcome
    }

    fn events(&self) -> &[Event] {
        &self.events
    }

    fn state(&self, time: f64) -> Result<State, ExactError> {
        let piece = self.piece_at(time)?;
        Ok(piece.evaluator(&self.chain).state(since_start(piece, time)))
    }
}

/// Walks along the pieces and sums up the works.
struct Bookkeeper<'a> {
    trajectory: &'a ExactTrajectory,
    index: usize,
    /// Time since the start of the piece up to which works are counted.
    counted: f64,
    ledger: Option<EnergyLedger>,
}

impl<'a> Bookkeeper<'a> {
    fn new(trajectory: &'a ExactTrajectory) -> Self {
        Self { trajectory, index: 0, counted: 0.0, ledger: None }
    }

    fn sample(&mut self, time: f64) -> Sample {
        let (chain, pieces) = (&self.trajectory.chain, &self.trajectory.pieces);
        let target = self.trajectory.index_at(time);
        let mut works = self.ledger.unwrap_or_default().works;
        while self.index < target {
            let piece = &pieces[self.index];
            works += piece.evaluator(chain).works(self.counted, piece.duration);
            (self.index, self.counted) = (self.index + 1, 0.0);
        }
        let piece = &pieces[target];
        let evaluator = piece.evaluator(chain);
        let since = since_start(piece, time);
        works += evaluator.works(self.counted, since);
        self.counted = since;
        let state = evaluator.state(since);
        let stored = chain.stored_energy(&state.positions, &state.velocities, &state.slider_forces);
        let stored_at_start = self.ledger.map_or(stored, |ledger| ledger.stored_at_start);
        let ledger = EnergyLedger { stored, stored_at_start, works };
        self.ledger = Some(ledger);
        Sample { time, state, contacts: piece.contacts.to_vec(), ledger }
    }
}

fn since_start(piece: &Piece, time: f64) -> f64 {
    piece.start.until(time).clamp(0.0, piece.duration)
}

/// # Errors
/// [`ExactError::OutOfRange`] unless `t_end` is finite and not negative.
pub(super) fn check_t_end(t_end: f64) -> Result<(), ExactError> {
    if t_end.is_finite() && t_end >= 0.0 {
        return Ok(());
    }
    Err(ExactError::OutOfRange { field: "t_end", found: t_end, allowed: "finite and not negative" })
}

/// # Errors
/// As [`ExactTrajectory::sampled`].
pub(super) fn check_sampling(Sampling { interval, t_end }: Sampling) -> Result<(), ExactError> {
    check_t_end(t_end)?;
    if !(interval.is_finite() && interval > 0.0) {
        return Err(ExactError::OutOfRange {
            field: "sampling.interval",
            found: interval,
            allowed: "finite and greater than 0",
        });
    }
    let found = t_end / interval;
    if found > MOST_SAMPLES as f64 {
        return Err(ExactError::TooManySamples { interval, t_end, found, allowed: MOST_SAMPLES });
    }
    Ok(())
}
