//! How wrong the engine is: numbers measured in it, beside what the theory of its configuration predicts and what the equations of
//! motion say.
//!
//! A [`Scenario`] is a motion with a reference that shares no code with the engine. It has [`Case`]s, one per variant and
//! [`Configuration`], and each yields [`Row`]s: a number, its prediction, its exact value, and two separate judgements (see [`Row`]'s
//! module): a [`Verdict`] on the prediction, and [`Physics`] on the truth.

mod configuration;
mod error;
mod exchange;
mod experiment;
mod fit;
mod ladder;
pub mod linear_mechanisms;
mod modal_rows;
pub mod native_friction;
pub mod oscillation;
mod registry;
mod row;
mod scenario;
mod scenarios;
pub mod slider_map;
mod switching;
mod theory;

pub use configuration::{Configuration, Mechanism};
pub use error::ConformanceError;
pub use exchange::{Score, ScoreCheck, Setup};
pub use experiment::{
    Experiment, FULL_LADDER, Measured, QUICK_LADDER, RIGHT, StateError, Tally, finish_ladder, hook_cases, ladder, tally,
};
pub use fit::fit_modes;
pub use ladder::{Ladder, ORDER_TOLERANCE, rounding_floor};
pub use modal_rows::{FORMULA_TOLERANCE, ModeAt};
pub use registry::registry;
pub use row::{Basis, Judgement, Physics, Row, Subject, Verdict};
pub use scenario::{Bench, Case, Depth, Rapier, Scenario, subject};
pub use theory::{DifferenceEquation, hook_damping};
