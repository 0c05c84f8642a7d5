//! Flutter of randomly mistuned disks.
//!
//! Sample i has the mistuning of seed `first_seed + i` and starts from rest with displacements drawn uniformly from the same seed. It is
//! followed by the exact flow over `periods`; what is recorded comes from the last tenth of the motion.
//!
//! # When a motion has settled
//!
//! The amplitude of a blade is half the way between its least and its largest displacement in a tenth of the motion: contacts that stick keep
//! static forces, and the displacement these hold is no motion.
//!
//! A bounded motion has settled when contacts slip in the last tenth, and the largest amplitude of any blade and the mean over the blades both
//! differ by less than 1 % between the last two tenths. An unstable motion that does not slip still grows, however slowly: nothing holds it yet.
//! While a motion has not settled, it is followed to four times its length, up to `longest`: the windows
//! grow with it, so that a slow beat, which is no settling, fits in. What has not settled by then counts apart and enters no quantile.
//! A motion that is linearly not unstable and whose contacts all stick in the last tenth does not grow: it needs no settling.
//!
//! A draw that is no disk, or whose motion fails, is a row with its reason among the others.
//!
//! Every sample depends on its seed alone, so the result is the same on any number of threads and after any interruption.

use super::cycle::participation;
use super::error::DiskError;
use super::settled::LONGEST_MOTION;
use crate::dynamics::{Outcome, Sampling, State};
use crate::exact::SparseFlow;
use crate::model::{BladedDisk, ContactState, Mistuning, ParameterError, Range, Stability};
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
/// Least number of periods: a tenth of them must hold a whole oscillation, and then some.
const FEWEST_PERIODS: f64 = 20.0;
/// A stage is left out where the longest motion is not this many times as long: its windows would overlap those of the last stage.
const WORTH_A_STAGE: f64 = 1.0 / TRANSIENT;
/// A motion that has not settled is made this many times as long.
const LENGTHENING: f64 = 4.0;
/// Samples of one Monte Carlo.
const MOST_SAMPLES: usize = 1_000_000;
/// Keeps the seeds of displacements apart from those of stiffnesses.
const START_STREAM: u64 = 0x5354_4152_5400_0000;

/// What is drawn and followed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MonteCarlo {
    /// With a random mistuning, whose seed is replaced.
    pub disk: BladedDisk,
    pub samples: usize,
    pub first_seed: u64,
    /// Length of each motion at first, in periods 2 pi of a blade, at least 20.
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
    /// Linearly stable or neutral, and no contact slips at the end.
    Stable,
    /// Linearly unstable or slipping at the end, and bounded so far; friction holds it where it has settled.
    Flutter,
    Diverged,
}

/// One sample. Amplitudes are those of the last tenth of the motion, in units of displacement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SampleRow {
    pub seed: u64,
    /// Least damping of all modes with stuck contacts, those that do not oscillate among them.
    pub least_damping: f64,
    /// What it says: negative beyond rounding is flutter or static divergence.
    pub linear: Stability,
    pub fate: Fate,
    /// Periods followed.
    pub periods: f64,
    /// Whether a contact slips in the last tenth; not looked at, and false, where the motion diverges before.
    pub slips: bool,
    /// Whether the amplitudes are those the motion keeps; true of stable and diverged ones, which have none.
    pub settled: bool,
    /// Largest amplitude of any blade, half its range of displacements; of a diverged motion the amplitude bound.
    pub amplitude: f64,
    /// Mean over the blades of their amplitudes.
    pub mean_amplitude: f64,
    /// `(sum a_j^2)^2 / (N sum a_j^4)`: 1 where all blades move alike, 1/N where one moves alone.
    pub participation: f64,
}

/// One draw: followed, or why not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Sample {
    Followed(SampleRow),
    Failed { seed: u64, reason: String },
}

impl Sample {
    /// The row of a sample that was followed.
    #[must_use]
    pub fn row(&self) -> Option<&SampleRow> {
        match self {
            Self::Followed(row) => Some(row),
            Self::Failed { .. } => None,
        }
    }
}

