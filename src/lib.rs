//! Self-excited, friction-damped oscillators: exact solution, Rapier simulation, cross-check and film.
//!
//! # The rig
//!
//! Two unit masses on prismatic joints, coupled by a spring and a damper. Mass 1 is held by a Jenkins element, an elastic
//! dry-friction slider with force `f`; negative damping `xi1 < 0` of the in-phase mode drives the motion:
//!
//! ```text
//! x1'' + d1 x1' + d2 x2' + (1 - g) x1 + k (x1 - x2) + g f[x1] = 0
//! x2'' + d1 x2' + d2 x1' +        x2 + k (x2 - x1)             = 0
//! d1 = (xi1 + xi2)/2      d2 = (xi1 - xi2)/2
//! df = dx1  while |f + dx1| < 1,  else 0
//! ```
//!
//! Equations (1)-(3) of L. Woiwode, A. F. Vakakis, M. Krack, *Analysis of the non-periodic oscillations of a self-excited
//! friction-damped system with closely spaced modes*, Nonlinear Dynamics 106 (2021) 1659-1673. Everything is non-dimensional unless it says
//! otherwise ([`model::DimensionalRig`] converts); angles are in rad; the state is `y = (x1, x2, v1, v2, f)`; works are done *on*
//! the system; the slider force acts against the elongation.
//!
//! # Map
//!
//! | module | what it holds |
//! |---|---|
//! | [`model`] | chain of N oscillators, Jenkins elements, self-excitation, units, linear modes, energy ledger |
//! | [`dynamics`] | what all solvers share: states, trajectories, flows and their tangents, maps |
//! | [`disk`] | bladed disks: travelling waves, their stability, random mistuning |
//! | [`exact`] | closed-form flow in each contact state, certified events |
//! | [`averaging`] | describing function and slow flow of the paper |
//! | [`orbit`] | periodic orbits: shooting, Floquet multipliers, continuation, special points |
//! | [`chaos`] | Poincare maps, amplitude diagrams, rotation numbers, 0-1 test, Lyapunov spectra |
//! | `engine` | the rig in Rapier (feature `engine`) |
//! | [`compare`] | distances, observed order, verdicts |
//! | [`scene`] | scene files |
//! | `render`, `stage`, `film` | drawing, what to draw, frame sequences and video (feature `render`) |
//! | `report` | charts (feature `cli`) |
//! | `paper` | the figures and the table of the paper (feature `cli`) |
//! | `conformance` | how wrong the engine is (feature `cli`) |
//! | [`store`] | atomic files, output directories, tables |
//! | `cli` | the command line (feature `cli`) |
//!
//! `exact` and `engine` share parameters and never evolution code: their agreement means something.

#![forbid(unsafe_code)]
#![warn(missing_debug_implementations)]
// Streams that cannot be written must not panic: the command line alone prints, see `cli`.
#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod averaging;
pub mod chaos;
#[cfg(feature = "cli")]
pub mod cli;
pub mod compare;
#[cfg(feature = "cli")]
pub mod conformance;
pub mod disk;
pub mod dynamics;
#[cfg(feature = "engine")]
pub mod engine;
pub mod exact;
#[cfg(feature = "render")]
pub mod film;
pub mod model;
pub mod orbit;
#[cfg(feature = "cli")]
pub mod paper;
#[cfg(feature = "render")]
pub mod render;
#[cfg(feature = "cli")]
pub mod report;
pub mod scene;
#[cfg(feature = "render")]
pub mod stage;
pub mod store;

/// The examples of the README are tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
