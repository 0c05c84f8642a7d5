//! A sampled motion that can be looked up at any time: positions by cubic Hermite interpolation of sampled positions and velocities
//! (fourth order), velocities and slider force linearly.

use crate::dynamics::Trajectory;
use crate::model::ContactState;

/// What is drawn of one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    pub time: f64,
    pub positions: [f64; 2],
    pub velocities: [f64; 2],
    pub slider_force: f64,
    pub contact: ContactState,
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
                Some(Instant {
                    time: sample.time,
                    positions: sample.state.positions.as_slice().try_into().ok()?,
                    velocities: sample.state.velocities.as_slice().try_into().ok()?,
                    slider_force: *sample.state.slider_forces.first()?,
                    contact: *sample.contacts.first()?,
                })
            })
            .collect::<Option<Vec<_>>>()?;
        (!instants.is_empty()).then_some(Self { instants })
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
    let hermite = |i: usize| {
        let (x0, x1, v0, v1) = (left.positions[i], right.positions[i], left.velocities[i] * h, right.velocities[i] * h);
        let r = 1.0 - s;
        r * r * ((1.0 + 2.0 * s) * x0 + s * v0) + s * s * ((3.0 - 2.0 * s) * x1 - r * v1)
    };
    Instant {
        time,
        positions: [hermite(0), hermite(1)],
        velocities: std::array::from_fn(|i| mix(left.velocities[i], right.velocities[i])),
        slider_force: mix(left.slider_force, right.slider_force),
        contact: left.contact,
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
    fn a_window_ends_at_its_instant_and_is_thinned_to_its_limit() {
        let motion = circle(0.01, 1001);
        let points: Vec<_> = motion.between(2.0, 6.005, 100).collect();
        assert!(points.len() <= 103 && points.len() > 80);
        assert_eq!(points.last().unwrap().time, 6.005);
        assert!(points.iter().all(|p| p.time >= 2.0 && p.time <= 6.005));
        assert_eq!(motion.at(99.0), motion.at(10.0));
    }
}
