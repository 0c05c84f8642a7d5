//! The motion one series after the other. Each leg lasts until its cell ends, an element switches, the amplitude bound or the time asked
//! for is reached. Guards and the order of simultaneous events are those of [`super::super::chain_walk`].

use super::super::clock::Clock;
use super::super::crossing::{Verdict, Watch, first_crossing};
use super::super::error::ExactError;
use super::super::walk::{IDLE, MOST_IDLE_SWITCHES};
use super::series::{HIGHEST_ORDER, TaylorSeries};
use super::system::SparseSystem;
use crate::dynamics::{EventKind, State};
use crate::model::{ContactState, Direction, OscillatorChain};
use std::sync::Arc;

/// Lowest order of a series, and the step from one order to the next.
const LOWEST_ORDER: usize = 6;
const ORDER_STEP: usize = 2;
/// A cell is this many times the present time between events.
const CELL_PER_GAP: f64 = 2.0;
/// Weight of the last gap in the running mean.
const NEWEST: f64 = 0.1;
/// Forces at least this far from their guards cannot reach them by rounding.
const CLEARANCE: f64 = 1e-13;

/// Why a leg ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stop {
    Cell,
    Event { element: usize, kind: EventKind },
    Bound,
    Limit,
}

/// A leg just made; its series is [`SparseWalk::series`] until the next one.
#[derive(Debug, Clone, Copy)]
pub(super) struct SparseLeg {
    pub(super) start: Clock,
    pub(super) duration: f64,
    pub(super) stop: Stop,
}

impl SparseLeg {
    pub(super) fn end_time(&self) -> f64 {
        self.start.advanced(self.duration).time()
    }
}

#[derive(Debug)]
pub(super) struct SparseWalk<'a> {
    system: &'a SparseSystem,
    amplitude_bound: f64,
    t_end: f64,
    clock: Clock,
    /// State and contacts at the end of the last leg.
    pub(super) y: Vec<f64>,
    pub(super) contacts: Arc<[ContactState]>,
    /// State and contacts of the last leg at its start.
    pub(super) start: Vec<f64>,
    pub(super) series: TaylorSeries,
    armed: Vec<bool>,
    cells: Vec<(usize, f64)>,
    /// Running mean of the time between events, and the time since the last.
    gap: f64,
    quiet: f64,
    idle: usize,
    over: bool,
    forces_go: Vec<f64>,
    rates_go: Vec<f64>,
}

impl<'a> SparseWalk<'a> {
    pub(super) fn new(
        chain: &OscillatorChain,
        system: &'a SparseSystem,
        initial: &State,
        t_end: f64,
        amplitude_bound: f64,
    ) -> Self {
        let y: Vec<f64> = initial.components().collect();
        let cell = |order| (order, system.cell(order));
        Self {
            system,
            amplitude_bound,
            t_end,
            clock: Clock::default(),
            start: y.clone(),
            y,
            contacts: initial.initial_contacts(chain).into(),
            series: TaylorSeries::default(),
            armed: vec![false; chain.sliders()],
            cells: (LOWEST_ORDER..=HIGHEST_ORDER).step_by(ORDER_STEP).map(cell).collect(),
            gap: system.longest_cell(),
            quiet: 0.0,
            idle: 0,
            over: false,
            forces_go: Vec::new(),
            rates_go: Vec::new(),
        }
    }

    /// The next leg; `None` after the last.
    pub(super) fn advance(&mut self) -> Result<Option<SparseLeg>, ExactError> {
        if self.over {
            return Ok(None);
        }
        let (order, cell) = self.order_and_cell();
        self.series.expand(self.system, &self.y, &self.contacts, order);
        let limit = self.clock.until(self.t_end);
        let span = cell.min(limit);
        let event = self.first_event(span);
        let bound = self.leaves_bound(event.map_or(span, |(time, ..)| time));
        let duration = bound.or(event.map(|(time, ..)| time)).unwrap_or(span);
        std::mem::swap(&mut self.start, &mut self.y);
        self.series.state(duration, &mut self.y);
        self.arm();
        let stop = match (bound, event) {
            (Some(_), _) => Stop::Bound,
            (None, Some((_, element, kind, side))) => {
                let kind = if self.turns_back(element, side) { EventKind::Grazing } else { kind };
                self.switch(element, kind, side);
                Stop::Event { element, kind }
            }
            (None, None) if span >= limit => Stop::Limit,
            (None, None) => Stop::Cell,
        };
        let leg = SparseLeg { start: self.clock, duration, stop };
        self.clock = self.clock.advanced(duration);
        self.over = matches!(stop, Stop::Bound | Stop::Limit);
        self.keep_rhythm(&leg)?;
        Ok(Some(leg))
    }

    /// The least order whose cell is long enough for the present rhythm of events.
    fn order_and_cell(&self) -> (usize, f64) {
        let wanted = CELL_PER_GAP * self.gap.max(self.quiet);
        let last = self.cells[self.cells.len() - 1];
        self.cells.iter().copied().find(|(_, cell)| *cell >= wanted).unwrap_or(last)
    }

