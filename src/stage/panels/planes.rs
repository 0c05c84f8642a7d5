//! Two planes with a fading trail: hysteresis of the Jenkins element, and phase plane of mass 1 with the points of a Poincare section.

use super::{FADES, Frame, MOST_POINTS, TRAIL};
use crate::model::Scales;
use crate::render::{Colour, OverlayItem, Rectangle};
use crate::stage::motion::{Instant, Motion};
use crate::stage::plot::{Axis, Plot};

/// Radius of a point of the section, pixels of a 720 lines high picture.
const POINT: f32 = 2.6;

/// Slider force over the displacement of mass 1.
#[derive(Debug, Clone)]
pub(super) struct Hysteresis {
    plot: Plot,
    scales: Scales,
}

/// Of mass 1, with a margin; at least the slip limit.
fn position_axis(frame: &Frame<'_>) -> Axis {
    Axis::symmetric(frame.motion.largest(|i| i.positions[0]).max(1.0) * frame.scales.length)
}

impl Hysteresis {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let axes = [position_axis(frame), Axis::symmetric(frame.scales.slip_force)];
        let labels = [frame.label("x₁", "m"), frame.label("f", "N")];
        Self { plot: frame.plot(place, "Hysteresis of the Jenkins element", labels, axes), scales: frame.scales }
    }

    pub fn draw(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        let s = self.scales;
        let data = |i: &Instant| (i.positions[0] * s.length, i.slider_force * s.slip_force);
        self.plot.draw_frame(out);
        draw_trail(&self.plot, motion, now, data, out);
        let (x, y) = data(now);
        self.plot.draw_marker(x, y, self.plot.palette.contact(now.contact), out);
    }
}

/// Velocity over displacement of mass 1, and its points where mass 2 passes a maximum.
#[derive(Debug, Clone)]
pub(super) struct PhasePlane {
    plot: Plot,
    scales: Scales,
    /// Time and place of the section's points, in order of time.
    section: Vec<(f64, [f64; 2])>,
}

/// Where v2 falls through zero: by straight lines between samples in time, by the motion's own interpolation in place.
fn section(motion: &Motion) -> Vec<(f64, [f64; 2])> {
    let crossing = |pair: &[Instant]| {
        let (a, b) = (pair[0].velocities[1], pair[1].velocities[1]);
        (a > 0.0 && b <= 0.0).then(|| {
            let time = pair[0].time + (pair[1].time - pair[0].time) * a / (a - b);
            let at = motion.at(time);
            (time, [at.positions[0], at.velocities[0]])
        })
    };
    motion.instants().windows(2).filter_map(crossing).collect()
}

impl PhasePlane {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let s = frame.scales;
        let speed = frame.motion.largest(|i| i.velocities[0]).max(1.0);
        let axes = [position_axis(frame), Axis::symmetric(speed * s.velocity)];
        let labels = [frame.label("x₁", "m"), frame.label("v₁", "m/s")];
        let section = section(frame.motion);
        let title =
            if section.is_empty() { "Phase plane of mass 1" } else { "Phase plane of mass 1, points at v₂ = 0" };
        Self { plot: frame.plot(place, title, labels, axes), scales: s, section }
    }

    pub fn draw(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        let s = self.scales;
        let data = |i: &Instant| (i.positions[0] * s.length, i.velocities[0] * s.velocity);
        self.plot.draw_frame(out);
        draw_trail(&self.plot, motion, now, data, out);
        let colour = self.plot.palette.masses[1];
        for (_, [x, v]) in self.section.iter().take_while(|(time, _)| *time <= now.time) {
            let (x, y) = (x * s.length, v * s.velocity);
            out.push(OverlayItem::Disc {
                centre: self.plot.pixel(x, y),
                radius: POINT * self.plot.scale,
                fill: colour,
                stroke: None,
            });
        }
        let (x, y) = data(now);
        self.plot.draw_marker(x, y, self.plot.palette.masses[0], out);
    }
}

/// The past, faintly, and the last stretch fading into it.
fn draw_trail(
    plot: &Plot,
    motion: &Motion,
    now: &Instant,
    data: impl Fn(&Instant) -> (f64, f64) + Copy,
    out: &mut Vec<OverlayItem>,
) {
    let colour: Colour = plot.palette.masses[0];
    let past = motion.between((now.time - 8.0 * TRAIL).max(0.0), now.time, 3 * MOST_POINTS).map(|i| data(&i));
    plot.draw_line(past, 1.0, colour.with_alpha(0.22), out);
    for piece in 0..FADES {
        let part = |n: u32| now.time - TRAIL * (1.0 - f64::from(n) / f64::from(FADES));
        if part(piece + 1) > 0.0 {
            let recent = motion.between(part(piece).max(0.0), part(piece + 1), MOST_POINTS).map(|i| data(&i));
            let fresh = (piece + 1) as f32 / FADES as f32;
            plot.draw_line(recent, 1.8, colour.with_alpha(0.15 + 0.85 * fresh), out);
        }
    }
}
