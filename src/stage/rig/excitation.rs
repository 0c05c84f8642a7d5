//! The self-excitation as energy that flows into the carriages: an arrow over each, as long as the power it feeds in,
//!
//! ```text
//! P_i = -xi1 v_i^2
//! ```
//!
//! pointing into the carriage where it is positive, as for all xi1 < 0, and out of it where energy is taken.

use super::{HALF, HEIGHT};
use crate::render::shapes::arrow;
use crate::render::{Colour, Object};
use crate::scene;
use crate::stage::motion::{Instant, Motion};
use crate::stage::palette;
use glam::{Affine3A, Mat3, Vec3};
use std::sync::Arc;

/// Length of an arrow at the largest power of the film; shorter ones than `LEAST` are left out.
const LENGTH: f32 = 0.62;
const LEAST: f32 = 0.03;

#[derive(Debug, Clone)]
pub(super) struct Excitation {
    xi1: scene::Excitation,
    colour: Colour,
    length_per_power: f32,
}

fn powers(xi1: scene::Excitation, at: &Instant) -> [f64; 2] {
    let xi1 = xi1.at(at.time);
    at.velocities.map(|v| -xi1 * v * v)
}

impl Excitation {
    pub fn new(xi1: scene::Excitation, motion: &Motion, colour: Colour) -> Self {
        let largest = motion.largest(|at| {
            let [first, second] = powers(xi1, at);
            first.abs().max(second.abs())
        });
        Self { xi1, colour, length_per_power: LENGTH / (largest as f32).max(1e-9) }
    }

    pub fn draw(&self, x: [f32; 2], now: &Instant, objects: &mut Vec<Object>) {
        for (place, power) in x.into_iter().zip(powers(self.xi1, now)) {
            let length = self.length_per_power * power.abs() as f32;
            if length < LEAST {
                continue;
            }
            // Thick arrows for much power; the head is never longer than the arrow.
            let radius = 0.022 + 0.035 * length;
            let head = (3.4 * radius).min(0.6 * length);
            let mesh = Arc::new(arrow(length, radius, head, 2.0 * radius, 24));
            let foot = HEIGHT + HALF + 0.06;
            let (direction, start) = if power > 0.0 { (Vec3::NEG_Y, foot + length) } else { (Vec3::Y, foot) };
            let turn = Mat3::from_cols(direction, Vec3::Z.cross(direction), Vec3::Z);
            let transform = Affine3A::from_mat3_translation(turn, Vec3::new(place, start, 0.0));
            let material = palette::glowing(self.colour, 0.3);
            objects.push(Object { mesh, transform, material, casts_shadow: true });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Outcome, Sample, State, Trajectory};
    use crate::model::{ContactState, EnergyLedger, RigParameters, TwoMassRig};

    /// Against the chain's own power, which is computed from its damping matrices.
    #[test]
    fn the_arrows_together_show_the_power_of_the_self_excitation() {
        let parameters = RigParameters::default();
        let chain_power = TwoMassRig::new(parameters).unwrap().chain().powers(&[0.0; 2], &[0.7, -0.2]).self_excitation;
        let sample = Sample {
            time: 0.0,
            state: State::two_mass([0.0, 0.0, 0.7, -0.2, 0.0]),
            contacts: vec![ContactState::Stick],
            ledger: EnergyLedger::default(),
        };
        let motion = Motion::new(&Trajectory { samples: vec![sample], events: vec![], outcome: Outcome::Completed });
        let xi1 = scene::Excitation { start: parameters.xi1, duration: 1.0, ramp: None };
        let [first, second] = powers(xi1, &motion.unwrap().at(0.0));
        assert!((first + second - chain_power).abs() < 1e-15 && first > second && second > 0.0);
    }
}
