//! The linearised flow against central finite differences of the flow, switches and starts beside them included.

use nalgebra::{DMatrix, DVector};
use stickslip::dynamics::{Closure, Outcome, ParameterTangent, ReversalPoint, SectionMap, State, TangentFlow};
use stickslip::exact::{Representation, TwoMassFlow};
use stickslip::model::{RigParameter, RigParameters, TwoMassRig};

const Y0: [f64; 5] = [1.2226496266, 0.9053979113, 0.0, -0.5377904062, 1.0];

fn flow(p: RigParameters) -> TwoMassFlow {
    TwoMassFlow::new(&TwoMassRig::new(p).unwrap())
}

fn carried(flow: &TwoMassFlow, y: [f64; 5], duration: f64) -> (DVector<f64>, DMatrix<f64>) {
    let (mut state, mut tangents) = (DVector::from_row_slice(&y), DMatrix::identity(5, 5));
    assert_eq!(flow.carry(&mut state, &mut tangents, duration).unwrap(), Outcome::Completed);
    (state, tangents)
}

fn end(flow: &TwoMassFlow, y: [f64; 5], duration: f64) -> DVector<f64> {
    let arrival = flow.advance(&State::two_mass(y), duration).unwrap();
    DVector::from_iterator(5, arrival.state.components())
}

/// Columns of the directions in `directions`, by central differences with `step`.
fn differences(flow: &TwoMassFlow, y: [f64; 5], duration: f64, step: f64, directions: &[usize]) -> DMatrix<f64> {
    let column = |&i: &usize| {
        let moved = |by: f64| {
            let mut y = y;
            y[i] += by;
            end(flow, y, duration)
        };
        (moved(step) - moved(-step)) / (2.0 * step)
    };
    DMatrix::from_columns(&directions.iter().map(column).collect::<Vec<_>>())
}

/// A difference quotient errs by `c step^2` from truncation and `1e-15/step` from rounding: about 1e-9 for step 1e-6 here,
/// times the growth over the span.
fn assert_tangent(flow: &TwoMassFlow, y: [f64; 5], duration: f64, directions: &[usize]) {
    let (state, tangents) = carried(flow, y, duration);
    assert_eq!(state, end(flow, y, duration));
    let expected = differences(flow, y, duration, 1e-6, directions);
    let found = DMatrix::from_columns(&directions.iter().map(|&i| tangents.column(i).into_owned()).collect::<Vec<_>>());
    let difference = (&found - &expected).amax();
    assert!(difference < 1e-7, "{difference:e} over {duration} from {y:?}\n{found}{expected}");
}

const ALL: [usize; 5] = [0, 1, 2, 3, 4];

#[test]
fn the_tangent_is_the_derivative_over_any_span() {
    let flow = flow(RigParameters::default());
    for duration in [0.0, 0.4, 1.0, 2.5, 3.4, 7.0, 20.0] {
        assert_tangent(&flow, [1.3, 0.4, -0.2, 0.3, 0.6], duration, &ALL);
    }
}

#[test]
fn it_is_the_derivative_just_before_and_just_after_every_switch() {
    let flow = flow(RigParameters::default());
    let y = [1.3, 0.4, -0.2, 0.3, 0.6];
    let motion = flow.solve(&State::two_mass(y), 40.0).unwrap();
    assert!(motion.events().len() >= 10);
    for event in motion.events() {
        // Further from the switch than the perturbation of 1e-6 moves it (by up to 1e-5).
        for beside in [-1e-4, 1e-4] {
            assert_tangent(&flow, y, event.time + beside, &ALL);
        }
    }
}

#[test]
fn a_start_in_slip_forgets_its_force() {
    let flow = flow(RigParameters::default());
    // f = 1 is at the edge of what is allowed: the other four directions by differences, the force only from inside.
    let y = [1.2, 0.5, 0.4, -0.3, 1.0];
    assert_tangent(&flow, y, 5.0, &[0, 1, 2, 3]);
    let (_, tangents) = carried(&flow, y, 5.0);
    assert_eq!(tangents.column(4).amax(), 0.0);
    let inside = [1.2, 0.5, 0.4, -0.3, 1.0 - 1e-6];
    // One-sided: slip begins 1e-6/0.4 later, which the end feels only at second order, 1e-12/1e-6.
    let quotient = (end(&flow, y, 5.0) - end(&flow, inside, 5.0)) / 1e-6;
    assert!(quotient.amax() < 1e-5, "{quotient}");
}

#[test]
fn it_is_the_derivative_in_the_series_representation() {
    let flow = flow(RigParameters { xi1: -0.05, xi2: -0.05, kappa: 0.0, gamma: 0.5 });
    assert_eq!(flow.representation(), Representation::Series);
    let y = [1.3, 0.4, -0.2, 0.3, 0.6];
    let (_, tangents) = carried(&flow, y, 6.0);
    let difference = (&tangents - differences(&flow, y, 6.0, 1e-6, &ALL)).amax();
    assert!(difference < 1e-7, "{difference:e}");
}

#[test]
fn cutting_a_motion_changes_nothing_even_at_a_switch() {
    let flow = flow(RigParameters::default());
    let (state, tangents) = carried(&flow, Y0, 12.0);
    let switch = flow.solve(&State::two_mass(Y0), 12.0).unwrap().events()[0].time;
    for cut in [0.5, switch, 5.0] {
        let (mut y, mut d) = carried(&flow, Y0, cut);
        flow.carry(&mut y, &mut d, 12.0 - cut).unwrap();
        // Roundings of a few exponentials.
        assert!((&y - &state).amax() < 1e-13 && (&d - &tangents).amax() < 1e-12);
    }
}

