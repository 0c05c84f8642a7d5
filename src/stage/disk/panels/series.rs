//! Deflections over time of three blades: the first two, which show the phase between neighbours, and the one that moves most.

use super::{Frame, MOST_POINTS, draw_legend};
use crate::render::{OverlayItem, Rectangle};
use crate::stage::disk::motion::{DiskInstant, DiskMotion};
use crate::stage::plot::{Axis, Plot};

/// Length of the stretch, non-dimensional time units.
const WINDOW: f64 = 30.0;

#[derive(Debug, Clone)]
pub(super) struct Series {
    plot: Plot,
    blades: Vec<usize>,
}

impl Series {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let motion = frame.motion;
        let largest = |j: usize| motion.instants().iter().map(|i| i.positions[j].abs()).fold(0.0, f64::max);
        let all = 0..motion.blades();
        let reach: Vec<f64> = all.clone().map(largest).collect();
        let most = all.fold(0, |best, j| if reach[j] > reach[best] { j } else { best });
        let first = (0..motion.blades().min(2)).collect::<Vec<usize>>();
        let third = if first.contains(&most) { 2 } else { most };
        let blades: Vec<usize> = first.into_iter().chain([third]).filter(|j| *j < motion.blades()).collect();
        let title = if blades.len() == 3 { "Three blades" } else { "Blades" };
        let plot = frame.plot_until_now(place, title, "deflection x", WINDOW, Axis::symmetric(frame.colours.limit()));
        Self { plot, blades }
    }

    pub fn draw(&self, motion: &DiskMotion, now: &DiskInstant, out: &mut Vec<OverlayItem>) {
        let plot = &self.plot;
        plot.draw_frame(out);
        let palette = plot.palette;
        let colours = [palette.masses[0], palette.masses[1], palette.excitation];
        for (&blade, colour) in self.blades.iter().zip(colours).rev() {
            let past = motion.between(now.time + plot.x.min, now.time, MOST_POINTS);
            let line = past.map(|i| (i.time - now.time, i.positions[blade])).chain([(0.0, now.positions[blade])]);
            plot.draw_line(line, 1.6, colour, out);
            plot.draw_marker(0.0, now.positions[blade], colour, out);
        }
        let words = self.blades.iter().zip(colours).map(|(blade, colour)| (blade.to_string(), colour));
        draw_legend(plot, words.rev(), out);
    }
}
