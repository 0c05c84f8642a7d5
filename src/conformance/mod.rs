//! How wrong the engine is: numbers measured in it, beside what the theory of its configuration predicts and what the equations of
//! motion say.
//!
//! A [`Scenario`] is a motion with a reference. References share with the engine side the description of the model only (parameters, matrices,
//! formulae of forces and energies as definitions, each tested against numbers found by hand), and no evolution in time; and the solver of periodic
//! orbits, which sees either as a map. It has [`Case`]s, one per variant and
//! [`Configuration`], and each yields [`Row`]s: a number, its prediction, its exact value, and two separate judgements (see [`Row`]'s
//! module): a [`Verdict`] on the prediction, and [`Physics`] on the truth.

mod advice;
mod baseline;
mod changes;
mod configuration;
mod cost;
mod document;
mod error;
mod exchange;
mod experiment;
mod fit;
pub mod hopf;
mod ladder;
mod ledger;
pub mod linear_mechanisms;
mod modal_rows;
pub mod native_friction;
pub mod oscillation;
mod page;
mod plan;
mod registry;
mod row;
mod scenario;
mod scenarios;
pub mod slider_body;
pub mod slider_map;
mod switching;
mod theory;
mod words;

pub use advice::{Advice, Fewest, HOPF_QUANTITY, HOPF_WORST, advice};
pub use baseline::{Baseline, Known};
pub use changes::{Change, Changes};
pub use configuration::{Configuration, Mechanism};
pub use cost::costs;
pub use document::{Cost, Machine, Parameters, Report, ScenarioNote, Timing};
pub use error::ConformanceError;
pub use exchange::{Element, Judged, Prescribed, Quantity, Score, ScoreCheck, Setup, Start, setups};
pub use experiment::{
    Experiment, FULL_LADDER, Measured, QUICK_LADDER, RIGHT, StateError, Tally, bounded_row, finish_ladder,
    friction_cases, hook_cases, is_notable, ladder, tally,
};
pub use fit::fit_modes;
pub use ladder::{Ladder, ORDER_TOLERANCE, Rung, rounding_floor};
pub use modal_rows::{FORMULA_TOLERANCE, ModeAt};
pub use page::{html, markdown};
pub use plan::{Archive, Progress, compute, scenario_named};
pub use registry::registry;
pub use row::{Basis, Judgement, Physics, Row, Subject, Verdict};
pub use scenario::{Bench, Case, Depth, Rapier, Scenario, subject};
pub use theory::{DifferenceEquation, hook_damping};
pub use words::{about, found_and_expected, quantity_in_words};
