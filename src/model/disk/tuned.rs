//! Modes of a cyclic disk: travelling waves, one nodal diameter at a time.
//!
//! With one oscillator per sector the eigenvalue of a wave solves `s^2 + d(sigma) s + k(sigma) = 0` with complex d and k; of its two roots the
//! one with positive imaginary part belongs to this wave, the other is the conjugate of the opposite wave's. With two oscillators
//! per sector the same holds of the four eigenvalues of the 4 x 4 companion matrix. Real eigenvalues are modes too, of this wave and of the opposite
//! one; imaginary parts below 1e-12 of the largest eigenvalue are rounding. Backward waves have the conjugates of the forward ones, so that no
//! eigenvalue is counted twice or lost: all waves together have 2N of them for N oscillators.

use super::bladed_disk::BladedDisk;
use super::wave::NodalDiameter;
use crate::model::modes::NEUTRAL;
use crate::model::{LinearMode, ModesError, OscillatorChain, ParameterError};
use nalgebra::{Complex, DMatrix};

/// A wave and how it oscillates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TunedMode {
    pub wave: NodalDiameter,
    /// Number among the modes of this wave that oscillate, by angular frequency: 0 the lowest. Those that do not follow.
    pub family: usize,
    pub mode: LinearMode,
}

impl BladedDisk {
    /// The waves of the disk without its mistuning, with all contacts stuck or all slipping, in order of [`NodalDiameter::all`] and family.
    ///
    /// # Errors
    /// [`ModesError::NotCyclic`] unless this is a ring with contacts on all sectors or none, [`ModesError::Parameter`] and
    /// [`ModesError::NoConvergence`].
    pub fn tuned_modes(&self, stuck: bool) -> Result<Vec<TunedMode>, ModesError> {
        let disk = self.tuned();
        let chain = disk.chain()?;
        if !disk.is_cyclic()? {
            return Err(ModesError::NotCyclic);
        }
        let stiffness = chain.stiffness_with(&vec![stuck; chain.sliders()]);
        let damping = chain.total_damping();
        let mut modes = Vec::new();
        let forward = (0..=disk.sectors / 2)
            .map(|n| eigenvalues_of(&disk, &chain, [&stiffness, &damping], NodalDiameter::new(n as i64, disk.sectors)))
            .collect::<Result<Vec<_>, _>>()?;
        let largest = forward.iter().flatten().map(|s| s.norm()).fold(0.0, f64::max);
        for wave in NodalDiameter::all(disk.sectors) {
            let values = &forward[wave.signed().unsigned_abs() as usize];
            let turned = |s: &Complex<f64>| if wave.signed() < 0 { s.conj() } else { *s };
            let mut found: Vec<LinearMode> = values.iter().filter_map(|s| mode(turned(s), NEUTRAL * largest)).collect();
            let rank = |mode: &LinearMode| (!mode.oscillates(), mode.angular_frequency, mode.damping);
            found.sort_by(|a, b| rank(a).partial_cmp(&rank(b)).unwrap_or(std::cmp::Ordering::Equal));
            modes.extend(found.into_iter().enumerate().map(|(family, mode)| TunedMode { wave, family, mode }));
        }
        Ok(modes)
    }

    /// Frequencies to see the waves of a ring at, by wave number 0 to N - 1: the lowest of each with stuck contacts, without mistuning; contacts on
    /// chosen sectors count as if they were on none. 1 for a wave that does not oscillate.
    ///
    /// # Errors
    /// As [`Self::tuned_modes`].
    pub fn wave_frequencies(&self) -> Result<Vec<f64>, ModesError> {
        let everywhere = self.friction.iter().filter(|contacts| contacts.sectors.is_none()).cloned().collect();
        let modes = Self { friction: everywhere, ..self.tuned() }.tuned_modes(true)?;
        let mut frequencies = vec![1.0; self.sectors];
        for mode in modes.iter().filter(|found| found.family == 0 && found.mode.oscillates()) {
            frequencies[mode.wave.index()] = mode.mode.angular_frequency;
        }
        Ok(frequencies)
    }

    /// Aerodynamic damping of each wave at the reference frequency, the S-curve, in order of [`NodalDiameter::all`].
    ///
    /// # Errors
    /// As [`BladedDisk::influence_coefficients`].
    pub fn aerodynamic_damping(&self) -> Result<Vec<(NodalDiameter, f64)>, ParameterError> {
        let l = self.influence_coefficients()?;
        let damping = |wave| if self.aerodynamics.is_some() { l.damping(wave) } else { 0.0 };
        Ok(NodalDiameter::all(self.sectors).map(|wave| (wave, damping(wave))).collect())
    }
}

/// The eigenvalues of a wave, two per oscillator of a sector.
fn eigenvalues_of(
    disk: &BladedDisk,
    chain: &OscillatorChain,
    [stiffness, damping]: [&DMatrix<f64>; 2],
    wave: NodalDiameter,
) -> Result<Vec<Complex<f64>>, ModesError> {
    let [k, d] = [stiffness, damping].map(|matrix| disk.wave_block(matrix, wave));
    let mass: Vec<f64> = (0..disk.oscillators_per_sector()).map(|a| chain.mass()[a * disk.sectors]).collect();
    sector_eigenvalues(&mass, &d, &k)
}

