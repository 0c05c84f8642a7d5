//! The linear side of one sector of a cyclic disk: what its oscillators do under the force of its contact, and the describing function.

use super::error::DiskError;
use super::odd_series::C;
use crate::model::{BladedDisk, ContactPlace, NodalDiameter, sector_eigenvalues};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

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
    /// K(sigma), D(sigma) and `R conj(c) c^T` of the first harmonic.
    first: [DMatrix<C>; 3],
}

impl<'a> Sector<'a> {
    pub(super) fn new(disk: &'a BladedDisk, wave: NodalDiameter) -> Result<Self, DiskError> {
        let [contacts] = disk.friction.as_slice() else { return Err(DiskError::NotOneGroup) };
        if !disk.tuned().is_cyclic()? || contacts.sectors.is_some() {
            return Err(DiskError::NotOneGroup);
        }
        let chain = disk.tuned().chain()?;
        let element = chain.jenkins()[0];
        let (stiffness, damping) = (chain.stiffness().clone(), chain.total_damping());
        let size = disk.oscillators_per_sector();
        let first = [disk.wave_block(&stiffness, wave), disk.wave_block(&damping, wave), DMatrix::zeros(size, size)];
        let mut sector = Self {
            disk,
            wave,
            mass: (0..size).map(|a| chain.mass()[a * disk.sectors]).collect(),
            stiffness,
            damping,
            slip_force: element.slip_force,
            slip_elongation: 1.0 / element.normalised_stiffness(),
            place: contacts.place,
            first,
        };
        let c = sector.direction(1);
        sector.first[2] = c.conjugate() * c.transpose() * C::from(sector.slip_force);
        Ok(sector)
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

    /// Eigenvalues of the sector with its contact swinging at the sticking angle `tau`; see [`super::amplitudes`].
    pub(super) fn eigenvalues(&self, tau: f64) -> Result<Vec<C>, DiskError> {
        let in_phase = (2.0 * tau - (2.0 * tau).sin()) / (2.0 * PI);
        let force = C::new(in_phase, tau.sin().powi(2) / PI) / self.slip_elongation;
        let [stiffness, damping, contact] = &self.first;
        Ok(sector_eigenvalues(&self.mass, damping, &(stiffness + contact * force))?)
    }
}
