//! The plane of the slow amplitudes: a limit cycle is a point in it, a torus a closed loop, chaos a tangle.

use super::Frame;
use crate::model::Scales;
use crate::render::{OverlayItem, Rectangle};
use crate::stage::envelope::Envelope;
use crate::stage::motion::Instant;
use crate::stage::plot::{Axis, Plot};

/// Length of the bright part of the trail, non-dimensional time units: slow amplitudes take some 80 for a round.
const BRIGHT: f64 = 40.0;

#[derive(Debug, Clone)]
pub(super) struct Amplitudes {
    plot: Plot,
    scales: Scales,
    envelopes: [Envelope; 2],
}

impl Amplitudes {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let envelopes = [0, 1].map(|mass| Envelope::of_mass(frame.motion, mass));
        let [x, y] = [0, 1].map(|i| Axis::covering(0.0, envelopes[i].largest().max(0.5) * frame.scales.length));
        let labels = [frame.label("a₁", "m"), frame.label("a₂", "m")];
        Self { plot: frame.plot(place, "Slow amplitudes", labels, [x, y]), scales: frame.scales, envelopes }
    }

    /// The latest time up to `time` at which both amplitudes are known, and the earliest.
    fn known(&self, time: f64) -> Option<[f64; 2]> {
        let [a, b] = [self.envelopes[0].known(time)?, self.envelopes[1].known(time)?];
        let [first, last] = [a[0].max(b[0]), a[1].min(b[1])];
        (first <= last).then_some([first, last])
    }

    fn point(&self, time: f64) -> (f64, f64) {
        let [a1, a2] = [0, 1].map(|i| self.envelopes[i].at(time) * self.scales.length);
        (a1, a2)
    }

    pub fn draw(&self, now: &Instant, out: &mut Vec<OverlayItem>) {
        self.plot.draw_frame(out);
        let Some([first, last]) = self.known(now.time) else { return };
        let corners = |from: f64| {
            let inner = self.envelopes[0].turns(from, last).map(|turn| turn[0]);
            std::iter::once(from).chain(inner).chain([last]).map(|time| self.point(time))
        };
        let colour = self.plot.palette.masses[0];
        self.plot.draw_line(corners(first), 1.2, colour.with_alpha(0.35), out);
        self.plot.draw_line(corners((last - BRIGHT).max(first)), 1.8, colour, out);
        let (x, y) = self.point(last);
        self.plot.draw_marker(x, y, colour, out);
    }
}
