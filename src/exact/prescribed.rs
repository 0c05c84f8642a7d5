//! The hysteresis of a chain whose oscillator 0 is moved as `x_0 = a sin(w t)` while all others are held where they are.
//!
//! Between two reversals, `w t = (b - 1/2) pi` and `(b + 1/2) pi`, the elongation of an element goes one way. With the force
//! `f_r` at the last reversal, where the position was `x_r`,
//!
//! ```text
//! f = f_r + s k/R (x_0 - x_r)  until it reaches d = s (-1)^b, then f = d          (s = +1 or -1: which end moves)
//! corner:  x_c = x_r + s R/k (d - f_r),   w t_c = b pi + (-1)^b arcsin(x_c/a)
//! ```
//!
//! Of an element between reversals at `f = -d` and amplitude `a > R/k` the loop encloses the work `4 R (a - R/k)`.

use super::error::ExactError;
use super::gauss::integrate;
use super::trajectory::check_sampling;
use crate::dynamics::{Event, EventKind, Flow, Outcome, Sample, Sampling, State, Trajectory};
use crate::model::{ContactState, Direction, EnergyLedger, OscillatorChain, PrescribedMotion, Works};
use std::f64::consts::PI;

/// Half periods beyond which a motion is refused.
const MOST_BRANCHES: f64 = 1e7;
/// Velocities and positions may differ from the prescribed ones by this much, relative to the motion's own scale: they may have
/// been computed in another order.
const AGREEMENT: f64 = 1e-12;

/// Closed form of the prescribed motion of oscillator 0.
#[derive(Debug, Clone)]
pub struct PrescribedFlow {
    chain: OscillatorChain,
    motion: PrescribedMotion,
}

/// Force law of one element over a stretch of time.
#[derive(Debug, Clone, Copy)]
enum ForceLaw {
    /// Force `force` at position `at` of oscillator 0.
    Stick {
        force: f64,
        at: f64,
    },
    Slip(Direction),
}

/// A stretch of time between corners and reversals.
#[derive(Debug, Clone)]
struct Stretch {
    start: f64,
    end: f64,
    laws: Vec<ForceLaw>,
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

    /// Which end of element `j` moves with oscillator 0: +1, -1, or 0 if neither.
    fn side(&self, j: usize) -> f64 {
        let mut direction = vec![0.0; self.chain.oscillators()];
        self.chain.jenkins()[j].attachment.scatter(1.0, &mut direction);
        direction[0]
    }

    fn force(&self, j: usize, law: ForceLaw, position: f64) -> f64 {
        match law {
            ForceLaw::Slip(direction) => direction.sign(),
            ForceLaw::Stick { force, at } => {
                let stiffness = self.chain.jenkins()[j].normalised_stiffness();
                (force + self.side(j) * stiffness * (position - at)).clamp(-1.0, 1.0)
            }
        }
    }

