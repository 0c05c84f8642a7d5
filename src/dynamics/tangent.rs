//! Flows with their linearisation.

use super::state::State;
use super::trajectory::Outcome;
use crate::model::RigParameter;
use nalgebra::{DMatrix, DVector, Vector5};

/// A flow of the two-mass rig that knows how its end depends on the parameters.
pub trait ParameterTangent {
    type Error: std::error::Error + Send + Sync + 'static;

    /// Derivatives of the state `(x1, x2, v1, v2, f)` at `duration` after `initial` with respect to `parameters`, in their order.
    ///
    /// # Errors
    /// If the state or the duration cannot be used, the motion diverges before, or the solver fails.
    fn parameter_tangents(
        &self,
        initial: &State,
        duration: f64,
        parameters: &[RigParameter],
    ) -> Result<Vec<Vector5<f64>>, Self::Error>;
}

/// A flow that carries infinitesimal perturbations along: what Lyapunov exponents and Floquet multipliers are computed from.
///
/// States are plain vectors of length n = [`Self::dimension`]; for a chain they are `(x, v, f)`. Motions may be
/// cut anywhere: carrying over `a` and then over `b` is carrying over `a + b`.
pub trait TangentFlow {
    type Error: std::error::Error + Send + Sync + 'static;

    /// Length n of the state.
    fn dimension(&self) -> usize;

    /// Carries `state` (length n) and each column of `tangents` (n x m, any m) over `duration`, in place, through all
    /// changes of contact state on the way. When the motion diverges both are left at the time of divergence, which counts
    /// from the start of this call.
    ///
    /// # Errors
    /// If the lengths do not fit, the state or the duration cannot be used, or the solver fails. Divergence is an outcome.
    fn carry(
        &self,
        state: &mut DVector<f64>,
        tangents: &mut DMatrix<f64>,
        duration: f64,
    ) -> Result<Outcome, Self::Error>;

    /// The vector field just after `state`, length n: the direction in which perturbations neither grow nor decay.
    ///
    /// # Errors
    /// If the state cannot be used.
    fn vector_field(&self, state: &DVector<f64>) -> Result<DVector<f64>, Self::Error>;
}