/// The mode of an eigenvalue; none for one of the opposite wave. `rounding` is the size below which an imaginary part is none.
fn mode(s: Complex<f64>, rounding: f64) -> Option<LinearMode> {
    let angular_frequency = if s.im.abs() <= rounding { 0.0 } else { s.im };
    (angular_frequency >= 0.0).then_some(LinearMode { angular_frequency, damping: -2.0 * s.re })
}

/// Roots s of `det(s^2 M + s D + K) = 0` for a diagonal M and complex D and K, as one sector of a ring has them.
///
/// # Errors
/// [`ModesError::NoConvergence`].
pub(crate) fn sector_eigenvalues(
    mass: &[f64],
    damping: &DMatrix<Complex<f64>>,
    stiffness: &DMatrix<Complex<f64>>,
) -> Result<Vec<Complex<f64>>, ModesError> {
    let size = mass.len();
    if size == 1 {
        return Ok(quadratic(damping[(0, 0)] / mass[0], stiffness[(0, 0)] / mass[0]).to_vec());
    }
    eigenvalues(DMatrix::from_fn(2 * size, 2 * size, |row, column| match (row < size, column < size) {
        (true, _) => Complex::from(f64::from(u8::from(column == row + size))),
        (false, true) => -stiffness[(row - size, column)] / mass[row - size],
        (false, false) => -damping[(row - size, column - size)] / mass[row - size],
    }))
}

/// Roots of `s^2 + d s + k`: the larger from the formula without cancellation, the other from their product.
fn quadratic(d: Complex<f64>, k: Complex<f64>) -> [Complex<f64>; 2] {
    let root = (d * d - 4.0 * k).sqrt();
    let sum = if (d.conj() * root).re >= 0.0 { d + root } else { d - root };
    if sum.norm() == 0.0 {
        return [Complex::ZERO; 2];
    }
    [-0.5 * sum, -2.0 * k / sum]
}

fn eigenvalues(matrix: DMatrix<Complex<f64>>) -> Result<Vec<Complex<f64>>, ModesError> {
    let size = matrix.nrows();
    let failed = ModesError::NoConvergence { size };
    let schur = nalgebra::linalg::Schur::try_new(matrix, f64::EPSILON, 10_000).ok_or(failed.clone())?;
    Ok(schur.eigenvalues().ok_or(failed)?.iter().copied().collect())
}

#[cfg(test)]
mod tests {
    use super::super::bladed_disk::DiskSegments;
    use super::*;

    #[test]
    fn a_heavy_stiff_disk_leaves_the_blades_alone() {
        // Segments of stiffness 1e8: blades on rigid ground, frequency 1 for every wave.
        let disk =
            BladedDisk { segments: Some(DiskSegments { mass: 1.0, stiffness: 1e8 }), ..BladedDisk::ring(6, 0.3) };
        let modes = disk.tuned_modes(true).unwrap();
        assert_eq!(modes.len(), 12);
        for mode in modes.iter().filter(|mode| mode.family == 0) {
            // Compliance of the segment: relative 1/(2 * 1e8).
            assert!((mode.mode.angular_frequency - 1.0).abs() < 2e-8, "{mode:?}");
        }
    }

    #[test]
    fn waves_that_diverge_do_not_oscillate_and_are_counted_once() {
        use super::super::{Aerodynamics, InfluenceCoefficient};
        use crate::model::Stability;
        // The air takes a stiffness of 2 from the 1 of a blade: s^2 = 1 - 4 kappa sin^2(pi n/4), +-1 for n = 0.
        let coefficients = vec![InfluenceCoefficient { offset: 0, real: -2.0, imaginary: 0.0 }];
        let aerodynamics = Some(Aerodynamics::Coefficients { coefficients, reference_frequency: 1.0 });
        let disk = BladedDisk { aerodynamics, ..BladedDisk::ring(4, 0.02) };
        let modes = disk.tuned_modes(true).unwrap();
        assert!(modes.len() == 8 && modes.iter().all(|found| !found.mode.oscillates()));
        for found in &modes {
            let s = (1.0 - 0.08 * (std::f64::consts::FRAC_PI_4 * found.wave.signed() as f64).sin().powi(2)).sqrt();
            // Rounding of a square root.
            assert!((found.mode.damping.abs() - 2.0 * s).abs() < 1e-14, "{found:?} {s}");
        }
        assert_eq!(Stability::of(&modes.iter().map(|found| found.mode).collect::<Vec<_>>()), Stability::Divergence);
    }

    #[test]
    fn chains_and_single_contacts_have_no_waves() {
        use super::super::{ContactPlace, FrictionContacts, Topology};
        let chain = BladedDisk { topology: Topology::Chain, ..BladedDisk::ring(4, 0.1) };
        assert_eq!(chain.tuned_modes(true).unwrap_err(), ModesError::NotCyclic);
        let one = FrictionContacts { sectors: Some(vec![1]), ..FrictionContacts::everywhere(ContactPlace::Foot, 0.3) };
        let ring = BladedDisk { friction: vec![one], ..BladedDisk::ring(4, 0.1) };
        assert_eq!(ring.tuned_modes(true).unwrap_err(), ModesError::NotCyclic);
    }
}
