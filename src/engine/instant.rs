//! The rig at one instant, and between two instants one step apart.

use crate::dynamics::State;
use crate::model::{ContactState, Direction, OscillatorChain};

/// What is recorded of the rig at a grid time.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Instant {
    pub time: f64,
    pub state: State,
    pub contacts: Vec<ContactState>,
    /// Force that a prescribed motion needs on oscillator 0; zero where nothing is prescribed.
    pub drive_force: f64,
}

impl Instant {
    /// Between `self` and `next`, at the fraction `s` of the step, with errors of second order in the step: positions by the cubic
    /// through both positions and velocities, velocities linearly, slider forces by the return mapping from `self`.
    pub fn towards(&self, next: &Self, s: f64, chain: &OscillatorChain) -> Self {
        let step = next.time - self.time;
        let (a, b) = (&self.state, &next.state);
        let mut between = Self {
            time: self.time + s * step,
            state: a.clone(),
            contacts: self.contacts.clone(),
            drive_force: lerp(self.drive_force, next.drive_force, s),
        };
        for i in 0..chain.oscillators() {
            let slopes = (step * a.velocities[i], step * b.velocities[i]);
            between.state.positions[i] = hermite(a.positions[i], b.positions[i], slopes, s);
            between.state.velocities[i] = lerp(a.velocities[i], b.velocities[i], s);
        }
        for (j, element) in chain.jenkins().iter().enumerate() {
            let du =
                element.attachment.elongation(&between.state.positions) - element.attachment.elongation(&a.positions);
            let f = super::force_law::return_mapping(element, a.slider_forces[j], du);
            between.state.slider_forces[j] = f;
        }
        between.find_contacts(chain);
        between
    }

    /// Sets the contact states from slider forces and velocities.
    pub fn find_contacts(&mut self, chain: &OscillatorChain) {
        for (j, element) in chain.jenkins().iter().enumerate() {
            let rate = element.attachment.elongation(&self.state.velocities);
            self.contacts[j] = contact(self.state.slider_forces[j], rate);
        }
    }
}

/// Contact state just after an instant: slip if the slider force is at its limit and the elongation still grows in its sense.
pub(super) fn contact(slider_force: f64, elongation_rate: f64) -> ContactState {
    match Direction::of(slider_force) {
        Some(direction) if slider_force.abs() >= 1.0 && slider_force * elongation_rate > 0.0 => {
            ContactState::Slip(direction)
        }
        _ => ContactState::Stick,
    }
}

pub(super) fn lerp(a: f64, b: f64, s: f64) -> f64 {
    a + s * (b - a)
}

/// Cubic on [0, 1] with end values a and b and the given end slopes.
fn hermite(a: f64, b: f64, (slope_a, slope_b): (f64, f64), s: f64) -> f64 {
    let r = 1.0 - s;
    a * r * r * (1.0 + 2.0 * s) + b * s * s * (1.0 + 2.0 * r) + slope_a * s * r * r - slope_b * s * s * r
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_reproduced_between_its_ends() {
        let x = |s: f64| 2.0 - s + 3.0 * s * s - 4.0 * s.powi(3);
        let slope = |s: f64| -1.0 + 6.0 * s - 12.0 * s * s;
        for s in [0.0, 0.3, 0.5, 1.0] {
            // Rounding of a few terms of order 1.
            assert!((hermite(x(0.0), x(1.0), (slope(0.0), slope(1.0)), s) - x(s)).abs() < 1e-14);
        }
    }

    #[test]
    fn only_an_element_at_its_limit_and_loaded_further_slips() {
        assert_eq!(contact(1.0, 0.2), ContactState::Slip(Direction::Positive));
        assert_eq!(contact(-1.0, -0.2), ContactState::Slip(Direction::Negative));
        for (f, rate) in [(1.0, -0.2), (1.0, 0.0), (0.999, 0.2), (0.0, 0.2)] {
            assert_eq!(contact(f, rate), ContactState::Stick);
        }
    }
}
