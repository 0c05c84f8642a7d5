//! Amplitudes of the waves of a ring at an instant, and over time.
//!
//! With `z_j = x_j - i v_j/w`, which is `q exp(i (w t - j sigma))` in a harmonic wave, the amplitude of the wave n is
//!
//! ```text
//! a_n = |1/N sum_j z_j exp(+i j sigma_n)|
//! ```
//!
//! exact for harmonic motion at w, otherwise right up to half the difference between the wave's frequency and w, relative.

use super::error::DiskError;
use crate::dynamics::State;
use crate::model::{BladedDisk, NodalDiameter};
use nalgebra::Complex;

/// Amplitudes by wave number 0 to N - 1 of the first `blades` oscillators, seen at angular frequency `w`.
#[must_use]
pub fn wave_amplitudes(state: &State, blades: usize, w: f64) -> Vec<f64> {
    wave_amplitudes_at(state, &vec![w; blades])
}

/// The same with an angular frequency for each wave, by wave number 0 to N - 1; N is the number of frequencies.
#[must_use]
pub fn wave_amplitudes_at(state: &State, frequencies: &[f64]) -> Vec<f64> {
    let blade = |j: usize, w: f64| Complex::new(state.positions[j], -state.velocities[j] / w);
    let amplitude = |(n, w): (usize, &f64)| wave_amplitude(n, frequencies.len(), |j| blade(j, *w));
    frequencies.iter().enumerate().map(amplitude).collect()
}

/// Amplitudes by wave number of complex amplitudes `z_j`, one per blade, as averaging gives them.
#[must_use]
pub fn slow_wave_amplitudes(z: &[Complex<f64>]) -> Vec<f64> {
    (0..z.len()).map(|n| wave_amplitude(n, z.len(), |j| z[j])).collect()
}

fn wave_amplitude(n: usize, blades: usize, z: impl Fn(usize) -> Complex<f64>) -> f64 {
    let wave = NodalDiameter::new(n as i64, blades);
    let sum: Complex<f64> = (0..blades).map(|j| z(j) * Complex::from_polar(1.0, wave.multiple(j as i64))).sum();
    sum.norm() / blades as f64
}

/// Frequencies to see the waves of a ring at, by wave number: the lowest of each with stuck contacts, without mistuning; contacts on chosen sectors
/// count as if they were on none.
///
/// # Errors
/// [`DiskError::Modes`] as [`BladedDisk::tuned_modes`].
pub fn wave_frequencies(disk: &BladedDisk) -> Result<Vec<f64>, DiskError> {
    let everywhere = disk.friction.iter().filter(|contacts| contacts.sectors.is_none()).cloned().collect();
    let modes = BladedDisk { friction: everywhere, ..disk.tuned() }.tuned_modes(true)?;
    let mut frequencies = vec![1.0; disk.sectors];
    for mode in modes.iter().filter(|mode| mode.family == 0) {
        frequencies[mode.wave.index()] = mode.mode.angular_frequency;
    }
    Ok(frequencies)
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
