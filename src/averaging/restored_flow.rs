//! The slow flow as one of the solvers: states of the rig in, states of the rig out.
//!
//! An initial state becomes slow amplitudes by `A_j = x_j - i v_j/w`, with w from the energy of these amplitudes: the inverse of (4)-(5),
//! so that a motion may be cut anywhere and continued.

use super::describing::DescribingFunction;
use super::error::AveragingError;
use super::fixed_points::fixed_point;
use super::motion::{SlowMotion, SlowState};
use super::slow_flow::SlowFlow;
use super::torus::carried;
use crate::dynamics::{DenseFlow, Flow, Motion, Outcome, Sample, Sampling, State, StateError, TangentFlow, Trajectory};
use crate::model::{EnergyLedger, OscillatorChain, RigParameters, TwoMassRig, Works};
use nalgebra::{Complex, DMatrix, DVector, Vector3};

/// Samples beyond which a sampling is refused.
const MOST_SAMPLES: f64 = 1e8;
/// Longest time over which the averaged power is taken by one Simpson rule.
const POWER_STEP: f64 = 1.0;

/// The slow flow with the fast oscillation restored.
#[derive(Debug, Clone)]
pub struct RestoredSlowFlow {
    slow: SlowFlow,
    chain: OscillatorChain,
    amplitude_bound: f64,
}

impl RestoredSlowFlow {
    /// # Errors
    /// [`AveragingError::Parameter`].
    pub fn new(slow: SlowFlow) -> Result<Self, AveragingError> {
        let chain = TwoMassRig::new(slow.parameters())?.chain().clone();
        let amplitude_bound = known_amplitude(&slow);
        Ok(Self { slow, chain, amplitude_bound })
    }

    /// Motions of larger amplitude count as diverged; at most, and by default, the amplitude up to which w(E) is known for all motions:
    /// about 20 for the nominal set.
    ///
    /// # Errors
    /// [`AveragingError::OutOfRange`] unless the bound is greater than 0.
    pub fn with_amplitude_bound(self, bound: f64) -> Result<Self, AveragingError> {
        if bound > 0.0 {
            return Ok(Self { amplitude_bound: bound.min(known_amplitude(&self.slow)), ..self });
        }
        Err(AveragingError::OutOfRange { field: "amplitude_bound", found: bound, allowed: "greater than 0" })
    }

    #[must_use]
    pub fn slow(&self) -> &SlowFlow {
        &self.slow
    }

    #[must_use]
    pub fn amplitude_bound(&self) -> f64 {
        self.amplitude_bound
    }

    /// The slow amplitudes of a state of the rig, at phase 0; its slider force is of no effect.
    ///
    /// # Errors
    /// [`AveragingError::State`], and [`AveragingError::StartsBeyondBound`].
    pub fn slow_state(&self, state: &State) -> Result<SlowState, AveragingError> {
        let state = state.clone().validated(&self.chain)?;
        let mut y = [0.0; 5];
        y.iter_mut().zip(state.components()).for_each(|(y, component)| *y = component);
        let [x1, x2, v1, v2, _] = y;
        let amplitudes = |w: f64| [Complex::new(x1, -v1 / w), Complex::new(x2, -v2 / w)];
        let (slowest, _) = self.slow.frequency().frequency_range();
        let largest = amplitudes(slowest).map(|a| a.norm());
        for (field, found) in [("A1", largest[0]), ("A2", largest[1])] {
            if found > self.amplitude_bound {
                return Err(AveragingError::StartsBeyondBound { field, found, bound: self.amplitude_bound });
            }
        }
        // The slope of the energy is left out: plain iteration, which contracts since w(E) is flat, inside the bracket of the solver.
        let (w, _) = self.slow.frequency().solve(|w| {
            let slow = SlowState { amplitudes: amplitudes(w), phase: 0.0 }.reduced();
            let energy = self.slow.energy(&DescribingFunction::at(slow[0]), [slow[1], slow[2]]);
            (energy.at_frequency(w), 0.0)
        });
        Ok(SlowState { amplitudes: amplitudes(w), phase: 0.0 })
    }

    /// The state on the slow flow's limit cycle at a reversal of mass 1 from its positive side.
    ///
    /// # Errors
    /// [`AveragingError::NoLimitCycle`] where there is none before the fold, and [`AveragingError::NoConvergence`].
    pub fn limit_cycle(&self) -> Result<State, AveragingError> {
        let point = fixed_point(&self.slow)?;
        let [a, re, im] = point.state.into();
        Ok(State::two_mass([a, re, 0.0, -point.angular_frequency * im, a.min(1.0)]))
    }

    fn sampled(&self, motion: &SlowMotion, sampling: Sampling) -> Result<Trajectory, AveragingError> {
        let last = match motion.outcome() {
            Outcome::Completed => f64::INFINITY,
            Outcome::Diverged { time, .. } => time,
        };
        let (mut samples, mut works, mut counted) = (Vec::new(), Works::default(), 0.0);
        let mut stored_at_start = None;
        for time in sampling.times().take_while(|time| *time < last) {
            let state = motion.state(time)?;
            works += averaged_works(motion, counted, time);
            counted = time;
            let stored = self.chain.stored_energy(&state.positions, &state.velocities, &state.slider_forces);
            let stored_at_start = *stored_at_start.get_or_insert(stored);
            let ledger = EnergyLedger { stored, stored_at_start, works };
            samples.push(Sample { time, state, contacts: vec![motion.contact(time)?], ledger });
        }
        Ok(Trajectory { samples, events: motion.events().to_vec(), outcome: motion.outcome() })
    }
}

