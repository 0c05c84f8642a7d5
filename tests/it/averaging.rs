//! Slow flow: fixed points and their bifurcations against values computed outside this project; derivatives against finite differences.

use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;
use stickslip::averaging::{
    EnergyDefinition, EnergyFrequency, Interpolation, SlowFlow, fixed_point, folds, hopf_points,
};
use stickslip::model::RigParameters;

pub fn slow_flow(parameters: RigParameters, definition: EnergyDefinition) -> SlowFlow {
    let frequency = EnergyFrequency::new(parameters, definition, Interpolation::Converged).unwrap();
    SlowFlow::new(parameters, Arc::new(frequency)).unwrap()
}

#[test]
fn the_secondary_hopf_point_is_at_the_published_place() {
    for (definition, expected) in
        [(EnergyDefinition::MeanPotential, -0.035_002_1), (EnergyDefinition::EquivalentStiffness, -0.034_834_4)]
    {
        let flow = slow_flow(RigParameters::default(), definition);
        let found = hopf_points(&flow).unwrap();
        println!("{definition:?} {found:?}");
        // Seven digits are given.
        assert!((found[0].point.xi1 - expected).abs() < 1e-7, "{definition:?}: {}", found[0].point.xi1);
    }
}

#[test]
fn the_fold_of_the_limit_cycles_does_not_need_the_energy() {
    let found = folds(RigParameters::default(), 10.0).unwrap();
    assert_eq!(found.len(), 1);
    let cycle = found[0].cycle;
    // As many digits as are given.
    assert!((cycle.xi1 - -0.213_986_24).abs() < 1e-8, "{}", cycle.xi1);
    assert!((cycle.amplitude - 2.726_382).abs() < 1e-6 && (cycle.angular_frequency - 0.884_481).abs() < 1e-6);
}

#[test]
fn the_jacobian_of_the_slow_flow_is_its_derivative() {
    for definition in [EnergyDefinition::MeanPotential, EnergyDefinition::EquivalentStiffness] {
        let flow = slow_flow(RigParameters::default(), definition);
        for state in [[1.3, 1.1, -0.4], [0.7, 0.9, 0.8], [2.5, -0.3, 1.9], [0.5, 0.2, -0.1], [4.0, 3.0, 0.0]] {
            let state = Vector3::from(state);
            let found = flow.slow_rate(&state);
            let step = 1e-5;
            let columns = [0, 1, 2].map(|i| {
                let h = Vector3::ith(i, step);
                (flow.slow_rate(&(state + h)).rate - flow.slow_rate(&(state - h)).rate) / (2.0 * step)
            });
            let difference = Matrix3::from_columns(&columns);
            // Central differences: step^2 times third derivatives of order 1, and roundings over the step 1e-11; w(E) has jumps of its
            // second derivative at nodes, of size 1e-3 at most: 1e-8.
            assert!((difference - found.jacobian).amax() < 1e-7, "{state:?} {difference} {}", found.jacobian);
            let xi1 = flow.parameters().xi1;
            let rate = |by: f64| flow.with_xi1(xi1 + by).unwrap().slow_rate(&state).rate;
            let difference = (rate(step) - rate(-step)) / (2.0 * step);
            assert!((difference - found.xi1_derivative).amax() < 1e-9, "{state:?}");
        }
    }
}

#[test]
fn the_fixed_point_is_stable_before_the_hopf_point_and_unstable_after() {
    for (xi1, stable) in [(-0.02, true), (-0.034, true), (-0.036, false), (-0.1, false)] {
        let flow = slow_flow(RigParameters { xi1, ..Default::default() }, EnergyDefinition::MeanPotential);
        let point = fixed_point(&flow).unwrap();
        assert_eq!(point.stable(), stable, "{xi1}");
        assert!(flow.slow_rate(&point.state).rate.amax() < 1e-13);
    }
}
