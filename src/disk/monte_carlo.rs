//! Flutter of randomly mistuned disks.
//!
//! Sample i has the mistuning of seed `first_seed + i` and starts from rest with displacements drawn uniformly from the same seed. It is
//! followed by the exact flow over `periods`; what is recorded comes from the last tenth of the motion.
//!
//! # When a motion has settled
//!
//! A bounded motion has settled when the largest amplitude of any blade and the mean over the blades of their largest amplitudes both differ by
//! less than 1 % between the last two tenths. While it has not, it is followed to four times its length, up to `longest`: the windows
//! grow with it, so that a slow beat, which is no settling, fits in. What has not settled by then counts apart and enters no quantile.
//! A linearly stable motion whose contacts all stick in the last tenth only decays: it needs no settling.
//!
//! Every sample depends on its seed alone, so the result is the same on any number of threads and after any interruption.

use super::cycle::participation;
use super::error::DiskError;
use crate::dynamics::{Outcome, Sampling, State};
use crate::exact::SparseFlow;
use crate::model::{BladedDisk, ContactState, Mistuning, ParameterError, Range};
use crate::store::{OutputDir, read_whole};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Samples in a file of the record: the work an interruption can cost.
const BLOCK: usize = 10;
/// Samples of the motion in a period of 2 pi: a peak between two is missed by (pi/64)^2/2 = 0.12 % at most.
const PER_PERIOD: f64 = 64.0;
/// What is looked at begins after this part of the motion.
const TRANSIENT: f64 = 0.8;
/// Largest relative change between the last two tenths of a settled motion.
const SETTLED: f64 = 0.01;
/// A motion that has not settled is made this many times as long.
const LENGTHENING: f64 = 4.0;
/// Keeps the seeds of displacements apart from those of stiffnesses.
const START_STREAM: u64 = 0x5354_4152_5400_0000;

/// What is drawn and followed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MonteCarlo {
    /// With a random mistuning, whose seed is replaced.
    pub disk: BladedDisk,
    pub samples: usize,
    pub first_seed: u64,
    /// Length of each motion at first, in periods 2 pi of a blade.
    pub periods: f64,
    /// Length up to which motions that have not settled are followed, at least `periods`.
    pub longest: f64,
    /// Displacements at the start are uniform from minus this to this.
    pub start: f64,
}

/// How a motion went on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    /// Linearly stable, and no contact slips at the end.
    Stable,
    /// Linearly unstable or slipping at the end, and bounded: friction holds the flutter.
    Flutter,
    Diverged,
}

/// One sample. Amplitudes are those of the last tenth of the motion, in units of displacement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SampleRow {
    pub seed: u64,
    /// Least damping of all modes with stuck contacts; negative: linear flutter.
    pub least_damping: f64,
    pub fate: Fate,
    /// Periods followed.
    pub periods: f64,
    /// Whether the amplitudes are those the motion keeps; true of stable and diverged ones, which have none.
    pub settled: bool,
    /// Largest amplitude of any blade; of a diverged motion the amplitude bound.
    pub amplitude: f64,
    /// Mean over the blades of their largest amplitudes.
    pub mean_amplitude: f64,
    /// `(sum a_j^2)^2 / (N sum a_j^4)`: 1 where all blades move alike, 1/N where one moves alone.
    pub participation: f64,
}

/// How many samples met each fate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct FateCounts {
    pub stable: usize,
    /// Settled ones.
    pub flutter: usize,
    /// Bounded by friction, but not settled within the longest time.
    pub unsettled: usize,
    pub diverged: usize,
}

/// What the samples say together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    pub fates: FateCounts,
    /// Samples with negative least damping over all samples, and its standard error.
    pub probability_of_linear_flutter: f64,
    pub standard_error: f64,
    /// 5, 25, 50, 75, 95 % quantiles of the amplitude of settled samples that flutter; empty if none does.
    pub amplitude_quantiles: Vec<f64>,
    /// Samples by the number of periods after which they had settled, diverged or were given up: periods and count.
    pub lengths: Vec<(f64, usize)>,
}

