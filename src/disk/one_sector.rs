//! A travelling-wave limit cycle of a tuned ring from one sector alone.
//!
//! All blades do the same, each a time `sigma/w` after the one before, so the contacts of one sector decide the motion. With `theta = w t` and
//! the elongation `u(theta) = sum_h Re U_h exp(i h theta)` over odd h,
//!
//! ```text
//! U_h + H_h(w) f_h[u] = 0,   H_h = R c_h^T Z_h^-1 conj(c_h),   Z_h = -h^2 w^2 M + i h w D(h sigma) + K(h sigma)
//! ```
//!
//! where `c_h` takes the motion of a sector to the elongation of its contact: 1 for a blade at its foot, `1 - exp(-i h sigma)` between neighbours.
//! Measured from a reversal `u'(0) = 0`, `u(0) = u_max`, the force obeys over half a period
//!
//! ```text
//! f = 1 - (u(0) - u)/e  for 0 <= theta <= tau,   f = -1 for tau <= theta <= pi,   u(0) - u(tau) = 2 e,
//! f_h = 2/(i h pi e) int_0^tau u' exp(-i h theta) dtheta      (by parts; f is continuous)
//! ```
//!
//! and the integrals of products of harmonics are known in closed form: no time is discretised, and no code is shared with the exact
//! flow. Left out are the harmonics beyond the last; `f_h = O(1/h^2)` and `H_h = O(1/h^2)`, so the error of the amplitude falls at least with the
//! third power of their number. With one harmonic this is the describing function.
//!
//! Where to look for them over the amplitude is said in [`super::amplitudes`].
//!
//! Assumptions: a ring with one group of contacts on all sectors; contacts that reverse twice and slip twice in a period; odd symmetry.

use super::amplitudes::{Candidate, LARGEST_AMPLITUDE, Searched, search};
use super::balance::Balance;
use super::error::DiskError;
use super::odd_series::{C, largest, value};
use super::sector::Sector;
use crate::dynamics::State;
use crate::model::{BladedDisk, ContactPlace, NodalDiameter};
use nalgebra::DVector;
use std::f64::consts::PI;

/// Harmonics of the describing function, and enough for 1e-10 in the amplitude.
pub const DESCRIBING_FUNCTION: usize = 1;
pub const MANY_HARMONICS: usize = 256;

/// A travelling-wave limit cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct TravellingWave {
    pub wave: NodalDiameter,
    pub angular_frequency: f64,
    /// Largest displacement of a blade.
    pub amplitude: f64,
    /// Largest elongation of a contact.
    pub elongation: f64,
    /// `theta` from a reversal to the next slip.
    pub sticking_angle: f64,
    /// Complex amplitudes of the odd harmonics 1, 3, 5, ... of each oscillator of sector 0.
    pub harmonics: Vec<DVector<C>>,
    slip_elongation: f64,
    place: ContactPlace,
    contact: Vec<C>,
}

impl TravellingWave {
    /// All limit cycles that the describing function of a wave has, by family and amplitude, and what was searched; for the disk without its
    /// mistuning.
    ///
    /// # Errors
    /// [`DiskError::NotOneGroup`] unless the disk is a ring with one group of contacts on all sectors; [`DiskError::Modes`].
    pub fn candidates(disk: &BladedDisk, wave: NodalDiameter) -> Result<(Vec<Candidate>, Searched), DiskError> {
        search(&Sector::new(disk, wave)?)
    }

    /// The first of the candidates, with `count` odd harmonics: the wave of least amplitude of the lowest family that has one.
    ///
    /// # Errors
    /// As [`Self::candidates`] and [`Self::near`]; [`DiskError::NoWave`] where there is none up to 1000 slip elongations.
    pub fn of(disk: &BladedDisk, wave: NodalDiameter, count: usize) -> Result<Self, DiskError> {
        let (found, _) = Self::candidates(disk, wave)?;
        let none = DiskError::NoWave { wave: wave.signed(), elongations: LARGEST_AMPLITUDE };
        Self::near(disk, found.first().ok_or(none)?, count)
    }

    /// The wave near a candidate, with `count` odd harmonics.
    ///
    /// # Errors
    /// [`DiskError::NotOneGroup`] as above; [`DiskError::NoConvergence`], [`DiskError::NoSlip`]; [`DiskError::ManyReversals`].
    pub fn near(disk: &BladedDisk, candidate: &Candidate, count: usize) -> Result<Self, DiskError> {
        let wave = candidate.wave;
        let sector = Sector::new(disk, wave)?;
        let mut balance = Balance::new(&sector, candidate.elongation, count);
        let w = balance.solve(candidate.elongation, candidate.angular_frequency)?;
        if balance.falls() {
            Self::from_balance(balance, w)
        } else {
            Err(DiskError::ManyReversals { wave: wave.signed() })
        }
    }

    fn from_balance(mut balance: Balance<'_, '_>, w: f64) -> Result<Self, DiskError> {
        let forces = balance.forces()?;
        let Balance { sector, u, tau, .. } = balance;
        let size = sector.mass.len();
        let harmonics: Vec<DVector<C>> = forces
            .iter()
            .enumerate()
            .map(|(k, f)| sector.response(2 * k + 1, w).map_or(DVector::zeros(size), |x| x * *f))
            .collect();
        let blade: Vec<C> = harmonics.iter().map(|x| x[0]).collect();
        Ok(Self {
            wave: sector.wave,
            angular_frequency: w,
            amplitude: largest(&blade),
            elongation: value(&u, 0.0),
            sticking_angle: tau,
            harmonics,
            slip_elongation: sector.slip_elongation,
            place: sector.place,
            contact: u,
        })
    }

    /// The state of the whole ring at the time at which the contact of sector 0 reverses at f = +1.
    #[must_use]
    pub fn state(&self) -> State {
        let n = self.wave.sectors();
        let size = self.harmonics.first().map_or(0, DVector::len);
        let theta = |j: usize| -self.wave.multiple(j as i64);
        let of = |part: usize, j: usize, rate: bool| {
            let terms = self.harmonics.iter().enumerate().map(|(k, x)| {
                let h = (2 * k + 1) as f64;
                let factor = if rate { C::i() * h * self.angular_frequency } else { C::from(1.0) };
                (factor * x[part] * C::from_polar(1.0, h * theta(j))).re
            });
            terms.sum::<f64>()
        };
        let all =
            |rate| (0..size).flat_map(|part| (0..n).map(move |j| (part, j))).map(|(p, j)| of(p, j, rate)).collect();
        State {
            positions: all(false),
            velocities: all(true),
            slider_forces: (0..n).map(|j| self.force(theta(j))).collect(),
        }
    }

    #[must_use]
    pub fn period(&self) -> f64 {
        std::f64::consts::TAU / self.angular_frequency
    }

    /// Contact force at a phase, in units of the slip force.
    fn force(&self, theta: f64) -> f64 {
        let turn = theta.rem_euclid(2.0 * PI);
        let (phase, sign) = if turn >= PI { (turn - PI, -1.0) } else { (turn, 1.0) };
        if phase >= self.sticking_angle {
            return -sign;
        }
        let drop = self.elongation - value(&self.contact, phase);
        sign * (1.0 - drop / self.slip_elongation).clamp(-1.0, 1.0)
    }

    #[must_use]
    pub fn place(&self) -> ContactPlace {
        self.place
    }
}
