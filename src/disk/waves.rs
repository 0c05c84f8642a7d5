//! All travelling-wave limit cycles of a nodal diameter that the search over the amplitude finds, each solved for on the whole ring.
//!
//! A candidate of the describing function is refined by harmonic balance of one sector, where that converges, and closed on the whole ring by
//! shooting. What comes out is held against what was asked for: it must be a wave of this nodal diameter that slips. Two candidates
//! that lead to one cycle give one.

use super::amplitudes::{Candidate, Searched};
use super::error::DiskError;
use super::one_sector::{DESCRIBING_FUNCTION, MANY_HARMONICS, TravellingWave};
use super::ring::{RingWave, largest_by_wave, ring_wave, wave_multipliers};
use super::sector::Sector;
use super::spectrum::{strongest, wave_amplitudes};
use super::stability::OrbitStability;
use crate::dynamics::State;
use crate::exact::{ExactError, SparseFlow};
use crate::model::{BladedDisk, NodalDiameter};

/// Bound on |x| of the flow that closes the orbits: far beyond the largest amplitude searched.
const FARTHEST: f64 = 1e8;
/// Largest difference between blades on a wave, of its amplitude: they agree to the closure of the orbit.
const UNEQUAL: f64 = 1e-6;
/// Orbits whose amplitudes and frequencies differ by less than this part are one.
const SAME: f64 = 1e-7;

/// A limit cycle of a wave.
#[derive(Debug, Clone)]
pub struct WaveCycle {
    pub family: usize,
    pub ring: RingWave,
    /// By harmonic balance of one sector; none where that does not converge.
    pub amplitude_from_one_sector: Option<f64>,
    pub amplitude_by_describing_function: f64,
    /// Largest modulus of the multipliers over a period by relative nodal diameter, the trivial one left out.
    pub growth: Vec<(NodalDiameter, f64)>,
    pub stability: OrbitStability,
}

/// A candidate that could not be made a cycle.
#[derive(Debug)]
pub struct FailedCandidate {
    pub candidate: Candidate,
    pub error: DiskError,
}

/// What the search has found of a wave.
#[derive(Debug)]
pub struct FoundWaves {
    pub searched: Searched,
    /// By family and amplitude.
    pub cycles: Vec<WaveCycle>,
    pub failed: Vec<FailedCandidate>,
}

impl FoundWaves {
    /// Passes a disk that has travelling waves of the kind searched for.
    ///
    /// # Errors
    /// [`DiskError::NotOneGroup`] unless it is a ring with one group of contacts on all sectors; [`DiskError::Parameter`].
    pub fn check(disk: &BladedDisk) -> Result<(), DiskError> {
        Sector::new(&disk.tuned(), NodalDiameter::new(0, disk.sectors)).map(|_| ())
    }

    /// Of the disk without its mistuning.
    ///
    /// # Errors
    /// As [`TravellingWave::candidates`].
    pub fn of(disk: &BladedDisk, wave: NodalDiameter) -> Result<Self, DiskError> {
        let disk = disk.tuned();
        let (candidates, searched) = TravellingWave::candidates(&disk, wave)?;
        let mut found = Self { searched, cycles: Vec::new(), failed: Vec::new() };
        if candidates.is_empty() {
            return Ok(found);
        }
        let flow = SparseFlow::new(&disk.chain()?).with_amplitude_bound(FARTHEST)?;
        for candidate in candidates {
            match WaveCycle::near(&disk, &flow, &candidate) {
                Ok(cycle) if found.cycles.iter().any(|other| other.is_same(&cycle)) => {}
                Ok(cycle) => found.cycles.push(cycle),
                Err(error) => found.failed.push(FailedCandidate { candidate, error }),
            }
        }
        Ok(found)
    }
}

impl WaveCycle {
    fn near(disk: &BladedDisk, flow: &SparseFlow, candidate: &Candidate) -> Result<Self, DiskError> {
        let wave = candidate.wave;
        let estimate = TravellingWave::near(disk, candidate, DESCRIBING_FUNCTION)?;
        let one = TravellingWave::near(disk, candidate, MANY_HARMONICS);
        let ring = ring_wave(flow, one.as_ref().unwrap_or(&estimate))?;
        let on_orbit = State::from_components(ring.orbit.state.as_slice(), flow.chain()).map_err(ExactError::from)?;
        let amplitudes = wave_amplitudes(&on_orbit, disk.sectors, ring.orbit.angular_frequency());
        let is_wave = strongest(&amplitudes) == wave && ring.asymmetry <= UNEQUAL * ring.amplitude;
        // Below the slip limit of the contacts the ring is linear: rest closes as well.
        let slips = flow.advance(&on_orbit, ring.orbit.period)?.switches > 0;
        if !(is_wave && slips) {
            let (expected, found) = (estimate.amplitude, ring.amplitude);
            return Err(DiskError::AnotherOrbit { wave: wave.signed(), expected, found });
        }
        let multipliers = wave_multipliers(flow, disk, wave, &ring.orbit)?;
        let growth = largest_by_wave(&multipliers, disk.sectors);
        let largest = growth.iter().map(|(_, multiplier)| *multiplier).fold(0.0, f64::max);
        Ok(Self {
            family: candidate.family,
            amplitude_from_one_sector: one.ok().map(|one| one.amplitude),
            amplitude_by_describing_function: estimate.amplitude,
            growth,
            stability: OrbitStability::of(largest),
            ring,
        })
    }

    fn is_same(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= SAME * a;
        near(self.ring.amplitude, other.ring.amplitude) && near(self.ring.orbit.period, other.ring.orbit.period)
    }
}
