//! Branches of periodic orbits over one parameter, as an iterator of points, and the special points along them.

use super::bifurcation::Bifurcation;
use super::curve::{Curve, Equations, StepControl};
use super::error::OrbitError;
use super::family::Family;
use super::search::{Found, Node, Search};
use super::shooting::PeriodicOrbit;
use super::special::SpecialPoint;
use crate::dynamics::{Closure, SectionMap};
use crate::model::{RigParameter, RigParameters};
use nalgebra::{DVector, Matrix3, Vector3};

/// Largest step unless another is asked for, relative to the state.
const LARGEST_STEP: f64 = 0.05;
/// Largest component of an orbit at the reversal with which a branch is followed: half the amplitude bound of the flow.
const UNBOUNDED: f64 = 500.0;

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
        self.over = point.as_ref().map_or(true, |point| {
            point.orbit.amplitude() > self.largest_amplitude || point.orbit.section.amax() > UNBOUNDED
        });
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
    /// Two special points closer than this in the parameter may have been passed over.
    pub resolution: f64,
    pub end: BranchEnd,
}

/// Why a branch was not followed further.
#[derive(Debug, Clone, PartialEq)]
pub enum BranchEnd {
    /// Whoever asked had enough.
    Enough,
    /// The amplitude asked for was exceeded.
    Amplitude,
    /// The orbit grows beyond all bounds: the branch goes to infinity near its last point.
    Unbounded,
    /// The continuation failed.
    Lost { reason: String },
}

impl Branch {
    /// Follows a branch to its end, or until `enough` says so of the points and special points so far.
    ///
    /// # Errors
    /// The first error of the continuation, or of the search for a special point.
    pub fn follow<M, F>(branch: PseudoArclength<F>, enough: impl Fn(&Self) -> bool) -> Result<Self, OrbitError>
    where
        M: SectionMap,
        F: Fn(RigParameters) -> Result<M, OrbitError> + Clone,
    {
        let (followed, outcome) = Self::follow_until_lost(branch, enough);
        outcome.map(|()| followed)
    }

    /// The same, but what was followed before the continuation failed is kept: see [`BranchEnd::Lost`].
    pub fn explore<M, F>(branch: PseudoArclength<F>, enough: impl Fn(&Self) -> bool) -> Self
    where
        M: SectionMap,
        F: Fn(RigParameters) -> Result<M, OrbitError> + Clone,
    {
        Self::follow_until_lost(branch, enough).0
    }

    fn follow_until_lost<M, F>(
        mut branch: PseudoArclength<F>,
        enough: impl Fn(&Self) -> bool,
    ) -> (Self, Result<(), OrbitError>)
    where
        M: SectionMap,
        F: Fn(RigParameters) -> Result<M, OrbitError> + Clone,
    {
        let mut followed = Self { points: Vec::new(), special: Vec::new(), resolution: 0.0, end: BranchEnd::Amplitude };
        let mut last: Option<Node> = None;
        while let Some(point) = branch.next() {
            match point.and_then(|point| followed.append(&branch, point, &mut last)) {
                Ok(()) if enough(&followed) => {
                    followed.end = BranchEnd::Enough;
                    break;
                }
                Ok(()) => {}
                Err(error) => {
                    followed.end = BranchEnd::Lost { reason: error.to_string() };
                    return (followed, Err(error));
                }
            }
        }
        let unbounded = |point: &BranchPoint| point.orbit.section.amax() > UNBOUNDED;
        if followed.end == BranchEnd::Amplitude && followed.points.last().is_some_and(unbounded) {
            followed.end = BranchEnd::Unbounded;
        }
        (followed, Ok(()))
    }

    fn append<M, F>(
        &mut self,
        branch: &PseudoArclength<F>,
        point: BranchPoint,
        last: &mut Option<Node>,
    ) -> Result<(), OrbitError>
    where
        M: SectionMap,
        F: Fn(RigParameters) -> Result<M, OrbitError> + Clone,
    {
        let search = Search::new(&branch.family);
        let node = search.node(branch.curve.u.clone(), &branch.curve.tangent)?;
        if let Some(last) = last {
            let mut found = Found { points: Vec::new(), resolution: self.resolution };
            search.between(last, &node, &mut found)?;
            self.special.append(&mut found.points);
            self.resolution = found.resolution;
        }
        *last = Some(node);
        self.points.push(point);
        Ok(())
    }

    /// The special points of one kind.
    pub fn special_of(&self, kind: Bifurcation) -> impl Iterator<Item = &SpecialPoint> {
        self.special.iter().filter(move |point| point.kind == kind)
    }
}
