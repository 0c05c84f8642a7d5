//! The motion of a chain, one cell after the other: each leg lasts until the cell, the phase or the time asked for ends.
//!
//! Guards of element j: `f_j - 1` and `-f_j - 1` while sticking, `-s b_j^T v` while slipping with `f_j = s`. The earliest
//! crossing of all ends the leg. Of crossings at the same time to rounding the one computed as earlier goes first, of equal
//! times the element with the lower index; the other follows in a leg of zero length, because its guard is then crossed at
//! once. The state is continuous through both, so the order does not matter for the motion.

use super::clock::Clock;
use super::crossing::{Verdict, Watch, first_crossing};
use super::error::ExactError;
use super::pattern::{Expansion, Pattern};
use super::walk::{IDLE, MOST_IDLE_SWITCHES};
use crate::dynamics::{EventKind, State};
use crate::model::{ContactState, Direction, OscillatorChain};
use nalgebra::DVector;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Part of a motion within one cell.
#[derive(Debug, Clone)]
pub(super) struct ChainLeg {
    pub(super) start: Clock,
    pub(super) duration: f64,
    pub(super) contacts: Arc<[ContactState]>,
    pub(super) pattern: Arc<Pattern>,
    pub(super) y: DVector<f64>,
    /// State at the end.
    pub(super) end: DVector<f64>,
    pub(super) stop: Stop,
}

impl ChainLeg {
    pub(super) fn end_time(&self) -> f64 {
        self.start.advanced(self.duration).time()
    }
}

/// Why a leg ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stop {
    Cell,
    Event { element: usize, kind: EventKind },
    Bound,
    Limit,
}

#[derive(Debug)]
pub(super) struct ChainWalk<'a> {
    chain: &'a OscillatorChain,
    amplitude_bound: f64,
    t_end: f64,
    clock: Clock,
    y: DVector<f64>,
    contacts: Arc<[ContactState]>,
    /// Whether the force of each element has been below its slip force since its guards were set.
    armed: Vec<bool>,
    patterns: BTreeMap<Vec<bool>, Arc<Pattern>>,
    idle: usize,
    over: bool,
}

impl<'a> ChainWalk<'a> {
    pub(super) fn new(chain: &'a OscillatorChain, initial: &State, t_end: f64, amplitude_bound: f64) -> Self {
        Self {
            chain,
            amplitude_bound,
            t_end,
            clock: Clock::default(),
            y: DVector::from_iterator(2 * chain.oscillators() + chain.sliders(), initial.components()),
            contacts: initial.initial_contacts(chain).into(),
            armed: vec![false; chain.sliders()],
            patterns: BTreeMap::new(),
            idle: 0,
            over: false,
        }
    }

    fn pattern(&mut self) -> Arc<Pattern> {
        let sticking: Vec<bool> = self.contacts.iter().map(|contact| contact.is_stick()).collect();
        let chain = self.chain;
        let pattern = self.patterns.entry(sticking).or_insert_with_key(|key| Arc::new(Pattern::new(chain, key)));
        Arc::clone(pattern)
    }

    /// The guard crossed or touched first within `span`: time, element, kind of event, and the force reached.
    fn first_event(&self, motion: &Expansion, span: f64) -> Option<(f64, usize, EventKind, Direction)> {
        let mut first: Option<(f64, usize, EventKind, Direction)> = None;
        for (element, &contact) in self.contacts.iter().enumerate() {
            let sides: &[Direction] = match &contact {
                ContactState::Stick => &[Direction::Positive, Direction::Negative],
                ContactState::Slip(direction) => std::slice::from_ref(direction),
            };
            for &side in sides {
                let (time, kind) = match (self.verdict(motion, span, element, contact, side), contact) {
                    (Verdict::Clear, _) => continue,
                    (Verdict::Touches(time), _) => (time, EventKind::Grazing),
                    (Verdict::Crosses(time), ContactState::Stick) => (time, EventKind::StickToSlip),
                    (Verdict::Crosses(time), ContactState::Slip(_)) => (time, EventKind::SlipToStick),
                };
                if first.is_none_or(|(earliest, ..)| time < earliest) {
                    first = Some((time, element, kind, side));
                }
            }
        }
        first
    }

    fn verdict(&self, motion: &Expansion, span: f64, j: usize, contact: ContactState, side: Direction) -> Verdict {
        let n = self.chain.oscillators();
        match contact {
            ContactState::Stick => {
                let force = |y: &[f64]| y[2 * n + j];
                let excess = motion.series(force, side.sign(), -1.0, span, 1.0);
                let stiffness = self.chain.jenkins()[j].normalised_stiffness();
                let excess = excess.of_motion(1.0 + stiffness * self.size(span));
                first_crossing(&excess, span, Watch::Touches { armed: self.armed[j] })
            }
            ContactState::Slip(direction) => {
                let attachment = self.chain.jenkins()[j].attachment;
                let rate = |y: &[f64]| attachment.elongation(&y[n..2 * n]);
                let scale = self.y.rows(n, n).amax();
                let excess = motion.series(rate, -direction.sign(), 0.0, span, scale);
                first_crossing(&excess.of_motion(self.size(span) / span), span, Watch::Crossings)
            }
        }
    }

