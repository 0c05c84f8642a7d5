//! Long-term behaviour of a flow: sections, amplitude diagrams, rotation numbers, the 0-1 test and Lyapunov spectra.
//!
//! Everything here takes any flow through the traits of [`crate::dynamics`] and knows no solver. No random numbers: the same
//! input gives the same output on any number of threads.

mod average;
mod crossing;
mod diagram;
mod envelope;
mod error;
mod lyapunov;
mod motion_class;
mod poincare;
mod rotation;
mod window;
mod zero_one;

pub use diagram::{DiagramPlan, DiagramRow, DivergenceEdge, amplitude_diagram, divergence_edge, every_row};
pub use error::ChaosError;
pub use lyapunov::{ConvergencePoint, LyapunovOutcome, LyapunovPlan, LyapunovSpectrum, lyapunov_spectrum};
pub use motion_class::{Classification, Criteria, Decision, Evidence, KnownCycle, MotionClass, classify};
pub use poincare::{PoincareMap, PoincareSection, poincare_map};
pub use rotation::{Rotation, torus_rotation};
pub use window::Window;
pub use zero_one::zero_one_test;
