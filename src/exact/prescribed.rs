//! Prescribed motion of a chain: oscillator 0 moved as `x_0 = a sin(w t)`, all others held where they are.
//!
//! The slider forces come from the closed form of the hysteresis (`hysteresis`). The driving force is the one that Newton's law
//! asks for, `F = m_0 x_0'' - (free force on oscillator 0)`, and its work closes the energy ledger.

use super::error::ExactError;
use super::gauss::integrate;
use super::hysteresis::{ForceLaw, Stretch};
use super::trajectory::check_sampling;
use crate::dynamics::{Flow, Outcome, Sample, Sampling, State, Trajectory};
use crate::model::{EnergyLedger, OscillatorChain, PrescribedMotion, Works};
use std::f64::consts::PI;

/// Half periods beyond which a motion is refused.
const MOST_BRANCHES: f64 = 1e7;
/// Velocities and positions may differ from the prescribed ones by this much, relative to the motion's own scale: they may have
/// been computed in another order.
const AGREEMENT: f64 = 1e-12;

/// Closed form of the prescribed motion of oscillator 0.
#[derive(Debug, Clone)]
pub struct PrescribedFlow {
    pub(super) chain: OscillatorChain,
    pub(super) motion: PrescribedMotion,
}

impl PrescribedFlow {
    /// # Errors
    /// [`ExactError::Parameter`] unless amplitude and angular frequency are finite and positive.
    pub fn new(chain: &OscillatorChain, motion: PrescribedMotion) -> Result<Self, ExactError> {
        Ok(Self { chain: chain.clone(), motion: motion.validated()? })
    }

    #[must_use]
    pub fn motion(&self) -> PrescribedMotion {
        self.motion
    }

    fn agreeing(&self, initial: &State) -> Result<State, ExactError> {
        let state = initial.clone().validated(&self.chain)?;
        let scale = [self.motion.amplitude, self.motion.velocity(0.0)];
        let check = |field, index, found: f64, expected: f64, scale: f64| {
            let agrees = (found - expected).abs() <= AGREEMENT * scale;
            if agrees { Ok(()) } else { Err(ExactError::MotionMismatch { field, index, found, expected }) }
        };
        check("positions", 0, state.positions[0], self.motion.position(0.0), scale[0])?;
        for (index, &velocity) in state.velocities.iter().enumerate() {
            let expected = if index == 0 { self.motion.velocity(0.0) } else { 0.0 };
            check("velocities", index, velocity, expected, scale[1])?;
        }
        Ok(state)
    }

    /// Works from `from` to `to` within a stretch; the driving force is the one that Newton's law for oscillator 0 asks for.
    fn works(&self, initial: &State, stretch: &Stretch, from: f64, to: f64) -> Works {
        let mut works = Works::default();
        if to <= from {
            return works;
        }
        let w = self.motion.angular_frequency;
        let mass = self.chain.mass()[0];
        integrate(from, to, 1.0 / w, |time, weight| {
            let state = self.state(initial, &stretch.laws, time);
            let powers = self.chain.powers(&state.positions, &state.velocities);
            works.damping += weight * powers.damping;
            works.self_excitation += weight * powers.self_excitation;
            works.circulatory += weight * powers.circulatory;
            let free = self.chain.acceleration(&state.positions, &state.velocities, &state.slider_forces)[0];
            let moved = -w * w * state.positions[0];
            works.drive += weight * mass * (moved - free) * state.velocities[0];
        });
        let slip = (self.motion.position(to) - self.motion.position(from)).abs();
        for (element, law) in self.chain.jenkins().iter().zip(&stretch.laws) {
            if matches!(law, ForceLaw::Slip(_)) {
                works.friction -= element.slip_force * slip;
            }
        }
        works
    }
}

impl Flow for PrescribedFlow {
    type Error = ExactError;

    fn name(&self) -> String {
        "exact-prescribed".to_owned()
    }

    /// `initial` gives the slider forces and where the other oscillators are held; positions and velocities must agree with the
    /// motion at time 0.
    fn trajectory(&self, initial: &State, sampling: Sampling) -> Result<Trajectory, ExactError> {
        check_sampling(sampling)?;
        let initial = self.agreeing(initial)?;
        if sampling.t_end * self.motion.angular_frequency > MOST_BRANCHES * PI {
            return Err(ExactError::OutOfRange {
                field: "t_end",
                found: sampling.t_end,
                allowed: "at most 5e6 periods of the prescribed motion",
            });
        }
        let (stretches, events) = self.stretches(&initial, sampling.t_end);
        let (mut index, mut counted, mut works) = (0, 0.0, Works::default());
        let mut stored_at_start = None;
        let samples = sampling.times().map(|time| {
            while index + 1 < stretches.len() && stretches[index + 1].start <= time {
                works += self.works(&initial, &stretches[index], counted, stretches[index].end);
                index += 1;
                counted = stretches[index].start;
            }
            let stretch = &stretches[index];
            works += self.works(&initial, stretch, counted, time);
            counted = time;
            let state = self.state(&initial, &stretch.laws, time);
            let stored = self.chain.stored_energy(&state.positions, &state.velocities, &state.slider_forces);
            let stored_at_start = *stored_at_start.get_or_insert(stored);
            let contacts = stretch.laws.iter().map(|law| law.contact()).collect();
            Sample { time, state, contacts, ledger: EnergyLedger { stored, stored_at_start, works } }
        });
        Ok(Trajectory { samples: samples.collect(), events, outcome: Outcome::Completed })
    }
}
