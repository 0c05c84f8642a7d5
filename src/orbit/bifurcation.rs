//! Test functions of the local bifurcations of a periodic orbit.
//!
//! With trace T, sum of principal 2x2 minors S and determinant D of the derivative of the section map (3x3), a multiplier
//!
//! ```text
//! +1:              1 - T + S - D = 0
//! -1:              1 + T + S + D = 0
//! e^(+- i theta):  D^2 - T D + S - 1 = 0,   2 cos(theta) = T - D
//! ```
//!
//! The third also holds for a real pair with product 1 (a neutral saddle, no bifurcation), which |T - D| >= 2 tells apart. For
//! a half-period map -1 breaks the symmetry; it cannot double the period, since over the full period it is +1.

use crate::dynamics::Closure;
use nalgebra::Matrix3;

/// What happens to a periodic orbit at a special point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Bifurcation {
    /// Two orbits meet and vanish.
    Fold,
    /// A pair of complex multipliers crosses the unit circle: a torus is born (secondary Hopf).
    NeimarkSacker,
    PeriodDoubling,
    /// Another branch crosses: two asymmetric orbits leave the symmetric one.
    BranchPoint,
}

/// Which way a test function passes zero as a branch is followed. That of [`Bifurcation::NeimarkSacker`] has the sign of |multiplier| - 1
/// of its pair: upwards, the pair leaves the unit circle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passage {
    Upwards,
    Downwards,
    /// The point was not met on a branch.
    Unfollowed,
}

impl Bifurcation {
    /// Those that orbits with the given closure meet along a branch.
    #[must_use]
    pub fn possible(closure: Closure) -> [Self; 3] {
        match closure {
            Closure::HalfPeriod => [Self::Fold, Self::NeimarkSacker, Self::BranchPoint],
            Closure::FullPeriod { .. } => [Self::Fold, Self::NeimarkSacker, Self::PeriodDoubling],
        }
    }

    /// Changes its sign through the bifurcation; `jacobian` is the derivative of the section map at the orbit.
    #[must_use]
    pub fn test_function(self, jacobian: &Matrix3<f64>) -> f64 {
        let (t, s, d) = invariants(jacobian);
        match self {
            Self::Fold => 1.0 - t + s - d,
            Self::PeriodDoubling | Self::BranchPoint => 1.0 + t + s + d,
            Self::NeimarkSacker => d * d - t * d + s - 1.0,
        }
    }

    /// Whether a zero of the test function is the bifurcation: always, but for real pairs with product 1.
    #[must_use]
    pub(super) fn is_genuine(self, jacobian: &Matrix3<f64>) -> bool {
        let (t, _, d) = invariants(jacobian);
        self != Self::NeimarkSacker || (t - d).abs() < 2.0
    }
}

fn invariants(j: &Matrix3<f64>) -> (f64, f64, f64) {
    let minor = |a: usize, b: usize| j[(a, a)] * j[(b, b)] - j[(a, b)] * j[(b, a)];
    (j.trace(), minor(0, 1) + minor(0, 2) + minor(1, 2), j.determinant())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Similar to blocks with a pair `r e^(+- i theta)` and a real multiplier.
    fn with_multipliers(r: f64, theta: f64, real: f64) -> Matrix3<f64> {
        let (c, s) = (r * theta.cos(), r * theta.sin());
        let basis = Matrix3::new(1.0, 0.3, -0.2, 0.5, 1.1, 0.4, -0.1, 0.6, 0.9);
        basis * Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, real) * basis.try_inverse().unwrap()
    }

    #[test]
    fn each_test_function_vanishes_at_its_multipliers_and_nowhere_near() {
        let zero = |kind: Bifurcation, j: Matrix3<f64>| kind.test_function(&j).abs() < 1e-14;
        assert!(zero(Bifurcation::NeimarkSacker, with_multipliers(1.0, 0.7, 0.3)));
        assert!(zero(Bifurcation::Fold, with_multipliers(0.8, 0.7, 1.0)));
        assert!(zero(Bifurcation::PeriodDoubling, with_multipliers(0.8, 0.7, -1.0)));
        for kind in [Bifurcation::NeimarkSacker, Bifurcation::Fold, Bifurcation::BranchPoint] {
            assert!(!zero(kind, with_multipliers(0.9, 0.7, 0.3)));
        }
    }

    #[test]
    fn a_neutral_saddle_is_no_bifurcation() {
        let saddle = Matrix3::from_diagonal(&[2.0, 0.5, 0.3].into());
        assert!(Bifurcation::NeimarkSacker.test_function(&saddle).abs() < 1e-15);
        assert!(!Bifurcation::NeimarkSacker.is_genuine(&saddle));
        assert!(Bifurcation::NeimarkSacker.is_genuine(&with_multipliers(1.0, 0.7, 0.3)));
    }
}
