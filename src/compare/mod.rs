//! How far two motions are apart, and whether that is as little as it should be.
//!
//! ```text
//! state error       max over t_n <= horizon of max_i |y_i(t_n) - z_i(t_n)|,   y = (x, v, f)
//! amplitude error   difference of the maxima of x_1:  largest, smallest, mean
//! frequency error   difference of 2 pi (n - 1)/(t_n - t_1) over the n upward zeros of x_1
//! observed order    slope of log(error) over log(step)
//! ```
//!
//! This module is handed trajectories, or two flows, and knows no solver. Numbers are in the units of the trajectories; tolerances
//! assume non-dimensional ones, with an angular frequency near 1.

mod cycles;
mod distance;
mod error;
mod order;
mod tolerance;
mod verdict;

pub use cycles::{Cycles, Maximum};
pub use distance::{common_samples, max_state_error};
pub use error::CompareError;
pub use order::{ObservedOrder, observed_order};
pub use tolerance::{Expectation, LARGEST_TOLERANCE, Motion, Tolerances};
pub use verdict::{Agreement, Check, compare, compare_flows};
