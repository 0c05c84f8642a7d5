//! Energy ledger of the last period: what self-excitation put in, what damping and friction took out, what is stored more than a
//! period before, and what is left over, which an exact solution leaves at zero.
//!
//! ```text
//! W_self_excitation + W_drive + W_damping + W_friction + residual = change of the stored energy
//! ```

use super::Frame;
use crate::model::{EnergyLedger, Scales};
use crate::render::{Anchor, Colour, OverlayItem, Rectangle, Stroke};
use crate::stage::motion::{Instant, Motion};
use crate::stage::numbers;
use crate::stage::palette::Palette;
use glam::Vec2;
use std::f64::consts::TAU;

/// A period of the sticking in-phase mode, non-dimensional.
const PERIOD: f64 = TAU;
/// Instants looked at for the largest bar.
const LOOKED_AT: u32 = 400;
/// Left ends of labels and bars and right end of the numbers, and first row, pixels of a 720 lines high picture.
const LABEL: f32 = 12.0;
const BARS: f32 = 92.0;
const NUMBERS: f32 = 72.0;
const FIRST_ROW: f32 = 46.0;

/// One row of the ledger.
#[derive(Debug, Clone, PartialEq)]
struct Entry {
    label: &'static str,
    colour: Colour,
    value: f64,
    /// Numbers that may be tiny are written with their power of ten.
    is_tiny: bool,
}

#[derive(Debug, Clone)]
pub(super) struct Energy {
    place: Rectangle,
    scale: f32,
    palette: Palette,
    scales: Scales,
    is_driven: bool,
    /// Non-dimensional energy of the longest bar.
    largest: f64,
}

/// Change of a ledger over the last period, or since the start.
fn change(motion: &Motion, now: &Instant) -> EnergyLedger {
    let before = motion.at((now.time - PERIOD).max(0.0)).ledger;
    let mut change = now.ledger;
    change.stored_at_start = before.stored;
    change.works.damping -= before.works.damping;
    change.works.self_excitation -= before.works.self_excitation;
    change.works.circulatory -= before.works.circulatory;
    change.works.friction -= before.works.friction;
    change.works.drive -= before.works.drive;
    change
}

impl Energy {
    pub fn new(frame: &Frame<'_>, place: Rectangle, is_driven: bool) -> Self {
        let Frame { motion, scales, scale, palette } = *frame;
        let mut panel = Self { place, scale, palette, scales, is_driven, largest: 0.0 };
        let times = (0..=LOOKED_AT).map(|n| motion.end() * f64::from(n) / f64::from(LOOKED_AT));
        let largest = times.flat_map(|time| panel.entries(motion, &motion.at(time))).map(|entry| entry.value.abs());
        panel.largest = largest.fold(1e-9, f64::max);
        panel
    }

    fn entries(&self, motion: &Motion, now: &Instant) -> Vec<Entry> {
        let ledger = change(motion, now);
        let (works, palette) = (ledger.works, &self.palette);
        let entry = |label, colour, value| Entry { label, colour, value, is_tiny: false };
        let drive = self.is_driven.then(|| entry("drive", palette.stick, works.drive));
        let works = [
            entry("excitation", palette.excitation, works.self_excitation),
            entry("damping", palette.damping, works.damping),
            entry("friction", palette.slip, works.friction),
            entry("stored", palette.masses[0], ledger.stored - ledger.stored_at_start),
            Entry { is_tiny: true, ..entry("residual", palette.text, ledger.residual()) },
        ];
        drive.into_iter().chain(works).collect()
    }

    pub fn draw(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        let (s, palette) = (self.scale, &self.palette);
        out.push(OverlayItem::Box {
            area: self.place,
            corner_radius: 8.0 * s,
            fill: palette.panel,
            stroke: Some(Stroke { width: s, colour: palette.panel_edge }),
        });
        let unit = if self.scales == Scales::UNITY { "" } else { " [J]" };
        let title = format!("Energy in the last period{unit}");
        let text = |position, anchor, size: f32, colour, bold, text| OverlayItem::Text {
            position,
            anchor,
            size: size * s,
            colour,
            bold,
            text,
        };
        out.push(text(self.place.min + Vec2::new(LABEL, 19.0) * s, Anchor::Left, 13.0, palette.text, true, title));
        let entries = self.entries(motion, now);
        let row = (self.place.max.y - self.place.min.y - (FIRST_ROW - 4.0) * s) / entries.len() as f32;
        let (left, right) = (self.place.min.x + BARS * s, self.place.max.x - NUMBERS * s);
        let zero = 0.5 * (left + right);
        let foot = self.place.max.y - 10.0 * s;
        out.push(OverlayItem::Line {
            points: vec![Vec2::new(zero, self.place.min.y + 32.0 * s), Vec2::new(zero, foot)],
            stroke: Stroke { width: s, colour: palette.zero_line },
            clip: None,
        });
        for (number, entry) in entries.into_iter().enumerate() {
            let middle = self.place.min.y + FIRST_ROW * s + row * number as f32;
            let end = zero + 0.5 * (right - left) * (entry.value / self.largest).clamp(-1.0, 1.0) as f32;
            let half = (0.28 * row).min(9.0 * s);
            out.push(OverlayItem::Box {
                area: Rectangle {
                    min: Vec2::new(zero.min(end), middle - half),
                    max: Vec2::new(zero.max(end), middle + half),
                },
                corner_radius: 0.0,
                fill: entry.colour,
                stroke: None,
            });
            let baseline = middle + 4.0 * s;
            let label = Vec2::new(self.place.min.x + LABEL * s, baseline);
            out.push(text(label, Anchor::Left, 12.0, palette.text, false, entry.label.to_owned()));
            let value = entry.value * self.scales.energy;
            let number = written(value, entry.is_tiny || self.scales != Scales::UNITY);
            let place = Vec2::new(self.place.max.x - LABEL * s, baseline);
            out.push(text(place, Anchor::Right, 12.0, palette.faint_text, false, number));
        }
    }
}

/// With its sign; three digits after the point, or two and the power of ten.
fn written(value: f64, with_power: bool) -> String {
    if with_power {
        let sign = if value > 0.0 { "+" } else { "" };
        return format!("{sign}{}", numbers::with_power(value));
    }
    let text = format!("{value:+.3}");
    // A sign before nothing says nothing.
    if text == "-0.000" || text == "+0.000" {
        return "0.000".to_owned();
    }
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energies_are_written_with_their_sign() {
        assert_eq!(written(0.12345, false), "+0.123");
        assert_eq!(written(-2.0, false), "−2.000");
        assert_eq!(written(-0.0001, false), "0.000");
        assert_eq!(written(-2.34e-6, true), "−2.3·10⁻⁶");
        assert_eq!(written(2.34e-6, true), "+2.3·10⁻⁶");
    }
}
