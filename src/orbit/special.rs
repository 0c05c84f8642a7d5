//! Special points by Newton's method on the extended system, and their curves over two parameters:
//!
//! ```text
//! P(z, p) - z = 0,     g(dP/dz (z, p)) = 0,      g the test function of the bifurcation
//! ```
//!
//! The residual is exact; the gradient of g, which holds second derivatives of the map, is taken by central differences of
//! exact first derivatives. That affects the rate of convergence alone, not the point found.

use super::bifurcation::{Bifurcation, Passage};
use super::curve::Equations;
use super::error::OrbitError;
use super::family::Family;
use super::shooting::PeriodicOrbit;
use crate::dynamics::SectionMap;
use crate::model::RigParameters;
use nalgebra::{DMatrix, DVector};

/// Step of the central differences, relative to the scales.
const DIFFERENCE: f64 = 1e-5;
const MAX_STEPS: usize = 25;
/// Newton steps this short, relative to the scales, end the search; the next would be shorter by about 1e5.
const LAST_STEP: f64 = 1e-10;
/// Largest value of a test function at a point of a curve: roundings of a determinant of entries of order 1 to 10.
pub(super) const TEST_TOLERANCE: f64 = 1e-11;

/// Where a branch of periodic orbits bifurcates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpecialPoint {
    pub kind: Bifurcation,
    pub parameters: RigParameters,
    pub orbit: PeriodicOrbit,
    /// Value of the test function there.
    pub test_residual: f64,
    pub passage: Passage,
}

impl SpecialPoint {
    /// Angle of the pair of multipliers on the unit circle over one return, rad in (0, pi): how far the torus born at a
    /// Neimark-Sacker point turns. `None` for other bifurcations.
    #[must_use]
    pub fn rotation_angle(&self) -> Option<f64> {
        let on_circle = self.orbit.section_multipliers().into_iter().filter(|m| m.im > 0.0);
        let nearest = on_circle.min_by(|a, b| (a.norm() - 1.0).abs().total_cmp(&(b.norm() - 1.0).abs()));
        nearest.map(|m| m.arg()).filter(|_| self.kind == Bifurcation::NeimarkSacker)
    }
}

/// Orbits of a family that are at a bifurcation.
#[derive(Debug, Clone)]
pub(super) struct Extended<F> {
    pub(super) family: Family<F>,
    pub(super) kind: Bifurcation,
}

impl<M, F> Extended<F>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    pub(super) fn test(&self, u: &DVector<f64>) -> Result<f64, OrbitError> {
        Ok(self.kind.test_function(&self.family.returned(u, &[])?.jacobian))
    }

    /// Newton's method in the single parameter of the family.
    pub(super) fn located(&self, guess: DVector<f64>) -> Result<DVector<f64>, OrbitError> {
        let mut u = guess;
        let mut found = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let (residual, jacobian) = self.evaluate(&u)?;
            found = residual.amax();
            let step = jacobian
                .lu()
                .solve(&residual)
                .filter(|step| step.iter().all(|c| c.is_finite()))
                .ok_or_else(|| OrbitError::singular(u.as_slice(), found))?;
            u -= &step;
            if step.component_div(&self.scales(&u)).amax() <= LAST_STEP {
                return Ok(u);
            }
        }
        Err(OrbitError::no_convergence(u.as_slice(), found, MAX_STEPS))
    }

    pub(super) fn point(&self, u: &DVector<f64>) -> Result<SpecialPoint, OrbitError> {
        let orbit = self.family.orbit(u)?;
        let parameters = self.family.parameters(u);
        let test_residual = self.kind.test_function(&orbit.jacobian);
        Ok(SpecialPoint { kind: self.kind, parameters, orbit, test_residual, passage: Passage::Unfollowed })
    }

    fn test_gradient(&self, u: &DVector<f64>) -> Result<DVector<f64>, OrbitError> {
        let scales = self.scales(u);
        let mut gradient = DVector::zeros(u.len());
        for i in 0..u.len() {
            let moved = |by: f64| {
                let mut moved = u.clone();
                moved[i] += by;
                self.test(&moved)
            };
            let step = DIFFERENCE * scales[i];
            gradient[i] = (moved(step)? - moved(-step)?) / (2.0 * step);
        }
        Ok(gradient)
    }
}

impl<M, F> Equations for Extended<F>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    fn evaluate(&self, u: &DVector<f64>) -> Result<(DVector<f64>, DMatrix<f64>), OrbitError> {
        let (residual, jacobian) = self.family.evaluate(u)?;
        let gradient = self.test_gradient(u)?;
        let rows = jacobian.nrows();
        let jacobian =
            DMatrix::from_fn(rows + 1, u.len(), |i, j| if i < rows { jacobian[(i, j)] } else { gradient[j] });
        Ok((residual.push(self.test(u)?), jacobian))
    }

    fn scales(&self, u: &DVector<f64>) -> DVector<f64> {
        self.family.scales(u)
    }

    fn vanishes(&self, u: &DVector<f64>, residual: &DVector<f64>) -> bool {
        self.family.vanishes(u, residual) && residual[3].abs() <= TEST_TOLERANCE
    }
}