impl MonteCarlo {
    /// All samples in order of seed. With `record`, finished blocks are kept there and not computed again.
    ///
    /// # Errors
    /// [`DiskError::Parameter`] for numbers out of range and a mistuning that is not random, the first failure of a sample otherwise,
    /// and [`DiskError::Store`] and [`DiskError::Record`] of the record.
    pub fn run(
        &self,
        record: Option<&OutputDir>,
        progress: impl Fn(usize, usize) + Sync,
    ) -> Result<Vec<SampleRow>, DiskError> {
        self.validate()?;
        let done = AtomicUsize::new(0);
        let blocks: Vec<Vec<SampleRow>> = (0..self.samples.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let rows = self.block(block, record)?;
                progress(done.fetch_add(rows.len(), Ordering::Relaxed) + rows.len(), self.samples);
                Ok(rows)
            })
            .collect::<Result<_, DiskError>>()?;
        Ok(blocks.concat())
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Range::Positive.check("samples", self.samples as f64)?;
        Range::Positive.check("periods", self.periods)?;
        Range::Positive.check("start", self.start)?;
        if !(self.longest >= self.periods && self.longest.is_finite()) {
            let allowed = "finite and at least the number of periods";
            return Err(ParameterError::OutOfRange { field: "longest".to_owned(), found: self.longest, allowed });
        }
        if !self.disk.mistuning.as_ref().is_some_and(Mistuning::is_random) {
            let allowed = "`normal` or `uniform`: give [disk.mistuning] one of these kinds";
            return Err(ParameterError::OutOfRange { field: "mistuning".to_owned(), found: 0.0, allowed });
        }
        self.disk.chain().map(|_| ())
    }

    fn block(&self, block: usize, record: Option<&OutputDir>) -> Result<Vec<SampleRow>, DiskError> {
        let name = format!("samples/block-{block:06}.json");
        if let Some(directory) = record
            && directory.trusted(&name, "").is_some()
        {
            let bytes = read_whole(&directory.path().join(&name))?;
            return serde_json::from_slice(&bytes)
                .map_err(|error| DiskError::Record { name: name.clone(), reason: error.to_string() });
        }
        let seeds = (block * BLOCK..self.samples.min((block + 1) * BLOCK)).map(|i| self.first_seed + i as u64);
        let rows: Vec<SampleRow> = seeds.map(|seed| self.sample(seed)).collect::<Result<_, _>>()?;
        if let Some(directory) = record {
            directory.write(&name, "", |file| {
                serde_json::to_writer(&mut *file, &rows)?;
                writeln!(file)
            })?;
        }
        Ok(rows)
    }

    /// One sample.
    ///
    /// # Errors
    /// [`DiskError`] if the disk cannot be built, its modes do not converge or its motion stalls.
    pub fn sample(&self, seed: u64) -> Result<SampleRow, DiskError> {
        let mistuning = self.disk.mistuning.as_ref().map(|mistuning| mistuning.with_seed(seed));
        let disk = BladedDisk { mistuning, ..self.disk.clone() };
        let chain = disk.chain()?;
        let modes = chain.linear_modes(&vec![true; chain.sliders()])?;
        let least_damping = modes.iter().map(|mode| mode.damping).fold(f64::INFINITY, f64::min);
        let displacements = Mistuning::Uniform { half_width: self.start, seed: seed ^ START_STREAM };
        let mut start = State::rest(&chain);
        start.positions[..disk.sectors].copy_from_slice(&displacements.deviations(disk.sectors)?);
        self.follow(&SparseFlow::new(&chain), start, Fixed { seed, least_damping, blades: disk.sectors })
    }

    /// The motion in stages, each to `LENGTHENING` times the length of the one before.
    fn follow(&self, flow: &SparseFlow, start: State, fixed: Fixed) -> Result<SampleRow, DiskError> {
        let (mut state, mut known, mut periods) = (start, 0.0, self.periods);
        loop {
            let mut tenths = Tenths { blades: vec![[0.0; 2]; fixed.blades], slips: false };
            let end = periods * TAU;
            let before = flow.advance(&state, (TRANSIENT * end - known).max(0.0))?;
            if before.outcome != Outcome::Completed {
                return Ok(tenths.row(&fixed, periods, before.outcome));
            }
            // The windows of a stage that is hardly longer than the last may have begun before it: they begin with it then.
            let length = end - known.max(TRANSIENT * end);
            let sampling = Sampling { interval: TAU / PER_PERIOD, t_end: length };
            let see = |t: f64, state: &State, contacts: &[ContactState]| tenths.see(t > 0.5 * length, state, contacts);
            let arrival = flow.observe(&before.state, sampling, see)?;
            let row = tenths.row(&fixed, periods, arrival.outcome);
            if row.settled || periods >= self.longest {
                return Ok(row);
            }
            (state, known) = (arrival.state, end);
            periods = (LENGTHENING * periods).min(self.longest);
        }
    }
}