    /// The guard crossed or touched first within `span`: time, element, kind of event, and the force reached.
    fn first_event(&mut self, span: f64) -> Option<(f64, usize, EventKind, Direction)> {
        let series = &self.series;
        series.excursions(span, false, &mut self.forces_go);
        series.excursions(span, true, &mut self.rates_go);
        let n = self.system.oscillators;
        let fastest = self.y[n..2 * n].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let springs = self.system.elements.iter().map(|element| 1.0 / element.normalised_stiffness);
        let widest = self.y[..n].iter().fold(fastest * span, |m, x| m.max(x.abs()));
        let size = springs.fold(widest, f64::max);
        let mut first: Option<(f64, usize, EventKind, Direction)> = None;
        for (j, &contact) in self.contacts.iter().enumerate() {
            let to = first.map_or(span, |(time, ..)| time);
            match contact {
                ContactState::Stick => {
                    let force = self.y[2 * n + j];
                    let go = self.system.elements[j].normalised_stiffness * self.forces_go[j];
                    for side in [Direction::Positive, Direction::Negative] {
                        if side.sign() * force + go < 1.0 - CLEARANCE {
                            continue;
                        }
                        let excess = series.force_excess(j, side.sign(), to);
                        let excess = excess.of_motion(1.0 + self.system.elements[j].normalised_stiffness * size);
                        let (time, kind) = match first_crossing(&excess, to, Watch::Touches { armed: self.armed[j] }) {
                            Verdict::Clear => continue,
                            Verdict::Touches(time) => (time, EventKind::Grazing),
                            Verdict::Crosses(time) => (time, EventKind::StickToSlip),
                        };
                        if first.is_none_or(|(earliest, ..)| time < earliest) {
                            first = Some((time, j, kind, side));
                        }
                    }
                }
                ContactState::Slip(direction) => {
                    let rate = direction.sign() * series.elongation_rate(j);
                    if rate - self.rates_go[j] > CLEARANCE * fastest {
                        continue;
                    }
                    let excess = series.stop_excess(j, direction.sign(), to, fastest).of_motion(size / to);
                    if let Some(time) = first_crossing(&excess, to, Watch::Crossings).time()
                        && first.is_none_or(|(earliest, ..)| time < earliest)
                    {
                        first = Some((time, j, EventKind::SlipToStick, direction));
                    }
                }
            }
        }
        first
    }

    /// First time within `span` at which a position exceeds the amplitude bound.
    fn leaves_bound(&self, span: f64) -> Option<f64> {
        let system = self.system;
        // |x| <= |y| exp(r t)/w, asked first because it is almost always enough.
        if system.norm(&self.y) * (system.rate * span).exp() < system.frequency * self.amplitude_bound {
            return None;
        }
        let bound = self.amplitude_bound;
        (0..system.oscillators)
            .flat_map(|i| [1.0, -1.0].map(|sign| self.series.position_excess(i, sign, bound, span)))
            .filter_map(|excess| first_crossing(&excess, span, Watch::Crossings).time())
            .min_by(f64::total_cmp)
    }

    /// Makes what defines the event hold exactly, and changes the contact state.
    fn switch(&mut self, element: usize, kind: EventKind, side: Direction) {
        let n = self.system.oscillators;
        self.armed[element] = false;
        let next = match kind {
            EventKind::Grazing => return,
            EventKind::StickToSlip => {
                self.y[2 * n + element] = side.sign();
                ContactState::Slip(side)
            }
            EventKind::SlipToStick => {
                let ends = &self.system.elements[element];
                self.y[n + ends.first] = ends.second.map_or(0.0, |second| self.y[n + second]);
                ContactState::Stick
            }
        };
        // Shared with the pieces of a dense motion: copied only where they still hold it.
        Arc::make_mut(&mut self.contacts)[element] = next;
    }

    /// Whether a sticking element does not load further where it reached its slip force: to rounding it only touches it.
    fn turns_back(&self, element: usize, side: Direction) -> bool {
        let velocities = &self.y[self.system.oscillators..];
        self.contacts[element].is_stick() && side.sign() * self.system.elements[element].elongation(velocities) < 0.0
    }

    fn arm(&mut self) {
        let forces = &self.y[2 * self.system.oscillators..];
        self.armed.iter_mut().zip(forces).for_each(|(armed, f)| *armed |= f.abs() < 1.0 - CLEARANCE);
    }

    fn keep_rhythm(&mut self, leg: &SparseLeg) -> Result<(), ExactError> {
        self.quiet += leg.duration;
        let Stop::Event { element, .. } = leg.stop else {
            self.idle = 0;
            return Ok(());
        };
        self.gap += NEWEST * (self.quiet - self.gap);
        self.quiet = 0.0;
        if leg.duration > IDLE * self.clock.time() {
            self.idle = 0;
            return Ok(());
        }
        self.idle += 1;
        let allowed = MOST_IDLE_SWITCHES * self.system.elements.len().max(1);
        if self.idle > allowed {
            return Err(ExactError::Stalled { element, time: self.clock.time(), found: self.idle, allowed });
        }
        Ok(())
    }
}
