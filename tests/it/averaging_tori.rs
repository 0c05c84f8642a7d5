//! Tori of the slow flow: period doublings, multipliers, exponents.

use super::averaging::slow_flow;
use nalgebra::{DMatrix, DVector, Vector3};
use std::sync::Arc;
use stickslip::averaging::{
    EnergyDefinition, EnergyFrequency, Interpolation, NodeSpacing, SlowFlow, SlowTorus, hopf_points, period_doublings,
};
use stickslip::dynamics::TangentFlow;
use stickslip::model::RigParameters;

fn doublings(flow: &SlowFlow, count: usize) -> Vec<SlowTorus> {
    let hopf = hopf_points(flow).unwrap();
    period_doublings(flow, &hopf[0], count).unwrap().into_iter().map(|doubling| doubling.torus).collect()
}

#[test]
fn the_torus_doubles_where_an_outside_computation_says() {
    let expected = [
        (EnergyDefinition::MeanPotential, [-0.105_942, -0.127_459, -0.133_161, -0.134_679, -0.134_950]),
        (EnergyDefinition::EquivalentStiffness, [-0.105_812, -0.127_108, -0.132_620, -0.133_861, -0.134_042]),
    ];
    for (definition, expected) in expected {
        let found = doublings(&slow_flow(RigParameters::default(), definition), 5);
        for (i, (torus, expected)) in found.iter().zip(expected).enumerate() {
            // Given to six digits: half a unit of the last, and as much for the error of that computation.
            assert!((torus.xi1 - expected).abs() < 1e-6, "{definition:?} {i}: {}", torus.xi1);
            // The multiplier moves by 1e3 per unit of xi1 at least near the fifth, so this is 1e-10 in xi1 there.
            assert!((torus.multipliers()[0].re + 1.0).abs() < 1e-6, "{definition:?} {i}");
            // Newton's last step was below 1e-9 of the scales, 1500 of the period.
            assert!(torus.residual < 1e-7, "{definition:?} {i}: {:e}", torus.residual);
        }
        // Each cycle closes after twice the time of the one it left, up to the change of the frequency on the way.
        let periods: Vec<f64> = found.iter().map(|torus| torus.period).collect();
        assert!(periods.windows(2).all(|pair| (pair[1] / pair[0] - 2.0).abs() < 0.05), "{periods:?}");
    }
}

#[test]
fn four_hundred_nodes_move_the_first_doubling_by_less_than_the_paper_is_off() {
    let p = RigParameters::default();
    let at = |interpolation| {
        let frequency = EnergyFrequency::new(p, EnergyDefinition::MeanPotential, interpolation).unwrap();
        doublings(&SlowFlow::new(p, Arc::new(frequency)).unwrap(), 1)[0].xi1
    };
    let converged = at(Interpolation::Converged);
    let shifts = NodeSpacing::ALL.map(|spacing| at(Interpolation::Pchip { nodes: 400, spacing }) - converged);
    // Measured elsewhere, for other spacings: up to 1.6e-4. The distance to the printed digits is 3.7e-4.
    assert!(shifts.iter().all(|shift| shift.abs() < 3.7e-4), "{shifts:?}");
    // They are not the converged value: the interpolation does matter.
    assert!(shifts.iter().any(|shift| shift.abs() > 1e-6), "{shifts:?}");
    let many = at(Interpolation::Pchip { nodes: 5000, spacing: NodeSpacing::Arclength });
    // Integrated to 1e-8 of the state, and located to 1e-7 of xi1.
    assert!((many - converged).abs() < 3e-8, "{:e}", many - converged);
}

#[test]
fn the_monodromy_matrix_of_the_slow_flow_is_the_derivative_of_its_end() {
    let flow = slow_flow(RigParameters { xi1: -0.09, ..Default::default() }, EnergyDefinition::MeanPotential);
    // Through both kinks: a1 passes 1 on the way.
    let start = Vector3::new(0.85, 1.75, -0.2);
    let end = |start: Vector3<f64>, duration: f64| {
        let mut state = DVector::from_column_slice(start.as_slice());
        let mut tangents = DMatrix::identity(3, 3);
        flow.carry(&mut state, &mut tangents, duration).unwrap();
        (state, tangents)
    };
    let passes = (0..60).map(|n| end(start, f64::from(n)).0[0]).fold((0.0, 0.0), |(inside, outside): (f64, f64), a| {
        if a < 1.0 { (inside + 1.0, outside) } else { (inside, outside + 1.0) }
    });
    assert!(passes.0 >= 2.0 && passes.1 >= 2.0, "{passes:?}");
    let (_, tangents) = end(start, 60.0);
    let step = 1e-5;
    for i in 0..3 {
        let h = Vector3::ith(i, step);
        let difference = (end(start + h, 60.0).0 - end(start - h, 60.0).0) / (2.0 * step);
        // Errors of integration 1e-10 over the step, and step^2 times third derivatives; the derivative of the flow is continuous but not
        // smooth where the path through the kink moves.
        assert!(
            (&difference - tangents.column(i)).amax() < 1e-4 * tangents.amax().max(1.0),
            "{i} {difference} {tangents}"
        );
    }
}
