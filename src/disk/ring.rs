//! Travelling-wave limit cycles of the full ring, and their stability by nodal diameter.
//!
//! A wave of nodal diameter n repeats itself, seen from another blade, after a fraction of its period. With `g = gcd(n, N)`, `N' = N/g`
//! and the shift `s` with `s n/g = 1 mod N'`,
//!
//! ```text
//! x_(j+s)(t + T/N') = x_j(t)          and          x_(j+N')(t) = x_j(t).
//! ```
//!
//! A perturbation is a sum of `dx_j = exp(lambda t) exp(-i j theta_r) p(t - j sigma/w)` with p periodic and `theta_r = 2 pi r/N`: on the wave n it
//! is, in the first harmonic, another wave `n + r`. The map A, the shift after `T/N'`, multiplies it by `alpha = exp(lambda T/N') exp(-i s theta_r)`,
//! and a shift by N' blades by `exp(-i N' theta_r)`. Both together give r and the multiplier `mu = exp(lambda T)`, with |Im lambda| T <= pi.

use super::error::DiskError;
use super::one_sector::TravellingWave;
use crate::dynamics::{State, TangentFlow};
use crate::exact::SparseFlow;
use crate::model::{BladedDisk, NodalDiameter};
use crate::orbit::{FlowOrbit, OrbitError, SpatialClosure, shoot_flow};
use nalgebra::{Complex, DMatrix, DVector};
use std::f64::consts::TAU;

/// A travelling-wave limit cycle of the whole ring.
#[derive(Debug, Clone)]
pub struct RingWave {
    pub wave: NodalDiameter,
    pub orbit: FlowOrbit,
    /// Largest amplitude of any blade on the orbit.
    pub amplitude: f64,
    /// Largest difference between blades, each seen a phase angle after the one before, in units of displacement.
    pub asymmetry: f64,
}

/// A Floquet multiplier of a wave over its period, and the interblade phase angle of its perturbation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaveMultiplier {
    /// r: the perturbation is, in the first harmonic, the wave n + r.
    pub relative: NodalDiameter,
    pub multiplier: Complex<f64>,
}

/// The exact wave near the estimate, closed by the full period of the full ring: no symmetry is assumed.
///
/// # Errors
/// [`DiskError::Orbit`] if Newton's method fails.
pub fn ring_wave(flow: &SparseFlow, estimate: &TravellingWave) -> Result<RingWave, DiskError> {
    let guess = DVector::from_iterator(flow.dimension(), estimate.state().components());
    let closure = SpatialClosure::full_period(flow.dimension());
    let blades = estimate.wave.sectors();
    let forces = 2 * flow.chain().oscillators();
    let admit = |y: &mut DVector<f64>| y.iter_mut().skip(forces).for_each(|f| *f = f.clamp(-1.0, 1.0));
    let orbit = shoot_flow(flow, &guess, estimate.period(), &closure, admit)?;
    let peaks = blade_amplitudes(flow, &orbit, blades)?;
    let (low, high) = peaks.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), a| (l.min(*a), h.max(*a)));
    Ok(RingWave { wave: estimate.wave, orbit, amplitude: high, asymmetry: high - low })
}

/// Amplitude of each blade over one period of an orbit, half the way between its least and its largest displacement: contacts that never slip may
/// hold a blade off its rest, which is no motion. Of the dense motion, the best of 256 samples, then the zero of the velocity beside it by bisection.
///
/// # Errors
/// [`DiskError::Flow`].
pub fn blade_amplitudes(flow: &SparseFlow, orbit: &FlowOrbit, blades: usize) -> Result<Vec<f64>, DiskError> {
    const SAMPLES: usize = 256;
    let start = State::from_components(orbit.state.as_slice(), flow.chain()).map_err(crate::exact::ExactError::from)?;
    // Two periods, so that a peak near the ends lies inside.
    let motion = flow.solve(&start, 2.0 * orbit.period)?;
    let at = |time: f64| motion.state_at(time).map(|instant| instant.state);
    let step = orbit.period / SAMPLES as f64;
    let samples: Vec<State> = (0..=SAMPLES + 1).map(|n| at(n as f64 * step)).collect::<Result<_, _>>()?;
    // Largest sign * x_j.
    let peak = |j: usize, sign: f64| -> Result<f64, DiskError> {
        let height = |n: &usize| sign * samples[*n].positions[j];
        let best = (1..=SAMPLES).max_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or(1);
        let (mut low, mut high) = ((best - 1) as f64 * step, (best + 1) as f64 * step);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if sign * at(middle)?.velocities[j] > 0.0 { low = middle } else { high = middle }
        }
        Ok(sign * at(0.5 * (low + high))?.positions[j])
    };
    (0..blades).map(|j| Ok(0.5 * (peak(j, 1.0)? + peak(j, -1.0)?))).collect()
}

