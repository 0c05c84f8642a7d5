//! Energy ledger of the last period: what self-excitation put in, what damping and friction took out, what is stored more than a
//! period before, and what is left over, which an exact solution leaves at zero.
//!
//! ```text
//! W_self_excitation + W_drive + W_damping + W_friction + residual = change of the stored energy
//! ```

use super::Frame;
use super::bars::{Bar, Bars, largest, written};
use super::full_scale::FullScale;
use crate::model::{EnergyLedger, RigParameters, Scales};
use crate::render::{OverlayItem, Rectangle};
use crate::scene::Case;
use crate::stage::motion::{Instant, Motion};
use std::f64::consts::TAU;

/// A period of the sticking in-phase mode, non-dimensional.
const PERIOD: f64 = TAU;

#[derive(Debug, Clone)]
pub(super) struct Energy {
    bars: Bars,
    full: FullScale,
    scales: Scales,
    rows: Rows,
}

/// Rows that are not in every ledger.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rows {
    pub drive: bool,
    pub excitation: bool,
    pub damping: bool,
}

impl Rows {
    /// Where a mass is moved from outside there is a drive, and what the rig has not got is no row: the coupling damper is (xi2 - xi1)/2.
    pub fn of(case: &Case) -> Self {
        let drive = case.prescribed.is_some();
        let RigParameters { xi1, xi2, .. } = case.parameters;
        Self { drive, excitation: !drive || xi1 != 0.0, damping: !drive || xi1 != xi2 }
    }
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
    pub fn new(frame: &Frame<'_>, place: Rectangle, rows: Rows) -> Self {
        let Frame { motion, scales, scale, palette } = *frame;
        let unit = if scales == Scales::UNITY { "" } else { " [J]" };
        let title = format!("Energy in the last period{unit}");
        let bars = Bars { place, scale, palette, title, unit: scales.energy };
        let mut panel = Self { bars, full: FullScale::default(), scales, rows };
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
        let Rows { drive, excitation, damping } = self.rows;
        let drive = drive.then(|| bar("drive", palette.stick, works.drive, false));
        let excitation = excitation.then(|| bar("excitation", palette.excitation, works.self_excitation, false));
        let damping = damping.then(|| bar("damping", palette.damping, works.damping, false));
        let always = [
            bar("friction", palette.slip, works.friction, false),
            bar("stored", palette.masses[0], ledger.stored - ledger.stored_at_start, false),
            bar("residual", palette.text, ledger.residual(), true),
        ];
        drive.into_iter().chain(excitation).chain(damping).chain(always).collect()
    }

    pub fn draw(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        let entries = self.entries(motion, now);
        // Between the instants the scale knows a bar may be longer.
        let full = self.full.at(now.time).max(largest(&entries));
        self.bars.draw(entries, full, out);
    }
}
