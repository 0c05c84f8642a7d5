//! Every Jacobian against central finite differences.

use nalgebra::Matrix3;
use stickslip::dynamics::{HalfPeriodMap, ReversalPoint};
use stickslip::exact::{Representation, TwoMassFlow};
use stickslip::model::{RigParameters, TwoMassRig};

fn flow(p: RigParameters) -> TwoMassFlow {
    TwoMassFlow::new(&TwoMassRig::new(p).unwrap())
}

fn central_difference(flow: &TwoMassFlow, start: ReversalPoint, step: f64) -> Matrix3<f64> {
    let image = |point| flow.half_return(point).unwrap().image;
    Matrix3::from_columns(&[0, 1, 2].map(|i| {
        let mut offset = ReversalPoint::zeros();
        offset[i] = step;
        (image(start + offset) - image(start - offset)) / (2.0 * step)
    }))
}

/// The difference quotient has an error of `c step^2` from truncation and `1e-15 scale/step` from rounding.
fn assert_derivative(flow: &TwoMassFlow, start: ReversalPoint, step: f64, allowed: f64) {
    let exact = flow.half_return(start).unwrap().jacobian;
    let difference = (exact - central_difference(flow, start, step)).amax();
    assert!(difference <= allowed, "{difference:e} at {start}\n{exact}");
}

#[test]
fn the_half_period_jacobian_is_the_derivative() {
    let flow = flow(RigParameters::default());
    // step 1e-5: truncation of order 1e-10, rounding 1e-10.
    assert_derivative(&flow, ReversalPoint::new(1.2226496, 0.9043979, -0.5377904), 1e-5, 1e-8);
    assert_derivative(&flow, ReversalPoint::new(1.5, 0.4, 0.3), 1e-5, 1e-8);
}

#[test]
fn it_is_the_derivative_also_where_slip_begins_just_after_the_start() {
    let flow = flow(RigParameters::default());
    // At x1 = 300 the slider takes 0.12 time units to reverse: f = 1 - 150 t^2. Steps and errors scale with the amplitude.
    let start = ReversalPoint::new(300.0, -20.0, 150.0);
    assert!(flow.half_return(start).is_ok());
    assert_derivative(&flow, start, 1e-3, 1e-7);
}

#[test]
fn it_is_the_derivative_in_the_series_representation() {
    // kappa = 0, xi1 = xi2: uncoupled masses with equal eigenvalues while sticking.
    let flow = flow(RigParameters { xi1: -0.05, xi2: -0.05, kappa: 0.0, gamma: 0.5 });
    assert_eq!(flow.representation(), Representation::Series);
    assert_derivative(&flow, ReversalPoint::new(1.6, 0.9, -0.5), 1e-5, 1e-8);
}

#[test]
fn the_multipliers_at_the_limit_cycle_are_the_published_ones() {
    // Newton's method on the fixed point, then the eigenvalues: 0.262700 and 0.977968 +- 0.248221 i, computed outside this
    // project to six digits.
    let flow = flow(RigParameters::default());
    let mut point = ReversalPoint::new(1.2226496, 0.9043979, -0.5377904);
    for _ in 0..5 {
        let half = flow.half_return(point).unwrap();
        point -= (half.jacobian - Matrix3::identity()).try_inverse().unwrap() * (half.image - point);
    }
    let half = flow.half_return(point).unwrap();
    assert!((half.image - point).amax() < 1e-14);
    // Given to seven digits, as is the angular frequency pi / duration = 0.98948851.
    assert!((point - ReversalPoint::new(1.2226496, 0.9043979, -0.5377904)).amax() < 6e-8);
    assert!((std::f64::consts::PI / half.duration - 0.98948851).abs() < 6e-9);
    let multipliers = half.jacobian.complex_eigenvalues();
    for (re, im) in [(0.262700, 0.0), (0.977968, 0.248221), (0.977968, -0.248221)] {
        let found = multipliers.iter().any(|m| (m.re - re).abs() < 1e-6 && (m.im - im).abs() < 1e-6);
        assert!(found, "{multipliers}");
    }
}
