//! Dense output for flows that only give samples.
//!
//! Between two samples at times `t_n` and `t_n + h` the positions are the cubic that has the positions and velocities of both (error
//! `h^4 |x''''|/384`), the velocities its derivative, and the slider forces lie on a straight line. An element that switches between two
//! samples makes `x'''` jump there; then the positions are off by `O(h^3)` and the slider force by up to `h |v|/4`.

use super::flow::Flow;
use super::motion::{DenseFlow, Motion};
use super::state::State;
use super::trajectory::{Event, Outcome, Sampling, Trajectory};
use crate::model::{ParameterError, Range};
use thiserror::Error;

#[derive(Debug, Error)]
pub enum SampledError<E: std::error::Error> {
    #[error(transparent)]
    Flow(E),
    #[error("time {time} is not part of the motion, which is known from 0 to {end}")]
    OutsideMotion { time: f64, end: f64 },
}

/// A flow with the dense output that its samples allow.
#[derive(Debug, Clone)]
pub struct Sampled<F> {
    flow: F,
    interval: f64,
}

impl<F: Flow> Sampled<F> {
    /// With a sample every `interval`; where the flow takes steps, best a multiple of its step.
    ///
    /// # Errors
    /// [`ParameterError::OutOfRange`] unless the interval is finite and positive.
    pub fn new(flow: F, interval: f64) -> Result<Self, ParameterError> {
        Ok(Self { flow, interval: Range::Positive.check("interval", interval)? })
    }
}

impl<F: Flow> Flow for Sampled<F> {
    type Error = SampledError<F::Error>;

    fn name(&self) -> String {
        self.flow.name()
    }

    fn trajectory(&self, initial: &State, sampling: Sampling) -> Result<Trajectory, Self::Error> {
        self.flow.trajectory(initial, sampling).map_err(SampledError::Flow)
    }
}

impl<F: Flow> DenseFlow for Sampled<F> {
    type Motion = SampledMotion<F::Error>;

    fn motion(&self, initial: &State, t_end: f64) -> Result<Self::Motion, Self::Error> {
        let sampling = Sampling { interval: self.interval, t_end };
        Ok(SampledMotion::new(self.trajectory(initial, sampling)?, self.interval))
    }

    /// Whoever takes steps may remember more than the state between them.
    fn restarts_exactly(&self) -> bool {
        false
    }
}

/// A sampled trajectory, interpolated.
#[derive(Debug, Clone)]
pub struct SampledMotion<E> {
    trajectory: Trajectory,
    interval: f64,
    error: std::marker::PhantomData<fn() -> E>,
}

impl<E: std::error::Error> SampledMotion<E> {
    fn new(trajectory: Trajectory, interval: f64) -> Self {
        Self { trajectory, interval, error: std::marker::PhantomData }
    }

    fn last_time(&self) -> f64 {
        self.trajectory.last().map_or(0.0, |sample| sample.time)
    }
}

impl<E: std::error::Error + Send + Sync + 'static> Motion for SampledMotion<E> {
    type Error = SampledError<E>;

    fn end(&self) -> f64 {
        self.last_time()
    }

    fn outcome(&self) -> Outcome {
        self.trajectory.outcome
    }

    fn events(&self) -> &[Event] {
        &self.trajectory.events
    }

    fn state(&self, time: f64) -> Result<State, Self::Error> {
        let outside = || SampledError::OutsideMotion { time, end: self.last_time() };
        if !(0.0..=self.last_time()).contains(&time) {
            return Err(outside());
        }
        let samples = &self.trajectory.samples;
        // Samples lie at multiples of the interval, but for the last one; rounding may put the time one cell off.
        let mut n = ((time / self.interval) as usize).min(samples.len().saturating_sub(1));
        while n > 0 && samples[n].time > time {
            n -= 1;
        }
        let from = samples.get(n).ok_or_else(outside)?;
        let Some(to) = samples.get(n + 1) else { return Ok(from.state.clone()) };
        Ok(between(&from.state, &to.state, to.time - from.time, (time - from.time) / (to.time - from.time)))
    }
}

/// The state at the fraction `s` of the way between two states `h` apart.
fn between(from: &State, to: &State, h: f64, s: f64) -> State {
    let cubic = |i: usize| {
        let (x, y, v, w) = (from.positions[i], to.positions[i], h * from.velocities[i], h * to.velocities[i]);
        // x + v s + b s^2 + c s^3
        let (b, c) = (3.0 * (y - x) - 2.0 * v - w, 2.0 * (x - y) + v + w);
        (x + s * (v + s * (b + s * c)), (v + s * (2.0 * b + s * 3.0 * c)) / h)
    };
    let (positions, velocities) = (0..from.positions.len()).map(cubic).unzip();
    let straight = |(a, b): (&f64, &f64)| a + s * (b - a);
    let slider_forces = from.slider_forces.iter().zip(&to.slider_forces).map(straight).collect();
    State { positions, velocities, slider_forces }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_motion_is_reproduced() {
        let x = |t: f64| 1.0 + t * (0.5 - t * (0.25 - 0.125 * t));
        let v = |t: f64| 0.5 - 0.5 * t + 0.375 * t * t;
        let at = |t: f64| State { positions: vec![x(t)], velocities: vec![v(t)], slider_forces: vec![0.1 * t] };
        let found = between(&at(1.0), &at(1.5), 0.5, 0.3);
        // A few roundings of numbers of order 1, divided by h in the velocity.
        assert!(found.max_difference(&at(1.15)) < 4e-15, "{found:?}");
    }
}