/// What is known of a sample before it moves.
struct Fixed {
    seed: u64,
    least_damping: f64,
    blades: usize,
}

/// Largest |x| of each blade in the last but one and the last tenth of a motion.
struct Tenths {
    blades: Vec<[f64; 2]>,
    slips: bool,
}

impl Tenths {
    fn see(&mut self, last: bool, state: &State, contacts: &[ContactState]) {
        let tenth = usize::from(last);
        for (largest, x) in self.blades.iter_mut().zip(&state.positions) {
            largest[tenth] = largest[tenth].max(x.abs());
        }
        self.slips |= last && contacts.iter().any(|contact| !contact.is_stick());
    }

    fn largest(&self, tenth: usize) -> f64 {
        self.blades.iter().map(|b| b[tenth]).fold(0.0, f64::max)
    }

    fn mean(&self, tenth: usize) -> f64 {
        self.blades.iter().map(|b| b[tenth]).sum::<f64>() / self.blades.len() as f64
    }

    fn has_settled(&self) -> bool {
        let near = |[before, now]: [f64; 2]| (now - before).abs() <= SETTLED * now;
        near([0, 1].map(|tenth| self.largest(tenth))) && near([0, 1].map(|tenth| self.mean(tenth)))
    }

    fn row(&self, fixed: &Fixed, periods: f64, outcome: Outcome) -> SampleRow {
        let Fixed { seed, least_damping, .. } = *fixed;
        let (fate, amplitude) = match outcome {
            Outcome::Diverged { bound, .. } => (Fate::Diverged, bound),
            Outcome::Completed if least_damping >= 0.0 && !self.slips => (Fate::Stable, self.largest(1)),
            Outcome::Completed => (Fate::Flutter, self.largest(1)),
        };
        let amplitudes: Vec<f64> = self.blades.iter().map(|blade| blade[1]).collect();
        SampleRow {
            seed,
            least_damping,
            fate,
            periods,
            settled: fate != Fate::Flutter || self.has_settled(),
            amplitude,
            mean_amplitude: self.mean(1),
            participation: participation(&amplitudes),
        }
    }
}

impl Summary {
    /// Of at least one sample; all zero for none.
    #[must_use]
    pub fn of(rows: &[SampleRow]) -> Self {
        let count = |fate, settled| rows.iter().filter(|row| row.fate == fate && row.settled == settled).count();
        let all = rows.len().max(1) as f64;
        let p = rows.iter().filter(|row| row.least_damping < 0.0).count() as f64 / all;
        let fluttering = rows.iter().filter(|row| row.fate == Fate::Flutter && row.settled);
        let mut amplitudes: Vec<f64> = fluttering.map(|row| row.amplitude).collect();
        amplitudes.sort_by(f64::total_cmp);
        let quantile = |q: f64| amplitudes[(q * (amplitudes.len() - 1) as f64).round() as usize];
        let quantiles = [0.05, 0.25, 0.5, 0.75, 0.95];
        Self {
            fates: FateCounts {
                stable: count(Fate::Stable, true),
                flutter: count(Fate::Flutter, true),
                unsettled: count(Fate::Flutter, false),
                diverged: count(Fate::Diverged, true),
            },
            probability_of_linear_flutter: p,
            standard_error: (p * (1.0 - p) / all).sqrt(),
            amplitude_quantiles: if amplitudes.is_empty() { vec![] } else { quantiles.map(quantile).to_vec() },
            lengths: lengths(rows),
        }
    }
}

/// Rows by the number of periods followed, in rising order.
fn lengths(rows: &[SampleRow]) -> Vec<(f64, usize)> {
    let mut periods: Vec<f64> = rows.iter().map(|row| row.periods).collect();
    periods.sort_by(f64::total_cmp);
    periods.chunk_by(|a, b| a == b).map(|equal| (equal[0], equal.len())).collect()
}
