//! Curves of special points over two parameters: pseudo-arclength continuation of the extended system of `special`.
//!
//! Extrema of either parameter and cusps of folds are ordinary points of these curves. A Neimark-Sacker curve ends where its
//! pair of multipliers becomes real, at +1 or -1.

use super::bifurcation::Bifurcation;
use super::branch::Heading;
use super::curve::{Curve, StepControl};
use super::error::OrbitError;
use super::family::Family;
use super::special::{Extended, SpecialPoint};
use crate::dynamics::SectionMap;
use crate::model::{RigParameter, RigParameters};
use nalgebra::DVector;

/// Largest step unless another is asked for, relative to the state.
const LARGEST_STEP: f64 = 0.05;

/// Iterator over the special points of one kind, from a known one on. It ends after an error, or where the bifurcation ceases
/// to be one ([`Self::pair_became_real`]).
#[derive(Debug)]
pub struct SpecialCurve<F> {
    extended: Extended<F>,
    curve: Curve,
    largest_amplitude: f64,
    started: bool,
    over: bool,
    pair_became_real: bool,
}

impl<M, F> SpecialCurve<F>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    /// Follows `start` over both parameters; `heading` is that of the second one at the start.
    ///
    /// # Errors
    /// [`OrbitError::SameParameter`], what `map_at` and the map return, and [`OrbitError::Singular`] if the second parameter
    /// has an extremum at the start.
    pub fn new(
        map_at: F,
        start: &SpecialPoint,
        [first, second]: [RigParameter; 2],
        heading: Heading,
    ) -> Result<Self, OrbitError> {
        if first == second {
            return Err(OrbitError::SameParameter { kind: start.kind, parameter: first.name() });
        }
        let varied = vec![first, second];
        let family = Family { map_at, base: start.parameters, varied, closure: start.orbit.closure };
        let u = family.unknowns(&start.orbit.section, &start.parameters);
        let extended = Extended { family, kind: start.kind };
        let direction = DVector::from_row_slice(&[0.0, 0.0, 0.0, 0.0, heading.sign()]);
        let curve = Curve::new(&extended, u, &direction, StepControl::up_to(LARGEST_STEP))?;
        Ok(Self {
            extended,
            curve,
            largest_amplitude: f64::INFINITY,
            started: false,
            over: false,
            pair_became_real: false,
        })
    }

    /// The longest step, relative to the state (default 0.05).
    #[must_use]
    pub fn with_largest_step(mut self, step: f64) -> Self {
        self.curve = self.curve.limited_to(step);
        self
    }

    /// Ends the curve after the first orbit of larger amplitude.
    #[must_use]
    pub fn up_to_amplitude(self, amplitude: f64) -> Self {
        Self { largest_amplitude: amplitude, ..self }
    }

    #[must_use]
    pub fn kind(&self) -> Bifurcation {
        self.extended.kind
    }

    /// Whether the curve ended because the pair of multipliers left the unit circle along the real axis.
    #[must_use]
    pub fn pair_became_real(&self) -> bool {
        self.pair_became_real
    }
}

impl<M, F> Iterator for SpecialCurve<F>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    type Item = Result<SpecialPoint, OrbitError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.over {
            return None;
        }
        let advanced = if self.started { self.curve.advance(&self.extended) } else { Ok(()) };
        self.started = true;
        let point = advanced.and_then(|()| self.extended.point(&self.curve.u));
        self.pair_became_real = point.as_ref().is_ok_and(|p| !self.extended.kind.is_genuine(&p.orbit.jacobian));
        let too_large = point.as_ref().map_or(true, |point| point.orbit.amplitude() > self.largest_amplitude);
        self.over = too_large || self.pair_became_real;
        if self.pair_became_real { None } else { Some(point) }
    }
}
