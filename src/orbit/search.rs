//! The special points between two neighbouring orbits of a branch, pairs that lie close together included.
//!
//! A test function g that changes its sign has a zero between the nodes. One that does not may have two: it is modelled by the cubic
//! through its values and slopes at both ends, and where an extreme of the cubic comes near zero an orbit is computed there and both halves
//! are searched. So a pair is found, or excluded, unless it lies within an interval that could not be divided further; the
//! widest of these is told.
//!
//! The slope is that of g along the branch, `g'(u) t`, by a central difference of exact derivatives of the map. It only
//! directs the search: zeros are those of [`Extended`].

use super::bifurcation::{Bifurcation, Passage};
use super::curve::{Curve, Equations};
use super::error::OrbitError;
use super::family::Family;
use super::special::{Extended, SpecialPoint, TEST_TOLERANCE};
use crate::dynamics::SectionMap;
use crate::model::RigParameters;
use nalgebra::{DVector, Matrix3};

/// Step of the central difference along the branch, relative to the scales.
const DIFFERENCE: f64 = 1e-5;
/// An extreme of the cubic this far from zero, relative to the nearer end, is taken for no crossing.
const CLEARANCE: f64 = 0.5;
/// Halvings of an interval, after which an extreme is no longer followed: 1e-5 of a step of the branch.
const DEEPEST: usize = 16;
/// Divisions keep this part of an interval on either side.
const MARGIN: f64 = 0.02;
/// Parts of an interval to which a zero is narrowed down before Newton's method.
const NARROW: f64 = 1e-3;
const MOST_SECANTS: usize = 40;

/// An orbit of the branch with the test functions and their slopes along the branch; no slopes where a neighbouring point
/// has no return.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) u: DVector<f64>,
    jacobian: Matrix3<f64>,
    slopes: Option<[f64; 3]>,
}

/// What was found on a branch, and the widest range of the parameter in which a pair could have been passed over.
#[derive(Debug, Clone, Default)]
pub(super) struct Found {
    pub(super) points: Vec<SpecialPoint>,
    pub(super) resolution: f64,
}

pub(super) struct Search<'a, F> {
    family: &'a Family<F>,
    kinds: [Bifurcation; 3],
}

