//! The slow flow of a chain in time: Dormand and Prince's method of order 8(5,3) with its dense output (crate `ode_solvers`).
//!
//! The field is continuous; its derivative jumps where an elongation passes its slip limit. Steps are not cut there, as the two-mass flow
//! does: with many contacts there are many such places, and the step control shortens the few steps that notice.

use super::chain_flow::{ChainSlowArrival, ChainSlowFlow, ChainSlowState};
use super::error::AveragingError;
use crate::dynamics::{Outcome, Sampling};
use crate::model::Range;
use nalgebra::Complex;
use ode_solvers::dop_shared::IntegrationError;
use ode_solvers::{DVector, Dop853, OutputType, System};

/// Far below what averaging leaves out.
const TOLERANCE: f64 = 1e-9;
const MOST_STEPS: u32 = 10_000_000;
/// Samples kept at a time.
const CHUNK: usize = 1000;

/// `(Re z_0, Im z_0, Re z_1, ..., phi)`.
type Vector = DVector<f64>;

struct Field<'a> {
    flow: &'a ChainSlowFlow,
    z: Vec<Complex<f64>>,
    rates: Vec<Complex<f64>>,
    beyond: Option<f64>,
    /// Set where there is no mean frequency; the motion stands still from there until the step is over.
    lost: bool,
}

impl<'a> Field<'a> {
    fn new(flow: &'a ChainSlowFlow) -> Self {
        let n = flow.oscillators();
        Self { flow, z: vec![Complex::ZERO; n], rates: vec![Complex::ZERO; n], beyond: None, lost: false }
    }
}

/// The solver takes the field by value and hands it a shared reference.
struct Shared<'b, 'a>(&'b std::cell::RefCell<Field<'a>>);

impl System<f64, Vector> for Shared<'_, '_> {
    fn system(&self, _time: f64, y: &Vector, rate: &mut Vector) {
        let field = &mut *self.0.borrow_mut();
        for (z, pair) in field.z.iter_mut().zip(y.as_slice().chunks_exact(2)) {
            *z = Complex::new(pair[0], pair[1]);
        }
        let Some(w) = field.flow.rates(&field.z, &mut field.rates) else {
            field.lost = true;
            rate.fill(0.0);
            return;
        };
        for (rate, pair) in field.rates.iter().zip(rate.as_mut_slice().chunks_exact_mut(2)) {
            (pair[0], pair[1]) = (rate.re, rate.im);
        }
        let last = rate.len() - 1;
        rate[last] = w;
    }

    fn solout(&mut self, time: f64, y: &Vector, _rate: &Vector) -> bool {
        let mut field = self.0.borrow_mut();
        let bound = field.flow.amplitude_bound;
        let out = y.as_slice().chunks_exact(2).any(|pair| pair[0].hypot(pair[1]) > bound);
        if out {
            field.beyond = Some(time);
        }
        out || field.lost
    }
}

impl ChainSlowFlow {
    /// Follows the averaged motion from `start` at time 0 and shows it at the times of `sampling`, up to divergence.
    ///
    /// # Errors
    /// [`AveragingError::Parameter`] for samplings that cannot be used and a start of another length, [`AveragingError::NoCarrier`] where there is
    /// no mean frequency, [`AveragingError::Integration`].
    pub fn follow(
        &self,
        start: &ChainSlowState,
        sampling: Sampling,
        mut see: impl FnMut(f64, &ChainSlowState),
    ) -> Result<ChainSlowArrival, AveragingError> {
        Range::Positive.check("sampling.interval", sampling.interval)?;
        Range::NonNegative.check("sampling.t_end", sampling.t_end)?;
        self.check_start(start)?;
        let mut arrival =
            ChainSlowArrival { state: start.clone(), outcome: Outcome::Completed, steps: 0, evaluations: 0 };
        let times: Vec<f64> = sampling.times().collect();
        see(0.0, start);
        // The last sample may be nearer than an interval: a stretch of its own.
        let (even, last) = times.split_at(times.len() - 1);
        let mut known = 0;
        while known + 1 < even.len() && arrival.outcome == Outcome::Completed {
            let count = CHUNK.min(even.len() - 1 - known);
            self.stretch(&mut arrival, even[known], sampling.interval, count, |k, state| see(even[known + k], state))?;
            known += count;
        }
        let rest = last[0] - even.last().copied().unwrap_or(0.0);
        if rest > 0.0 && arrival.outcome == Outcome::Completed {
            let from = last[0] - rest;
            self.stretch(&mut arrival, from, rest, 1, |_, state| see(last[0], state))?;
        }
        Ok(arrival)
    }

