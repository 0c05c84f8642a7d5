use crate::dynamics::StateError;
use crate::model::ParameterError;
use thiserror::Error;

/// Why a motion could not be computed in the engine.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EngineError {
    /// A setting, size or sampling outside its range.
    #[error("engine: {0}")]
    Parameter(#[from] ParameterError),
    /// An initial state that cannot start a motion.
    #[error("engine: initial state: {0}")]
    InitialState(#[from] StateError),
    /// A number that the chosen precision cannot hold.
    #[error("engine: {field} = {found} is not representable in {precision}: scale the rig, or choose double precision")]
    NotRepresentable { field: String, found: f64, precision: &'static str },
    /// An initial state that contradicts the prescribed motion.
    #[error(
        "engine: {field}[{index}] = {found}, expected {expected}: start with the prescribed motion, all else at rest"
    )]
    OffPrescribedMotion { field: &'static str, index: usize, found: f64, expected: f64 },
    /// Rapier did not take a multibody joint.
    #[error("engine: Rapier refused the multibody joint of oscillator {oscillator}: use impulse joints")]
    JointRefused { oscillator: usize },
    /// A mechanism that Rapier does not have on these joints.
    #[error(
        "engine: {mechanism} on {joints} joints is not available: {reason}. Choose other joints or another mechanism"
    )]
    Unavailable { mechanism: &'static str, joints: &'static str, reason: &'static str },
    /// A force law returned infinity or NaN.
    #[error(
        "engine: the force on oscillator {oscillator} at t = {time} is {found}, expected a finite number: reduce the step"
    )]
    ForceNotFinite { time: f64, oscillator: usize, found: f64 },
    /// Rapier found a body that is no longer finite, rolled it back and disabled it.
    #[error(
        "engine: Rapier quarantined {found:?} at t = {time}, expected none: their state was no longer finite. Reduce the step or the stiffness"
    )]
    Quarantined { time: f64, found: Vec<String> },
    /// A position or velocity read back from Rapier is infinity or NaN.
    #[error(
        "engine: oscillator {oscillator} was at {found} at t = {time}, expected a finite number: reduce the step or the stiffness"
    )]
    MotionNotFinite { time: f64, oscillator: usize, found: f64 },
}
