//! Turns the instants of a run into a [`Recording`]: samples, events, ledger, drift, and the engine's own poses.

use super::events;
use super::geometry::{BodyPose, JointDrift};
use super::instant::Instant;
use super::plant::Plant;
use super::work::WorkMeter;
use crate::dynamics::{Event, Outcome, Sample, Sampling, State, Trajectory};
use crate::model::{EnergyLedger, OscillatorChain, Works};
use std::iter::Peekable;

/// A motion in the engine, with what only an engine has.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    pub trajectory: Trajectory,
    /// Poses of all bodies at each sample, rail (hub) first, then in the order of oscillators. Between steps the pose at the end of the step,
    /// moved along the joint to the sample's position.
    pub poses: Vec<Vec<BodyPose>>,
    /// Over all steps.
    pub drift: JointDrift,
    /// Number of steps taken.
    pub steps: u64,
}

/// Whether poses are kept: they take more room than the samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Poses {
    Keep,
    Drop,
}

pub(super) struct Recorder<'a> {
    chain: &'a OscillatorChain,
    meter: WorkMeter,
    works: Works,
    stored_at_start: f64,
    times: Peekable<Box<dyn Iterator<Item = f64>>>,
    samples: Vec<Sample>,
    events: Vec<Event>,
    keep: Poses,
    poses: Vec<Vec<BodyPose>>,
    drift: JointDrift,
    steps: u64,
}

/// A sample time this close to a grid time, in steps, is that grid time: room for the rounding of `n * interval / step`.
pub(super) const SAME_TIME: f64 = 1e-6;

impl<'a> Recorder<'a> {
    pub fn new(
        chain: &'a OscillatorChain,
        sampling: Sampling,
        keep: Poses,
        start: &Instant,
        plant: &dyn Plant,
    ) -> Self {
        let times: Box<dyn Iterator<Item = f64>> = Box::new(sampling.times());
        let mut recorder = Self {
            chain,
            meter: WorkMeter::new(chain),
            works: Works::default(),
            stored_at_start: stored_energy(chain, &start.state),
            times: times.peekable(),
            samples: Vec::new(),
            events: Vec::new(),
            keep,
            poses: Vec::new(),
            drift: plant.drift(),
            steps: 0,
        };
        if let Some(time) = recorder.times.next() {
            recorder.sample(time, start, Works::default(), plant);
        }
        recorder
    }

    /// Takes in the step from one instant to the next.
    pub fn advance(&mut self, from: &Instant, to: &Instant, plant: &dyn Plant) {
        let step = to.time - from.time;
        while let Some(time) = self.times.next_if(|&time| time < to.time - SAME_TIME * step) {
            let between = from.towards(to, (time - from.time) / step, self.chain);
            let mut works = self.works;
            works += self.meter.between(from, &between);
            self.sample(time, &between, works, plant);
        }
        let works = self.meter.between(from, to);
        self.works += works;
        while let Some(time) = self.times.next_if(|&time| time <= to.time + SAME_TIME * step) {
            self.sample(time, to, self.works, plant);
        }
        events::find(self.chain, from, to, &mut self.events);
        self.drift = self.drift.or_larger(plant.drift());
        self.steps += 1;
    }

    pub fn finish(self, outcome: Outcome) -> Recording {
        let trajectory = Trajectory { samples: self.samples, events: self.events, outcome };
        Recording { trajectory, poses: self.poses, drift: self.drift, steps: self.steps }
    }

    fn sample(&mut self, time: f64, at: &Instant, works: Works, plant: &dyn Plant) {
        if self.keep == Poses::Keep {
            self.poses.push(plant.poses_at(&at.state.positions));
        }
        let ledger =
            EnergyLedger { stored: stored_energy(self.chain, &at.state), stored_at_start: self.stored_at_start, works };
        self.samples.push(Sample { time, state: at.state.clone(), contacts: at.contacts.clone(), ledger });
    }
}

fn stored_energy(chain: &OscillatorChain, state: &State) -> f64 {
    chain.stored_energy(&state.positions, &state.velocities, &state.slider_forces)
}
