//! Branches of limit cycles: folds, multipliers along them, step control.

use super::orbits::{exact_at, from_the_sticking_limit, nominal};
use nalgebra::Complex;
use stickslip::exact::TwoMassFlow;
use stickslip::model::{RigParameter, RigParameters, TwoMassRig};
use stickslip::orbit::{
    Bifurcation, Branch, BranchPoint, FloquetMultipliers, Heading, OrbitError, PseudoArclength, limit_cycle,
};

fn multipliers(point: &BranchPoint) -> FloquetMultipliers {
    let flow = TwoMassFlow::new(&TwoMassRig::new(point.parameters).unwrap());
    FloquetMultipliers::of(&flow, &point.orbit).unwrap()
}

#[test]
fn the_branch_goes_through_its_fold_to_amplitude_50_with_clean_multipliers() {
    let branch = Branch::follow(from_the_sticking_limit(nominal()).up_to_amplitude(50.0), |_| false).unwrap();
    assert!(branch.points.last().unwrap().orbit.amplitude() > 50.0);
    for point in &branch.points {
        let found = multipliers(point);
        assert!(found.trivial_error < 1e-10, "{:e}", found.trivial_error);
        assert!(found.zero.norm() < 1e-12, "{:e}", found.zero.norm());
        // Over the full period the multipliers are the squares of those of the half-period map; known to half the digits
        // where two of them meet.
        let mut squares = point.orbit.section_multipliers().map(|m| m * m).to_vec();
        for other in found.others {
            let nearest = |m: &Complex<f64>| (m - other).norm();
            let index =
                (0..squares.len()).min_by(|&a, &b| nearest(&squares[a]).total_cmp(&nearest(&squares[b]))).unwrap();
            assert!(nearest(&squares.swap_remove(index)) < 1e-6 * other.norm().max(1.0));
        }
    }
}

#[test]
fn the_fold_is_where_it_was_computed_elsewhere() {
    let branch = Branch::follow(from_the_sticking_limit(nominal()).up_to_amplitude(5.0), |_| false).unwrap();
    let [fold] = branch.special_of(Bifurcation::Fold).collect::<Vec<_>>()[..] else { panic!("one fold expected") };
    // Given to nine digits and to five.
    assert!((fold.parameters.xi1 + 0.215051734).abs() < 1e-9, "{}", fold.parameters.xi1);
    assert!((fold.orbit.amplitude() - 2.7628).abs() < 5e-5);
    // No orbit of the branch goes beyond, and the parameter turns there.
    assert!(branch.points.iter().all(|point| point.parameters.xi1 >= fold.parameters.xi1));
    let turns = branch.points.windows(2).filter(|pair| pair[0].parameter_rate * pair[1].parameter_rate < 0.0);
    assert_eq!(turns.count(), 1);
}

#[test]
fn long_steps_allowed_lead_along_the_same_branch() {
    // Compared by amplitude, which grows along the branch: chords of the fine branch err by step^2/8 times the curvature.
    let follow = |step| {
        let branch = from_the_sticking_limit(nominal()).with_largest_step(step).up_to_amplitude(20.0);
        Branch::follow(branch, |_| false).unwrap().points
    };
    let (fine, bold) = (follow(0.005), follow(10.0));
    assert!(bold.len() * 5 < fine.len(), "{} {}", bold.len(), fine.len());
    let amplitude = |point: &BranchPoint| point.orbit.amplitude();
    for point in &bold[..bold.len() - 1] {
        let after = fine.partition_point(|other| amplitude(other) < amplitude(point)).max(1);
        let (a, b) = (&fine[after - 1], &fine[after]);
        let fraction = (amplitude(point) - amplitude(a)) / (amplitude(b) - amplitude(a));
        let xi1 = a.parameters.xi1 + fraction * (b.parameters.xi1 - a.parameters.xi1);
        assert!((point.parameters.xi1 - xi1).abs() < 1e-5, "{} {xi1}", point.parameters.xi1);
    }
}

#[test]
fn a_branch_may_be_followed_in_any_parameter() {
    // From the nominal cycle in each parameter and back in xi1: the same cycle as found directly.
    let start = nominal();
    let orbit = limit_cycle(start, exact_at).unwrap();
    for (parameter, heading) in [
        (RigParameter::Xi2, Heading::Increasing),
        (RigParameter::Kappa, Heading::Increasing),
        (RigParameter::Gamma, Heading::Decreasing),
    ] {
        let branch = PseudoArclength::new(exact_at, start, &orbit, parameter, heading).unwrap();
        let followed = branch.take(12).map(Result::unwrap).last().unwrap();
        assert_ne!(followed.parameters.get(parameter), start.get(parameter));
        let direct = limit_cycle(followed.parameters, exact_at).unwrap();
        // Both to the residual of 2e-13, divided by the distance of the multipliers from 1 (0.25).
        assert!((direct.section - followed.orbit.section).amax() < 1e-11);
    }
}

#[test]
fn a_branch_that_cannot_go_on_says_where_and_why() {
    // gamma = 1 is the end of the parameter's range.
    let start = RigParameters { gamma: 0.97, ..nominal() };
    let orbit = limit_cycle(start, exact_at).unwrap();
    let branch = PseudoArclength::new(exact_at, start, &orbit, RigParameter::Gamma, Heading::Increasing).unwrap();
    let error = branch.take(1000).find_map(Result::err).expect("gamma cannot exceed 1");
    assert!(matches!(&error, OrbitError::StepTooSmall { at, .. } if (at[3] - 1.0).abs() < 1e-5), "{error}");
    assert!(error.to_string().contains("gamma = 1.0"), "{error}");
}

#[test]
fn the_limit_cycle_has_the_digits_computed_elsewhere() {
    // At xi1 = -0.06, computed outside this project: to the last digit given.
    let orbit = limit_cycle(nominal(), exact_at).unwrap();
    for (found, expected, unit) in [
        (orbit.section[0], 1.2226496, 1e-7),
        (orbit.section[1], 0.9043979, 1e-7),
        (orbit.section[2], -0.5377904, 1e-7),
        (orbit.angular_frequency(), 0.98948851, 1e-8),
    ] {
        assert!((found - expected).abs() < 0.51 * unit, "{found} {expected}");
    }
    let [pair, conjugate, real] = orbit.section_multipliers();
    for (found, expected) in [(pair, Complex::new(0.977968, 0.248221)), (real, Complex::new(0.262700, 0.0))] {
        assert!((found - expected).norm() < 1e-6, "{found} {expected}");
    }
    assert_eq!(pair.conj(), conjugate);
}
