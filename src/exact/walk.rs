//! The phases of a two-mass motion one after the other, without allocation: the lean way to follow a long motion.

use super::clock::Clock;
use super::error::ExactError;
use super::modal_phase::{End, ModalPair, Phase};
use super::scan::Exit;
use crate::dynamics::EventKind;
use crate::model::ContactState;

/// Switches in a row without time going on that are taken for a motion at rest on its slip limit.
pub(super) const MOST_IDLE_SWITCHES: usize = 1000;
/// Phases at most this long, relative to the time, do not count as time going on.
pub(super) const IDLE: f64 = 4.0 * f64::EPSILON;

/// One phase with its place in time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leg {
    pub(super) start: Clock,
    pub(super) phase: Phase,
    pub(super) exit: Exit,
}

impl Leg {
    pub(super) fn end_time(&self) -> f64 {
        self.start.advanced(self.exit.time).time()
    }

    /// The event at the end of the leg, if it is one.
    pub(super) fn event(&self) -> Option<EventKind> {
        match (self.exit.end, ModalPair::contact_state(&self.phase)) {
            (End::Limit | End::Bound, _) => None,
            (End::Graze, _) => Some(EventKind::Grazing),
            (_, ContactState::Stick) => Some(EventKind::StickToSlip),
            (_, ContactState::Slip(_)) => Some(EventKind::SlipToStick),
        }
    }
}

/// Iterator over the legs up to `t_end`; the last one ends there, at the amplitude bound, or where the motion stalls.
#[derive(Debug, Clone)]
pub(super) struct ModalWalk<'a> {
    pair: &'a ModalPair,
    amplitude_bound: f64,
    t_end: f64,
    clock: Clock,
    next: Option<Phase>,
    idle: usize,
}

impl<'a> ModalWalk<'a> {
    pub(super) fn new(pair: &'a ModalPair, start: Phase, t_end: f64, amplitude_bound: f64) -> Self {
        Self { pair, amplitude_bound, t_end, clock: Clock::default(), next: Some(start), idle: 0 }
    }

    /// # Errors
    /// [`ExactError::Stalled`] if the walk was given up because time no longer went on.
    pub(super) fn completed(&self) -> Result<(), ExactError> {
        if self.idle <= MOST_IDLE_SWITCHES {
            return Ok(());
        }
        let (time, found) = (self.clock.time(), self.idle);
        Err(ExactError::Stalled { element: 0, time, found, allowed: MOST_IDLE_SWITCHES })
    }
}

impl Iterator for ModalWalk<'_> {
    type Item = Leg;

    #[inline]
    fn next(&mut self) -> Option<Leg> {
        let phase = self.next?;
        let exit = self.pair.exit(&phase, self.clock.until(self.t_end), self.amplitude_bound);
        let leg = Leg { start: self.clock, phase, exit };
        self.clock = self.clock.advanced(exit.time);
        self.idle = if exit.time > IDLE * self.clock.time() { 0 } else { self.idle + 1 };
        let over = matches!(exit.end, End::Limit | End::Bound) || self.idle > MOST_IDLE_SWITCHES;
        self.next = if over { None } else { Some(self.pair.switched(&phase, exit.end, &exit.c)) };
        Some(leg)
    }
}
