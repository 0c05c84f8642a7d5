//! Orbits of one closure over one or two parameters, as zeros of `P(z, p) - z`; unknowns are `u = (x1, x2, v2, p, ...)`.

use super::curve::Equations;
use super::error::OrbitError;
use super::shooting::{PeriodicOrbit, tolerance};
use crate::dynamics::{Closure, HalfReturn, ReversalPoint, SectionMap, SectionReturn};
use crate::model::{RigParameter, RigParameters};
use nalgebra::{DMatrix, DVector};

/// A change of a parameter that counts as much as a change of the state by its own size.
const PARAMETER_SCALE: f64 = 0.1;

/// How a section map is built for given parameters, and which of them vary.
#[derive(Debug, Clone)]
pub(super) struct Family<F> {
    pub(super) map_at: F,
    pub(super) base: RigParameters,
    pub(super) varied: Vec<RigParameter>,
    pub(super) closure: Closure,
}

impl<M, F> Family<F>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    /// The unknowns of an orbit at given parameters.
    pub(super) fn unknowns(&self, section: &ReversalPoint, parameters: &RigParameters) -> DVector<f64> {
        let varied = self.varied.iter().map(|parameter| parameters.get(*parameter));
        DVector::from_iterator(3 + self.varied.len(), section.iter().copied().chain(varied))
    }

    pub(super) fn section(u: &DVector<f64>) -> ReversalPoint {
        ReversalPoint::new(u[0], u[1], u[2])
    }

    pub(super) fn parameters(&self, u: &DVector<f64>) -> RigParameters {
        self.varied.iter().enumerate().fold(self.base, |p, (i, parameter)| p.with(*parameter, u[3 + i]))
    }

    /// The map applied at `u`, with derivatives in the parameters named.
    pub(super) fn returned(&self, u: &DVector<f64>, varied: &[RigParameter]) -> Result<SectionReturn, OrbitError> {
        let section = Self::section(u);
        (self.map_at)(self.parameters(u))?
            .section_return(section, self.closure, varied)
            .map_err(|source| OrbitError::Map { at: section.into(), source: Box::new(source) })
    }

    pub(super) fn orbit(&self, u: &DVector<f64>) -> Result<PeriodicOrbit, OrbitError> {
        let SectionReturn { image, duration, jacobian, .. } = self.returned(u, &[])?;
        Ok(PeriodicOrbit::closed(Self::section(u), self.closure, &HalfReturn { image, duration, jacobian }))
    }
}

impl<M, F> Equations for Family<F>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    fn evaluate(&self, u: &DVector<f64>) -> Result<(DVector<f64>, DMatrix<f64>), OrbitError> {
        let back = self.returned(u, &self.varied)?;
        let residual = DVector::from_column_slice((back.image - Self::section(u)).as_slice());
        let jacobian = DMatrix::from_fn(3, u.len(), |i, j| match j {
            0..3 => back.jacobian[(i, j)] - if i == j { 1.0 } else { 0.0 },
            _ => back.sensitivities[j - 3][i],
        });
        Ok((residual, jacobian))
    }

    fn scales(&self, u: &DVector<f64>) -> DVector<f64> {
        let size = Self::section(u).amax().max(1.0);
        DVector::from_fn(u.len(), |i, _| if i < 3 { size } else { PARAMETER_SCALE })
    }

    fn vanishes(&self, u: &DVector<f64>, residual: &DVector<f64>) -> bool {
        residual.rows(0, 3).amax() <= tolerance(&Self::section(u))
    }
}
