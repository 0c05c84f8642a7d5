//! A sampled motion that can be looked up at any time: positions by cubic Hermite interpolation of sampled positions and velocities
//! (fourth order), velocities and slider force linearly.

use crate::dynamics::Trajectory;
use crate::model::{ContactState, EnergyLedger, Works};

/// How a carriage stands, seen from its rest pose, and the cuboid that it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Along the rail, up, and across.
    pub displacement: [f64; 3],
    /// Unit quaternion x, y, z, w.
    pub rotation: [f64; 4],
    pub half_extents: [f64; 3],
}

impl Body {
    /// A carriage that follows its rail perfectly: what a solver without bodies moves.
    #[must_use]
    pub fn on_the_rail(position: f64) -> Self {
        Self { displacement: [position, 0.0, 0.0], rotation: [0.0, 0.0, 0.0, 1.0], half_extents: [0.4; 3] }
    }
}

/// What is drawn of one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    pub time: f64,
    pub positions: [f64; 2],
    pub velocities: [f64; 2],
    pub slider_force: f64,
    pub contact: ContactState,
    pub ledger: EnergyLedger,
    /// The carriages as they are drawn.
    pub bodies: [Body; 2],
}

/// Samples of a two-mass motion.
#[derive(Debug, Clone)]
pub struct Motion {
    instants: Vec<Instant>,
}

impl Motion {
    /// `None` for an empty trajectory, or one that is not of two masses and one slider.
    #[must_use]
    pub fn new(trajectory: &Trajectory) -> Option<Self> {
        let instants = trajectory
            .samples
            .iter()
            .map(|sample| {
                let positions: [f64; 2] = sample.state.positions.as_slice().try_into().ok()?;
                Some(Instant {
                    time: sample.time,
                    positions,
                    velocities: sample.state.velocities.as_slice().try_into().ok()?,
                    slider_force: *sample.state.slider_forces.first()?,
                    contact: *sample.contacts.first()?,
                    ledger: sample.ledger,
                    bodies: positions.map(Body::on_the_rail),
                })
            })
            .collect::<Option<Vec<_>>>()?;
        (!instants.is_empty()).then_some(Self { instants })
    }

    /// The same motion with the carriages drawn as `bodies` say, one pair per sample: a physics engine's own poses. `None` for
    /// another number of pairs.
    #[must_use]
    pub fn with_bodies(mut self, bodies: &[[Body; 2]]) -> Option<Self> {
        if bodies.len() != self.instants.len() {
            return None;
        }
        self.instants.iter_mut().zip(bodies).for_each(|(instant, &bodies)| instant.bodies = bodies);
        Some(self)
    }

    /// All samples in order of time.
    #[must_use]
    pub fn instants(&self) -> &[Instant] {
        &self.instants
    }

    #[must_use]
    pub fn end(&self) -> f64 {
        self.instants.last().map_or(0.0, |instant| instant.time)
    }

    /// The instant at `time`, held fixed before the first and after the last sample.
    #[must_use]
    pub fn at(&self, time: f64) -> Instant {
        let after = self.instants.partition_point(|instant| instant.time <= time);
        match (after.checked_sub(1).map(|before| self.instants[before]), self.instants.get(after)) {
            (Some(left), Some(right)) => between(&left, right, time),
            (Some(last), None) => last,
            (None, _) => self.instants[0],
        }
    }

    /// Samples in `from..=to`, at most about `most` of them, evenly thinned out by their index so that the same ones are taken in every
    /// frame, between the interpolated instants at `from` and `to`.
    pub fn between(&self, from: f64, to: f64, most: usize) -> impl Iterator<Item = Instant> + '_ {
        let first = self.instants.partition_point(|instant| instant.time < from);
        let end = self.instants.partition_point(|instant| instant.time <= to).max(first);
        let stride = (end - first).div_ceil(most.max(1)).max(1);
        std::iter::once(self.at(from))
            .chain((first.next_multiple_of(stride)..end).step_by(stride).map(|index| self.instants[index]))
            .chain(std::iter::once(self.at(to)))
    }

    /// Largest absolute value of a quantity over the whole motion.
    #[must_use]
    pub fn largest(&self, quantity: impl Fn(&Instant) -> f64) -> f64 {
        self.instants.iter().map(|instant| quantity(instant).abs()).fold(0.0, f64::max)
    }
}

