//! The interface all solvers share.

use super::state::State;
use super::trajectory::{Sampling, Trajectory};
use nalgebra::{Matrix3, Vector3};

/// Anything that carries a state forward in time: the closed form, the physics engine, the slow flow.
pub trait Flow {
    type Error: std::error::Error + Send + Sync + 'static;

    /// Name for reports, such as `exact` or `rapier3d-f64`.
    fn name(&self) -> String;

    /// The motion from `initial` at time 0, sampled as asked.
    ///
    /// # Errors
    /// If the initial state or the sampling cannot be used, or the solver fails. Divergence is an outcome, not an error.
    fn trajectory(&self, initial: &State, sampling: Sampling) -> Result<Trajectory, Self::Error>;
}

/// Where a symmetric orbit of the two-mass rig is cut: `(x1, x2, v2)` at `v1 = 0`, `f = +1`, the element about to stick.
pub type ReversalPoint = Vector3<f64>;

/// One application of the half-period map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfReturn {
    /// The next reversal, mirrored: `-(x1, x2, v2)` at `v1 = 0`, `f = -1`.
    pub image: ReversalPoint,
    /// Time between the two reversals.
    pub duration: f64,
    /// Derivative of the image with respect to the starting point.
    pub jacobian: Matrix3<f64>,
}

/// A flow with odd symmetry and its derivative, seen as the map from one reversal of mass 1 to the mirror image of the next.
/// A symmetric limit cycle is a fixed point.
pub trait HalfPeriodMap {
    type Error: std::error::Error + Send + Sync + 'static;

    /// # Errors
    /// If the motion never slips and reverses again within the solver's time bound, or its intermediate states are not those
    /// of one stick and one slip phase.
    fn half_return(&self, start: ReversalPoint) -> Result<HalfReturn, Self::Error>;
}