/// Amplitude up to which no motion has an energy beyond w(E): `E <= (1 + 2 k + w^2) a^2/2` for amplitudes up to a, because the Jenkins
/// spring holds no more than a linear one and `1 + 2 k` is the largest eigenvalue of the sticking stiffness.
fn known_amplitude(slow: &SlowFlow) -> f64 {
    let (_, w) = slow.frequency().frequency_range();
    (2.0 * slow.frequency().largest_energy() / (1.0 + 2.0 * slow.parameters().kappa + w * w)).sqrt()
}

/// Works of the averaged power by Simpson's rule. The stored energy is that of the restored motion, so the residual of the ledger is the
/// ripple of the energy within a cycle plus what averaging gets wrong.
fn averaged_works(motion: &SlowMotion, from: f64, to: f64) -> Works {
    let pieces = ((to - from) / POWER_STEP).ceil().max(1.0);
    let width = (to - from) / pieces;
    let mut sums = [0.0; 3];
    for n in 0..pieces as usize {
        let start = from + n as f64 * width;
        let powers = [start, start + 0.5 * width, start + width].map(|time| motion.power(time));
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum += width / 6.0 * (powers[0][i] + 4.0 * powers[1][i] + powers[2][i]);
        }
    }
    let [damping, self_excitation, friction] = sums;
    Works { damping, self_excitation, friction, ..Works::default() }
}

fn check(field: &'static str, found: f64, holds: bool, allowed: &'static str) -> Result<(), AveragingError> {
    if found.is_finite() && holds { Ok(()) } else { Err(AveragingError::OutOfRange { field, found, allowed }) }
}

impl Flow for RestoredSlowFlow {
    type Error = AveragingError;

    fn name(&self) -> String {
        "slow-flow".to_owned()
    }

    fn trajectory(&self, initial: &State, sampling: Sampling) -> Result<Trajectory, AveragingError> {
        let Sampling { interval, t_end } = sampling;
        check("sampling.interval", interval, interval > 0.0, "finite and greater than 0")?;
        check("sampling.t_end", t_end, t_end / interval <= MOST_SAMPLES, "at most 1e8 intervals")?;
        self.sampled(&self.motion(initial, t_end)?, sampling)
    }
}

impl DenseFlow for RestoredSlowFlow {
    type Motion = SlowMotion;

    fn motion(&self, initial: &State, t_end: f64) -> Result<SlowMotion, AveragingError> {
        check("t_end", t_end, t_end >= 0.0, "finite and not negative")?;
        SlowMotion::follow(&self.slow, self.slow_state(initial)?, t_end, self.amplitude_bound)
    }
}

/// The reduced slow flow, with states `(a1, Re B, Im B)`, a1 > 0: Lyapunov exponents and multipliers of the slow motion.
impl TangentFlow for SlowFlow {
    type Error = AveragingError;

    fn dimension(&self) -> usize {
        3
    }

    fn carry(
        &self,
        state: &mut DVector<f64>,
        tangents: &mut DMatrix<f64>,
        duration: f64,
    ) -> Result<Outcome, AveragingError> {
        check("duration", duration, duration >= 0.0, "finite and not negative")?;
        if tangents.nrows() != 3 {
            return Err(wrong_length("tangents", tangents.nrows()));
        }
        match carried(self, reduced(state)?, duration) {
            Ok(found) => {
                state.copy_from(&found.end);
                let columns = DMatrix::from_fn(3, 3, |i, j| found.monodromy[(i, j)]);
                *tangents = columns * &*tangents;
                Ok(Outcome::Completed)
            }
            Err(AveragingError::Left { time, .. }) => Ok(Outcome::Diverged { time, bound: known_amplitude(self) }),
            Err(error) => Err(error),
        }
    }

    fn vector_field(&self, state: &DVector<f64>) -> Result<DVector<f64>, AveragingError> {
        Ok(DVector::from_column_slice(self.slow_rate(&reduced(state)?).rate.as_slice()))
    }
}

fn wrong_length(field: &'static str, found: usize) -> AveragingError {
    StateError::WrongLength { field, found, expected: 3, per: "slow state variable" }.into()
}

fn reduced(state: &DVector<f64>) -> Result<Vector3<f64>, AveragingError> {
    let [a, re, im] = state.as_slice() else { return Err(wrong_length("state", state.len())) };
    check("a1", *a, *a > 0.0, "finite and greater than 0")?;
    Ok(Vector3::new(*a, *re, *im))
}

impl RestoredSlowFlow {
    /// The flow for one parameter set from a w(E) of the same xi2, kappa and gamma.
    ///
    /// # Errors
    /// As [`SlowFlow::new`].
    pub fn at(
        parameters: RigParameters,
        frequency: &std::sync::Arc<super::EnergyFrequency>,
    ) -> Result<Self, AveragingError> {
        Self::new(SlowFlow::new(parameters, std::sync::Arc::clone(frequency))?)
    }
}
