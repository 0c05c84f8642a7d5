use super::energy::EnergyDefinition;
use crate::dynamics::StateError;
use crate::model::ParameterError;
use thiserror::Error;

/// What can go wrong in the slow flow. Slow states are `(a1, Re B, Im B)`.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AveragingError {
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error(transparent)]
    State(#[from] StateError),
    #[error("{field} = {found} is not allowed: it must be {allowed}")]
    OutOfRange { field: &'static str, found: f64, allowed: &'static str },
    #[error(
        "kappa = {kappa} is not allowed: without coupling there is no branch of limit cycles from which the frequency could be taken"
    )]
    NoCoupling { kappa: f64 },
    #[error(
        "the branch of limit cycles could not be followed beyond a1 = {amplitude}, w = {angular_frequency}, xi1 = {xi1}, energy {energy} (wanted: {wanted})"
    )]
    BranchLost { amplitude: f64, angular_frequency: f64, xi1: f64, energy: f64, wanted: f64 },
    #[error(
        "the energy ({definition:?}) falls from {from} to {to} along the branch of limit cycles at a1 = {amplitude}: the frequency is no function of it for these parameters"
    )]
    EnergyNotMonotone { definition: EnergyDefinition, from: f64, to: f64, amplitude: f64 },
    #[error("the frequency was asked for at energy {found}, but it is known up to {end}: it is never extrapolated")]
    BeyondEnergy { found: f64, end: f64 },
    #[error("there is no limit cycle at xi1 = {xi1} on the branch up to a1 = {amplitude}")]
    NoLimitCycle { xi1: f64, amplitude: f64 },
    #[error("Newton's method for {what} did not converge near {at:?}: residual {residual:e}")]
    NoConvergence { what: &'static str, at: Vec<f64>, residual: f64 },
    #[error(
        "the averaged motion has no mean frequency at time {time}: all oscillators rest, or their mean stiffness is not positive. Start with an amplitude, or give a carrier frequency"
    )]
    NoCarrier { time: f64 },
    #[error("the slow flow could not be integrated beyond time {time}: {reason}")]
    Integration { time: f64, reason: String },
    #[error("the slow motion from {from:?} leaves the energies up to {end} at time {time}")]
    Left { from: Vec<f64>, time: f64, end: f64 },
    #[error("the branch of slow limit cycles could not be followed beyond xi1 = {xi1}, period {period}: {reason}")]
    TorusLost { xi1: f64, period: f64, reason: String },
    #[error(
        "initial |{field}| = {found} lies beyond {bound}, up to which the frequency is known for all motions: start with smaller amplitudes"
    )]
    StartsBeyondBound { field: &'static str, found: f64, bound: f64 },
    #[error(
        "the motion was asked for at time {found}, but it is known from 0 to {end}: choose a time in that span or solve for longer"
    )]
    OutsideSpan { found: f64, end: f64 },
}