fn between(left: &Instant, right: &Instant, time: f64) -> Instant {
    let h = right.time - left.time;
    let s = (time - left.time) / h;
    let mix = |a: f64, b: f64| a + s * (b - a);
    let along = |i: usize, x0: f64, x1: f64| {
        let (v0, v1) = (left.velocities[i] * h, right.velocities[i] * h);
        let r = 1.0 - s;
        r * r * ((1.0 + 2.0 * s) * x0 + s * v0) + s * s * ((3.0 - 2.0 * s) * x1 - r * v1)
    };
    let hermite = |i: usize| along(i, left.positions[i], right.positions[i]);
    let body = |i: usize| {
        let (a, b) = (left.bodies[i], right.bodies[i]);
        let x = along(i, a.displacement[0], b.displacement[0]);
        let [_, y, z] = std::array::from_fn(|axis| mix(a.displacement[axis], b.displacement[axis]));
        // Within a step rotations hardly change: their components may be mixed, and are made a unit again where they are drawn.
        let rotation = std::array::from_fn(|k| mix(a.rotation[k], b.rotation[k]));
        Body { displacement: [x, y, z], rotation, half_extents: a.half_extents }
    };
    Instant {
        time,
        positions: [hermite(0), hermite(1)],
        velocities: std::array::from_fn(|i| mix(left.velocities[i], right.velocities[i])),
        slider_force: mix(left.slider_force, right.slider_force),
        contact: left.contact,
        ledger: ledger_between(&left.ledger, &right.ledger, s),
        bodies: [body(0), body(1)],
    }
}

pub(super) fn ledger_between(left: &EnergyLedger, right: &EnergyLedger, s: f64) -> EnergyLedger {
    let mix = |a: f64, b: f64| a + s * (b - a);
    let (a, b) = (&left.works, &right.works);
    EnergyLedger {
        stored: mix(left.stored, right.stored),
        stored_at_start: left.stored_at_start,
        works: Works {
            damping: mix(a.damping, b.damping),
            self_excitation: mix(a.self_excitation, b.self_excitation),
            circulatory: mix(a.circulatory, b.circulatory),
            friction: mix(a.friction, b.friction),
            drive: mix(a.drive, b.drive),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Outcome, Sample, State};
    use crate::model::EnergyLedger;

    /// x1 = sin t, x2 = cos t.
    fn circle(interval: f64, count: u32) -> Motion {
        let samples = (0..count)
            .map(|n| {
                let t = f64::from(n) * interval;
                Sample {
                    time: t,
                    state: State::two_mass([t.sin(), t.cos(), t.cos(), -t.sin(), 0.0]),
                    contacts: vec![ContactState::Stick],
                    ledger: EnergyLedger::default(),
                }
            })
            .collect();
        Motion::new(&Trajectory { samples, events: vec![], outcome: Outcome::Completed }).unwrap()
    }

    #[test]
    fn positions_are_interpolated_to_fourth_order() {
        let error = |interval: f64| {
            let motion = circle(interval, 11);
            (0..100)
                .map(|i| f64::from(i) * 0.1 * interval)
                .map(|t| (motion.at(t).positions[0] - t.sin()).abs())
                .fold(0.0, f64::max)
        };
        // Error of cubic Hermite interpolation: h^4/384 of the fourth derivative, which is 1 at most.
        assert!(error(0.1) < 0.1_f64.powi(4) / 384.0 && error(0.1) > 0.0);
        let order = (error(0.2) / error(0.1)).log2();
        assert!((3.5..4.5).contains(&order), "order {order}");
    }

    #[test]
    fn bodies_are_drawn_where_their_owner_says_and_must_be_as_many_as_the_samples() {
        let motion = circle(0.1, 11);
        let lifted: Vec<[Body; 2]> = motion
            .instants()
            .iter()
            .map(|i| i.positions.map(|x| Body { displacement: [x, 0.25, 0.0], ..Body::on_the_rail(x) }))
            .collect();
        assert!(motion.clone().with_bodies(&lifted[1..]).is_none());
        let motion = motion.with_bodies(&lifted).unwrap();
        let now = motion.at(0.33);
        assert_eq!(now.bodies[0].displacement, [now.positions[0], 0.25, 0.0]);
    }

    #[test]
    fn a_window_ends_at_its_instant_and_is_thinned_to_its_limit() {
        let motion = circle(0.01, 1001);
        let points: Vec<_> = motion.between(2.0, 6.005, 100).collect();
        assert!(points.len() <= 103 && points.len() > 80);
        assert_eq!(points.last().unwrap().time, 6.005);
        assert!(points.iter().all(|p| p.time >= 2.0 && p.time <= 6.005));
        assert_eq!(motion.at(99.0), motion.at(10.0));
    }
}