impl<'a, M, F> Search<'a, F>
where
    M: SectionMap,
    F: Fn(RigParameters) -> Result<M, OrbitError> + Clone,
{
    pub(super) fn new(family: &'a Family<F>) -> Self {
        Self { family, kinds: Bifurcation::possible(family.closure) }
    }

    /// `tangent` has length 1 when divided by the scales at `u`.
    pub(super) fn node(&self, u: DVector<f64>, tangent: &DVector<f64>) -> Result<Node, OrbitError> {
        let jacobian = self.family.returned(&u, &[])?.jacobian;
        let tests = |by: f64| {
            let moved = self.family.returned(&(&u + tangent * by), &[]).ok()?;
            Some(self.kinds.map(|kind| kind.test_function(&moved.jacobian)))
        };
        let slopes = match (tests(DIFFERENCE), tests(-DIFFERENCE)) {
            (Some(after), Some(before)) => Some([0, 1, 2].map(|i| (after[i] - before[i]) / (2.0 * DIFFERENCE))),
            _ => None,
        };
        Ok(Node { u, jacobian, slopes })
    }

    /// The special points between two nodes, in the order in which they are met.
    pub(super) fn between(&self, from: &Node, to: &Node, found: &mut Found) -> Result<(), OrbitError> {
        let mut met = Vec::new();
        for index in 0..self.kinds.len() {
            self.divide(index, from, to, 0, &mut met, &mut found.resolution)?;
        }
        let along = |point: &SpecialPoint| {
            let u = self.family.unknowns(&point.orbit.section, &point.parameters);
            (u - &from.u).dot(&(&to.u - &from.u))
        };
        met.sort_by(|a, b| along(a).total_cmp(&along(b)));
        found.points.extend(met);
        Ok(())
    }

    fn divide(
        &self,
        index: usize,
        from: &Node,
        to: &Node,
        depth: usize,
        met: &mut Vec<SpecialPoint>,
        resolution: &mut f64,
    ) -> Result<(), OrbitError> {
        let kind = self.kinds[index];
        let [g0, g1] = [from, to].map(|node| kind.test_function(&node.jacobian));
        match self.doubtful_extreme(index, from, to) {
            Doubt::At(part) if depth < DEEPEST => {
                let middle = self.on_chord(from, to, part)?;
                self.divide(index, from, &middle, depth + 1, met, resolution)?;
                return self.divide(index, &middle, to, depth + 1, met, resolution);
            }
            Doubt::None => {}
            _ => *resolution = resolution.max((to.u[3] - from.u[3]).abs()),
        }
        if (g0 < 0.0) != (g1 < 0.0) {
            let passage = if g0 < 0.0 { Passage::Upwards } else { Passage::Downwards };
            met.extend(self.located(kind, from, to)?.map(|point| SpecialPoint { passage, ..point }));
        }
        Ok(())
    }

    /// Where the cubic through both ends may have zeros that the signs at the ends do not show.
    fn doubtful_extreme(&self, index: usize, from: &Node, to: &Node) -> Doubt {
        let (Some(before), Some(after)) = (from.slopes, to.slopes) else { return Doubt::Unknown };
        let kind = self.kinds[index];
        let [g0, g1] = [from, to].map(|node| kind.test_function(&node.jacobian));
        let length = (&to.u - &from.u).component_div(&self.family.scales(&from.u)).norm();
        let cubic = Cubic::new([g0, g1], [before[index] * length, after[index] * length]);
        let nearer = CLEARANCE * g0.abs().min(g1.abs());
        // Beyond an extreme on the far side of zero, or close to it, there are zeros in pairs.
        let hidden = |t: &f64| {
            let value = cubic.at(*t);
            if (g0 < 0.0) == (g1 < 0.0) {
                value * g0.signum() < nearer
            } else {
                value * g0.signum() < -g1.abs() - nearer
            }
        };
        let turns = cubic.extremes();
        let both_sides = (g0 < 0.0) != (g1 < 0.0) && turns.len() == 2 && cubic.at(turns[0]) * cubic.at(turns[1]) < 0.0;
        let doubtful = turns.into_iter().find(|t| both_sides || hidden(t));
        doubtful.map_or(Doubt::None, |t| Doubt::At(t.clamp(MARGIN, 1.0 - MARGIN)))
    }

    /// The orbit of the branch in the plane across the chord at `part` of its length.
    fn on_chord(&self, from: &Node, to: &Node, part: f64) -> Result<Node, OrbitError> {
        let (u, tangent) = Curve::on_chord(self.family, &from.u, &to.u, part)?;
        self.node(u, &tangent)
    }

    /// The zero between two nodes at which the test function has different signs; `None` where it is no bifurcation.
    fn located(&self, kind: Bifurcation, from: &Node, to: &Node) -> Result<Option<SpecialPoint>, OrbitError> {
        let extended = Extended { family: self.family.clone(), kind };
        let scales = self.family.scales(&from.u);
        let chord = (&to.u - &from.u).component_div(&scales);
        let place = |u: &DVector<f64>| (u - &from.u).component_div(&scales).dot(&chord) / chord.norm_squared();
        let test = |node: &Node| kind.test_function(&node.jacobian);
        // Illinois: secants between ends of different signs; the end that stays twice counts half.
        let (mut low, mut high) = ((0.0, test(from)), (1.0, test(to)));
        let mut guess = (0.5, from.u.clone());
        for _ in 0..MOST_SECANTS {
            let part = low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1)).clamp(0.01, 0.99);
            let middle = self.on_chord(from, to, part)?;
            let value = test(&middle);
            guess = (part, middle.u);
            if (value < 0.0) == (low.1 < 0.0) {
                (low, high.1) = ((part, value), 0.5 * high.1);
            } else {
                (high, low.1) = ((part, value), 0.5 * low.1);
            }
            if high.0 - low.0 < NARROW || value.abs() < NARROW * (test(to) - test(from)).abs() {
                // The zero is the one between these ends, or Newton's method is not believed.
                let inside = |u: &DVector<f64>| (low.0 - NARROW..=high.0 + NARROW).contains(&place(u));
                if let Some(u) = extended.located(guess.1.clone()).ok().filter(inside) {
                    guess.1 = u;
                    break;
                }
            }
            if value.abs() <= TEST_TOLERANCE {
                break;
            }
        }
        let point = extended.point(&guess.1)?;
        Ok(kind.is_genuine(&point.orbit.jacobian).then_some(point))
    }
}

enum Doubt {
    None,
    At(f64),
    /// There are no slopes to tell by.
    Unknown,
}

/// A cubic on [0, 1] by values and slopes at its ends.
struct Cubic([f64; 4]);

impl Cubic {
    fn new([g0, g1]: [f64; 2], [m0, m1]: [f64; 2]) -> Self {
        let rise = g1 - g0;
        Self([g0, m0, 3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise])
    }

    fn at(&self, t: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, c| sum * t + c)
    }

    /// The extremes within (0, 1), in order.
    fn extremes(&self) -> Vec<f64> {
        let [_, slope, half_curvature, third] = self.0;
        // 3 c3 t^2 + 2 c2 t + c1 = 0, without cancellation.
        let discriminant = half_curvature * half_curvature - 3.0 * third * slope;
        if discriminant < 0.0 {
            return Vec::new();
        }
        let sum = -(half_curvature + discriminant.sqrt().copysign(half_curvature));
        let mut turns = vec![sum / (3.0 * third), slope / sum];
        turns.retain(|t| *t > 0.0 && *t < 1.0);
        turns.sort_by(f64::total_cmp);
        turns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_of_a_cubic_are_where_its_slope_vanishes() {
        // (t - 0.3)^2: one extreme; t^3 - 0.75 t^2 + 0.1 t: slope 3 t^2 - 1.5 t + 0.1 = 0 at 0.25 -+ sqrt(0.0625 - 1/30).
        let parabola = Cubic::new([0.09, 0.49], [-0.6, 1.4]);
        assert!((parabola.extremes()[0] - 0.3).abs() < 1e-12 && parabola.extremes().len() == 1);
        let cubic = Cubic::new([0.0, 0.35], [0.1, 1.6]);
        let half_width = (0.0625_f64 - 1.0 / 30.0).sqrt();
        for (found, expected) in cubic.extremes().iter().zip([0.25 - half_width, 0.25 + half_width]) {
            assert!((found - expected).abs() < 1e-12);
        }
        assert_eq!(Cubic::new([0.0, 1.0], [1.0, 1.0]).extremes(), Vec::<f64>::new());
    }
}
