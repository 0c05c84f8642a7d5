//! The live panels. Each says what it shows in the units of the scene, and shows nothing that is still to come.

mod amplitudes;
pub(super) mod bars;
pub(super) mod energy;
pub(super) mod full_scale;
mod map;
mod planes;
mod series;

pub use map::DampingMap;

use super::motion::{Instant, Motion};
use super::palette::Palette;
use super::plot::{Axis, Plot, RIGHT};
use crate::model::Scales;
use crate::render::{OverlayItem, Rectangle};
use crate::scene::{Case, Panel};
use amplitudes::Amplitudes;
use energy::{Energy, Rows};
use map::Map;
use planes::{Hysteresis, PhasePlane};
use series::Series;

/// Points of one line: more than pixels across a panel.
const MOST_POINTS: usize = 700;
/// Plots narrower than this have few ticks, pixels of a 720 lines high picture.
const SMALL: f32 = 340.0;
/// Steps of a fading trail.
const FADES: u32 = 8;
/// Length of the bright part of a trail, non-dimensional time units.
const TRAIL: f64 = 14.0;

/// The panels of one film: their places and axes are the same in every frame.
#[derive(Debug, Clone)]
pub struct Panels {
    drawn: Vec<Drawn>,
}

#[derive(Debug, Clone)]
enum Drawn {
    Series(Series),
    Hysteresis(Hysteresis),
    Phase(PhasePlane),
    Amplitudes(Amplitudes),
    Energy(Energy),
    Map(Map),
}

/// What all panels are made with.
#[derive(Debug, Clone, Copy)]
struct Frame<'a> {
    motion: &'a Motion,
    scales: Scales,
    scale: f32,
    palette: Palette,
}

impl Frame<'_> {
    /// Axes are quantities with their SI units, which are shown where the scene is in SI.
    fn plot(&self, panel: Rectangle, title: &str, quantities: [Quantity; 2], axes: [Axis; 2]) -> Plot {
        let is_small = panel.max.x - panel.min.x < SMALL * self.scale;
        let axes = axes.map(|axis| if is_small { axis.sparse() } else { axis });
        let [(x_label, x), (y_label, y)] = [0, 1].map(|i| self.labelled(quantities[i], axes[i]));
        Plot {
            panel,
            scale: self.scale,
            palette: self.palette,
            title: title.to_owned(),
            x_label,
            y_label,
            x,
            y,
            right: RIGHT,
        }
    }

    /// Name and unit of an axis; its numbers are written in a multiple of the unit that keeps them short.
    fn labelled(&self, Quantity(name, unit): Quantity, axis: Axis) -> (String, Axis) {
        if self.scales == Scales::UNITY || unit.is_empty() {
            return (name.to_owned(), axis);
        }
        let (prefix, multiple) = prefix(axis.min.abs().max(axis.max.abs()));
        (format!("{name} [{prefix}{unit}]"), Axis { multiple, ..axis })
    }
}

/// Name of a quantity, and its SI unit; none for a pure number.
#[derive(Debug, Clone, Copy)]
struct Quantity(&'static str, &'static str);

/// SI prefix and its factor for an axis that reaches to `largest`.
fn prefix(largest: f64) -> (&'static str, f64) {
    const PREFIXES: [(&str, f64); 7] =
        [("G", 1e9), ("M", 1e6), ("k", 1e3), ("", 1.0), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9)];
    let fits = |(_, factor): &&(&str, f64)| largest >= 0.2 * factor;
    PREFIXES.iter().find(fits).copied().unwrap_or(PREFIXES[6])
}

impl Panels {
    /// The panels the case asks for, each in its place.
    #[must_use]
    pub fn new(
        case: &Case,
        motion: &Motion,
        map: Option<&DampingMap>,
        places: &[Rectangle],
        scale: f32,
        palette: Palette,
    ) -> Self {
        let frame = Frame { motion, scales: case.scales, scale, palette };
        let panel = |(&kind, &place): (&Panel, &Rectangle)| match kind {
            Panel::Series => Some(Drawn::Series(Series::new(&frame, place))),
            Panel::Hysteresis => Some(Drawn::Hysteresis(Hysteresis::new(&frame, place))),
            Panel::Phase => Some(Drawn::Phase(PhasePlane::new(&frame, place))),
            Panel::Amplitudes => Some(Drawn::Amplitudes(Amplitudes::new(&frame, place))),
            Panel::Energy => Some(Drawn::Energy(Energy::new(&frame, place, Rows::of(case)))),
            Panel::Map => {
                Some(Drawn::Map(Map::new(&frame, place, map.cloned().unwrap_or_default(), case.excitation())))
            }
            // Of disks: a case about the rig has none.
            Panel::Spectrum | Panel::Carpet => None,
        };
        Self { drawn: case.panels().iter().zip(places).filter_map(panel).collect() }
    }

    /// All panels as they stand at `now`.
    pub fn draw(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        for panel in &self.drawn {
            match panel {
                Drawn::Series(panel) => panel.draw(motion, now, out),
                Drawn::Hysteresis(panel) => panel.draw(motion, now, out),
                Drawn::Phase(panel) => panel.draw(motion, now, out),
                Drawn::Amplitudes(panel) => panel.draw(now, out),
                Drawn::Energy(panel) => panel.draw(motion, now, out),
                Drawn::Map(panel) => panel.draw(now, out),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_an_axis_are_short_in_the_multiple_of_its_unit() {
        let chosen = [4e-10, 8e-4, 0.25, 3.0, 12.0, 1.5e3, 2e12].map(prefix);
        let expected = [("n", 1e-9), ("m", 1e-3), ("", 1.0), ("", 1.0), ("", 1.0), ("k", 1e3), ("G", 1e9)];
        assert_eq!(chosen, expected);
    }
}
