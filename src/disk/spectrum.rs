//! Amplitudes of the waves of a ring at an instant, and over time.
//!
//! Formula and its error: [`Spectrum`]. The sums are of displacements at an instant: a static one, held by contacts that stick, stands in them as
//! if it swung.

use super::error::DiskError;
use crate::dynamics::State;
use crate::model::{BladedDisk, NodalDiameter, Spectrum, Topology};
use nalgebra::Complex;

/// Amplitudes by wave number 0 to N - 1 of the first `blades` oscillators, seen at angular frequency `w`.
#[must_use]
pub fn wave_amplitudes(state: &State, blades: usize, w: f64) -> Vec<f64> {
    wave_amplitudes_at(state, &vec![w; blades])
}

/// The same with an angular frequency for each wave, by wave number 0 to N - 1; N is the number of frequencies.
#[must_use]
pub fn wave_amplitudes_at(state: &State, frequencies: &[f64]) -> Vec<f64> {
    Spectrum::new(Topology::Ring, frequencies.to_vec()).amplitudes(&state.positions, &state.velocities)
}

/// Amplitudes by wave number of complex amplitudes `z_j`, one per blade, as averaging gives them.
#[must_use]
pub fn slow_wave_amplitudes(z: &[Complex<f64>]) -> Vec<f64> {
    Spectrum::new(Topology::Ring, vec![1.0; z.len()]).amplitudes_of(|j, _| z[j])
}

/// [`BladedDisk::wave_frequencies`].
///
/// # Errors
/// [`DiskError::Modes`] as there.
pub fn wave_frequencies(disk: &BladedDisk) -> Result<Vec<f64>, DiskError> {
    Ok(disk.wave_frequencies()?)
}

/// The wave with the largest amplitude.
#[must_use]
pub fn strongest(amplitudes: &[f64]) -> NodalDiameter {
    let sectors = amplitudes.len();
    NodalDiameter::all(sectors).fold(NodalDiameter::new(0, sectors), |best, wave| {
        if amplitudes[wave.index()] > amplitudes[best.index()] { wave } else { best }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_wave_is_found_in_its_own_direction_with_its_amplitude() {
        for n in [-2, 0, 1, 3] {
            let wave = NodalDiameter::new(n, 7);
            let at = |j: usize| Complex::from_polar(0.7, 0.4 - wave.multiple(j as i64));
            let state = State {
                positions: (0..7).map(|j| at(j).re).collect(),
                velocities: (0..7).map(|j| (Complex::i() * 1.3 * at(j)).re).collect(),
                slider_forces: vec![],
            };
            let amplitudes = wave_amplitudes(&state, 7, 1.3);
            assert_eq!(strongest(&amplitudes), wave);
            for (index, amplitude) in amplitudes.iter().enumerate() {
                let expected = if index == wave.index() { 0.7 } else { 0.0 };
                // Rounding of a sum of seven terms.
                assert!((amplitude - expected).abs() < 1e-15);
            }
        }
    }
}