    fn check_start(&self, start: &ChainSlowState) -> Result<(), AveragingError> {
        let (found, expected) = (start.amplitudes.len(), self.oscillators());
        if found != expected {
            let field = "amplitudes";
            return Err(crate::dynamics::StateError::WrongLength { field, found, expected, per: "oscillator" }.into());
        }
        self.frequency(&start.amplitudes).map(|_| ()).ok_or(AveragingError::NoCarrier { time: 0.0 })
    }

    /// `count` intervals on from the arrival, at time `from`; `see` hears of the end of each, numbered from 1.
    fn stretch(
        &self,
        arrival: &mut ChainSlowArrival,
        from: f64,
        interval: f64,
        count: usize,
        mut see: impl FnMut(usize, &ChainSlowState),
    ) -> Result<(), AveragingError> {
        let field = std::cell::RefCell::new(Field::new(self));
        let y = Vector::from_iterator(
            2 * self.oscillators() + 1,
            arrival.state.amplitudes.iter().flat_map(|z| [z.re, z.im]).chain([arrival.state.phase]),
        );
        // A little beyond the last sample: where a sample falls on the end, the solver extrapolates to it from a step before.
        let end = interval * count as f64 + 0.25 * interval.min(1.0);
        // Defaults of the method; the field is not stiff, so that its test for stiffness is put off for good.
        let mut solver = Dop853::from_param(
            Shared(&field),
            0.0,
            end,
            interval,
            y,
            TOLERANCE,
            TOLERANCE,
            0.9,
            0.0,
            0.333,
            6.0,
            end,
            0.0,
            MOST_STEPS,
            MOST_STEPS,
            OutputType::Dense,
        );
        let stats = solver.integrate().map_err(|error| self.failure(from, &error))?;
        arrival.steps += stats.accepted_steps as usize;
        arrival.evaluations += stats.num_eval as usize;
        let states: Vec<ChainSlowState> = solver.y_out().iter().map(slow_state).collect();
        if field.borrow().lost {
            return Err(AveragingError::NoCarrier { time: from });
        }
        if let Some(time) = field.borrow().beyond {
            arrival.outcome = Outcome::Diverged { time: from + time, bound: self.amplitude_bound };
        } else if states.len() != count + 1 {
            let reason = format!("{} of {} samples came back", states.len(), count + 1);
            return Err(AveragingError::Integration { time: from, reason });
        }
        for (k, state) in states.iter().enumerate().skip(1).take(count) {
            see(k, state);
        }
        if let Some(last) = states.into_iter().next_back() {
            arrival.state = last;
        }
        Ok(())
    }

    fn failure(&self, from: f64, error: &IntegrationError) -> AveragingError {
        let (IntegrationError::MaxNumStepReached { x, .. }
        | IntegrationError::StepSizeUnderflow { x }
        | IntegrationError::StiffnessDetected { x }) = error;
        AveragingError::Integration { time: from + x, reason: error.to_string() }
    }
}

fn slow_state(y: &Vector) -> ChainSlowState {
    let n = y.len() - 1;
    ChainSlowState {
        amplitudes: y.as_slice()[..n].chunks_exact(2).map(|pair| Complex::new(pair[0], pair[1])).collect(),
        phase: y[n],
    }
}
