//! Branches of periodic orbits over one parameter, as an iterator of points, and the special points along them.

use super::bifurcation::Bifurcation;
use super::curve::{Curve, Equations, StepControl};
use super::error::OrbitError;
use super::family::Family;
use super::shooting::PeriodicOrbit;
use super::special::{Extended, SpecialPoint};
use crate::dynamics::{Closure, SectionMap};
use crate::model::{RigParameter, RigParameters};
use nalgebra::{DVector, Matrix3, Vector3};

/// Largest step unless another is asked for, relative to the state.
const LARGEST_STEP: f64 = 0.05;
/// A special point may lie this far outside the bracket of its branch points, in lengths of their chord.
const BRACKET_SLACK: f64 = 0.5;

/// Distance from a crossing at which the other branch is picked up, relative to the state.
const DEPARTURE: f64 = 0.01;

/// Which way a branch is followed first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heading {
    /// Towards larger values of the parameter.
    Increasing,
    /// Towards smaller values.
    Decreasing,
}

impl Heading {
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Increasing => 1.0,
            Self::Decreasing => -1.0,
        }
    }
}

/// One orbit of a branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BranchPoint {
    pub parameters: RigParameters,
    pub orbit: PeriodicOrbit,
    /// Rate of the parameter along the branch (per unit of scaled arclength); changes its sign at folds.
    pub parameter_rate: f64,
}

/// Iterator over the points of a branch, from a known orbit on, through folds. It ends after the first orbit outside its
/// limits, or after an error.
#[derive(Debug)]
pub struct PseudoArclength<F> {
    family: Family<F>,
    curve: Curve,
    largest_amplitude: f64,
    started: bool,
    over: bool,
}

impl<M, F> PseudoArclength<F>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    /// Follows `orbit`, known at `parameters`, in one parameter; `map_at` builds the section map for given parameters.
    ///
    /// # Errors
    /// What `map_at` and the map return, and [`OrbitError::Singular`] at a fold or where branches cross.
    pub fn new(
        map_at: F,
        parameters: RigParameters,
        orbit: &PeriodicOrbit,
        varied: RigParameter,
        heading: Heading,
    ) -> Result<Self, OrbitError> {
        let family = Family { map_at, base: parameters, varied: vec![varied], closure: orbit.closure };
        let start = family.unknowns(&orbit.section, &parameters);
        let direction = DVector::from_row_slice(&[0.0, 0.0, 0.0, heading.sign()]);
        let curve = Curve::new(&family, start, &direction, StepControl::up_to(LARGEST_STEP))?;
        Ok(Self { family, curve, largest_amplitude: f64::INFINITY, started: false, over: false })
    }

    /// The branch of the twice iterated map that leaves a branch where a multiplier is -1: the asymmetric orbits at a
    /// [`Bifurcation::BranchPoint`] of symmetric ones, the doubled ones at a [`Bifurcation::PeriodDoubling`]. Their mirror images,
    /// or the same orbits one cycle later, are the other half of that branch.
    ///
    /// # Errors
    /// [`OrbitError::NoBranchLeaves`] at other bifurcations, and as for [`Self::new`].
    pub fn switched(map_at: F, special: &SpecialPoint, varied: RigParameter) -> Result<Self, OrbitError> {
        let closure = match (special.kind, special.orbit.closure) {
            (Bifurcation::BranchPoint, Closure::HalfPeriod) => Closure::FullPeriod { cycles: 1 },
            (Bifurcation::PeriodDoubling, Closure::FullPeriod { cycles }) => Closure::FullPeriod { cycles: 2 * cycles },
            (kind, _) => return Err(OrbitError::NoBranchLeaves { kind }),
        };
        let family = Family { map_at, base: special.parameters, varied: vec![varied], closure };
        let u = family.unknowns(&special.orbit.section, &special.parameters);
        let scales = family.scales(&u);
        let leaving = flipped_direction(&special.orbit.jacobian).push(0.0);
        let tangent = DVector::from_column_slice(leaving.as_slice());
        let tangent = &tangent / tangent.component_div(&scales).norm();
        let curve = Curve::leaving(&family, &u, tangent, DEPARTURE, StepControl::up_to(LARGEST_STEP))?;
        Ok(Self { family, curve, largest_amplitude: f64::INFINITY, started: false, over: false })
    }

    /// Ends the branch after the first orbit of larger amplitude.
    #[must_use]
    pub fn up_to_amplitude(self, amplitude: f64) -> Self {
        Self { largest_amplitude: amplitude, ..self }
    }

    /// The longest step, relative to the state (default 0.05). Steps are shorter wherever the branch bends.
    #[must_use]
    pub fn with_largest_step(mut self, step: f64) -> Self {
        self.curve = self.curve.limited_to(step);
        self
    }

    fn point(&self) -> Result<BranchPoint, OrbitError> {
        let u = &self.curve.u;
        let (parameters, orbit) = (self.family.parameters(u), self.family.orbit(u)?);
        Ok(BranchPoint { parameters, orbit, parameter_rate: self.curve.tangent[3] })
    }

    /// The bifurcations between two successive points.
    ///
    /// # Errors
    /// If Newton's method fails on one of them or leads out of the bracket.
    fn special_points(&self, from: &BranchPoint, to: &BranchPoint) -> Result<Vec<SpecialPoint>, OrbitError>
    where
        F: Clone,
    {
        let mut found = Vec::new();
        for kind in Bifurcation::possible(self.family.closure) {
            let [g0, g1] = [from, to].map(|point| kind.test_function(&point.orbit.jacobian));
            if (g0 < 0.0) != (g1 < 0.0) {
                found.extend(self.special_point(kind, [from, to], g0 / (g0 - g1))?);
            }
        }
        Ok(found)
    }

    fn special_point(
        &self,
        kind: Bifurcation,
        ends: [&BranchPoint; 2],
        fraction: f64,
    ) -> Result<Option<SpecialPoint>, OrbitError>
    where
        F: Clone,
    {
        let [from, to] = ends.map(|end| self.family.unknowns(&end.orbit.section, &end.parameters));
        let extended = Extended { family: self.family.clone(), kind };
        let u = extended.located(&from + (&to - &from) * fraction)?;
        let scales = self.family.scales(&from);
        let length = |v: DVector<f64>| v.component_div(&scales).norm();
        let chord = length(&to - &from);
        if length(&u - &from).max(length(&u - &to)) > (1.0 + BRACKET_SLACK) * chord {
            let [from, to, found] = [from, to, u].map(|u| u.as_slice().to_vec());
            return Err(OrbitError::OutsideBracket { kind, from, to, found });
        }
        let point = extended.point(&u)?;
        Ok(kind.is_genuine(&point.orbit.jacobian).then_some(point))
    }
}

