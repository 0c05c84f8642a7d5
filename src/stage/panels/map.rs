//! Where the scene stands in the amplitude-damping diagram: amplitude of mass 1 over the self-excitation -xi1, with limit cycles, the
//! range of amplitudes of the steady motions, and where they diverge.

use super::{Frame, Quantity};
use crate::model::Scales;
use crate::render::{Anchor, OverlayItem, Rectangle};
use crate::scene::Excitation;
use crate::stage::envelope::Envelope;
use crate::stage::motion::Instant;
use crate::stage::plot::{Axis, Plot};
use glam::Vec2;

/// The diagram, non-dimensional.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DampingMap {
    /// `(xi1, a1)` of limit cycles along their branch, and whether they are stable.
    pub limit_cycles: Vec<(f64, f64, bool)>,
    /// `xi1` and the smallest and largest maximum of x1 of a steady motion.
    pub motions: Vec<(f64, [f64; 2])>,
    /// `xi1` beyond which motions diverge.
    pub divergence: Option<f64>,
}

/// Largest amplitude shown, non-dimensional.
const HIGHEST: f64 = 3.4;
/// Radius of a dot, pixels of a 720 lines high picture.
const DOT: f32 = 1.3;

#[derive(Debug, Clone)]
pub(super) struct Map {
    plot: Plot,
    map: DampingMap,
    scales: Scales,
    xi1: Excitation,
    envelope: Envelope,
}

impl Map {
    pub fn new(frame: &Frame<'_>, place: Rectangle, map: DampingMap, xi1: Excitation) -> Self {
        // The edge of divergence is seen with a little beyond it.
        let edge = map.divergence.map(|edge| -1.15 * edge);
        let values = map.motions.iter().map(|motion| -motion.0).chain(edge);
        let strongest = values.fold(-1.05 * xi1.strongest(), f64::max).max(0.02);
        let axes = [Axis::exactly((-xi1.start).min(0.0), strongest), Axis::exactly(0.0, HIGHEST * frame.scales.length)];
        let labels = [Quantity("−ξ₁", ""), Quantity("a₁", "m")];
        let plot = frame.plot(place, "Amplitude over self-excitation", labels, axes);
        Self { plot, map, scales: frame.scales, xi1, envelope: Envelope::of_mass(frame.motion, 0) }
    }

    pub fn draw(&self, now: &Instant, out: &mut Vec<OverlayItem>) {
        let (plot, palette, length) = (&self.plot, &self.plot.palette, self.scales.length);
        plot.draw_frame(out);
        for &(xi1, amplitudes) in self.map.motions.iter().filter(|(_, [_, largest])| *largest < HIGHEST) {
            let inside = |centre: &Vec2| centre.cmpge(plot.area().min).all() && centre.cmple(plot.area().max).all();
            for centre in amplitudes.map(|amplitude| plot.pixel(-xi1, amplitude * length)).into_iter().filter(inside) {
                out.push(OverlayItem::Disc { centre, radius: DOT * plot.scale, fill: palette.damping, stroke: None });
            }
        }
        // Stable stretches go on to the first unstable point, so that the line has no gap.
        for stable in [true, false] {
            let runs = self.map.limit_cycles.chunk_by(|a, b| a.2 == b.2).scan(None, |last, run| {
                let joined: Vec<_> = last.iter().chain(run).copied().collect();
                *last = run.last().copied();
                Some((run[0].2, joined))
            });
            let colour = if stable { palette.stick } else { palette.excitation };
            for (_, run) in runs.filter(|(kind, _)| *kind == stable) {
                plot.draw_line(run.into_iter().map(|(xi1, a1, _)| (-xi1, a1 * length)), 1.6, colour, out);
            }
        }
        if let Some(edge) = self.map.divergence {
            let ends = [(-edge, plot.y.min), (-edge, plot.y.max)];
            plot.draw_line(ends.into_iter(), 1.2, palette.slip.with_alpha(0.7), out);
        }
        self.draw_here(now, out);
    }

    /// What the lines and dots are: most in the corner that amplitudes near the slip limit leave free.
    fn draw_legend(&self, out: &mut Vec<OverlayItem>) {
        let (plot, palette) = (&self.plot, &self.plot.palette);
        let words = [
            ("stable cycle", palette.stick),
            ("unstable", palette.excitation),
            ("range of motion", palette.faint_text),
        ];
        let corner = [plot.x.min, plot.y.max];
        self.draw_ground(corner, [[2.0, 1.0], [90.0, 39.0]], out);
        for (row, (word, colour)) in words.into_iter().enumerate() {
            let shift = Vec2::new(5.0, 11.0 + 12.0 * row as f32);
            plot.draw_word(corner, shift, Anchor::Left, word, colour, out);
        }
        if let Some(edge) = self.map.divergence {
            let foot = [-edge, plot.y.min];
            self.draw_ground(foot, [[-50.0, -15.0], [-2.0, -2.0]], out);
            plot.draw_word(foot, Vec2::new(-4.0, -5.0), Anchor::Right, "diverges", palette.slip, out);
        }
    }

    /// Ground for words, where the line of the scene's own damping may pass: a box between two corners beside a data point.
    fn draw_ground(&self, [x, y]: [f64; 2], corners: [[f32; 2]; 2], out: &mut Vec<OverlayItem>) {
        let plot = &self.plot;
        let [min, max] = corners.map(|shift| plot.pixel(x, y) + Vec2::from(shift) * plot.scale);
        let fill = plot.palette.panel.with_alpha(0.85);
        out.push(OverlayItem::Box { area: Rectangle { min, max }, corner_radius: 0.0, fill, stroke: None });
    }

    /// The amplitude now, at the last turning point, on a line at the scene's own damping.
    fn draw_here(&self, now: &Instant, out: &mut Vec<OverlayItem>) {
        let (plot, colour) = (&self.plot, self.plot.palette.masses[0]);
        let x = -self.xi1.at(now.time);
        plot.draw_line([(x, plot.y.min), (x, plot.y.max)].into_iter(), 1.2, colour.with_alpha(0.6), out);
        self.draw_legend(out);
        if let Some(amplitude) = self.envelope.last(now.time).map(|amplitude| amplitude * self.scales.length) {
            if amplitude > plot.y.max {
                plot.draw_beyond(x, colour, out);
            } else {
                plot.draw_marker(x, amplitude, colour, out);
            }
        }
    }
}
