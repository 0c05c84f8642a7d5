//! Displacements over time: the last stretch of both masses.

use super::{Frame, MOST_POINTS, Quantity};
use crate::model::Scales;
use crate::render::{Anchor, OverlayItem, Rectangle};
use crate::stage::motion::{Instant, Motion};
use crate::stage::plot::{Axis, Plot};
use glam::Vec2;

/// Length of the stretch, non-dimensional time units.
const WINDOW: f64 = 60.0;

/// Widths of the lines of masses 1 and 2, and radii of their marks, pixels of a 720 lines high picture.
const WIDTHS: [[f32; 2]; 2] = [[1.5, 4.0], [3.6, 6.5]];

#[derive(Debug, Clone)]
pub(super) struct Series {
    plot: Plot,
    scales: Scales,
}

impl Series {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let s = frame.scales;
        let amplitude = frame.motion.largest(|i| i.positions[0].abs().max(i.positions[1].abs())).max(1.0);
        let axes = [Axis::exactly(0.0, WINDOW.min(frame.motion.end()) * s.time), Axis::symmetric(amplitude * s.length)];
        let plot = frame.plot(place, "Displacements", [Quantity("t", "s"), Quantity("x₁, x₂", "m")], axes);
        Self { plot, scales: s }
    }

    /// The axis moves with time once it is full.
    pub fn draw(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        let s = self.scales;
        let window = self.plot.x.max;
        let end = (now.time * s.time).max(window);
        let plot = Plot { x: self.plot.x.slid_to(end - window, end), ..self.plot.clone() };
        plot.draw_frame(out);
        let from = (end - window) / s.time;
        // Mass 2 below and wider: where both move alike both are seen.
        for (mass, (colour, [width, ring])) in plot.palette.masses.into_iter().zip(WIDTHS).enumerate().rev() {
            let data =
                motion.between(from, now.time, MOST_POINTS).map(|i| (i.time * s.time, i.positions[mass] * s.length));
            plot.draw_line(data, width, colour, out);
            plot.draw_disc([now.time * s.time, now.positions[mass] * s.length], ring, colour, out);
        }
        draw_legend(&plot, out);
    }
}

fn draw_legend(plot: &Plot, out: &mut Vec<OverlayItem>) {
    let corner = Vec2::new(plot.panel.max.x, plot.panel.min.y);
    for ((shift, colour), text) in [-82.0, -14.0].into_iter().zip(plot.palette.masses).zip(["mass 1", "mass 2"]) {
        out.push(OverlayItem::Text {
            position: corner + Vec2::new(shift, 19.0) * plot.scale,
            anchor: Anchor::Right,
            size: 12.0 * plot.scale,
            colour,
            bold: true,
            text: text.to_owned(),
        });
    }
}