impl MonteCarlo {
    /// All samples in order of seed. With `record`, finished blocks are kept there and not computed again.
    ///
    /// # Errors
    /// [`DiskError::Parameter`] and [`DiskError::TooMany`] for numbers out of range, [`DiskError::NotRandom`], [`DiskError::Seeds`], and [`DiskError::Store`] and
    /// [`DiskError::Record`] of the record. A sample that fails is a row.
    pub fn run(
        &self,
        record: Option<&OutputDir>,
        progress: impl Fn(usize, usize) + Sync,
    ) -> Result<Vec<Sample>, DiskError> {
        self.validate()?;
        let done = AtomicUsize::new(0);
        let blocks: Vec<Vec<Sample>> = (0..self.samples.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let rows = self.block(block, record)?;
                progress(done.fetch_add(rows.len(), Ordering::Relaxed) + rows.len(), self.samples);
                Ok(rows)
            })
            .collect::<Result<_, DiskError>>()?;
        Ok(blocks.concat())
    }

    /// Seconds of computing on one thread, if no motion goes on and if all go on to the longest, by the pace of the first disk over a few periods; none
    /// where that disk cannot be followed.
    ///
    /// # Errors
    /// As [`Self::run`] for the plan.
    pub fn estimate(&self) -> Result<Option<[f64; 2]>, DiskError> {
        self.validate()?;
        let trial = Self { periods: FEWEST_PERIODS, longest: FEWEST_PERIODS, ..self.clone() };
        let before = std::time::Instant::now();
        if trial.sample(self.first_seed).is_err() {
            return Ok(None);
        }
        let pace = before.elapsed().as_secs_f64() / FEWEST_PERIODS * self.samples as f64;
        Ok(Some([self.periods, self.longest].map(|periods| pace * periods)))
    }

    fn validate(&self) -> Result<(), DiskError> {
        Range::Positive.check("samples", self.samples as f64)?;
        Range::Positive.check("periods", self.periods)?;
        if self.periods < FEWEST_PERIODS {
            let allowed = "at least 20: amplitudes are measured over tenths of the motion";
            return Err(out_of_range("periods", self.periods, allowed));
        }
        Range::Positive.check("start", self.start)?;
        if !(self.longest >= self.periods && self.longest.is_finite()) {
            let allowed = "finite and at least the number of periods";
            return Err(out_of_range("longest", self.longest, allowed));
        }
        match &self.disk.mistuning {
            None => return Err(DiskError::NotRandom { found: "no mistuning" }),
            Some(fixed) if !fixed.is_random() => return Err(DiskError::NotRandom { found: "a given pattern" }),
            Some(_) => {}
        }
        let most = LONGEST_MOTION / TAU;
        for (what, found, allowed) in [
            ("samples", self.samples as f64, MOST_SAMPLES as f64),
            ("periods", self.periods, most),
            ("periods at the longest", self.longest, most),
        ] {
            if found > allowed {
                return Err(DiskError::TooMany { what, found, allowed });
            }
        }
        if self.first_seed.checked_add(self.samples as u64 - 1).is_none() {
            return Err(DiskError::Seeds { first: self.first_seed, samples: self.samples });
        }
        // The width of the scatter; the draw of the scene's own seed is none of the samples.
        self.disk.deviations()?;
        self.disk.tuned().chain()?;
        Ok(())
    }

    fn block(&self, block: usize, record: Option<&OutputDir>) -> Result<Vec<Sample>, DiskError> {
        let name = format!("samples/block-{block:06}.json");
        if let Some(directory) = record
            && directory.trusted(&name, "").is_some()
        {
            let bytes = read_whole(&directory.path().join(&name))?;
            return serde_json::from_slice(&bytes)
                .map_err(|error| DiskError::Record { name: name.clone(), reason: error.to_string() });
        }
        let seeds = (block * BLOCK..self.samples.min((block + 1) * BLOCK)).map(|i| self.first_seed + i as u64);
        let sample = |seed| match self.sample(seed) {
            Ok(row) => Sample::Followed(row),
            Err(error) => Sample::Failed { seed, reason: error.to_string() },
        };
        let rows: Vec<Sample> = seeds.map(sample).collect();
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
        let linear = Stability::of(&modes);
        let displacements = Mistuning::Uniform { half_width: self.start, seed: seed ^ START_STREAM };
        let mut start = State::rest(&chain);
        start.positions[..disk.sectors].copy_from_slice(&displacements.deviations(disk.sectors)?);
        self.follow(&SparseFlow::new(&chain), start, Fixed { seed, least_damping, linear, blades: disk.sectors })
    }

    /// The motion in stages, each to `LENGTHENING` times the length of the one before.
    fn follow(&self, flow: &SparseFlow, start: State, fixed: Fixed) -> Result<SampleRow, DiskError> {
        let (mut state, mut known, mut periods) = (start, 0.0, self.stage(self.periods));
        loop {
            let mut tenths = Tenths { blades: vec![[Extent::NONE; 2]; fixed.blades], slips: false };
            let end = periods * TAU;
            let before = flow.advance(&state, (TRANSIENT * end - known).max(0.0))?;
            if before.outcome != Outcome::Completed {
                return Ok(tenths.row(&fixed, periods, before.outcome));
            }
            let length = (1.0 - TRANSIENT) * end;
            let sampling = Sampling { interval: TAU / PER_PERIOD, t_end: length };
            let see = |t: f64, state: &State, contacts: &[ContactState]| tenths.see(t > 0.5 * length, state, contacts);
            let arrival = flow.observe(&before.state, sampling, see)?;
            let row = tenths.row(&fixed, periods, arrival.outcome);
            if row.settled || periods >= self.longest {
                return Ok(row);
            }
            (state, known) = (arrival.state, end);
            periods = self.stage(LENGTHENING * periods);
        }
    }

    /// Length of a stage: the wanted one, or the longest if that is hardly longer or shorter.
    fn stage(&self, wanted: f64) -> f64 {
        if WORTH_A_STAGE * wanted > self.longest { self.longest } else { wanted }
    }
}

