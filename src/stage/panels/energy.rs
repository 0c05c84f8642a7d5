//! Energy ledger of the last period: what self-excitation put in, what damping and friction took out, what is stored more than a
//! period before, and what is left over, which an exact solution leaves at zero.
//!
//! ```text
//! W_self_excitation + W_drive + W_damping + W_friction + residual = change of the stored energy
//! ```

use super::Frame;
use super::bars::{Bar, Bars, largest, written};
use super::full_scale::FullScale;
use crate::model::{EnergyLedger, Scales};
use crate::render::{OverlayItem, Rectangle};
use crate::stage::motion::{Instant, Motion};
use std::f64::consts::TAU;

/// A period of the sticking in-phase mode, non-dimensional.
const PERIOD: f64 = TAU;

#[derive(Debug, Clone)]
pub(super) struct Energy {
    bars: Bars,
    full: FullScale,
    scales: Scales,
    is_driven: bool,
}

/// Change of a ledger from an earlier one.
pub fn change(before: &EnergyLedger, now: &EnergyLedger) -> EnergyLedger {
    let mut change = *now;
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
        let unit = if scales == Scales::UNITY { "" } else { " [J]" };
        let title = format!("Energy in the last period{unit}");
        let bars = Bars { place, scale, palette, title, unit: scales.energy };
        let mut panel = Self { bars, full: FullScale::default(), scales, is_driven };
        panel.full = FullScale::new(motion.end(), |time| largest(&panel.entries(motion, &motion.at(time))));
        panel
    }

    fn entries(&self, motion: &Motion, now: &Instant) -> Vec<Bar> {
        let ledger = change(&motion.at((now.time - PERIOD).max(0.0)).ledger, &now.ledger);
        let (works, palette) = (ledger.works, &self.bars.palette);
        // Numbers that may be tiny are written with their power of ten.
        let bar = |label, colour, value, is_tiny: bool| {
            let number = written(value * self.scales.energy, is_tiny || self.scales != Scales::UNITY);
            Bar { label, colour, value, number }
        };
        let drive = self.is_driven.then(|| bar("drive", palette.stick, works.drive, false));
        let works = [
            bar("excitation", palette.excitation, works.self_excitation, false),
            bar("damping", palette.damping, works.damping, false),
            bar("friction", palette.slip, works.friction, false),
            bar("stored", palette.masses[0], ledger.stored - ledger.stored_at_start, false),
            bar("residual", palette.text, ledger.residual(), true),
        ];
        drive.into_iter().chain(works).collect()
    }

    pub fn draw(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        self.bars.draw(self.entries(motion, now), self.full.at(now.time), out);
    }
}
