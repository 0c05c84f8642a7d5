//! Orbits without symmetry: where they leave the symmetric branch, and what happens to them.

use super::orbits::{MapAt, exact_at, from_the_sticking_limit};
use stickslip::dynamics::{Closure, HalfPeriodMap, ReversalPoint, SectionMap};
use stickslip::model::{RigParameter, RigParameters};
use stickslip::orbit::{
    Bifurcation, Branch, FloquetMultipliers, OrbitError, PseudoArclength, SpecialPoint, shoot_section,
};

/// Strong coupling and friction: the symmetric branch breaks its symmetry twice near xi1 = -0.18.
const BREAKING: RigParameters = RigParameters { xi1: -0.18, xi2: 0.0, kappa: 1.0, gamma: 0.8 };

fn symmetric_branch() -> Branch {
    Branch::follow(from_the_sticking_limit(BREAKING).up_to_amplitude(4.0), |_| false).unwrap()
}

fn switched(special: &SpecialPoint) -> PseudoArclength<MapAt> {
    PseudoArclength::switched(exact_at as MapAt, special, RigParameter::Xi1).unwrap()
}

#[test]
fn the_symmetry_breaks_where_a_half_period_multiplier_is_minus_one() {
    let branch = symmetric_branch();
    let points: Vec<_> = branch.special_of(Bifurcation::BranchPoint).collect();
    assert_eq!(points.len(), 2);
    for point in points {
        let distance =
            point.orbit.section_multipliers().map(|m| (m + 1.0).norm()).into_iter().fold(f64::INFINITY, f64::min);
        assert!(distance < 1e-12, "{distance:e}");
    }
}

#[test]
fn asymmetric_orbits_leave_there_in_mirrored_pairs() {
    let branch = symmetric_branch();
    for special in branch.special_of(Bifurcation::BranchPoint) {
        for point in switched(special).map(Result::unwrap).take(20).skip(2) {
            let flow = exact_at(point.parameters).unwrap();
            let orbit = point.orbit;
            assert!(orbit.residual < 1e-12);
            // The next reversal, mirrored, is another point: the start of the mirror image, with the same period and multipliers.
            let mirrored = flow.half_return(orbit.section).unwrap().image;
            assert!((mirrored - orbit.section).amax() > 1e-3);
            let image = shoot_section(&flow, mirrored, orbit.closure).unwrap();
            assert!((image.section - mirrored).amax() < 1e-11);
            assert!((image.period - orbit.period).abs() < 1e-11);
            // The monodromies are similar, traces agree to rounding.
            assert!((image.jacobian.trace() - orbit.jacobian.trace()).abs() < 1e-9);
            let multipliers = FloquetMultipliers::of(&flow, &orbit).unwrap();
            assert!(multipliers.trivial_error < 1e-10 && multipliers.zero.norm() < 1e-12);
        }
    }
}

#[test]
fn mirrored_orbits_fold_at_the_same_parameter() {
    // The branch runs through both pitchforks and meets the fold of the orbit and that of its mirror image.
    let start = symmetric_branch();
    let leaving = switched(start.special_of(Bifurcation::BranchPoint).next().unwrap());
    let branch = Branch::follow(leaving, |so_far| so_far.special.len() == 2 || so_far.points.len() > 500).unwrap();
    let [first, second] = branch.special[..] else { panic!("two folds expected: {:?}", branch.special.len()) };
    assert!(first.kind == Bifurcation::Fold && second.kind == Bifurcation::Fold);
    assert!((first.orbit.amplitude() - second.orbit.amplitude()).abs() > 0.1);
    // Both are located to 1e-10 by Newton's method; they agree far better.
    assert!((first.parameters.xi1 - second.parameters.xi1).abs() < 1e-12);
    assert!((first.orbit.period - second.orbit.period).abs() < 1e-9);
}

#[test]
fn no_branch_of_another_symmetry_leaves_a_fold() {
    let branch = symmetric_branch();
    let fold = branch.special_of(Bifurcation::Fold).next().unwrap();
    let error = PseudoArclength::switched(exact_at as MapAt, fold, RigParameter::Xi1).unwrap_err();
    assert!(matches!(error, OrbitError::NoBranchLeaves { kind: Bifurcation::Fold }));
}

#[test]
fn the_equilibrium_of_the_slip_phase_is_no_orbit() {
    // x = -K_slip^-1 (g, 0), v = 0 at f = +1 returns to itself after any time.
    let p = RigParameters { xi1: -0.1, xi2: 0.011, kappa: 0.1, gamma: 0.5 };
    let determinant = 0.6 * 1.1 - 0.01;
    let equilibrium = ReversalPoint::new(-0.5 * 1.1 / determinant, -0.5 * 0.1 / determinant, 0.0);
    let flow = exact_at(p).unwrap();
    for offset in [0.0, 1e-12, 1e-10] {
        let start = equilibrium + ReversalPoint::new(offset, 0.0, 0.0);
        assert!(flow.section_return(start, Closure::FullPeriod { cycles: 1 }, &[]).is_err());
    }
}
