//! Energy ledger of the last period of all blades: what the air put in (negative damping, and the antisymmetric stiffness, which feeds one
//! direction of travel), what damping and friction took out, what is stored more than a period before, and what is left over.

use super::Frame;
use crate::render::{OverlayItem, Rectangle};
use crate::stage::disk::motion::{DiskInstant, DiskMotion};
use crate::stage::panels::bars::{Bar, Bars, largest, written};
use crate::stage::panels::energy::change;
use crate::stage::panels::full_scale::FullScale;
use std::f64::consts::TAU;

#[derive(Debug, Clone)]
pub(super) struct Ledger {
    bars: Bars,
    full: FullScale,
    period: f64,
}

impl Ledger {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let Frame { motion, scale, palette, .. } = *frame;
        let title = "Energy per period".to_owned();
        let period = TAU / motion.angular_frequency();
        let bars = Bars { place, scale, palette, title, unit: 1.0 };
        let mut panel = Self { bars, period, full: FullScale::default() };
        panel.full = FullScale::new(motion.end(), |time| largest(&panel.entries(motion, &motion.at(time))));
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
        // Between the instants the scale knows a bar may be longer.
        let full = self.full.at(now.time).max(largest(&entries));
        self.bars.draw(entries, full, out);
    }
}