    fn state(&self, initial: &State, laws: &[ForceLaw], time: f64) -> State {
        let mut state = initial.clone();
        state.positions[0] = self.motion.position(time);
        state.velocities[0] = self.motion.velocity(time);
        for (j, (force, law)) in state.slider_forces.iter_mut().zip(laws).enumerate() {
            *force = self.force(j, *law, state.positions[0]);
        }
        state
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

    /// All stretches and events up to `t_end`, branch by branch.
    fn stretches(&self, initial: &State, t_end: f64) -> (Vec<Stretch>, Vec<Event>) {
        let (mut stretches, mut events) = (Vec::new(), Vec::new());
        let mut forces = initial.slider_forces.clone();
        let mut slipping = vec![false; forces.len()];
        for branch in 0_u64.. {
            let start = if branch == 0 { 0.0 } else { (branch as f64 - 0.5) * PI / self.motion.angular_frequency };
            if start > t_end {
                break;
            }
            let from = if branch == 0 { 0.0 } else { -self.way(branch) * self.motion.amplitude };
            let mut laws: Vec<ForceLaw> = forces.iter().map(|&force| ForceLaw::Stick { force, at: from }).collect();
            for element in (0..laws.len()).filter(|&j| slipping[j]) {
                let state = self.state(initial, &laws, start);
                events.push(Event { time: start, element, kind: EventKind::SlipToStick, state });
            }
            let branch =
                Branch { number: branch, start, from, end: (branch as f64 + 0.5) * PI / self.motion.angular_frequency };
            self.follow(initial, &branch, &mut laws, &mut stretches, &mut events);
            let to = self.way(branch.number) * self.motion.amplitude;
            slipping = laws.iter().map(|law| matches!(law, ForceLaw::Slip(_))).collect();
            forces = laws.iter().enumerate().map(|(j, law)| self.force(j, *law, to)).collect();
        }
        events.retain(|event| event.time <= t_end);
        stretches.retain(|stretch| stretch.start <= t_end);
        (stretches, events)
    }

    /// +1 where oscillator 0 moves forwards, -1 where backwards.
    fn way(&self, branch: u64) -> f64 {
        if branch.is_multiple_of(2) { 1.0 } else { -1.0 }
    }

    fn follow(
        &self,
        initial: &State,
        branch: &Branch,
        laws: &mut [ForceLaw],
        stretches: &mut Vec<Stretch>,
        events: &mut Vec<Event>,
    ) {
        let mut corners: Vec<(f64, usize, EventKind)> =
            (0..laws.len()).filter_map(|j| self.corner(branch, laws[j], j)).collect();
        // Simultaneous corners in the order of the elements: the sort is stable.
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut start = branch.start;
        for (time, element, kind) in corners {
            if kind == EventKind::StickToSlip {
                stretches.push(Stretch { start, end: time, laws: laws.to_vec() });
                start = time;
                let direction = self.side(element) * self.way(branch.number);
                laws[element] = Direction::of(direction).map_or(laws[element], ForceLaw::Slip);
            }
            // A corner at time 0 is the contact state at the start, no event.
            if time > 0.0 {
                let mut state = self.state(initial, laws, time);
                state.slider_forces[element] = self.side(element) * self.way(branch.number);
                events.push(Event { time, element, kind, state });
            }
        }
        stretches.push(Stretch { start, end: branch.end, laws: laws.to_vec() });
    }

    /// Where element `j` reaches its slip force on a branch: time, element, and whether it goes on to slip or only touches.
    fn corner(&self, branch: &Branch, law: ForceLaw, j: usize) -> Option<(f64, usize, EventKind)> {
        let (side, way) = (self.side(j), self.way(branch.number));
        let ForceLaw::Stick { force, at } = law else { return None };
        if side == 0.0 {
            return None;
        }
        let amplitude = self.motion.amplitude;
        let corner = at + side * (side * way - force) / self.chain.jenkins()[j].normalised_stiffness();
        let beyond = way * corner - amplitude;
        // Two roundings of the sum above.
        let touch = beyond.abs() <= 2.0 * f64::EPSILON * (amplitude + at.abs());
        if beyond > 0.0 && !touch {
            return None;
        }
        if touch {
            return Some((branch.end, j, EventKind::Grazing));
        }
        let angle = branch.number as f64 * PI + way * (corner / amplitude).clamp(-1.0, 1.0).asin();
        let time = (angle / self.motion.angular_frequency).clamp(branch.start, branch.end);
        Some((if corner == branch.from { branch.start } else { time }, j, EventKind::StickToSlip))
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

/// Motion between two reversals.
struct Branch {
    number: u64,
    start: f64,
    /// Position at the start.
    from: f64,
    end: f64,
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

impl ForceLaw {
    fn contact(self) -> ContactState {
        match self {
            Self::Stick { .. } => ContactState::Stick,
            Self::Slip(direction) => ContactState::Slip(direction),
        }
    }
}
