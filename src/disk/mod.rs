//! Nonlinear analysis of bladed disks: travelling-wave limit cycles, their stability and competition, and what random mistuning does.
//!
//! - [`TravellingWave`]: the wave of a tuned ring from one sector (`one_sector`), by harmonic balance with exact friction integrals.
//!   [`TravellingWave::candidates`] searches for all of them over the amplitude (`amplitudes`).
//! - [`ring_wave`], [`wave_multipliers`]: the same wave as an orbit of the whole ring under the exact flow, and its Floquet multipliers grouped
//!   by interblade phase angle (`ring`). [`FoundWaves`] are all cycles of a nodal diameter so closed (`waves`).
//! - [`settled_cycle`], [`mistuned_wave`]: limit cycles of mistuned disks (`settled`, `watch`, `cycle`).
//! - [`wave_amplitudes`]: the spectrum by nodal diameter (`spectrum`).
//! - [`MonteCarlo`]: flutter of randomly mistuned disks, resumable (`monte_carlo`, `flutter_summary`).

mod amplitudes;
mod balance;
mod cycle;
mod error;
mod flutter_summary;
mod monte_carlo;
mod odd_series;
mod one_sector;
mod ring;
mod sector;
mod settled;
mod spectrum;
mod stability;
mod watch;
mod waves;

pub use amplitudes::{Candidate, LARGEST_AMPLITUDE, Searched};
pub use cycle::{DiskCycle, cycle_near, mistuned_wave, participation};
pub use error::DiskError;
pub use flutter_summary::{FateCounts, LinearCounts, Summary};
pub use monte_carlo::{Fate, MonteCarlo, Sample, SampleRow};
pub use one_sector::{DESCRIBING_FUNCTION, MANY_HARMONICS, TravellingWave};
pub use ring::{RingWave, WaveMultiplier, blade_amplitudes, largest_by_wave, ring_wave, wave_multipliers};
pub use settled::{LONGEST_MOTION, SettledCycle, settled_cycle};
pub use spectrum::{slow_wave_amplitudes, strongest, wave_amplitudes, wave_amplitudes_at, wave_frequencies};
pub use stability::{NEUTRAL_MULTIPLIER, OrbitStability};
pub use waves::{FailedCandidate, FoundWaves, WaveCycle};