    /// Largest displacement that the terms of a motion over `span` are computed from.
    fn size(&self, span: f64) -> f64 {
        let n = self.chain.oscillators();
        let springs = self.chain.jenkins().iter().map(|element| 1.0 / element.normalised_stiffness());
        springs.fold(self.y.rows(0, n).amax().max(self.y.rows(n, n).amax() * span), f64::max)
    }

    /// First time within `span` at which a position exceeds the amplitude bound.
    fn leaves_bound(&self, motion: &Expansion, span: f64) -> Option<f64> {
        let bound = self.amplitude_bound;
        (0..self.chain.oscillators())
            .filter(|&i| motion.bound(i, span) > bound)
            .flat_map(|i| [1.0, -1.0].map(|sign| motion.series(|y| y[i], sign, -bound, span, bound)))
            .filter_map(|excess| first_crossing(&excess, span, Watch::Crossings).time())
            .min_by(f64::total_cmp)
    }

    /// Makes what defines the event hold exactly, and changes the contact state.
    fn switch(&mut self, end: &mut DVector<f64>, element: usize, kind: EventKind, side: Direction) {
        let n = self.chain.oscillators();
        let next = match kind {
            EventKind::Grazing => ContactState::Stick,
            EventKind::StickToSlip => {
                end[2 * n + element] = side.sign();
                ContactState::Slip(side)
            }
            EventKind::SlipToStick => {
                use crate::model::Attachment::{Between, Ground};
                match self.chain.jenkins()[element].attachment {
                    Ground(i) => end[n + i] = 0.0,
                    Between(i, j) => end[n + i] = end[n + j],
                }
                ContactState::Stick
            }
        };
        self.contacts = self.contacts.iter().enumerate().map(|(j, &c)| if j == element { next } else { c }).collect();
        self.armed[element] = false;
    }

    /// Whether a sticking element does not load further where it reached its slip force: to rounding it only touches it.
    fn turns_back(&self, end: &DVector<f64>, element: usize, side: Direction) -> bool {
        let n = self.chain.oscillators();
        let rate = self.chain.jenkins()[element].attachment.elongation(&end.as_slice()[n..2 * n]);
        self.contacts[element].is_stick() && side.sign() * rate < 0.0
    }

    fn arm(&mut self, end: &DVector<f64>) {
        let n = self.chain.oscillators();
        for (j, armed) in self.armed.iter_mut().enumerate() {
            // Far below the slip force in units of rounding.
            *armed |= end[2 * n + j].abs() < 1.0 - 1e-13;
        }
    }

    fn advance(&mut self) -> Result<ChainLeg, ExactError> {
        let pattern = self.pattern();
        let motion = pattern.expand(&self.y);
        let limit = self.clock.until(self.t_end);
        let span = pattern.cell.min(limit);
        let event = self.first_event(&motion, span);
        let bound = self.leaves_bound(&motion, event.map_or(span, |(time, ..)| time));
        let contacts = Arc::clone(&self.contacts);
        let duration = bound.or(event.map(|(time, ..)| time)).unwrap_or(span);
        let mut end = motion.at(duration);
        end.iter_mut().skip(2 * self.chain.oscillators()).for_each(|f| *f = f.clamp(-1.0, 1.0));
        let stop = match (bound, event) {
            (Some(_), _) => Stop::Bound,
            (None, Some((_, element, kind, side))) => {
                let kind = if self.turns_back(&end, element, side) { EventKind::Grazing } else { kind };
                self.switch(&mut end, element, kind, side);
                Stop::Event { element, kind }
            }
            (None, None) if span >= limit => Stop::Limit,
            (None, None) => {
                self.arm(&end);
                Stop::Cell
            }
        };
        let leg = ChainLeg { start: self.clock, duration, contacts, pattern, y: self.y.clone(), end, stop };
        self.clock = self.clock.advanced(duration);
        self.y = leg.end.clone();
        self.over = matches!(stop, Stop::Bound | Stop::Limit);
        self.count_idle(&leg)?;
        Ok(leg)
    }

    fn count_idle(&mut self, leg: &ChainLeg) -> Result<(), ExactError> {
        let allowed = MOST_IDLE_SWITCHES * self.chain.sliders().max(1);
        match leg.stop {
            Stop::Event { element, .. } if leg.duration <= IDLE * self.clock.time() => {
                self.idle += 1;
                if self.idle > allowed {
                    let (time, found) = (self.clock.time(), self.idle);
                    return Err(ExactError::Stalled { element, time, found, allowed });
                }
            }
            _ => self.idle = 0,
        }
        Ok(())
    }
}

impl Iterator for ChainWalk<'_> {
    type Item = Result<ChainLeg, ExactError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.over {
            return None;
        }
        let leg = self.advance();
        self.over |= leg.is_err();
        Some(leg)
    }
}