/// What is known of a sample before it moves.
struct Fixed {
    seed: u64,
    least_damping: f64,
    linear: Stability,
    blades: usize,
}

/// Least and largest displacement.
#[derive(Debug, Clone, Copy)]
struct Extent {
    low: f64,
    high: f64,
}

impl Extent {
    const NONE: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    fn add(&mut self, x: f64) {
        (self.low, self.high) = (self.low.min(x), self.high.max(x));
    }

    /// Amplitude about the middle; 0 where nothing was seen.
    fn amplitude(self) -> f64 {
        (0.5 * (self.high - self.low)).max(0.0)
    }
}

/// How far each blade moves in the last but one and the last tenth of a motion, and whether contacts slip in the last.
struct Tenths {
    blades: Vec<[Extent; 2]>,
    slips: bool,
}

impl Tenths {
    fn see(&mut self, last: bool, state: &State, contacts: &[ContactState]) {
        for (extents, x) in self.blades.iter_mut().zip(&state.positions) {
            extents[usize::from(last)].add(*x);
        }
        self.slips |= last && contacts.iter().any(|contact| !contact.is_stick());
    }

    fn amplitudes(&self, tenth: usize) -> impl Iterator<Item = f64> {
        self.blades.iter().map(move |blade| blade[tenth].amplitude())
    }

    fn largest(&self, tenth: usize) -> f64 {
        self.amplitudes(tenth).fold(0.0, f64::max)
    }

    fn mean(&self, tenth: usize) -> f64 {
        self.amplitudes(tenth).sum::<f64>() / self.blades.len() as f64
    }

    fn has_settled(&self) -> bool {
        let near = |[before, now]: [f64; 2]| (now - before).abs() <= SETTLED * now;
        near([0, 1].map(|tenth| self.largest(tenth))) && near([0, 1].map(|tenth| self.mean(tenth)))
    }

    fn row(&self, fixed: &Fixed, periods: f64, outcome: Outcome) -> SampleRow {
        let Fixed { seed, least_damping, linear, .. } = *fixed;
        let (fate, amplitude) = match outcome {
            Outcome::Diverged { bound, .. } => (Fate::Diverged, bound),
            Outcome::Completed if !linear.is_unstable() && !self.slips => (Fate::Stable, self.largest(1)),
            Outcome::Completed => (Fate::Flutter, self.largest(1)),
        };
        let amplitudes: Vec<f64> = self.amplitudes(1).collect();
        SampleRow {
            seed,
            least_damping,
            linear,
            fate,
            periods,
            slips: self.slips,
            settled: fate != Fate::Flutter || (self.slips && self.has_settled()),
            amplitude,
            mean_amplitude: self.mean(1),
            participation: participation(&amplitudes),
        }
    }
}

fn out_of_range(field: &str, found: f64, allowed: &'static str) -> DiskError {
    ParameterError::OutOfRange { field: field.to_owned(), found, allowed }.into()
}
