//! The three live plots: time series, hysteresis loop, phase plane.

use super::motion::{Instant, Motion};
use super::palette;
use super::plot::{Axis, Plot};
use crate::model::Scales;
use crate::render::{Anchor, Colour, OverlayItem, Rectangle};
use glam::Vec2;

/// Length of the time series on show, and of the bright part of the trails, non-dimensional time units.
const WINDOW: f64 = 60.0;
const TRAIL: f64 = 14.0;
/// Points of one line: more than pixels across a panel.
const MOST_POINTS: usize = 700;
/// Pieces of a fading trail.
const FADES: u32 = 10;

/// The plots of one film: their places and axes are the same in every frame.
#[derive(Debug, Clone)]
pub struct Panels {
    series: Plot,
    loops: Plot,
    phase: Plot,
    scales: Scales,
}

/// `name` alone, or with its unit where the scene is in SI.
fn label(name: &str, unit: &str, scales: &Scales) -> String {
    if *scales == Scales::UNITY { name.to_owned() } else { format!("{name} [{unit}]") }
}

impl Panels {
    /// Plots in a column of three, in the given part of a picture.
    #[must_use]
    pub fn new(motion: &Motion, scales: Scales, column: Rectangle, scale: f32) -> Self {
        let amplitude = motion.largest(|i| i.positions[0]).max(motion.largest(|i| i.positions[1])).max(1.0);
        let first = motion.largest(|i| i.positions[0]).max(1.0);
        let speed = motion.largest(|i| i.velocities[0]).max(1.0);
        let gap = 10.0 * scale;
        let height = (column.max.y - column.min.y - 2.0 * gap) / 3.0;
        let place = |row: f32| {
            let top = column.min.y + row * (height + gap);
            Rectangle { min: Vec2::new(column.min.x, top), max: Vec2::new(column.max.x, top + height) }
        };
        let plot =
            |row, title, x_label, y_label, x, y| Plot { panel: place(row), scale, title, x_label, y_label, x, y };
        let position = Axis::symmetric(first * scales.length);
        let window = WINDOW.min(motion.end()) * scales.time;
        Self {
            series: plot(
                0.0,
                "Displacements",
                label("t", "s", &scales),
                label("x₁, x₂", "m", &scales),
                Axis::exactly(0.0, window),
                Axis::symmetric(amplitude * scales.length),
            ),
            loops: plot(
                1.0,
                "Hysteresis of the Jenkins element",
                label("x₁", "m", &scales),
                label("f", "N", &scales),
                position,
                Axis::symmetric(scales.slip_force),
            ),
            phase: plot(
                2.0,
                "Phase plane of mass 1",
                label("x₁", "m", &scales),
                label("v₁", "m/s", &scales),
                position,
                Axis::symmetric(speed * scales.velocity),
            ),
            scales,
        }
    }

    /// All plots as they stand at `now`.
    pub fn draw(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        self.draw_series(motion, now, out);
        let s = self.scales;
        let contact = super::contact_colour(now.contact);
        let loops = |i: &Instant| (i.positions[0] * s.length, i.slider_force * s.slip_force);
        draw_trail(&self.loops, motion, now, contact, loops, out);
        let phase = |i: &Instant| (i.positions[0] * s.length, i.velocities[0] * s.velocity);
        draw_trail(&self.phase, motion, now, palette::FIRST, phase, out);
    }

    /// The last `WINDOW` of both displacements; the axis moves with time once it is full.
    fn draw_series(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        let s = self.scales;
        let window = self.series.x.max;
        let end = (now.time * s.time).max(window);
        let plot = Plot { x: Axis::exactly(end - window, end), ..self.series.clone() };
        plot.draw_frame(out);
        let from = (end - window) / s.time;
        for (mass, colour) in [(1, palette::SECOND), (0, palette::FIRST)] {
            let data =
                motion.between(from, now.time, MOST_POINTS).map(|i| (i.time * s.time, i.positions[mass] * s.length));
            plot.draw_line(data, 1.6, colour, out);
            plot.draw_marker(now.time * s.time, now.positions[mass] * s.length, colour, out);
        }
        self.draw_legend(&plot, out);
    }

    fn draw_legend(&self, plot: &Plot, out: &mut Vec<OverlayItem>) {
        let right = plot.panel.max + Vec2::new(-14.0, 0.0) * plot.scale;
        for (place, colour, text) in [(-96.0, palette::FIRST, "mass 1"), (-28.0, palette::SECOND, "mass 2")] {
            out.push(OverlayItem::Text {
                position: Vec2::new(right.x + (place + 28.0) * plot.scale, plot.panel.min.y + 19.0 * plot.scale),
                anchor: Anchor::Right,
                size: 12.0 * plot.scale,
                colour,
                bold: true,
                text: text.to_owned(),
            });
        }
    }
}

/// Everything so far, faintly, and the last stretch fading into it.
fn draw_trail(
    plot: &Plot,
    motion: &Motion,
    now: &Instant,
    colour: Colour,
    data: impl Fn(&Instant) -> (f64, f64) + Copy,
    out: &mut Vec<OverlayItem>,
) {
    plot.draw_frame(out);
    let past = motion.between((now.time - 8.0 * TRAIL).max(0.0), now.time, 3 * MOST_POINTS).map(|i| data(&i));
    plot.draw_line(past, 1.0, palette::FIRST.with_alpha(0.22), out);
    for piece in 0..FADES {
        let part = |n: u32| now.time - TRAIL * (1.0 - f64::from(n) / f64::from(FADES));
        if part(piece + 1) > 0.0 {
            let recent = motion.between(part(piece).max(0.0), part(piece + 1), MOST_POINTS).map(|i| data(&i));
            let fresh = (piece + 1) as f32 / FADES as f32;
            plot.draw_line(recent, 1.8, palette::FIRST.with_alpha(0.15 + 0.85 * fresh), out);
        }
    }
    let (x, y) = data(now);
    plot.draw_marker(x, y, colour, out);
}
