//! Times of stick and slip: the engine's, those of the difference equation, and the exact ones.
//!
//! Both sampled motions have their times interpolated within a step,
//!
//! ```text
//! slip begins  where f_0 + (k/R)(u(t) - u_0) reaches the limit, u(t) the parabola through u_0, u_1 with the rate u_0' at t_0
//! slip ends    where the elongation rate, linear in the step, changes sign
//! ```
//!
//! written out here a second time, so that what rounding does is all by which the engine may differ from the difference equation: a state
//! that is off by e moves a switch by e over the rate at which its event function crosses zero, `|u'|` where slip begins, `|u''|` where it ends.

use crate::dynamics::{Event, EventKind, Trajectory};
use crate::model::{JenkinsElement, OscillatorChain};

/// A change of contact state of a sampled motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Switch {
    pub kind: EventKind,
    pub time: f64,
}

/// Switches of the engine's motion, in order of time.
#[must_use]
pub fn switches_of(tested: &Trajectory) -> Vec<Switch> {
    let switches = tested.events.iter().filter(|event| event.kind != EventKind::Grazing);
    switches.map(|event| Switch { kind: event.kind, time: event.time }).collect()
}

/// Switches of a motion of which every step is a sample, in order of time.
#[must_use]
pub fn switches_between(chain: &OscillatorChain, motion: &Trajectory) -> Vec<Switch> {
    let mut switches = Vec::new();
    for pair in motion.samples.windows(2) {
        let first = switches.len();
        for (j, element) in chain.jenkins().iter().enumerate() {
            let at = |i: usize| Sampled {
                elongation: element.attachment.elongation(&pair[i].state.positions),
                rate: element.attachment.elongation(&pair[i].state.velocities),
                force: pair[i].state.slider_forces[j],
            };
            let step = pair[1].time - pair[0].time;
            let found = within(element, &at(0), &at(1), step);
            switches.extend(found.into_iter().map(|(kind, part)| Switch { kind, time: pair[0].time + part * step }));
        }
        switches[first..].sort_by(|a, b| a.time.total_cmp(&b.time));
    }
    switches
}

/// An element at a step.
struct Sampled {
    elongation: f64,
    rate: f64,
    force: f64,
}

impl Sampled {
    fn slips(&self) -> bool {
        self.force.abs() >= 1.0 && self.force * self.rate > 0.0
    }
}

fn within(element: &JenkinsElement, a: &Sampled, b: &Sampled, step: f64) -> Vec<(EventKind, f64)> {
    let way = b.elongation - a.elongation;
    let (slope, bend) = (step * a.rate, way - step * a.rate);
    let target = (b.force - a.force) / element.normalised_stiffness();
    let begins = || {
        // Where the start runs the other way the parabola is of no use.
        let part = if slope * target > 0.0 {
            2.0 * target / (slope + slope.signum() * (slope * slope + 4.0 * bend * target).max(0.0).sqrt())
        } else {
            target / way
        };
        (EventKind::StickToSlip, if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 })
    };
    let ends = || {
        let part = a.rate / (a.rate - b.rate);
        (EventKind::SlipToStick, if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 })
    };
    let cut_off = (a.force + element.normalised_stiffness() * way).abs() > 1.0 && b.force.abs() >= 1.0;
    match (a.slips(), b.slips()) {
        (false, true) => vec![begins()],
        (true, false) => vec![ends()],
        (true, true) if a.force * b.force < 0.0 => vec![ends(), begins()],
        (false, false) if cut_off => {
            let (first, last) = (begins(), ends());
            vec![first, (last.0, last.1.max(first.1))]
        }
        _ => Vec::new(),
    }
}

/// Largest error of a switching time over the exact events up to `end`; `None` if the motion does not have the same switches in the same order.
#[must_use]
pub fn switching_error(exact: &[Event], tested: &[Switch], end: f64) -> Option<f64> {
    let counts = |event: &&Event| event.kind != EventKind::Grazing && event.time < end;
    let expected: Vec<&Event> = exact.iter().filter(counts).collect();
    if tested.len() < expected.len() || expected.iter().zip(tested).any(|(a, b)| a.kind != b.kind) {
        return None;
    }
    Some(expected.iter().zip(tested).map(|(a, b)| (a.time - b.time).abs()).fold(0.0, f64::max))
}

/// Least rate at which the event function of an exact event up to `end` crosses zero.
#[must_use]
pub fn slowest_rate(chain: &OscillatorChain, exact: &[Event], end: f64) -> f64 {
    let rate = |event: &Event| {
        let state = &event.state;
        let attachment = chain.jenkins()[event.element].attachment;
        match event.kind {
            EventKind::StickToSlip => attachment.elongation(&state.velocities).abs(),
            _ => attachment
                .elongation(&chain.acceleration(&state.positions, &state.velocities, &state.slider_forces))
                .abs(),
        }
    };
    let counts = |event: &&Event| event.kind != EventKind::Grazing && event.time < end;
    exact.iter().filter(counts).map(rate).fold(f64::INFINITY, f64::min)
}
