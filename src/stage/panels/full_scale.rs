//! Full scale of live bars: the largest bar of the film so far, forgotten slowly,
//!
//! ```text
//! F(t) = max over s <= t of |bar|(s) exp(-(t - s) / MEMORY)
//! ```
//!
//! so that bars are seen in small motion and in large, and shrink and grow with the motion over a beat all the same.

use std::f64::consts::TAU;

/// Time in which a past bar falls to 1/e, non-dimensional: a little longer than a beat of the slow amplitudes.
const MEMORY: f64 = 100.0;
/// The smallest scale, as a part of the largest: before anything happened there is nothing to scale with.
const LEAST: f64 = 0.01;
/// Distance of instants looked at, and the most of them.
const STEP: f64 = TAU / 16.0;
const MOST: f64 = 4000.0;

/// Full scale over the time of a film.
#[derive(Debug, Clone, Default)]
pub struct FullScale {
    step: f64,
    values: Vec<f64>,
}

impl FullScale {
    /// `largest` is the largest absolute value of a bar at a time from 0 to `end`.
    pub fn new(end: f64, largest: impl Fn(f64) -> f64) -> Self {
        let step = STEP.max(end / MOST);
        let kept = (-step / MEMORY).exp();
        let bars: Vec<f64> =
            (0..=(end / step).ceil() as u32).map(|n| largest((f64::from(n) * step).min(end))).collect();
        let floor = LEAST * bars.iter().copied().fold(0.0, f64::max);
        let values = bars.into_iter().scan(floor, |scale, bar| {
            *scale = bar.max(kept * *scale).max(floor);
            Some(*scale)
        });
        Self { step, values: values.collect() }
    }

    /// Full scale at a time, never 0; 1 where there is nothing to see.
    pub fn at(&self, time: f64) -> f64 {
        let place = (time / self.step).max(0.0);
        let index = place as usize;
        let value = |i: usize| self.values.get(i).or(self.values.last()).copied().unwrap_or(0.0);
        let between = value(index) + (place - index as f64) * (value(index + 1) - value(index));
        if between > 0.0 { between } else { 1.0 }
    }
}

/// A round value (1, 2, 5 times a power of ten) that a scale is marked with, and how far its line and its number are faded in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    pub value: f64,
    pub line: f32,
    pub number: f32,
}

/// The marks of a scale: one that leaves at the end is fainter before, as is one that comes too near to zero. The number stands at the
/// largest that is well inside; it changes its place only where it is not seen.
pub fn marks(full: f64) -> Vec<Mark> {
    let decade = full.log10().floor() as i32;
    let values = (decade - 1..=decade + 1).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| times_ten_to(digit, power)));
    let values: Vec<f64> = values.collect();
    let ramp = |part: f64, [from, to]: [f64; 2]| ((part - from) / (to - from)).clamp(0.0, 1.0) as f32;
    let inside = |value: f64| ramp(value / full, [0.95, 0.85]);
    let mark = |pair: &[f64]| {
        let part = pair[0] / full;
        let line = ramp(part, [1.0, 0.9]).min(ramp(part, [0.3, 0.4]));
        let number = (2.0 * inside(pair[0]) - 1.0).max(0.0) * (1.0 - 2.0 * inside(pair[1])).max(0.0);
        Mark { value: pair[0], line, number }
    };
    values.windows(2).map(mark).filter(|mark| mark.line > 0.0).collect()
}

/// Rounded once, so that it is written with one digit.
fn times_ten_to(digit: f64, power: i32) -> f64 {
    if power < 0 { digit / 10f64.powi(-power) } else { digit * 10f64.powi(power) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_follows_a_growing_bar_at_once_and_a_vanished_one_slowly() {
        let growing = FullScale::new(200.0, |t| 0.01 * t);
        // Linear between the instants looked at.
        assert!((growing.at(150.0) - 1.5).abs() < 1e-12);
        let vanished = FullScale::new(200.0, |t| if t < 50.0 { 3.0 } else { 0.0 });
        assert_eq!(vanished.at(20.0), 3.0);
        // Forgotten from the last instant before 50 on, at most a step earlier; MEMORY later it is 1/e.
        let expected = 3.0 * (-1.0_f64).exp();
        assert!((vanished.at(150.0) / expected - 1.0).abs() < STEP / MEMORY);
        assert_eq!(FullScale::new(10.0, |_| 0.0).at(3.0), 1.0);
    }

    #[test]
    fn a_scale_has_one_or_two_marks_one_number_at_most_and_none_appears_at_once() {
        assert_eq!(marks(2.5).iter().map(|mark| mark.value).collect::<Vec<_>>(), [1.0, 2.0]);
        let fulls = (0..4000).map(|n| 0.003 * (0.0025 * f64::from(n)).exp());
        let mut last: Vec<Mark> = vec![];
        for full in fulls {
            let now = marks(full);
            assert!((1..=2).contains(&now.len()) && now.iter().any(|mark| mark.line > 0.3), "{full}: {now:?}");
            assert!(now.iter().filter(|mark| mark.number > 0.0).count() <= 1, "{full}: {now:?}");
            for mark in &now {
                let before = last.iter().find(|other| other.value == mark.value);
                let [line, number] = before.map_or([0.0; 2], |mark| [mark.line, mark.number]);
                // The scale grows by 0.25 % from step to step, a line by ten times as much, a number by twice that.
                let jumps = (mark.line - line).abs() > 0.03 || (mark.number - number).abs() > 0.06;
                assert!(last.is_empty() || !jumps, "{full}: {mark:?}");
            }
            last = now;
        }
    }
}
