//! Changes of contact state between two instants one step apart, with times interpolated inside the step:
//!
//! ```text
//! stick -> slip   where f_0 + (k/R)(u(t) - u_0) reaches the limit, u(t) the parabola through u_0, u_1 with the rate u_0' at t_0,
//! slip -> stick   where the elongation rate, linear in the step, changes sign.
//! ```
//!
//! Both are second order in the step.

use super::instant::Instant;
use crate::dynamics::{Event, EventKind};
use crate::model::{ContactState, Direction, JenkinsElement, OscillatorChain};

/// Appends the events from `from` to `to` to `events`, in order of time.
pub(super) fn find(chain: &OscillatorChain, from: &Instant, to: &Instant, events: &mut Vec<Event>) {
    let first = events.len();
    for (index, element) in chain.jenkins().iter().enumerate() {
        for (kind, fraction) in changes(element, index, from, to) {
            let mut at = from.towards(to, fraction, chain);
            if let Some(limit) = Direction::of(to.state.slider_forces[index])
                && kind == EventKind::StickToSlip
            {
                at.state.slider_forces[index] = limit.sign();
            }
            events.push(Event { time: at.time, element: index, kind, state: at.state });
        }
    }
    events[first..].sort_by(|a, b| a.time.total_cmp(&b.time));
}

/// The number of events from `from` to `to`.
pub(super) fn count(chain: &OscillatorChain, from: &Instant, to: &Instant) -> usize {
    chain.jenkins().iter().enumerate().map(|(index, element)| changes(element, index, from, to).len()).sum()
}

/// Kinds and places within the step, as fractions in [0, 1].
fn changes(element: &JenkinsElement, index: usize, from: &Instant, to: &Instant) -> Vec<(EventKind, f64)> {
    let (before, after) = (from.contacts[index], to.contacts[index]);
    let slip_start = || (EventKind::StickToSlip, slip_fraction(element, index, from, to));
    let reversal = || (EventKind::SlipToStick, reversal_fraction(element, from, to));
    match (before, after) {
        (ContactState::Stick, ContactState::Slip(_)) => vec![slip_start()],
        (ContactState::Slip(_), ContactState::Stick) => vec![reversal()],
        (ContactState::Slip(a), ContactState::Slip(b)) if a != b => vec![reversal(), slip_start()],
        (ContactState::Stick, ContactState::Stick) if slid_within(element, index, from, to) => {
            let (start, stop) = (slip_start(), reversal());
            vec![start, (stop.0, stop.1.max(start.1))]
        }
        _ => Vec::new(),
    }
}

/// Did the return mapping cut the force off, so that an element sticking at both ends slipped in between?
fn slid_within(element: &JenkinsElement, index: usize, from: &Instant, to: &Instant) -> bool {
    let (du, _) = elongation(element, from, to);
    let cut_off = (from.state.slider_forces[index] + element.normalised_stiffness() * du).abs() > 1.0;
    // A force that is averaged over steps may fall short of the sum by a rounding of higher order, without any slip.
    cut_off && to.state.slider_forces[index].abs() >= 1.0
}

fn slip_fraction(element: &JenkinsElement, index: usize, from: &Instant, to: &Instant) -> f64 {
    let (du, rate) = elongation(element, from, to);
    let limit = to.state.slider_forces[index];
    let target = (limit - from.state.slider_forces[index]) / element.normalised_stiffness();
    // u(s) - u_0 = slope s + curvature s^2; the smallest root beyond 0 of a rise to `target`, in the form that does not cancel.
    let slope = rate * (to.time - from.time);
    let curvature = du - slope;
    let root = (slope * slope + 4.0 * curvature * target).max(0.0).sqrt();
    let denominator = slope + slope.signum() * root;
    // A slider that turned round within the step starts with the wrong sign of slope: the secant will do there.
    let fraction = if slope * target > 0.0 { 2.0 * target / denominator } else { target / du };
    if fraction.is_finite() { fraction.clamp(0.0, 1.0) } else { 0.0 }
}

fn reversal_fraction(element: &JenkinsElement, from: &Instant, to: &Instant) -> f64 {
    let (_, first) = elongation(element, from, to);
    let last = element.attachment.elongation(&to.state.velocities);
    let fraction = first / (first - last);
    if fraction.is_finite() { fraction.clamp(0.0, 1.0) } else { 0.0 }
}

/// Change of elongation over the step, and its rate at the beginning.
fn elongation(element: &JenkinsElement, from: &Instant, to: &Instant) -> (f64, f64) {
    let at = |values: &[f64]| element.attachment.elongation(values);
    (at(&to.state.positions) - at(&from.state.positions), at(&from.state.velocities))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::State;
    use crate::engine::instant::contact;
    use crate::model::{RigParameters, TwoMassRig};

    fn instant(time: f64, [x, v, f]: [f64; 3]) -> Instant {
        let state = State::two_mass([x, 0.0, v, 0.0, f]);
        Instant { time, state, contacts: vec![contact(f, v)], drive_force: 0.0 }
    }

    fn found(from: &Instant, to: &Instant) -> Vec<(EventKind, f64)> {
        let rig = TwoMassRig::new(RigParameters::default()).unwrap();
        let mut events = Vec::new();
        find(rig.chain(), from, to, &mut events);
        events.iter().map(|event| (event.kind, event.time)).collect()
    }

    #[test]
    fn slip_starts_where_the_parabola_reaches_the_limit() {
        // u = s + s^2/2 from f = 0.5 on: f = 1 at s = sqrt(2) - 1.
        let (from, to) = (instant(0.0, [0.0, 1.0, 0.5]), instant(1.0, [1.5, 2.0, 1.0]));
        let events = found(&from, &to);
        assert_eq!(events.len(), 1);
        // Rounding.
        assert!((events[0].1 - (2f64.sqrt() - 1.0)).abs() < 1e-15);
    }

    #[test]
    fn a_slip_shorter_than_the_step_gives_both_events() {
        let (from, to) = (instant(2.0, [0.0, 0.5, 0.9]), instant(3.0, [0.2, -0.1, 1.0]));
        let events = found(&from, &to);
        let kinds: Vec<_> = events.iter().map(|event| event.0).collect();
        assert_eq!(kinds, [EventKind::StickToSlip, EventKind::SlipToStick]);
        assert!(events[0].1 <= events[1].1 && events[1].1 < 3.0);
    }

    #[test]
    fn sticking_and_steady_slip_are_no_events() {
        assert!(found(&instant(0.0, [0.0, 0.1, 0.2]), &instant(1.0, [0.1, 0.1, 0.3])).is_empty());
        assert!(found(&instant(0.0, [0.0, 0.1, 1.0]), &instant(1.0, [0.1, 0.1, 1.0])).is_empty());
    }
}
