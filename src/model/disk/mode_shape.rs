//! Modes of a disk that need not be cyclic, with their shapes: localisation and content by nodal diameter.
//!
//! The shape phi of an eigenvalue s solves `(s^2 M + s D + K) phi = 0`; two steps of inverse iteration with the shift off by some 1e-10 find
//! it. The participation ratio
//!
//! ```text
//! P = (sum_j |phi_j|^2)^2 / (N sum_j |phi_j|^4)      over the blades
//! ```
//!
//! is 1 where all blades move alike (every travelling wave) and 1/N where one moves alone. Where eigenvalues coincide, shapes are not unique:
//! of a tuned disk take [`super::BladedDisk::tuned_modes`].

use super::wave::{NodalDiameter, TravelDirection};
use crate::model::{LinearMode, ModesError, OscillatorChain};
use nalgebra::{Complex, DMatrix, DVector};

/// Distance of the shift from the eigenvalue, relative: far beyond its rounding, far below any gap that matters.
const SHIFT: f64 = 1e-10;
/// Eigenvalues below this part of the largest are shifted by [`SHIFT`] of it: their rounding is that of the largest.
const SMALL: f64 = 1e-3;

/// Waves n and -n whose shares differ by less than this part of their sum stand. Shapes without air are real to rounding over the smallest gap between
/// frequencies, so that their shares differ by less; what travels by one part in a million is standing to any eye.
const STANDING: f64 = 1e-6;

/// A mode with its shape.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeShape {
    pub mode: LinearMode,
    /// Complex amplitude of each oscillator, largest modulus 1.
    pub shape: Vec<Complex<f64>>,
}

impl OscillatorChain {
    /// All modes of [`OscillatorChain::linear_modes`] with their shapes, in its order: those that do not oscillate come first.
    ///
    /// # Errors
    /// As [`OscillatorChain::linear_modes`]; [`ModesError::NoShape`] if a shape is not found.
    pub fn mode_shapes(&self, sticking: &[bool]) -> Result<Vec<ModeShape>, ModesError> {
        let modes = self.linear_modes(sticking)?;
        let (stiffness, damping) = (self.stiffness_with(sticking), self.total_damping());
        let largest = modes.iter().flat_map(LinearMode::eigenvalues).map(|s| s.norm()).fold(0.0, f64::max);
        modes.into_iter().map(|mode| shape_of(self, [&stiffness, &damping], mode, largest)).collect()
    }
}

fn shape_of(
    chain: &OscillatorChain,
    [stiffness, damping]: [&DMatrix<f64>; 2],
    mode: LinearMode,
    largest: f64,
) -> Result<ModeShape, ModesError> {
    let s = Complex::new(-0.5 * mode.damping, mode.angular_frequency);
    // Nothing holds and nothing damps: every shift is as good.
    let scale = if largest > 0.0 { largest } else { 1.0 };
    let shifted = if s.norm() > SMALL * scale { s * (1.0 + SHIFT) } else { s + SHIFT * scale };
    let n = chain.oscillators();
    let pencil = DMatrix::from_fn(n, n, |i, j| {
        let inertia = if i == j { shifted * shifted * chain.mass()[i] } else { Complex::ZERO };
        inertia + shifted * damping[(i, j)] + stiffness[(i, j)]
    });
    let no_shape = ModesError::NoShape { angular_frequency: mode.angular_frequency };
    let factors = pencil.lu();
    // No symmetry of the chain is shared by this start, so that no mode is missed.
    let mut shape = DVector::from_fn(n, |j, _| Complex::from_polar(1.0, 2.4 * (j * j) as f64 + 0.7 * j as f64));
    for _ in 0..3 {
        shape = factors.solve(&shape).ok_or(no_shape.clone())?;
        let largest = shape.iter().copied().max_by(|a, b| a.norm().total_cmp(&b.norm())).ok_or(no_shape.clone())?;
        shape /= largest;
        if !shape.iter().all(|c| c.is_finite()) {
            return Err(no_shape);
        }
    }
    Ok(ModeShape { mode, shape: shape.iter().copied().collect() })
}

