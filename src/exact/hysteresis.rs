//! Closed form of the slider forces while oscillator 0 moves as `x_0 = a sin(w t)` and all others rest.
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

use super::prescribed::PrescribedFlow;
use crate::dynamics::{Event, EventKind, State};
use crate::model::{ContactState, Direction};
use std::f64::consts::PI;

/// Force law of one element over a stretch of time.
#[derive(Debug, Clone, Copy)]
pub(super) enum ForceLaw {
    /// Force `force` at position `at` of oscillator 0.
    Stick {
        force: f64,
        at: f64,
    },
    Slip(Direction),
}

/// A stretch of time between corners and reversals.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) laws: Vec<ForceLaw>,
}

/// Motion between two reversals.
struct Branch {
    number: u64,
    start: f64,
    /// Position at the start.
    from: f64,
    end: f64,
}

impl ForceLaw {
    pub(super) fn contact(self) -> ContactState {
        match self {
            Self::Stick { .. } => ContactState::Stick,
            Self::Slip(direction) => ContactState::Slip(direction),
        }
    }
}

impl PrescribedFlow {
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

    pub(super) fn state(&self, initial: &State, laws: &[ForceLaw], time: f64) -> State {
        let mut state = initial.clone();
        state.positions[0] = self.motion.position(time);
        state.velocities[0] = self.motion.velocity(time);
        for (j, (force, law)) in state.slider_forces.iter_mut().zip(laws).enumerate() {
            *force = self.force(j, *law, state.positions[0]);
        }
        state
    }

    /// All stretches and events up to `t_end`, branch by branch.
    pub(super) fn stretches(&self, initial: &State, t_end: f64) -> (Vec<Stretch>, Vec<Event>) {
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
}
