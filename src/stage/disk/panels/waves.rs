//! Amplitudes of the strongest waves over the whole film, growing with time: means over the last period, so that what slip does within a
//! period does not blur them.

use super::{Frame, MOST_POINTS, WaveNames, draw_legend};
use crate::model::Spectrum;
use crate::render::{Anchor, Colour, OverlayItem, Rectangle};
use crate::stage::disk::motion::{DiskInstant, DiskMotion};
use crate::stage::plot::{Axis, Plot};
use glam::Vec2;
use std::f64::consts::TAU;

/// How clearly the waves shown are drawn, the strongest first.
const CLARITY: [f32; 4] = [1.0, 0.85, 0.72, 0.6];
/// Waves that stay below this part of the strongest one's largest amplitude are left out: a line on the axis says nothing.
const VISIBLE: f64 = 0.03;
/// Instants of a period that a mean is taken over.
const INSTANTS: u32 = 8;

#[derive(Debug, Clone)]
pub(super) struct Waves {
    plot: Plot,
    names: WaveNames,
    spectrum: Spectrum,
    period: f64,
    /// Indices of the waves with the largest amplitudes, the largest first.
    shown: Vec<usize>,
    /// Time and the amplitudes of those waves.
    points: Vec<(f64, Vec<f64>)>,
}

/// Mean amplitudes of all waves over the period before `time`, or since the start.
pub(super) fn means(motion: &DiskMotion, spectrum: &Spectrum, time: f64, period: f64) -> Vec<f64> {
    let mut sum = vec![0.0; motion.blades()];
    for n in 0..INSTANTS {
        let now = motion.at((time - period * f64::from(n) / f64::from(INSTANTS)).max(0.0));
        let amplitudes = spectrum.amplitudes(&now.positions, &now.velocities);
        sum.iter_mut().zip(amplitudes).for_each(|(sum, a)| *sum += a / f64::from(INSTANTS));
    }
    sum
}

impl Waves {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let (motion, names, spectrum) = (frame.motion, frame.waves(), frame.spectrum());
        let period = TAU / motion.angular_frequency();
        let all: Vec<(f64, Vec<f64>)> = (0..=MOST_POINTS)
            .map(|n| motion.end() * n as f64 / MOST_POINTS as f64)
            .map(|time| (time, means(motion, &spectrum, time, period)))
            .collect();
        let largest = |index: usize| all.iter().map(|(_, a)| a[index]).fold(0.0, f64::max);
        let mut order: Vec<(usize, f64)> = (0..motion.blades()).map(|index| (index, largest(index))).collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        let top = order.first().map_or(1.0, |first| first.1).max(1e-9);
        let shown: Vec<usize> = order
            .into_iter()
            .take(CLARITY.len())
            .filter(|(_, largest)| *largest >= VISIBLE * top)
            .map(|(index, _)| index)
            .collect();
        let points = all.into_iter().map(|(t, a)| (t, shown.iter().map(|&index| a[index]).collect())).collect();
        let axes = [Axis::exactly(0.0, motion.end()), Axis::exactly(0.0, 1.1 * top)];
        let plot =
            frame.plot(place, &format!("Strongest {}", names.kind()), ["t", "amplitude, mean of a period"], axes);
        Self { plot, names, spectrum, period, shown, points }
    }

    /// In the colours of their directions, the stronger the clearer.
    fn colours(&self) -> impl DoubleEndedIterator<Item = (usize, Colour)> + ExactSizeIterator + '_ {
        self.shown.iter().zip(CLARITY).map(|(&index, clarity)| (index, self.names.colour(index).with_alpha(clarity)))
    }

    pub fn draw(&self, motion: &DiskMotion, now: &DiskInstant, out: &mut Vec<OverlayItem>) {
        let plot = &self.plot;
        plot.draw_frame(out);
        let current = means(motion, &self.spectrum, now.time, self.period);
        let known = self.points.partition_point(|(time, _)| *time <= now.time);
        let place_of = |index: usize| plot.pixel(now.time, current[index]);
        for (place, (index, colour)) in self.colours().enumerate().rev() {
            let past = self.points[..known].iter().map(|(time, a)| (*time, a[place]));
            plot.draw_line(past.chain([(now.time, current[index])]), 1.8, colour, out);
            plot.draw_marker(now.time, current[index], colour, out);
        }
        let places: Vec<(usize, Vec2)> = self.shown.iter().map(|&index| (index, place_of(index))).collect();
        self.draw_names(places, out);
        draw_legend(plot, self.colours().map(|(index, colour)| (self.short_name(index), colour)), out);
    }

    /// The names of waves beside their marks, one above the other where these lie close together.
    fn draw_names(&self, mut places: Vec<(usize, Vec2)>, out: &mut Vec<OverlayItem>) {
        let (plot, s) = (&self.plot, self.plot.scale);
        // From the lowest mark upwards.
        places.sort_by(|a, b| b.1.y.total_cmp(&a.1.y));
        let mut room_above = plot.area().max.y;
        for (index, pixel) in places {
            // At the side of the mark that has room; where it has to stand over the line, above it.
            let has_room = pixel.x < plot.area().max.x - 34.0 * s;
            let (side, above, anchor) = if has_room { (9.0, 4.0, Anchor::Left) } else { (-7.0, -8.0, Anchor::Right) };
            let y = (pixel.y + above * s).min(room_above);
            room_above = y - 13.0 * s;
            out.push(OverlayItem::Text {
                position: Vec2::new(pixel.x + side * s, y),
                anchor,
                size: 12.0 * s,
                colour: plot.palette.text,
                bold: true,
                text: self.short_name(index),
            });
        }
    }

    /// The number alone.
    fn short_name(&self, index: usize) -> String {
        let name = self.names.name(index);
        name.rsplit(' ').next().unwrap_or_default().to_owned()
    }
}
