//! Slow amplitudes: the largest elongation of each mass at its turning points, `a_j = |x_j|` where `v_j = 0`, and straight lines between
//! them. Both maxima and minima count, since the mirrored motion is a motion too.

use super::motion::Motion;

/// Amplitude of one mass over time.
#[derive(Debug, Clone, Default)]
pub struct Envelope {
    /// Times and amplitudes of the turning points, in order of time.
    turns: Vec<[f64; 2]>,
}

impl Envelope {
    #[must_use]
    pub fn of_mass(motion: &Motion, mass: usize) -> Self {
        let turns = motion.instants().windows(2).filter_map(|pair| {
            let (a, b) = (pair[0].velocities[mass], pair[1].velocities[mass]);
            (a * b < 0.0 || (a != 0.0 && b == 0.0)).then(|| {
                let time = pair[0].time + (pair[1].time - pair[0].time) * a / (a - b);
                [time, motion.at(time).positions[mass].abs()]
            })
        });
        Self { turns: turns.collect() }
    }

    /// Time of the first turning point, and of the last one up to `time`.
    #[must_use]
    pub fn known(&self, time: f64) -> Option<[f64; 2]> {
        let count = self.turns.partition_point(|turn| turn[0] <= time);
        Some([self.turns.first()?[0], self.turns.get(count.checked_sub(1)?)?[0]])
    }

    /// Amplitude at a time, held fixed beyond the first and last turning point; 0 where there is none.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let after = self.turns.partition_point(|turn| turn[0] <= time);
        match (after.checked_sub(1).map(|i| self.turns[i]), self.turns.get(after)) {
            (Some([t0, a0]), Some([t1, a1])) => a0 + (a1 - a0) * (time - t0) / (t1 - t0),
            (Some([_, a]), None) | (None, Some(&[_, a])) => a,
            (None, None) => 0.0,
        }
    }

    #[must_use]
    pub fn largest(&self) -> f64 {
        self.turns.iter().map(|turn| turn[1]).fold(0.0, f64::max)
    }

    /// Times and amplitudes of the turning points in `from..=to`.
    pub fn turns(&self, from: f64, to: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
        let first = self.turns.partition_point(|turn| turn[0] < from);
        self.turns[first..].iter().copied().take_while(move |turn| turn[0] <= to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Outcome, Sample, State, Trajectory};
    use crate::model::{ContactState, EnergyLedger};

    /// x1 = 2 cos t, x2 = 0.5 sin t.
    #[test]
    fn a_harmonic_motion_has_its_amplitude_at_every_half_period() {
        let sample = |n: u32| {
            let time = 0.04 * f64::from(n);
            let (s, c) = time.sin_cos();
            Sample {
                time,
                state: State::two_mass([2.0 * c, 0.5 * s, -2.0 * s, 0.5 * c, 0.0]),
                contacts: vec![ContactState::Stick],
                ledger: EnergyLedger::default(),
            }
        };
        let trajectory =
            Trajectory { samples: (0..500).map(sample).collect(), events: vec![], outcome: Outcome::Completed };
        let motion = Motion::new(&trajectory).unwrap();
        let (first, second) = (Envelope::of_mass(&motion, 0), Envelope::of_mass(&motion, 1));
        // Cubic interpolation over 0.04: 0.04^4/384 of the fourth derivative, 2 at most; the turning time is off by 0.04^3/12 and counts
        // squared.
        assert!((first.at(10.0) - 2.0).abs() < 2e-8 && (second.at(10.0) - 0.5).abs() < 2e-8);
        let times: Vec<f64> = first.turns(0.0, 7.0).map(|turn| turn[0]).collect();
        assert_eq!(times.len(), 2);
        assert!((times[0] - std::f64::consts::PI).abs() < 1e-5, "{times:?}");
        let [start, last] = second.known(6.0).unwrap();
        assert!((start - 0.5 * std::f64::consts::PI).abs() < 1e-5 && (last - 1.5 * std::f64::consts::PI).abs() < 1e-5);
        assert_eq!(second.known(1.0), None);
    }
}
