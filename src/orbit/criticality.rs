//! Criticality of a Neimark-Sacker point, by iterating the section map at the critical parameter itself.
//!
//! Near the orbit the map has the normal form, in the coordinate w of the pair of multipliers `m = e^(i theta)`,
//!
//! ```text
//! w -> m w (1 + a |w|^2),     hence   1/|w_n|^2 = 1/|w_0|^2 - 2 Re(a) n      to leading order
//! ```
//!
//! Re(a) is read off two means of 1/|w|^2, one early and one late: the terms left out of the normal form turn with theta and
//! average out. Done at two radii, which must agree. Re(a) < 0: a stable torus is born beyond the point (supercritical);
//! Re(a) > 0: an unstable one lies before it, and the motion jumps away (subcritical).

use super::bifurcation::Bifurcation;
use super::error::OrbitError;
use super::special::SpecialPoint;
use crate::dynamics::{ReversalPoint, SectionMap};
use nalgebra::{Complex, Matrix3, Vector3};

/// Radii |w| at the start, relative to the state.
const RADII: [f64; 2] = [0.005, 0.0025];
/// Returns over which each mean is taken, and returns between the two means.
const WINDOW: usize = 500;
const APART: usize = 3000;
/// Largest difference of the two results, relative to their mean.
const AGREEMENT: f64 = 0.2;

/// How a torus is born.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Criticality {
    Supercritical,
    Subcritical,
}

/// Re(a) of the normal form, per return and squared unit of w, where the state is displaced by `2 Re(w p)`, |p| = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalForm {
    pub coefficient: f64,
    /// Difference of the results at two radii.
    pub uncertainty: f64,
}

impl NormalForm {
    /// `map` is the section map at the parameters of `point`.
    ///
    /// # Errors
    /// [`OrbitError::NoPair`] unless `point` is a Neimark-Sacker point, [`OrbitError::Undecided`] if the radii disagree (a strong
    /// resonance, or Re(a) too small), and what the map returns.
    pub fn of<M: SectionMap>(map: &M, point: &SpecialPoint) -> Result<Self, OrbitError> {
        let no_pair = || OrbitError::NoPair { kind: point.kind };
        if point.kind != Bifurcation::NeimarkSacker {
            return Err(no_pair());
        }
        let angle = point.rotation_angle().ok_or_else(no_pair)?;
        let plane = CriticalPlane::new(&point.orbit.jacobian, Complex::from_polar(1.0, angle)).ok_or_else(no_pair)?;
        let size = point.orbit.section.amax().max(1.0);
        let [outer, inner] = RADII.map(|radius| plane.coefficient(map, point, radius * size));
        let (outer, inner) = (outer?, inner?);
        let (coefficient, uncertainty) = (0.5 * (outer + inner), (outer - inner).abs());
        if uncertainty > AGREEMENT * coefficient.abs() {
            return Err(OrbitError::Undecided { outer, inner, allowed: AGREEMENT });
        }
        Ok(Self { coefficient, uncertainty })
    }

    #[must_use]
    pub fn criticality(&self) -> Criticality {
        if self.coefficient < 0.0 { Criticality::Supercritical } else { Criticality::Subcritical }
    }
}

/// The plane of the critical pair: right eigenvector p (|p| = 1) and left eigenvector s, `s . p = 1`, so `w = s . (z - z0)`.
struct CriticalPlane {
    right: Vector3<Complex<f64>>,
    left: Vector3<Complex<f64>>,
}

impl CriticalPlane {
    fn new(jacobian: &Matrix3<f64>, multiplier: Complex<f64>) -> Option<Self> {
        let shifted = jacobian.map(|entry| Complex::new(entry, 0.0)) - Matrix3::identity() * multiplier;
        let right = null_vector(&shifted);
        let left = null_vector(&shifted.transpose());
        let product = left.dot(&right);
        (product.norm() > 0.0).then(|| Self { right, left: left / product })
    }

