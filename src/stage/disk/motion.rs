//! A sampled motion of a bladed disk that can be looked up at any time: positions by cubic Hermite interpolation of sampled positions and
//! velocities (fourth order), everything else linearly, contact states as they were at the last sample.

use crate::dynamics::Trajectory;
use crate::model::{BladedDisk, ContactState, EnergyLedger, JenkinsElement, OscillatorChain, ParameterError};
use crate::stage::motion::ledger_between;

/// What is drawn of one instant: a number per oscillator (blades first, then disk segments), or per contact.
#[derive(Debug, Clone, PartialEq)]
pub struct DiskInstant {
    pub time: f64,
    pub positions: Vec<f64>,
    pub velocities: Vec<f64>,
    pub slider_forces: Vec<f64>,
    pub contacts: Vec<ContactState>,
    pub ledger: EnergyLedger,
}

/// Slip that counts, as a part of the elongation at which a contact gives way: far above the rounding of f32, far below what can be seen.
const LEAST_SLIP: f64 = 1e-3;

/// Samples of a motion of a disk.
#[derive(Debug, Clone)]
pub struct DiskMotion {
    blades: usize,
    elements: Vec<JenkinsElement>,
    instants: Vec<DiskInstant>,
}

impl DiskMotion {
    /// `None` for an empty trajectory, or one that is not of this disk.
    ///
    /// # Errors
    /// As [`BladedDisk::chain`].
    pub fn new(disk: &BladedDisk, trajectory: &Trajectory) -> Result<Option<Self>, ParameterError> {
        let chain: OscillatorChain = disk.chain()?;
        let fits = |instant: &DiskInstant| {
            let of = |count: usize, lengths: [usize; 2]| lengths == [count; 2];
            of(chain.oscillators(), [instant.positions.len(), instant.velocities.len()])
                && of(chain.sliders(), [instant.slider_forces.len(), instant.contacts.len()])
        };
        let instants: Vec<DiskInstant> = trajectory
            .samples
            .iter()
            .map(|sample| DiskInstant {
                time: sample.time,
                positions: sample.state.positions.clone(),
                velocities: sample.state.velocities.clone(),
                slider_forces: sample.state.slider_forces.clone(),
                contacts: sample.contacts.clone(),
                ledger: sample.ledger,
            })
            .collect();
        let sound = !instants.is_empty() && instants.iter().all(fits);
        Ok(sound.then(|| Self { blades: disk.sectors, elements: chain.jenkins().to_vec(), instants }))
    }

    /// Number of blades.
    #[must_use]
    pub fn blades(&self) -> usize {
        self.blades
    }

    /// The friction contacts.
    #[must_use]
    pub fn elements(&self) -> &[JenkinsElement] {
        &self.elements
    }

    /// All samples in order of time.
    #[must_use]
    pub fn instants(&self) -> &[DiskInstant] {
        &self.instants
    }

    #[must_use]
    pub fn end(&self) -> f64 {
        self.instants.last().map_or(0.0, |instant| instant.time)
    }

    /// The samples before and after `time`; one of them alone outside of the motion.
    fn around(&self, time: f64) -> (&DiskInstant, Option<&DiskInstant>) {
        let after = self.instants.partition_point(|instant| instant.time <= time);
        match (after.checked_sub(1).map(|before| &self.instants[before]), self.instants.get(after)) {
            (Some(left), right) => (left, right),
            (None, _) => (&self.instants[0], None),
        }
    }

    /// The instant at `time`, held fixed before the first and after the last sample.
    #[must_use]
    pub fn at(&self, time: f64) -> DiskInstant {
        let (left, right) = self.around(time);
        let Some(right) = right else { return left.clone() };
        let s = (time - left.time) / (right.time - left.time);
        let mix = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + s * (b - a)).collect();
        DiskInstant {
            time,
            positions: (0..left.positions.len()).map(|i| between(left, right, i, s)).collect(),
            velocities: mix(&left.velocities, &right.velocities),
            slider_forces: mix(&left.slider_forces, &right.slider_forces),
            contacts: left.contacts.clone(),
            ledger: ledger_between(&left.ledger, &right.ledger, s),
        }
    }

    /// Position of one oscillator at `time`.
    #[must_use]
    pub fn position(&self, time: f64, oscillator: usize) -> f64 {
        let (left, right) = self.around(time);
        match right {
            Some(right) => between(left, right, oscillator, (time - left.time) / (right.time - left.time)),
            None => left.positions[oscillator],
        }
    }

    /// Samples in `from..=to`, at most about `most`, evenly thinned out by their index so that the same ones are taken in every frame.
    pub fn between(&self, from: f64, to: f64, most: usize) -> impl Iterator<Item = &DiskInstant> {
        let first = self.instants.partition_point(|instant| instant.time < from);
        let end = self.instants.partition_point(|instant| instant.time <= to).max(first);
        let stride = (end - first).div_ceil(most.max(1)).max(1);
        (first.next_multiple_of(stride)..end).step_by(stride).map(|index| &self.instants[index])
    }

    /// Which contacts slipped from the first to the last sample in `from..=to`, seen by the place at which a contact carries no force,
    ///
    /// ```text
    /// u - F/k
    /// ```
    ///
    /// which slip alone moves: slips shorter than the time between two samples count too.
    #[must_use]
    pub fn slipped(&self, from: f64, to: f64) -> Vec<bool> {
        // Samples alone: between them force and place are interpolated differently, which looks like slip.
        let instants: Vec<&DiskInstant> = self.between(from, to, usize::MAX).collect();
        // Largest less smallest: as much for slow slip in many samples as for fast slip between two.
        let moved = |(number, element): (usize, &JenkinsElement)| {
            let reach = element.slip_force / element.stiffness;
            let rest = |i: &DiskInstant| element.attachment.elongation(&i.positions) - reach * i.slider_forces[number];
            let ends = |ends: [f64; 2], x: f64| [ends[0].min(x), ends[1].max(x)];
            let [least, most] = instants.iter().map(|i| rest(i)).fold([f64::INFINITY, f64::NEG_INFINITY], ends);
            most - least > LEAST_SLIP * reach
        };
        self.elements.iter().enumerate().map(moved).collect()
    }

    /// Largest deflection of a blade over the whole motion.
    #[must_use]
    pub fn largest_deflection(&self) -> f64 {
        let blades = self.instants.iter().flat_map(|instant| &instant.positions[..self.blades]);
        blades.fold(0.0, |largest, x| largest.max(x.abs()))
    }

    /// The angular frequency at which the waves are seen, `sqrt(sum v^2/sum x^2)` over all blades and samples: that of a harmonic motion,
    /// 1 for a disk that does not move.
    #[must_use]
    pub fn angular_frequency(&self) -> f64 {
        let sum = |of: fn(&DiskInstant) -> &[f64]| -> f64 {
            self.instants.iter().flat_map(|i| &of(i)[..self.blades]).map(|value| value * value).sum()
        };
        let (x, v) = (sum(|i| &i.positions), sum(|i| &i.velocities));
        if x > 0.0 && v > 0.0 { (v / x).sqrt() } else { 1.0 }
    }
}

fn between(left: &DiskInstant, right: &DiskInstant, i: usize, s: f64) -> f64 {
    let (h, r) = (right.time - left.time, 1.0 - s);
    let from = (1.0 + 2.0 * s) * left.positions[i] + s * h * left.velocities[i];
    let to = (3.0 - 2.0 * s) * right.positions[i] - r * h * right.velocities[i];
    r * r * from + s * s * to
}
