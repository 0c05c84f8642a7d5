//! The live panels of a bladed disk. Each shows nothing that is still to come.

mod carpet;
mod contact;
mod ledger;
mod series;
mod spectrum;
mod waves;

use super::colours::DeflectionColours;
use super::motion::{DiskInstant, DiskMotion};
use crate::model::{BladedDisk, NodalDiameter, Spectrum, Topology, TravelDirection};
use crate::render::{Anchor, Colour, OverlayItem, Rectangle};
use crate::scene::{Case, Panel};
use crate::stage::palette::Palette;
use crate::stage::plot::{Axis, Plot, RIGHT};
use carpet::Carpet;
use contact::Contact;
use glam::Vec2;
use ledger::Ledger;
use series::Series;
use spectrum::Bars;
use waves::Waves;

/// Points of one line: more than pixels across a panel.
const MOST_POINTS: usize = 600;
/// Plots narrower than this have few ticks, pixels of a 720 lines high picture.
const SMALL: f32 = 340.0;

/// What all panels are made with.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    pub disk: &'a BladedDisk,
    pub motion: &'a DiskMotion,
    pub colours: DeflectionColours,
    /// How much longer than usual the stretches of time are that panels show, at least 1: fast films would rush through them.
    pub pace: f64,
    pub scale: f32,
    pub palette: Palette,
}

impl Frame<'_> {
    fn plot(&self, panel: Rectangle, title: &str, [x_label, y_label]: [&str; 2], [x, y]: [Axis; 2]) -> Plot {
        let is_small = panel.max.x - panel.min.x < SMALL * self.scale;
        let [x, y] = if is_small { [x.sparse(), y.sparse()] } else { [x, y] };
        let [x_label, y_label] = [x_label, y_label].map(str::to_owned);
        let (scale, palette, title) = (self.scale, self.palette, title.to_owned());
        Plot { panel, scale, palette, title, x_label, y_label, x, y, right: RIGHT }
    }

    /// A plot over the time before now, whose axis stands still: ticks do not come and go while the motion runs through.
    fn plot_until_now(&self, panel: Rectangle, title: &str, y_label: &str, stretch: f64, y: Axis) -> Plot {
        let stretch = (stretch * self.pace).min(self.motion.end());
        self.plot(panel, title, ["now", y_label], [Axis::exactly(-stretch, 0.0), y])
    }

    fn waves(&self) -> WaveNames {
        let (topology, blades) = (self.disk.topology, self.motion.blades());
        WaveNames { topology, blades, palette: self.palette }
    }

    /// Waves of a ring are seen at their own frequencies with stuck contacts, modes of a chain all at that of the motion.
    fn spectrum(&self) -> Spectrum {
        let blades = self.motion.blades();
        let same = || vec![self.motion.angular_frequency(); blades];
        let frequencies = match self.disk.topology {
            Topology::Ring => self.disk.wave_frequencies().unwrap_or_else(|_| same()),
            Topology::Chain => same(),
        };
        Spectrum::new(self.disk.topology, frequencies)
    }
}

/// How waves of a ring and modes of a chain are numbered, named and coloured.
#[derive(Debug, Clone, Copy)]
struct WaveNames {
    topology: Topology,
    blades: usize,
    palette: Palette,
}

impl WaveNames {
    /// The number of the wave at a place of the spectrum: signed nodal diameter, or mode.
    fn number(&self, index: usize) -> i64 {
        match self.topology {
            Topology::Ring => NodalDiameter::new(index as i64, self.blades).signed(),
            Topology::Chain => index as i64,
        }
    }

    /// Smallest and largest number.
    fn range(&self) -> [i64; 2] {
        let count = self.blades as i64;
        match self.topology {
            Topology::Ring => [-(count - 1) / 2, count / 2],
            Topology::Chain => [0, count - 1],
        }
    }

    fn direction(&self, index: usize) -> TravelDirection {
        match self.topology {
            Topology::Ring => NodalDiameter::new(index as i64, self.blades).direction(),
            Topology::Chain => TravelDirection::Standing,
        }
    }