impl<M, F> Iterator for PseudoArclength<F>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError>,
{
    type Item = Result<BranchPoint, OrbitError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.over {
            return None;
        }
        let advanced = if self.started { self.curve.advance(&self.family) } else { Ok(()) };
        self.started = true;
        let point = advanced.and_then(|()| self.point());
        self.over = point.as_ref().map_or(true, |point| point.orbit.amplitude() > self.largest_amplitude);
        Some(point)
    }
}

/// The eigenvector of the multiplier nearest to -1: the direction that `J + I` shortens most.
fn flipped_direction(jacobian: &Matrix3<f64>) -> Vector3<f64> {
    let shifted = jacobian + Matrix3::identity();
    let squared = (shifted.transpose() * shifted).symmetric_eigen();
    let direction: Vector3<f64> = squared.eigenvectors.column(squared.eigenvalues.imin()).into_owned();
    // Its sign is arbitrary; the larger x1 makes it definite.
    if direction[0] < 0.0 { -direction } else { direction }
}

/// A branch with its special points, both in the order in which they are met.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    pub points: Vec<BranchPoint>,
    pub special: Vec<SpecialPoint>,
}

impl Branch {
    /// Follows a branch to its end, or until `enough` says so of the points and special points so far.
    ///
    /// # Errors
    /// The first error of the continuation, or of the search for a special point.
    pub fn follow<M, F>(mut branch: PseudoArclength<F>, enough: impl Fn(&Self) -> bool) -> Result<Self, OrbitError>
    where
        M: SectionMap,
        F: Fn(RigParameters) -> Result<M, OrbitError> + Clone,
    {
        let mut followed = Self { points: Vec::new(), special: Vec::new() };
        while let Some(point) = branch.next() {
            let point = point?;
            if let Some(last) = followed.points.last() {
                followed.special.extend(branch.special_points(last, &point)?);
            }
            followed.points.push(point);
            if enough(&followed) {
                break;
            }
        }
        Ok(followed)
    }

    /// The special points of one kind.
    pub fn special_of(&self, kind: Bifurcation) -> impl Iterator<Item = &SpecialPoint> {
        self.special.iter().filter(move |point| point.kind == kind)
    }
}
