//! Energy ledger of the last period of all blades: what the air put in (negative damping, and the antisymmetric stiffness, which feeds one
//! direction of travel), what damping and friction took out, what is stored more than a period before, and what is left over.

use super::Frame;
use crate::render::{Anchor, OverlayItem, Rectangle};
use crate::stage::disk::motion::{DiskInstant, DiskMotion};
use crate::stage::numbers;
use crate::stage::panels::bars::{Bar, Bars, written};
use crate::stage::panels::energy::change;
use glam::Vec2;
use std::f64::consts::TAU;

/// Instants looked at for the largest bar.
const LOOKED_AT: u32 = 300;
/// The scale follows the longest bar, so that what balances what is seen at small amplitudes too, down to this part of the film's longest.
const LEAST: f64 = 0.01;

#[derive(Debug, Clone)]
pub(super) struct Ledger {
    bars: Bars,
    period: f64,
}

impl Ledger {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let Frame { motion, scale, palette, .. } = *frame;
        let title = "Energy per period".to_owned();
        let period = TAU / motion.angular_frequency();
        let mut panel = Self { bars: Bars { place, scale, palette, title, largest: 0.0 }, period };
        let times = (0..=LOOKED_AT).map(|n| motion.end() * f64::from(n) / f64::from(LOOKED_AT));
        let largest = times.flat_map(|time| panel.entries(motion, &motion.at(time))).map(|bar| bar.value.abs());
        panel.bars.largest = largest.fold(1e-9, f64::max);
        panel
    }

    fn entries(&self, motion: &DiskMotion, now: &DiskInstant) -> Vec<Bar> {
        let ledger = change(&motion.at((now.time - self.period).max(0.0)).ledger, &now.ledger);
        let (works, palette) = (ledger.works, &self.bars.palette);
        let bar = |label, colour, value, is_tiny: bool| Bar { label, colour, value, number: written(value, is_tiny) };
        vec![
            bar("air, damping", palette.excitation, works.self_excitation, false),
            bar("air, stiffness", palette.excitation, works.circulatory, false),
            bar("damping", palette.damping, works.damping, false),
            bar("friction", palette.slip, works.friction, false),
            bar("stored", palette.masses[0], ledger.stored - ledger.stored_at_start, false),
            bar("residual", palette.text, ledger.residual(), true),
        ]
    }

    pub fn draw(&self, motion: &DiskMotion, now: &DiskInstant, out: &mut Vec<OverlayItem>) {
        let entries = self.entries(motion, now);
        let longest = entries.iter().map(|bar| bar.value.abs()).fold(LEAST * self.bars.largest, f64::max);
        let bars = Bars { largest: longest, ..self.bars.clone() };
        bars.draw(entries, out);
        out.push(OverlayItem::Text {
            position: Vec2::new(bars.place.max.x - 12.0 * bars.scale, bars.place.min.y + 19.0 * bars.scale),
            anchor: Anchor::Right,
            size: 11.0 * bars.scale,
            colour: bars.palette.faint_text,
            bold: false,
            text: format!("full bar: {}", significant(longest)),
        });
    }
}

/// Two significant digits.
fn significant(value: f64) -> String {
    if value < 0.01 {
        return numbers::with_power(value);
    }
    let digits = (1.0 - value.log10().floor()).max(0.0) as usize;
    format!("{value:.digits$}")
}