#[test]
fn the_vector_field_is_carried_into_the_vector_field() {
    let flow = flow(RigParameters::default());
    for y in [[1.3, 0.4, -0.2, 0.3, 0.6], Y0, [1.2, 0.5, 0.4, -0.3, 1.0]] {
        let before = flow.vector_field(&DVector::from_row_slice(&y)).unwrap();
        let (state, tangents) = carried(&flow, y, 30.0);
        let difference = (tangents * before - flow.vector_field(&state).unwrap()).amax();
        // Roundings of some ten phases.
        assert!(difference < 1e-12, "{difference:e}");
    }
}

#[test]
fn a_tangent_without_saltation_would_be_found() {
    // Starting in stick and ending in slip, the plain product of exponentials keeps the force's own response.
    let flow = flow(RigParameters::default());
    let y = [1.3, 0.4, -0.2, 0.3, 0.6];
    let switch = flow.solve(&State::two_mass(y), 20.0).unwrap().events()[0].time;
    let (_, before) = carried(&flow, y, switch - 1e-4);
    let (_, after) = carried(&flow, y, switch + 1e-4);
    assert!(before.row(4).amax() > 0.5);
    assert_eq!(after.row(4).amax(), 0.0);
}

#[test]
fn wrong_lengths_are_refused() {
    let flow = flow(RigParameters::default());
    let (mut short, mut tangents) = (DVector::zeros(4), DMatrix::identity(5, 5));
    assert!(flow.carry(&mut short, &mut tangents, 1.0).unwrap_err().to_string().contains("expected 5"));
    let (mut state, mut narrow) = (DVector::zeros(5), DMatrix::identity(4, 4));
    assert!(flow.carry(&mut state, &mut narrow, 1.0).unwrap_err().to_string().contains("expected 5"));
}

/// The derivative with respect to each parameter, by central differences.
fn parameter_difference(
    p: RigParameters,
    parameter: RigParameter,
    of: impl Fn(&TwoMassFlow) -> DVector<f64>,
) -> DVector<f64> {
    let step = 1e-6;
    let moved = |by: f64| of(&flow(p.with(parameter, p.get(parameter) + by)));
    (moved(step) - moved(-step)) / (2.0 * step)
}

#[test]
fn the_parameter_tangent_is_the_derivative_also_just_after_a_switch() {
    let p = RigParameters::default();
    let y = [1.3, 0.4, -0.2, 0.3, 0.6];
    let flow = flow(p);
    let switches = flow.solve(&State::two_mass(y), 40.0).unwrap();
    let beside = switches.events().iter().flat_map(|event| [event.time - 1e-3, event.time + 1e-3]);
    for duration in [0.3, 3.0, 15.0].into_iter().chain(beside) {
        let found = flow.parameter_tangents(&State::two_mass(y), duration, &RigParameter::ALL).unwrap();
        for (parameter, found) in RigParameter::ALL.into_iter().zip(found) {
            let expected = parameter_difference(p, parameter, |flow| end(flow, y, duration));
            let difference = (DVector::from_column_slice(found.as_slice()) - expected).amax();
            // As for states; third derivatives over 40 time units grow like 40^3, times step^2 = 1e-12.
            assert!(difference < 2e-7 * (1.0 + duration), "{difference:e} {parameter:?} over {duration}");
        }
    }
}

#[test]
fn section_maps_have_exact_derivatives() {
    let p = RigParameters { xi1: -0.08, kappa: 0.12, gamma: 0.45, xi2: 0.02 };
    let start = ReversalPoint::new(1.45, 0.8, -0.4);
    for closure in [Closure::HalfPeriod, Closure::FullPeriod { cycles: 1 }, Closure::FullPeriod { cycles: 3 }] {
        let image = |flow: &TwoMassFlow, start| flow.section_return(start, closure, &[]).unwrap().image;
        let found = flow(p).section_return(start, closure, &RigParameter::ALL).unwrap();
        for i in 0..3 {
            let mut step = ReversalPoint::zeros();
            step[i] = 1e-6;
            let expected = (image(&flow(p), start + step) - image(&flow(p), start - step)) / 2e-6;
            // Step 1e-6: rounding 1e-15/1e-6 and truncation 1e-12 times third derivatives of order 10 to 1e3.
            assert!((found.jacobian.column(i) - expected).amax() < 3e-8, "{closure:?}");
        }
        for (parameter, found) in RigParameter::ALL.into_iter().zip(&found.sensitivities) {
            let expected =
                parameter_difference(p, parameter, |flow| DVector::from_column_slice(image(flow, start).as_slice()));
            assert!(
                (DVector::from_column_slice(found.as_slice()) - expected).amax() < 3e-7,
                "{closure:?} {parameter:?}"
            );
        }
    }
}

#[test]
fn a_full_return_is_two_half_returns() {
    let flow = flow(RigParameters::default());
    let start = ReversalPoint::new(1.45, 0.8, -0.4);
    let first = flow.section_return(start, Closure::HalfPeriod, &[]).unwrap();
    let second = flow.section_return(first.image, Closure::HalfPeriod, &[]).unwrap();
    let full = flow.section_return(start, Closure::FullPeriod { cycles: 1 }, &[]).unwrap();
    // Roundings of one period.
    assert!((full.image - second.image).amax() < 1e-13);
    assert!((full.jacobian - second.jacobian * first.jacobian).amax() < 1e-12);
    assert!(flow.section_return(start, Closure::FullPeriod { cycles: 0 }, &[]).is_err());
}
