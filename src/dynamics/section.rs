//! The section on which orbits of the two-mass rig are periodic points, and the maps onto it.

use super::flow::ReversalPoint;
use crate::model::RigParameter;
use nalgebra::{Matrix3, Vector3};

/// Which return to the section closes a periodic orbit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Closure {
    /// The mirror image of the next reversal, at f = -1: symmetric orbits.
    HalfPeriod,
    /// The given number (at least 1) of returns to a reversal at f = +1: orbits without symmetry, of period 1, 2, ...
    FullPeriod { cycles: usize },
}

/// One application of a map from the section onto itself.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionReturn {
    pub image: ReversalPoint,
    pub duration: f64,
    /// Derivative of the image with respect to the starting point.
    pub jacobian: Matrix3<f64>,
    /// Derivatives of the image with respect to the parameters asked for, in their order.
    pub sensitivities: Vec<Vector3<f64>>,
}

/// A flow of the two-mass rig, seen as maps of the section `v1 = 0`, `f = +1` (about to stick), with exact derivatives.
pub trait SectionMap {
    type Error: std::error::Error + Send + Sync + 'static;

    /// # Errors
    /// If the start is no reversal, or the motion does not return within the solver's bounds.
    fn section_return(
        &self,
        start: ReversalPoint,
        closure: Closure,
        parameters: &[RigParameter],
    ) -> Result<SectionReturn, Self::Error>;
}
