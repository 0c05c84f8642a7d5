//! Amplitudes of the strongest waves over the whole film, growing with time.

use super::{Frame, MOST_POINTS, WaveNames, draw_legend};
use crate::model::Spectrum;
use crate::render::{Colour, OverlayItem, Rectangle};
use crate::stage::disk::motion::DiskInstant;
use crate::stage::plot::{Axis, Plot};

/// Waves shown, and their colours besides the palette's two.
const SHOWN: usize = 4;

#[derive(Debug, Clone)]
pub(super) struct Waves {
    plot: Plot,
    names: WaveNames,
    spectrum: Spectrum,
    angular_frequency: f64,
    /// Indices of the waves with the largest amplitudes, the largest first.
    shown: Vec<usize>,
    /// Time and the amplitudes of those waves.
    points: Vec<(f64, Vec<f64>)>,
}

impl Waves {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let (motion, names, spectrum) = (frame.motion, frame.waves(), frame.spectrum());
        let angular_frequency = motion.angular_frequency();
        let all: Vec<(f64, Vec<f64>)> = (0..=MOST_POINTS)
            .map(|n| motion.at(motion.end() * n as f64 / MOST_POINTS as f64))
            .map(|now| (now.time, spectrum.amplitudes(&now.positions, &now.velocities, angular_frequency)))
            .collect();
        let largest = |index: usize| all.iter().map(|(_, a)| a[index]).fold(0.0, f64::max);
        let mut order: Vec<(usize, f64)> = (0..motion.blades()).map(|index| (index, largest(index))).collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        let top = order.first().map_or(1.0, |first| first.1).max(1e-9);
        let shown: Vec<usize> = order.into_iter().take(SHOWN).map(|(index, _)| index).collect();
        let points = all.into_iter().map(|(t, a)| (t, shown.iter().map(|&index| a[index]).collect())).collect();
        let axes = [Axis::exactly(0.0, motion.end()), Axis::exactly(0.0, 1.1 * top)];
        let plot = frame.plot(place, "Strongest waves", ["t", "amplitude"], axes);
        Self { plot, names, spectrum, angular_frequency, shown, points }
    }

    /// In the palette's data colours, which differ from wave to wave whatever their direction.
    fn colours(&self) -> [Colour; SHOWN] {
        let palette = &self.plot.palette;
        [palette.masses[0], palette.masses[1], palette.excitation, palette.damping]
    }

    pub fn draw(&self, now: &DiskInstant, out: &mut Vec<OverlayItem>) {
        let plot = &self.plot;
        plot.draw_frame(out);
        let current = self.spectrum.amplitudes(&now.positions, &now.velocities, self.angular_frequency);
        let known = self.points.partition_point(|(time, _)| *time <= now.time);
        for (place, (&index, colour)) in self.shown.iter().zip(self.colours()).enumerate().rev() {
            let past = self.points[..known].iter().map(|(time, a)| (*time, a[place]));
            plot.draw_line(past.chain([(now.time, current[index])]), 1.6, colour, out);
            plot.draw_marker(now.time, current[index], colour, out);
        }
        let words = self.shown.iter().zip(self.colours()).map(|(&index, colour)| (self.short_name(index), colour));
        draw_legend(plot, words, out);
    }

    /// The number alone.
    fn short_name(&self, index: usize) -> String {
        let name = self.names.name(index);
        name.rsplit(' ').next().unwrap_or_default().to_owned()
    }
}
