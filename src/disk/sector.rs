//! The linear side of one sector of a cyclic disk: what its oscillators do under the force of its contact, and the describing function.

use super::error::DiskError;
use super::odd_series::C;
use crate::model::{BladedDisk, ContactPlace, NodalDiameter, TunedMode};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Largest amplitude looked at, in units of the slip elongation.
const LARGEST_AMPLITUDE: f64 = 100.0;
const MOST_STEPS: usize = 60;

/// The linear side of one sector.
pub(super) struct Sector<'a> {
    disk: &'a BladedDisk,
    pub(super) wave: NodalDiameter,
    pub(super) mass: Vec<f64>,
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
    slip_force: f64,
    pub(super) slip_elongation: f64,
    pub(super) place: ContactPlace,
}

impl<'a> Sector<'a> {
    pub(super) fn new(disk: &'a BladedDisk, wave: NodalDiameter) -> Result<Self, DiskError> {
        let [contacts] = disk.friction.as_slice() else { return Err(DiskError::NotOneGroup) };
        if !disk.tuned().is_cyclic()? || contacts.sectors.is_some() {
            return Err(DiskError::NotOneGroup);
        }
        let chain = disk.tuned().chain()?;
        let element = chain.jenkins()[0];
        Ok(Self {
            disk,
            wave,
            mass: (0..disk.oscillators_per_sector()).map(|a| chain.mass()[a * disk.sectors]).collect(),
            stiffness: chain.stiffness().clone(),
            damping: chain.total_damping(),
            slip_force: element.slip_force,
            slip_elongation: 1.0 / element.normalised_stiffness(),
            place: contacts.place,
        })
    }

    /// `c_h`: elongation of a contact per motion of the oscillators of its sector.
    fn direction(&self, harmonic: usize) -> DVector<C> {
        let mut c = DVector::zeros(self.mass.len());
        c[0] = C::from(1.0);
        match self.place {
            ContactPlace::Foot if c.len() > 1 => c[1] = C::from(-1.0),
            ContactPlace::Foot => {}
            ContactPlace::NextBlade => c[0] -= C::from_polar(1.0, -self.wave.multiple(harmonic as i64)),
        }
        c
    }

    /// Motion of the sector per unit force of harmonic h of its contact, `-R Z_h^-1 conj(c_h)`.
    pub(super) fn response(&self, harmonic: usize, w: f64) -> Option<DVector<C>> {
        let h = harmonic as f64;
        let seen = NodalDiameter::new(self.wave.signed() * harmonic as i64, self.disk.sectors);
        let [k, d] = [&self.stiffness, &self.damping].map(|matrix| self.disk.wave_block(matrix, seen));
        let mut z = k + d * (C::i() * h * w);
        for (a, mass) in self.mass.iter().enumerate() {
            z[(a, a)] -= C::from(h * h * w * w * mass);
        }
        z.lu().solve(&self.direction(harmonic).map(|c| -self.slip_force * c.conj()))
    }

    /// `H_h`, infinite at a resonance without damping.
    pub(super) fn compliance(&self, harmonic: usize, w: f64) -> C {
        self.response(harmonic, w).map_or(C::from(f64::INFINITY), |x| -self.direction(harmonic).dot(&x))
    }

    /// `1 + H_1 N(a)` made regular, `1/H_1(w) + N(a)` with N the force per elongation of a harmonic motion of amplitude a.
    fn balance(&self, amplitude: f64, w: f64) -> C {
        let e = self.slip_elongation;
        let tau = if amplitude > e { (1.0 - 2.0 * e / amplitude).acos() } else { PI };
        let in_phase = (2.0 * tau - (2.0 * tau).sin()) / (2.0 * PI * e);
        C::new(in_phase, tau.sin().powi(2) / (PI * e)) + 1.0 / self.compliance(1, w)
    }

    /// Amplitude and angular frequency by the describing function: the frequency from the real part for every amplitude, and the first
    /// amplitude at which friction balances the air.
    pub(super) fn describing_function(&self) -> Result<(f64, f64), DiskError> {
        let e = self.slip_elongation;
        let lowest = |modes: Vec<TunedMode>| {
            modes.into_iter().find(|mode| mode.wave == self.wave).map(|mode| mode.mode.angular_frequency)
        };
        let no_wave = || DiskError::NoWave { wave: self.wave.signed(), amplitude: LARGEST_AMPLITUDE * e };
        let mut w = lowest(self.disk.tuned_modes(true)?).ok_or_else(no_wave)?;
        let mut at = |a: f64| {
            w = self.frequency(a, w)?;
            Some((self.balance(a, w).im, w))
        };
        let (mut low, mut high) = (e * (1.0 + 1e-9), e);
        let start = at(low).ok_or_else(no_wave)?.0;
        // Below the slip limit only the air acts: a wave it damps has no cycle that grows out of rest.
        if start >= 0.0 {
            return Err(no_wave());
        }
        while high < LARGEST_AMPLITUDE * e {
            high = if high > e { high * 1.05 } else { 1.05 * e };
            if at(high).ok_or_else(no_wave)?.0 > 0.0 {
                break;
            }
            low = high;
        }
        if high >= LARGEST_AMPLITUDE * e {
            return Err(no_wave());
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if at(middle).ok_or_else(no_wave)?.0 < 0.0 { low = middle } else { high = middle }
        }
        let (_, w) = at(high).ok_or_else(no_wave)?;
        Ok((high, w))
    }

    /// Angular frequency at which the real part of the balance vanishes, by the secant method from a neighbour.
    fn frequency(&self, amplitude: f64, near: f64) -> Option<f64> {
        let real = |w: f64| self.balance(amplitude, w).re;
        let (mut a, mut b) = (near, near * (1.0 + 1e-4));
        let (mut fa, mut fb) = (real(a), real(b));
        for _ in 0..MOST_STEPS {
            if (fb - fa).abs() == 0.0 || (b - a).abs() <= 1e-15 * b {
                break;
            }
            let next = b - fb * (b - a) / (fb - fa);
            (a, fa) = (b, fb);
            (b, fb) = (next, real(next));
        }
        (b.is_finite() && b > 0.0 && fb.abs() < 1e-9 * (1.0 + 1.0 / self.slip_elongation)).then_some(b)
    }
}
