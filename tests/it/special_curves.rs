//! Curves of secondary Hopf points and folds over two parameters.

use super::orbits::{MapAt, exact_at, from_the_sticking_limit, nominal};
use stickslip::model::{RigParameter, RigParameters};
use stickslip::orbit::{Bifurcation, Branch, Heading, OrbitError, SpecialCurve, SpecialPoint};

fn branch(p: RigParameters) -> Branch {
    Branch::follow(from_the_sticking_limit(p).up_to_amplitude(5.0), |_| false).unwrap()
}

fn curve(kind: Bifurcation, second: RigParameter, heading: Heading) -> SpecialCurve<MapAt> {
    let start = *branch(nominal()).special_of(kind).next().unwrap();
    SpecialCurve::new(exact_at as MapAt, &start, [RigParameter::Xi1, second], heading).unwrap()
}

/// Points of the curve must be those that a branch over xi1 finds at their second parameter.
fn assert_found_by_branches(points: &[SpecialPoint]) {
    for point in points {
        let found = branch(point.parameters);
        let nearest = found
            .special_of(point.kind)
            .map(|other| (other.parameters.xi1 - point.parameters.xi1).abs())
            .fold(f64::INFINITY, f64::min);
        // Test function to 1e-11 over its slope in xi1, which is small where two points are about to meet.
        assert!(nearest < 1e-9, "{nearest:e} at {:?}", point.parameters);
    }
}

#[test]
fn the_hopf_curve_over_kappa_joins_start_and_end() {
    let curve = curve(Bifurcation::NeimarkSacker, RigParameter::Kappa, Heading::Decreasing);
    let points: Vec<_> = curve.take(60).map(Result::unwrap).collect();
    let kappa = |point: &SpecialPoint| point.parameters.kappa;
    let lowest = points.iter().position(|p| points.iter().all(|q| kappa(q) >= kappa(p))).unwrap();
    assert!(0 < lowest && lowest < points.len() - 1);
    // Perturbation theory, equation (32): start and end meet at nu = pi kappa^2/(gamma xi2) = 3. It holds to the leading orders
    // in kappa, so to some per cent.
    let expected = (3.0 * 0.5 * 0.011 / std::f64::consts::PI).sqrt();
    assert!((kappa(&points[lowest]) / expected - 1.0).abs() < 0.05, "{} {expected}", kappa(&points[lowest]));
    let sample: Vec<_> = points.iter().copied().filter(|p| p.orbit.amplitude() < 1.5).step_by(4).collect();
    assert!(sample.len() >= 5 && sample.iter().any(|p| p.parameters.xi1 < points[lowest].parameters.xi1));
    assert_found_by_branches(&sample);
}

#[test]
fn hopf_curves_run_over_gamma_and_xi2_as_well() {
    for (second, heading) in [
        (RigParameter::Gamma, Heading::Increasing),
        (RigParameter::Gamma, Heading::Decreasing),
        (RigParameter::Xi2, Heading::Increasing),
    ] {
        let points: Vec<_> = curve(Bifurcation::NeimarkSacker, second, heading).take(21).map(Result::unwrap).collect();
        let sample: Vec<_> = points.into_iter().step_by(5).collect();
        assert!((sample[4].parameters.get(second) - nominal().get(second)).abs() > 0.01);
        assert_found_by_branches(&sample);
    }
}

#[test]
fn the_fold_curve_goes_through_its_cusp() {
    let curve = curve(Bifurcation::Fold, RigParameter::Kappa, Heading::Decreasing);
    let points: Vec<_> = curve.map(Result::unwrap).take_while(|p| p.orbit.amplitude() > 1.5).collect();
    // At a cusp both parameters turn at once, while the orbit goes on changing.
    let moves: Vec<_> = points
        .windows(2)
        .map(|w| [w[1].parameters.xi1 - w[0].parameters.xi1, w[1].parameters.kappa - w[0].parameters.kappa])
        .collect();
    let turns: Vec<_> = moves.windows(2).filter(|w| w[0][0] * w[1][0] + w[0][1] * w[1][1] < 0.0).collect();
    assert_eq!(turns.len(), 1, "one cusp");
    assert!(points.windows(2).all(|w| w[1].orbit.amplitude() < w[0].orbit.amplitude()));
    // Below kappa = 0.077, where the curve has a maximum beyond the cusp, these folds lie on a branch of their own that does not
    // reach the sticking limit.
    let connected: Vec<_> = points.into_iter().take_while(|p| p.parameters.kappa > 0.08).step_by(2).collect();
    assert!(connected.len() >= 3);
    assert_found_by_branches(&connected);
}

#[test]
fn a_curve_needs_two_parameters() {
    let start = *branch(nominal()).special_of(Bifurcation::Fold).next().unwrap();
    let error = SpecialCurve::new(exact_at as MapAt, &start, [RigParameter::Xi1; 2], Heading::Increasing).unwrap_err();
    assert!(matches!(error, OrbitError::SameParameter { .. }));
}
