//! The plane of the slow amplitudes: a limit cycle is a point in it, a torus a closed loop, chaos a tangle. It runs one period late: the
//! smooth amplitude between two turning points takes the two next ones as well, which follow in about a period.

use super::{FADES, Frame, Quantity};
use crate::model::Scales;
use crate::render::{OverlayItem, Rectangle};
use crate::stage::envelope::Envelope;
use crate::stage::motion::Instant;
use crate::stage::plot::{Axis, Plot};
use std::f64::consts::TAU;

/// A period of the sticking in-phase mode; with slip turning points are a little farther apart.
const DELAY: f64 = TAU;
/// Length of the bright part of the trail, non-dimensional time units: slow amplitudes take some 80 for a round.
const BRIGHT: f64 = 60.0;
/// Distance of points along the trail, and the most points of a film's trail.
const STEP: f64 = 0.4;
const MOST: f64 = 4000.0;

/// Shortest range of an axis, non-dimensional: a limit cycle is a point.
const SHORTEST: f64 = 0.3;

/// From the smallest to the largest amplitude, so that a small loop is seen as well.
fn axis(envelope: &Envelope, length: f64) -> Axis {
    let [least, largest] = envelope.range();
    let half = 0.5 * (largest - least).max(SHORTEST);
    let middle = (0.5 * (least + largest)).max(half);
    Axis::covering((middle - half) * length, (middle + half) * length)
}

#[derive(Debug, Clone)]
pub(super) struct Amplitudes {
    plot: Plot,
    envelopes: [Envelope; 2],
    /// The whole curve: points at `start + n step`.
    curve: Vec<(f64, f64)>,
    start: f64,
    step: f64,
    scales: Scales,
}

impl Amplitudes {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let envelopes = [0, 1].map(|mass| Envelope::of_mass(frame.motion, mass));
        let [x, y] = [0, 1].map(|i| axis(&envelopes[i], frame.scales.length));
        let labels = [Quantity("a₁", "m"), Quantity("a₂", "m")];
        let plot = frame.plot(place, "Slow amplitudes", labels, [x, y]);
        let start = envelopes[0].start().zip(envelopes[1].start()).map_or(f64::INFINITY, |(a, b)| a.max(b));
        let length = (frame.motion.end() - DELAY - start).max(0.0);
        let step = STEP.max(length / MOST);
        let mut panel = Self { plot, envelopes, curve: Vec::new(), start, step, scales: frame.scales };
        panel.curve = (0..=(length / step) as u32).map(|n| panel.point(start + f64::from(n) * step)).collect();
        panel
    }

    fn point(&self, time: f64) -> (f64, f64) {
        let [a1, a2] = [0, 1].map(|i| self.envelopes[i].at(time) * self.scales.length);
        (a1, a2)
    }

    /// The curve from one time to another.
    fn between(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
        let number = |time: f64| ((time - self.start) / self.step).max(0.0);
        let inner = number(from).ceil() as usize..(number(to).ceil() as usize).min(self.curve.len());
        let points = self.curve.get(inner).unwrap_or_default().iter().copied();
        std::iter::once(self.point(from)).chain(points).chain([self.point(to)])
    }

    pub fn draw(&self, now: &Instant, out: &mut Vec<OverlayItem>) {
        self.plot.draw_frame(out);
        let time = now.time - DELAY;
        if time < self.start {
            return;
        }
        let colour = self.plot.palette.masses[0];
        self.plot.draw_line(self.between(self.start, time), 1.2, colour.with_alpha(0.3), out);
        for lines_left in (1..=FADES).rev() {
            let from = (time - BRIGHT * f64::from(lines_left) / f64::from(FADES)).max(self.start);
            self.plot.draw_line(self.between(from, time), 1.8, colour.with_alpha(1.0 / lines_left as f32), out);
        }
        let (x, y) = self.point(time);
        self.plot.draw_marker(x, y, colour, out);
    }
}
