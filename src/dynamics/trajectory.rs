//! What every solver returns: samples at `n dt`, the events between them, and how the motion ended.

use super::state::State;
use crate::model::{ContactState, EnergyLedger};
use serde::{Deserialize, Serialize};

/// When to sample: at `n * interval` up to `t_end`, and at `t_end`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sampling {
    pub interval: f64,
    pub t_end: f64,
}

impl Sampling {
    /// Sample times, computed as `n * interval`, never accumulated. A sample that would fall within a millionth of an interval
    /// of `t_end` is the one at `t_end`.
    pub fn times(self) -> impl Iterator<Item = f64> {
        // Time 0 is always a sample, however long the interval.
        let whole = (self.t_end / self.interval - 1e-6).ceil().max(if self.t_end > 0.0 { 1.0 } else { 0.0 }) as u64;
        (0..whole).map(move |n| n as f64 * self.interval).chain(std::iter::once(self.t_end))
    }
}

/// The state at one time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    pub time: f64,
    pub state: State,
    /// Contact state of each element just after `time`.
    pub contacts: Vec<ContactState>,
    pub ledger: EnergyLedger,
}

/// What happened to a Jenkins element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EventKind {
    StickToSlip,
    SlipToStick,
    /// The slider force touched the slip force without exceeding it: nothing changes.
    Grazing,
}

/// A change of contact state. The state is continuous through it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    pub time: f64,
    /// Index of the Jenkins element.
    pub element: usize,
    pub kind: EventKind,
    pub state: State,
}

/// How a trajectory ended.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// The end of the time span was reached.
    Completed,
    /// Some |x| exceeded `bound` by `time`; samples end before it.
    Diverged { time: f64, bound: f64 },
}

/// A sampled motion with its events in order of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trajectory {
    pub samples: Vec<Sample>,
    pub events: Vec<Event>,
    pub outcome: Outcome,
}

impl Trajectory {
    #[must_use]
    pub fn diverged(&self) -> bool {
        matches!(self.outcome, Outcome::Diverged { .. })
    }

    /// Number of changes of contact state, grazing not counted.
    #[must_use]
    pub fn switches(&self) -> usize {
        self.events.iter().filter(|event| event.kind != EventKind::Grazing).count()
    }

    /// The last sample; `None` only for an empty trajectory, which no solver returns.
    #[must_use]
    pub fn last(&self) -> Option<&Sample> {
        self.samples.last()
    }

    /// Largest |energy residual| over all samples.
    #[must_use]
    pub fn energy_residual(&self) -> f64 {
        self.samples.iter().map(|sample| sample.ledger.residual().abs()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sample_times_end_exactly_at_the_end() {
        let times = |interval, t_end| Sampling { interval, t_end }.times().collect::<Vec<_>>();
        assert_eq!(times(0.5, 2.0), [0.0, 0.5, 1.0, 1.5, 2.0]);
        assert_eq!(times(0.75, 2.0), [0.0, 0.75, 1.5, 2.0]);
        // 0.1 * 3 exceeds 0.3 by rounding: still one sample there.
        assert_eq!(times(0.1, 0.3).len(), 4);
        assert_eq!(times(1.0, 0.0), [0.0]);
        assert_eq!(times(1e10, 5.0), [0.0, 5.0]);
    }
}
