//! What can go wrong before or while a chain is followed in closed form.

use crate::dynamics::StateError;
use crate::model::ParameterError;
use thiserror::Error;

#[derive(Debug, Clone, PartialEq, Error)]
pub enum ExactError {
    #[error(transparent)]
    State(#[from] StateError),
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error("{field} = {found} is not allowed: it must be {allowed}")]
    OutOfRange { field: &'static str, found: f64, allowed: &'static str },
    #[error(
        "sampling every {interval} to {t_end} gives {found:.0} samples, allowed are at most {allowed}: take a longer interval or a shorter span"
    )]
    TooManySamples { interval: f64, t_end: f64, found: f64, allowed: usize },
    #[error(
        "initial {field}[{index}] = {found} lies beyond {bound}: start within the amplitude bound, or raise it (`amplitude_bound`)"
    )]
    StartsBeyondBound { field: &'static str, index: usize, found: f64, bound: f64 },
    #[error("the motion leaves the amplitude bound {bound} at time {time}, before {asked}: ask for a shorter span")]
    Diverged { time: f64, bound: f64, asked: f64 },
    #[error(
        "by time {time} of {asked} the motion takes {found} pieces, more than fit into memory: shorten it, or take out rates that are far faster than the others"
    )]
    TooManyPieces { time: f64, asked: f64, found: usize },
    #[error("tangent vectors have {found} components, expected {expected}: one per state variable")]
    TangentLength { found: usize, expected: usize },
    #[error(
        "the motion was asked for at time {found}, but it is known from 0 to {end}: choose a time in that span or solve for longer"
    )]
    OutsideSpan { found: f64, end: f64 },
    #[error(
        "element {element} switched {found} times in a row at time {time} without time going on, allowed are {allowed}: the motion rests on its slip limit within rounding; disturb the initial state"
    )]
    Stalled { element: usize, time: f64, found: usize, allowed: usize },
    #[error(
        "x1 = {x1}, x2 = {x2}, v2 = {v2} is no reversal at f = +1: mass 1 accelerates with {acceleration}, it must be negative; choose a larger x1 or a smaller x2"
    )]
    NotAReversal { x1: f64, x2: f64, v2: f64, acceleration: f64 },
    #[error(
        "the half period has {found} at time {time} where {expected} was expected: the start lies too far from a symmetric orbit with one stick and one slip phase per half period"
    )]
    NoHalfReturn { found: &'static str, expected: &'static str, time: f64 },
    #[error(
        "only {found} of {expected} reversals at f = +1 within {switches} switches and time {time}: the start lies too far from a periodic orbit"
    )]
    NoReturn { found: usize, expected: usize, switches: usize, time: f64 },
    #[error(
        "initial {field}[{index}] = {found} does not agree with the prescribed motion, which has {expected} at time 0: set it to that"
    )]
    MotionMismatch { field: &'static str, index: usize, found: f64, expected: f64 },
}