    fn coefficient<M: SectionMap>(&self, map: &M, point: &SpecialPoint, radius: f64) -> Result<f64, OrbitError> {
        let origin = point.orbit.section;
        let mut section: ReversalPoint = origin + self.right.map(|entry| 2.0 * radius * entry.re);
        let mut means = [0.0; 2];
        for n in 0..APART + WINDOW {
            section = map
                .section_return(section, point.orbit.closure, &[])
                .map_err(|source| OrbitError::Map { at: section.into(), source: Box::new(source) })?
                .image;
            let w = self.left.dot(&(section - origin).map(|entry| Complex::new(entry, 0.0)));
            let share = 1.0 / (w.norm_sqr() * WINDOW as f64);
            match n {
                0..WINDOW => means[0] += share,
                APART.. => means[1] += share,
                _ => {}
            }
        }
        Ok((means[0] - means[1]) / (2.0 * APART as f64))
    }
}

/// Unit vector that a matrix of rank 2 maps to zero: across two of its rows, the pair that is most independent.
fn null_vector(matrix: &Matrix3<Complex<f64>>) -> Vector3<Complex<f64>> {
    let row = |i: usize| matrix.row(i % 3).transpose();
    let candidates = [0, 1, 2].map(|i: usize| row(i).cross(&row(i + 1)));
    let [a, b, c] = candidates;
    let longer = if a.norm() >= b.norm() { a } else { b };
    let longest = if longer.norm() >= c.norm() { longer } else { c };
    longest / Complex::new(longest.norm().max(f64::MIN_POSITIVE), 0.0)
}

#[cfg(test)]
mod tests {
    use super::super::shooting::PeriodicOrbit;
    use super::*;
    use crate::dynamics::{Closure, SectionReturn};
    use crate::model::{RigParameter, RigParameters};

    /// The normal form with a contracting third direction and a quadratic term, in slanted coordinates.
    struct Known {
        coefficient: f64,
        angle: f64,
    }

    const BASIS: Matrix3<f64> = Matrix3::new(1.0, 0.0, 0.3, 0.2, 1.0, 0.0, 0.0, 0.0, 1.0);
    const ORIGIN: [f64; 3] = [1.0, 0.5, -0.3];

    impl Known {
        fn linear(&self) -> Matrix3<f64> {
            let (s, c) = self.angle.sin_cos();
            BASIS * Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 0.4) * BASIS.try_inverse().unwrap()
        }
    }

    impl SectionMap for Known {
        type Error = std::fmt::Error;

        fn section_return(
            &self,
            start: ReversalPoint,
            _: Closure,
            _: &[RigParameter],
        ) -> Result<SectionReturn, Self::Error> {
            let origin = ReversalPoint::from(ORIGIN);
            let local = BASIS.try_inverse().unwrap() * (start - origin);
            let w = Complex::new(local[0], local[1]);
            let image = Complex::from_polar(1.0, self.angle) * w * (1.0 + self.coefficient * w.norm_sqr());
            let image = origin + BASIS * Vector3::new(image.re, image.im, 0.4 * local[2] + 0.1 * local[0] * local[0]);
            Ok(SectionReturn { image, duration: 1.0, jacobian: self.linear(), sensitivities: Vec::new() })
        }
    }

    fn found(coefficient: f64) -> NormalForm {
        let map = Known { coefficient, angle: 0.7 };
        let orbit = PeriodicOrbit {
            section: ORIGIN.into(),
            period: 1.0,
            closure: Closure::HalfPeriod,
            jacobian: map.linear(),
            residual: 0.0,
        };
        let parameters = RigParameters::default();
        let point = SpecialPoint {
            kind: Bifurcation::NeimarkSacker,
            parameters,
            orbit,
            test_residual: 0.0,
            passage: crate::orbit::Passage::Unfollowed,
        };
        NormalForm::of(&map, &point).unwrap()
    }

    #[test]
    fn a_known_coefficient_of_either_sign_is_found() {
        // The eigenvector B (1, -i, 0)^T has length sqrt(2.04): u + i v = 2 w / sqrt(2.04), so |u + i v|^2 = (4/2.04) |w|^2.
        let scale = 4.0 / 2.04;
        for coefficient in [-0.8, 0.8] {
            let normal_form = found(coefficient);
            // Higher orders: a |w|^2 = 1e-4 relative, times the returns' growth.
            assert!((normal_form.coefficient / (coefficient * scale) - 1.0).abs() < 0.01, "{normal_form:?}");
        }
        assert_eq!(found(-0.8).criticality(), Criticality::Supercritical);
        assert_eq!(found(0.8).criticality(), Criticality::Subcritical);
    }
}