/// Floquet multipliers of the wave, grouped by the interblade phase angle of the perturbation, largest first; zeros of slipping contacts
/// included, the trivial one (`relative` 0, multiplier 1) too.
///
/// # Errors
/// [`DiskError::NotCyclic`] unless all sectors are equal, [`DiskError::Orbit`] if the flow fails along the orbit.
pub fn wave_multipliers(
    flow: &SparseFlow,
    disk: &BladedDisk,
    wave: NodalDiameter,
    orbit: &FlowOrbit,
) -> Result<Vec<WaveMultiplier>, DiskError> {
    if !disk.is_cyclic()? || disk.friction.iter().any(|contacts| contacts.sectors.is_some()) {
        return Err(DiskError::NotCyclic);
    }
    let cell = Cell::of(disk.sectors, wave.signed());
    let n = flow.dimension();
    let (mut state, mut tangent) = (orbit.state.clone(), DMatrix::identity(n, n));
    let span = orbit.period / cell.sectors as f64;
    flow.carry(&mut state, &mut tangent, span)
        .map_err(|source| OrbitError::Flow { period: span, source: Box::new(source) })?;
    let mut found = Vec::with_capacity(n);
    for rho in 0..cell.repeats {
        for alpha in eigenvalues(cell.reduced(&tangent, rho))? {
            found.push(cell.decoded(alpha, rho));
        }
    }
    found.sort_by(|a, b| b.multiplier.norm().total_cmp(&a.multiplier.norm()).then(a.relative.cmp(&b.relative)));
    Ok(found)
}

/// The symmetry of a wave: N', g, s of the module head.
struct Cell {
    all: usize,
    sectors: usize,
    repeats: usize,
    shift: usize,
    /// n/g modulo N'.
    step: usize,
}

impl Cell {
    fn of(all: usize, n: i64) -> Self {
        let n = n.rem_euclid(all as i64) as usize;
        let repeats = gcd(n, all);
        let sectors = all / repeats;
        let step = (n / repeats) % sectors.max(1);
        let shift = (0..sectors).find(|s| (s * step) % sectors == 1 % sectors).unwrap_or(0);
        Self { all, sectors, repeats, shift, step }
    }

    /// A on perturbations with `dx_(j+N') = exp(-2 pi i rho/g) dx_j`, in the components of the first N' sectors.
    fn reduced(&self, tangent: &DMatrix<f64>, rho: usize) -> DMatrix<Complex<f64>> {
        let groups = tangent.nrows() / self.all;
        let size = groups * self.sectors;
        let turn = |repeat: usize| {
            Complex::from_polar(1.0, -TAU * ((repeat * rho) % self.repeats) as f64 / self.repeats as f64)
        };
        DMatrix::from_fn(size, size, |row, column| {
            let (a, j) = (row / self.sectors, row % self.sectors);
            let (b, k) = (column / self.sectors, column % self.sectors);
            let from = a * self.all + (j + self.shift) % self.all;
            (0..self.repeats).map(|q| turn(q) * tangent[(from, b * self.all + k + q * self.sectors)]).sum()
        })
    }

    fn decoded(&self, alpha: Complex<f64>, rho: usize) -> WaveMultiplier {
        let cells = self.sectors as f64;
        let offset = TAU * (self.shift * rho) as f64 / self.all as f64;
        let m = ((alpha.arg() + offset) * cells / TAU).round() as i64;
        let k = (-m * self.step as i64).rem_euclid(self.sectors as i64);
        let r = rho as i64 + self.repeats as i64 * k;
        let relative = NodalDiameter::new(r, self.all);
        // alpha^N' with the phase of the shift taken out; exact in the number of whole turns.
        let phase = cells * (alpha.arg() + TAU * (self.shift as f64 * r as f64 / self.all as f64).fract());
        WaveMultiplier { relative, multiplier: Complex::from_polar(alpha.norm().powf(cells), phase) }
    }
}

fn gcd(a: usize, b: usize) -> usize {
    if a == 0 { b } else { gcd(b % a, a) }
}

fn eigenvalues(matrix: DMatrix<Complex<f64>>) -> Result<Vec<Complex<f64>>, DiskError> {
    let size = matrix.nrows();
    let failed = || DiskError::Modes(crate::model::ModesError::NoConvergence { size });
    let schur = nalgebra::linalg::Schur::try_new(matrix, f64::EPSILON, 10_000).ok_or_else(failed)?;
    Ok(schur.eigenvalues().ok_or_else(failed)?.iter().copied().collect())
}

/// Growth of the perturbations of a wave per period by relative nodal diameter: the largest modulus of each, the trivial multiplier left out.
#[must_use]
pub fn largest_by_wave(multipliers: &[WaveMultiplier], sectors: usize) -> Vec<(NodalDiameter, f64)> {
    let trivial = multipliers
        .iter()
        .enumerate()
        .filter(|(_, m)| m.relative.signed() == 0)
        .min_by(|a, b| (a.1.multiplier - 1.0).norm().total_cmp(&(b.1.multiplier - 1.0).norm()))
        .map(|(i, _)| i);
    NodalDiameter::all(sectors)
        .map(|wave| {
            let of_wave = multipliers.iter().enumerate().filter(|(i, m)| Some(*i) != trivial && m.relative == wave);
            (wave, of_wave.map(|(_, m)| m.multiplier.norm()).fold(0.0, f64::max))
        })
        .collect()
}