impl ModeShape {
    /// Participation ratio over the first `blades` oscillators, from `1/blades` to 1.
    #[must_use]
    pub fn participation(&self, blades: usize) -> f64 {
        let energies = || self.shape.iter().take(blades).map(|c| c.norm_sqr());
        energies().sum::<f64>().powi(2) / (blades as f64 * energies().map(|e| e * e).sum::<f64>())
    }

    /// Share of each wave in the motion of the first `blades` oscillators, by wave number 0 to N - 1; the sum is 1.
    #[must_use]
    pub fn wave_shares(&self, blades: usize) -> Vec<f64> {
        let total: f64 = self.shape.iter().take(blades).map(|c| c.norm_sqr()).sum();
        (0..blades)
            .map(|n| {
                let wave = NodalDiameter::new(n as i64, blades);
                let turned = |(j, c): (usize, &Complex<f64>)| c * Complex::from_polar(1.0, wave.multiple(j as i64));
                let amplitude: Complex<f64> = self.shape.iter().take(blades).enumerate().map(turned).sum();
                amplitude.norm_sqr() / (blades as f64 * total)
            })
            .collect()
    }

    /// Which way the wave with the largest share runs; standing where the opposite wave has the same share.
    #[must_use]
    pub fn direction(&self, blades: usize) -> TravelDirection {
        let wave = self.dominant_wave(blades);
        let shares = self.wave_shares(blades);
        let [here, there] = [wave, NodalDiameter::new(-wave.signed(), blades)].map(|wave| shares[wave.index()]);
        if here - there <= STANDING * (here + there) { TravelDirection::Standing } else { wave.direction() }
    }

    /// The wave with the largest share; of equal ones the first in the order 0, 1, -1, 2, ...
    #[must_use]
    pub fn dominant_wave(&self, blades: usize) -> NodalDiameter {
        let shares = self.wave_shares(blades);
        let first = NodalDiameter::new(0, blades);
        NodalDiameter::all(blades)
            .fold(first, |best, wave| if shares[wave.index()] > shares[best.index()] { wave } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Aerodynamics, BladedDisk, InfluenceCoefficient, Mistuning, TravelDirection};

    #[test]
    fn one_loose_blade_localises_a_mode_and_uncoupled_blades_localise_all() {
        let mut deviations = vec![0.0; 10];
        deviations[3] = 0.5;
        let disk = BladedDisk { mistuning: Some(Mistuning::Pattern { deviations }), ..BladedDisk::ring(10, 0.01) };
        let shapes = disk.chain().unwrap().mode_shapes(&[]).unwrap();
        let top = shapes.last().unwrap();
        // Neighbours move by kappa/delta = 0.02: P = 1/N (1 + 2 * 2 * 0.02^2) to that order.
        assert!((top.participation(10) - 0.1).abs() < 2e-4, "{}", top.participation(10));
        assert_eq!(top.shape.iter().position(|c| c.norm() == 1.0), Some(3));
        let shares: f64 = top.wave_shares(10).iter().sum();
        assert!((shares - 1.0).abs() < 1e-14);
    }

    #[test]
    fn modes_without_air_stand_and_air_lets_them_travel() {
        let mistuning = Some(Mistuning::Normal { standard_deviation: 0.02, seed: 4 });
        let still = BladedDisk { mistuning, ..BladedDisk::ring(9, 0.1) };
        let directions = |disk: &BladedDisk| -> Vec<TravelDirection> {
            disk.chain().unwrap().mode_shapes(&[]).unwrap().iter().map(|shape| shape.direction(9)).collect()
        };
        // Shapes of a symmetric matrix are real.
        assert!(directions(&still).iter().all(|direction| *direction == TravelDirection::Standing));
        let l = |offset, real| InfluenceCoefficient { offset, real, imaginary: 0.0 };
        let air = Aerodynamics::Coefficients { coefficients: vec![l(1, 0.02), l(-1, -0.02)], reference_frequency: 1.0 };
        let moving = directions(&BladedDisk { aerodynamics: Some(air), ..still });
        assert!(moving.contains(&TravelDirection::Forward) && moving.contains(&TravelDirection::Backward));
    }
}
