//! The exact flow. In each contact state the chain is linear with constant coefficients,
//!
//! ```text
//! y' = A y  in a stick or slip phase,   y continuous,   A changes when a slider reaches |f| = 1 or stops sliding,
//! ```
//!
//! so the motion of a phase is known in closed form and only the switching times need a root search. That search is
//! certified: a bound on the curvature of the event function proves that no crossing is missed (`crossing`).
//!
//! - [`TwoMassFlow`]: the paper's rig in modal coordinates (`modal`, `modal_phase`, `modal_root`, `scan`, `walk`), about 0.1 us per event.
//!   Its linearisation, with saltation at the switches, is in `tangent`.
//! - [`ChainFlow`]: any chain, matrix exponential by series (`pattern`, `chain_walk`).
//! - [`SparseFlow`]: large chains, Taylor series by sparse products (`sparse`), some microseconds per event and hundred oscillators.
//! - [`PrescribedFlow`]: hysteresis under a prescribed motion of oscillator 0 (`prescribed`, `hysteresis`).
//! - [`ExactTrajectory`]: the motion of either at any time, and its energy ledger (`piece`, `gauss`).
//!
//! Rules for events. A slip phase begins when |f| = 1 is exceeded, a stick phase when the sliding velocity changes its sign.
//! A force that touches |f| = 1 to rounding and turns back is [`crate::dynamics::EventKind::Grazing`], and nothing changes. A
//! sliding velocity that touches zero and goes on is no event. Where |f| = 1 and the sliding velocity is zero, the first of its derivatives that
//! is not zero decides; zero is what lies within the rounding of its terms. Mirrored motions are the same to the bit. An event at the very end of the time asked for counts, and the
//! contact states given for the time of an event are those after it. Simultaneous events: `chain_walk`.

mod bound;
mod chain_flow;
mod chain_walk;
mod clock;
mod crossing;
mod error;
mod gauss;
mod half_period;
mod hysteresis;
mod modal;
mod modal_phase;
mod modal_root;
mod pattern;
mod piece;
mod prescribed;
mod scan;
mod section;
mod series;
mod sparse;
mod tangent;
mod trajectory;
mod two_mass;
mod walk;

pub use bound::DEFAULT_AMPLITUDE_BOUND;
pub use chain_flow::ChainFlow;
pub use error::ExactError;
pub use prescribed::PrescribedFlow;
pub use sparse::SparseFlow;
pub use trajectory::{ExactTrajectory, Instant};
pub use two_mass::{Arrival, Representation, TwoMassFlow};
