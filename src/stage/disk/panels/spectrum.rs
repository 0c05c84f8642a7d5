//! Spectrum by nodal diameter: a bar for every wave, backward ones left of 0 and forward ones right of it; of a chain one for every mode.
//! Means over the last period, as of the strongest waves: neither bars nor the name of the highest one flicker.

use super::waves::means;
use super::{Frame, WaveNames, draw_legend, strongest};
use crate::model::{Spectrum, Topology};
use crate::render::{Anchor, OverlayItem, Rectangle, Stroke};
use crate::stage::disk::motion::{DiskInstant, DiskMotion};
use crate::stage::plot::{Axis, Plot};
use glam::Vec2;
use std::f64::consts::TAU;

/// Instants looked at for the largest bar.
const LOOKED_AT: u32 = 300;
/// Periods over which the highest bar is found.
const PERIODS: u32 = 6;
/// Part of the distance of two bars that a bar fills.
const WIDE: f64 = 0.72;

#[derive(Debug, Clone)]
pub(super) struct Bars {
    plot: Plot,
    names: WaveNames,
    spectrum: Spectrum,
    period: f64,
}

impl Bars {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let (motion, names, spectrum) = (frame.motion, frame.waves(), frame.spectrum());
        let times = (0..=LOOKED_AT).map(|n| motion.end() * f64::from(n) / f64::from(LOOKED_AT));
        let largest = times
            .map(|time| motion.at(time))
            .flat_map(|now| spectrum.amplitudes(&now.positions, &now.velocities))
            .fold(1e-9, f64::max);
        let [first, last] = names.range();
        let axes = [Axis::exactly(first as f64 - 0.6, last as f64 + 0.6), Axis::exactly(0.0, 1.18 * largest)];
        let (title, label) = match frame.disk.topology {
            Topology::Ring => ("Waves by nodal diameter", "n"),
            Topology::Chain => ("Standing modes of the chain", "mode"),
        };
        let plot = frame.plot(place, title, [label, "amplitude, mean of a period"], axes);
        let x = Axis { tick: plot.x.tick.max(1.0).round(), ..plot.x };
        Self { plot: Plot { x, ..plot }, names, spectrum, period: TAU / motion.angular_frequency() }
    }

    pub fn draw(&self, motion: &DiskMotion, now: &DiskInstant, out: &mut Vec<OverlayItem>) {
        let (plot, names) = (&self.plot, &self.names);
        plot.draw_frame(out);
        let amplitudes = means(motion, &self.spectrum, now.time, self.period);
        let highest = self.highest(motion, now.time);
        for (index, &amplitude) in amplitudes.iter().enumerate() {
            let middle = names.number(index) as f64;
            let stroke = Stroke { width: 1.6 * plot.scale, colour: plot.palette.text };
            out.push(OverlayItem::Box {
                area: Rectangle {
                    min: plot.pixel(middle - 0.5 * WIDE, amplitude.min(plot.y.max)),
                    max: plot.pixel(middle + 0.5 * WIDE, 0.0),
                },
                corner_radius: 0.0,
                fill: names.colour(index),
                stroke: (index == highest).then_some(stroke),
            });
        }
        self.draw_words(highest, amplitudes[highest], out);
    }

    /// The wave that was strongest over the last periods: where two are equally strong its name does not change from frame to frame.
    fn highest(&self, motion: &DiskMotion, time: f64) -> usize {
        let mut sum = vec![0.0; motion.blades()];
        for before in 0..PERIODS {
            let amplitudes = means(motion, &self.spectrum, time - self.period * f64::from(before), self.period);
            sum.iter_mut().zip(amplitudes).for_each(|(sum, a)| *sum += a);
        }
        strongest(&sum)
    }

    fn draw_words(&self, highest: usize, amplitude: f64, out: &mut Vec<OverlayItem>) {
        let (plot, names) = (&self.plot, &self.names);
        out.push(OverlayItem::Text {
            position: Vec2::new(plot.area().max.x, plot.area().min.y + 13.0 * plot.scale),
            anchor: Anchor::Right,
            size: 12.0 * plot.scale,
            colour: names.colour(highest),
            bold: true,
            text: format!("{}: {amplitude:.3}", names.name(highest)),
        });
        if names.topology == Topology::Ring {
            let palette = plot.palette;
            let words = [("forward", palette.masses[0]), ("backward", palette.excitation)];
            draw_legend(plot, words.map(|(word, colour)| (word.to_owned(), colour)), out);
        }
    }
}
