//! What remains of a motion after its transient: the maxima of x1, its frequency, and the slow frequency of a torus.

use crate::compare::{Cycles, Maximum};
use crate::conformance::ConformanceError;
use crate::dynamics::Trajectory;
use std::f64::consts::TAU;

/// Invariants of a motion from some time on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Settled {
    pub mean: f64,
    pub largest: f64,
    pub smallest: f64,
    pub angular_frequency: f64,
    /// Of the modulation of the maxima; none without at least two of its periods.
    pub slow_frequency: Option<f64>,
    /// Standard errors of mean and angular frequency; none for short records.
    pub errors: Option<(f64, f64)>,
}

const FEWEST: usize = 5;

impl Settled {
    pub fn of(scenario: &'static str, trajectory: &Trajectory, from: f64) -> Result<Self, ConformanceError> {
        let all = Cycles::of(trajectory, 0);
        let cycles = Cycles {
            maxima: all.maxima.into_iter().filter(|maximum| maximum.time >= from).collect(),
            upward_zeros: all.upward_zeros.into_iter().filter(|time| *time >= from).collect(),
        };
        let found = cycles.maxima.len();
        let (Some(mean), Some(angular_frequency), true) =
            (cycles.mean_maximum(), cycles.angular_frequency(), found >= FEWEST)
        else {
            return Err(ConformanceError::TooFew { scenario, what: "maxima of x1", found, expected: FEWEST });
        };
        let values = || cycles.maxima.iter().map(|maximum| maximum.value);
        Ok(Self {
            mean,
            largest: values().fold(f64::NEG_INFINITY, f64::max),
            smallest: values().fold(f64::INFINITY, f64::min),
            angular_frequency,
            slow_frequency: slow_frequency(&cycles.maxima, mean),
            errors: cycles.standard_error_of_mean().zip(cycles.standard_error_of_frequency()),
        })
    }

    /// Zero on a limit cycle.
    pub fn spread(&self) -> f64 {
        self.largest - self.smallest
    }
}

/// From the times at which the maxima rise through their mean, interpolated.
fn slow_frequency(maxima: &[Maximum], mean: f64) -> Option<f64> {
    let rises: Vec<f64> = maxima
        .windows(2)
        .filter(|pair| pair[0].value < mean && pair[1].value >= mean)
        .map(|pair| {
            let part = (mean - pair[0].value) / (pair[1].value - pair[0].value);
            pair[0].time + part * (pair[1].time - pair[0].time)
        })
        .collect();
    match rises.as_slice() {
        [first, _, .., last] => Some(TAU * (rises.len() - 1) as f64 / (last - first)),
        _ => None,
    }
}
