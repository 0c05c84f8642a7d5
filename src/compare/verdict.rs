//! The agreement of two motions, check by check.

use super::CompareError;
use super::cycles::Cycles;
use super::distance::{common_samples, max_state_error};
use super::tolerance::{Expectation, Motion, Tolerances};
use crate::dynamics::{Flow, Sampling, State, Trajectory};
use serde::Serialize;

/// One thing that was checked.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    pub name: &'static str,
    pub found: f64,
    pub tolerance: f64,
    /// Why the tolerance is what it is.
    pub reason: String,
    pub passed: bool,
}

impl Check {
    /// Passes if `found` is at most `tolerance`; NaN never passes.
    #[must_use]
    pub fn at_most(name: &'static str, found: f64, tolerance: f64, reason: impl Into<String>) -> Self {
        Self { name, found, tolerance, reason: reason.into(), passed: found <= tolerance }
    }
}

/// How far two motions agree.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Agreement {
    /// Time up to which states were compared, unless a motion diverged before.
    pub horizon: f64,
    pub max_state_error: f64,
    /// Of the maxima of x_1 over the whole record; none where a motion has no maximum.
    pub amplitude_error: Option<f64>,
    /// Of the angular frequency over the whole record; none where a motion has fewer than two upward zeros.
    pub frequency_error: Option<f64>,
    /// Largest energy residual of the tested motion.
    pub energy_residual: f64,
    /// All checks passed.
    pub passed: bool,
    pub checks: Vec<Check>,
}

/// Compares a tested motion with the reference.
///
/// # Errors
/// [`CompareError`] if the motions do not share their sample times, or numbers of the expectation are out of range. Disagreement is
/// not an error: it is an [`Agreement`] that did not pass.
pub fn compare(reference: &Trajectory, tested: &Trajectory, expected: &Expectation) -> Result<Agreement, CompareError> {
    let expected = expected.validated()?;
    let pairs = common_samples(reference, tested)?;
    let last = pairs.last().map_or(0.0, |(a, _)| a.time);
    let scale = pairs.iter().flat_map(|(a, _)| a.state.components()).fold(0.0, |s: f64, y| s.max(y.abs()));
    let tolerances = Tolerances::of(&expected, scale, last);
    let state = max_state_error(reference, tested, expected.horizon)?;
    let energy = tested.energy_residual();
    let contacts = pairs.first().map_or(1, |(a, _)| a.contacts.len().max(1)) as f64;
    let amplitude = amplitude(reference, tested, expected.motion, tolerances);
    let frequency = frequency(reference, tested, expected.motion, tolerances);

    let mut checks = vec![
        Check::at_most("max_state_error", state, tolerances.state, STATE_REASON),
        Check::at_most("energy_residual", energy, contacts * tolerances.energy, ENERGY_REASON),
        outcomes(reference, tested),
    ];
    checks.extend(amplitude.clone());
    checks.extend(frequency.clone());
    if let Some([lateral, rotation]) = expected.joint_drift {
        checks.push(Check::at_most("lateral_drift", lateral, tolerances.joint_drift, DRIFT_REASON));
        checks.push(Check::at_most("rotation_drift", rotation, tolerances.joint_drift, DRIFT_REASON));
    }
    Ok(Agreement {
        horizon: expected.horizon,
        max_state_error: state,
        amplitude_error: amplitude.map(|check| check.found),
        frequency_error: frequency.map(|check| check.found),
        energy_residual: energy,
        passed: checks.iter().all(|check| check.passed),
        checks,
    })
}

/// Runs both flows from the same start and compares them.
///
/// # Errors
/// As [`compare`], and [`CompareError::Flow`] if a flow fails.
pub fn compare_flows<R: Flow, T: Flow>(
    reference: &R,
    tested: &T,
    initial: &State,
    sampling: Sampling,
    expected: &Expectation,
) -> Result<Agreement, CompareError> {
    compare(&run(reference, initial, sampling)?, &run(tested, initial, sampling)?, expected)
}

fn run<F: Flow>(flow: &F, initial: &State, sampling: Sampling) -> Result<Trajectory, CompareError> {
    flow.trajectory(initial, sampling)
        .map_err(|error| CompareError::Flow { flow: flow.name(), reason: error.to_string() })
}

const STATE_REASON: &str = "A h^2 (1 + t/12) exp(lambda t): phase error h^2/24 per unit of time and missed extremes of the elongation, times two, growing with the motion's own rate; at most 1 % of A";
const ENERGY_REASON: &str = "A^2 h^2 (1 + t/12) for each contact: friction over missed extremes, twice a period, and the error of the trapezoidal works, times two; at most 1 % of A^2";
const DRIFT_REASON: &str =
    "1e-6, 17 roundings of a unit length in f32: its effect on the motion, of second order, is beyond every digit";

fn outcomes(reference: &Trajectory, tested: &Trajectory) -> Check {
    let differ = reference.diverged() != tested.diverged();
    let found = f64::from(u8::from(differ));
    Check::at_most("outcome", found, 0.0, "both motions must stay bounded, or both diverge (0: same, 1: different)")
}

fn amplitude(reference: &Trajectory, tested: &Trajectory, motion: Motion, tolerances: Tolerances) -> Option<Check> {
    let (a, b) = (Cycles::of(reference, 0), Cycles::of(tested, 0));
    let name = "amplitude_error";
    match motion {
        Motion::Regular => {
            let reason = "maxima of x1 agree as well as the state does over the whole record";
            Some(Check::at_most(name, a.inner(reference).amplitude_error(&b)?, tolerances.amplitude, reason))
        }
        Motion::Chaotic => {
            let (s, t) = (a.standard_error_of_mean()?, b.standard_error_of_mean()?);
            let found = (a.mean_maximum()? - b.mean_maximum()?).abs();
            let reason = "mean maximum of x1 within three standard errors of the difference, by means over batches";
            Some(Check::at_most(name, found, 3.0 * s.hypot(t), reason))
        }
    }
}

fn frequency(reference: &Trajectory, tested: &Trajectory, motion: Motion, tolerances: Tolerances) -> Option<Check> {
    let (a, b) = (Cycles::of(reference, 0), Cycles::of(tested, 0));
    let name = "frequency_error";
    match motion {
        Motion::Regular => {
            let reason = "h^2/24 from the leapfrog and the state error at both ends of the record, times two";
            Some(Check::at_most(name, a.inner(reference).frequency_error(&b)?, tolerances.frequency, reason))
        }
        Motion::Chaotic => {
            let (s, t) = (a.standard_error_of_frequency()?, b.standard_error_of_frequency()?);
            let found = (a.angular_frequency()? - b.angular_frequency()?).abs();
            let reason = "within three standard errors of the difference, by means over batches";
            Some(Check::at_most(name, found, 3.0 * s.hypot(t), reason))
        }
    }
}
