//! Slow amplitudes: the largest elongation of each mass at its turning points, `a_j = |x_j|` where `v_j = 0`, and a monotone cubic through
//! them (Fritsch and Carlson, SIAM J. Numer. Anal. 17 (1980) 238-246, with harmonic means as slopes): smooth, and never beyond the turning
//! points it lies between. Both maxima and minima count, since the mirrored motion is a motion too.

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

    /// Amplitude at a time, held fixed beyond the first and last turning point; 0 where there is none. It depends on the two turning
    /// points before and the two after.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let after = self.turns.partition_point(|turn| turn[0] <= time);
        match (after.checked_sub(1).map(|i| self.turns[i]), self.turns.get(after)) {
            (Some([t0, a0]), Some(&[t1, a1])) => {
                let h = t1 - t0;
                hermite((time - t0) / h, [a0, a1], [h * self.slope(after - 1), h * self.slope(after)])
            }
            (Some([_, a]), None) | (None, Some(&[_, a])) => a,
            (None, None) => 0.0,
        }
    }

    /// Slope at a turning point: 0 at an extremum of the amplitudes and at both ends, else the harmonic mean of the slopes beside it.
    fn slope(&self, index: usize) -> f64 {
        let secant = |i: usize| {
            let ([t0, a0], [t1, a1]) = (self.turns[i], self.turns[i + 1]);
            (a1 - a0) / (t1 - t0)
        };
        if index == 0 || index + 1 == self.turns.len() {
            return 0.0;
        }
        let (before, after) = (secant(index - 1), secant(index));
        if before * after <= 0.0 { 0.0 } else { 2.0 * before * after / (before + after) }
    }

    /// Amplitude at the last turning point up to `time`.
    #[must_use]
    pub fn last(&self, time: f64) -> Option<f64> {
        let count = self.turns.partition_point(|turn| turn[0] <= time);
        Some(self.turns.get(count.checked_sub(1)?)?[1])
    }

    /// Time of the first turning point.
    #[must_use]
    pub fn start(&self) -> Option<f64> {
        Some(self.turns.first()?[0])
    }

    #[must_use]
    pub fn largest(&self) -> f64 {
        self.turns.iter().map(|turn| turn[1]).fold(0.0, f64::max)
    }
}

/// The cubic with these values and slopes at 0 and 1.
fn hermite(s: f64, [a0, a1]: [f64; 2], [d0, d1]: [f64; 2]) -> f64 {
    let r = 1.0 - s;
    r * r * ((1.0 + 2.0 * s) * a0 + s * d0) + s * s * ((3.0 - 2.0 * s) * a1 - r * d1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Outcome, Sample, State, Trajectory};
    use crate::model::{ContactState, EnergyLedger};

    /// x1 = (2 + growth t) cos t, x2 = 0.5 sin t.
    fn motion(growth: f64) -> Motion {
        let sample = |n: u32| {
            let time = 0.04 * f64::from(n);
            let ((s, c), a) = (time.sin_cos(), 2.0 + growth * time);
            Sample {
                time,
                state: State::two_mass([a * c, 0.5 * s, growth * c - a * s, 0.5 * c, 0.0]),
                contacts: vec![ContactState::Stick],
                ledger: EnergyLedger::default(),
            }
        };
        let samples = (0..500).map(sample).collect();
        Motion::new(&Trajectory { samples, events: vec![], outcome: Outcome::Completed }).unwrap()
    }

    #[test]
    fn a_harmonic_motion_has_its_amplitude_at_all_times() {
        let motion = motion(0.0);
        let (first, second) = (Envelope::of_mass(&motion, 0), Envelope::of_mass(&motion, 1));
        // Cubic interpolation over 0.04: 0.04^4/384 of the fourth derivative, 2 at most; the turning time is off by 0.04^3/12 and counts
        // squared.
        for time in [0.0, 5.0, 10.0, 19.9] {
            assert!((first.at(time) - 2.0).abs() < 2e-8 && (second.at(time) - 0.5).abs() < 2e-8);
        }
        assert!((second.start().unwrap() - 0.5 * std::f64::consts::PI).abs() < 1e-5);
        assert_eq!(second.last(1.0), None);
        assert!((second.last(2.0).unwrap() - 0.5).abs() < 2e-8);
    }

    #[test]
    fn an_even_growth_stays_even_and_smooth_across_turning_points() {
        let envelope = Envelope::of_mass(&motion(0.05), 0);
        // tan t = growth / a at a turning point: a is taken by 0.025 earlier or later there, 0.0013 of amplitude, the same everywhere.
        let slope = |time: f64| (envelope.at(time + 1e-4) - envelope.at(time - 1e-4)) / 2e-4;
        // The last stretch, from 15.7 on, ends with slope 0 by definition.
        for n in 0..45 {
            let time = 6.5 + 0.2 * f64::from(n);
            assert!((envelope.at(time) - (2.0 + 0.05 * time)).abs() < 2e-3, "{time}");
            // The distance of turning points from even spacing changes slowly, and with it the slope: 2 % of it.
            assert!((slope(time) - 0.05).abs() < 1e-3, "{time}: {}", slope(time));
        }
    }

    #[test]
    fn the_curve_never_leaves_the_turning_points_it_lies_between() {
        let envelope = Envelope { turns: vec![[0.0, 1.0], [1.0, 1.1], [2.0, 3.0], [3.5, 3.0], [4.0, 0.2], [5.0, 0.3]] };
        for pair in envelope.turns.windows(2) {
            let (low, high) = (pair[0][1].min(pair[1][1]), pair[0][1].max(pair[1][1]));
            for part in 0..=20 {
                let at = envelope.at(pair[0][0] + (pair[1][0] - pair[0][0]) * f64::from(part) / 20.0);
                // Roundings of numbers of size 3.
                assert!((low - 1e-14..=high + 1e-14).contains(&at));
            }
        }
    }
}