    fn colour(&self, index: usize) -> Colour {
        match (self.topology, self.direction(index)) {
            (Topology::Chain, _) | (_, TravelDirection::Forward) => self.palette.masses[0],
            (_, TravelDirection::Backward) => self.palette.excitation,
            (_, TravelDirection::Standing) => self.palette.damping,
        }
    }

    /// Waves, or modes.
    fn kind(&self) -> &'static str {
        match self.topology {
            Topology::Ring => "waves",
            Topology::Chain => "modes",
        }
    }

    /// `n = +3`, or `mode 3`.
    fn name(&self, index: usize) -> String {
        match (self.topology, self.number(index)) {
            (Topology::Ring, 0) => "n = 0".to_owned(),
            (Topology::Ring, number) => format!("n = {number:+}").replace('-', "−"),
            (Topology::Chain, number) => format!("mode {number}"),
        }
    }
}

/// Index of the largest value.
fn strongest(amplitudes: &[f64]) -> usize {
    (0..amplitudes.len()).fold(0, |best, index| if amplitudes[index] > amplitudes[best] { index } else { best })
}

/// Words in the title line of a plot, right to left from its right end.
fn draw_legend(plot: &Plot, words: impl IntoIterator<Item = (String, Colour)>, out: &mut Vec<OverlayItem>) {
    let size = 12.0 * plot.scale;
    let mut right = plot.panel.max.x - 14.0 * plot.scale;
    for (text, colour) in words {
        let position = Vec2::new(right, plot.panel.min.y + 19.0 * plot.scale);
        right -= crate::render::text_width(&text, size, true) + 12.0 * plot.scale;
        out.push(OverlayItem::Text { position, anchor: Anchor::Right, size, colour, bold: true, text });
    }
}

/// The panels of one film: their places and axes are the same in every frame, but for the bars of the ledger.
#[derive(Debug, Clone)]
pub struct Panels {
    drawn: Vec<Drawn>,
}

#[derive(Debug, Clone)]
enum Drawn {
    Carpet(Carpet),
    Spectrum(Bars),
    Waves(Waves),
    Series(Series),
    Contact(Contact),
    Ledger(Ledger),
}

impl Panels {
    /// The panels the case asks for, each in its place; those of the rig have no place here.
    #[must_use]
    pub fn new(case: &Case, frame: &Frame<'_>, places: &[Rectangle]) -> Self {
        let panel = |(&kind, &place): (&Panel, &Rectangle)| match kind {
            Panel::Carpet => Some(Drawn::Carpet(Carpet::new(frame, place))),
            Panel::Spectrum => Some(Drawn::Spectrum(Bars::new(frame, place))),
            Panel::Amplitudes => Some(Drawn::Waves(Waves::new(frame, place))),
            Panel::Series => Some(Drawn::Series(Series::new(frame, place))),
            Panel::Hysteresis => Some(Drawn::Contact(Contact::new(frame, place))),
            Panel::Energy => Some(Drawn::Ledger(Ledger::new(frame, place))),
            Panel::Phase | Panel::Map => None,
        };
        Self { drawn: case.panels().iter().zip(places).filter_map(panel).collect() }
    }

    /// All panels as they stand at `now`.
    pub fn draw(&self, motion: &DiskMotion, now: &DiskInstant, out: &mut Vec<OverlayItem>) {
        for panel in &self.drawn {
            match panel {
                Drawn::Carpet(panel) => panel.draw(motion, now, out),
                Drawn::Spectrum(panel) => panel.draw(motion, now, out),
                Drawn::Waves(panel) => panel.draw(motion, now, out),
                Drawn::Series(panel) => panel.draw(motion, now, out),
                Drawn::Contact(panel) => panel.draw(motion, now, out),
                Drawn::Ledger(panel) => panel.draw(motion, now, out),
            }
        }
    }
}
