//! The exact flow of large chains against the general chain flow, the two-mass flow and its own energy ledger.

use nalgebra::{DMatrix, DVector};
use stickslip::dynamics::{EventKind, Flow, Motion, Outcome, Sampling, State, TangentFlow};
use stickslip::exact::{ChainFlow, SparseFlow, TwoMassFlow};
use stickslip::model::{
    Aerodynamics, BladedDisk, ContactPlace, DiskSegments, FrictionContacts, InfluenceCoefficient, Mistuning,
    OscillatorChain, RigParameters, TwoMassRig,
};

/// A mistuned ring with everything a disk can have: segments, foot and shroud contacts, influence coefficients.
pub fn everything(sectors: usize, coupling: f64) -> BladedDisk {
    let l = |offset, real, imaginary| InfluenceCoefficient { offset, real, imaginary };
    BladedDisk {
        damping: 0.002,
        segments: Some(DiskSegments { mass: 2.0, stiffness: 1.5 }),
        friction: vec![
            FrictionContacts::everywhere(ContactPlace::Foot, 0.4),
            FrictionContacts { slip_elongation: 0.7, ..FrictionContacts::everywhere(ContactPlace::NextBlade, 0.1) },
        ],
        aerodynamics: Some(Aerodynamics::Coefficients {
            coefficients: vec![l(0, 0.0, -0.03), l(1, 0.02, 0.0), l(-1, -0.02, 0.004)],
            reference_frequency: 1.0,
        }),
        mistuning: Some(Mistuning::Normal { standard_deviation: 0.03, seed: 11 }),
        ..BladedDisk::ring(sectors, coupling)
    }
}

/// Irregular displacements, at rest.
pub fn scattered(chain: &OscillatorChain, amplitude: f64) -> State {
    let n = chain.oscillators();
    let positions = (0..n).map(|i| amplitude * (2.4 * (i * i) as f64 + 0.3).sin()).collect();
    State { positions, ..State::rest(chain) }
}

#[test]
fn a_ring_with_everything_moves_as_the_general_chain_flow_says() {
    let chain = everything(5, 0.3).chain().unwrap();
    let start = scattered(&chain, 1.5);
    let (general, sparse) = (ChainFlow::new(&chain), SparseFlow::new(&chain));
    let [a, b] = [general.solve(&start, 120.0), sparse.solve(&start, 120.0)].map(Result::unwrap);
    let kinds = |kind| a.events().iter().filter(|event| event.kind == kind).count();
    assert!(kinds(EventKind::StickToSlip) > 150 && kinds(EventKind::SlipToStick) > 150);
    assert_eq!(a.events().len(), b.events().len());
    for (a, b) in a.events().iter().zip(b.events()) {
        assert_eq!((a.element, a.kind), (b.element, b.kind));
        assert!((a.time - b.time).abs() < 1e-11 && a.state.max_difference(&b.state) < 1e-11, "{a:?} {b:?}");
    }
    for t in [0.0, 0.1, 33.3, 77.7, 120.0] {
        let (a, b) = (a.state_at(t).unwrap(), b.state_at(t).unwrap());
        assert_eq!(a.contacts, b.contacts);
        // Two roundings of the same motion, some 500 events later.
        assert!(a.state.max_difference(&b.state) < 1e-11, "{t}: {:e}", a.state.max_difference(&b.state));
    }
    // Negative control: a millionth of the coupling is seen.
    let other = SparseFlow::new(&everything(5, 0.3000003).chain().unwrap()).solve(&start, 120.0).unwrap();
    assert!(other.state(120.0).unwrap().max_difference(&a.state(120.0).unwrap()) > 1e-8);
}

#[test]
fn two_masses_move_as_the_two_mass_flow_says() {
    let rig = TwoMassRig::new(RigParameters::default()).unwrap();
    let start = State::two_mass([1.2226496266, 0.9053979113, 0.0, -0.5377904062, 1.0]);
    let arrival = SparseFlow::new(rig.chain()).advance(&start, 2000.0).unwrap();
    // Computed with 50 digits outside this project.
    let reference =
        State::two_mass([1.17683461371815, 1.142441921330231, -0.00277934897911, -0.307457641547716, 0.99999649751427]);
    let error = arrival.state.max_difference(&reference);
    // Rounding over 1260 events on a motion that multiplies it by about 100.
    assert!(error < 5e-11, "{error:e}");
    assert_eq!(arrival.switches, 1260);
}

#[test]
fn what_is_kept_observed_and_only_followed_is_one_motion() {
    let chain = everything(4, 0.2).chain().unwrap();
    let (flow, start) = (SparseFlow::new(&chain), scattered(&chain, 1.5));
    let sampling = Sampling { interval: 0.37, t_end: 30.0 };
    let kept = flow.trajectory(&start, sampling).unwrap();
    let mut seen = Vec::new();
    let arrival = flow.observe(&start, sampling, |t, state, contacts| seen.push((t, state.clone(), contacts.to_vec())));
    let arrival = arrival.unwrap();
    assert_eq!(seen.len(), kept.samples.len());
    for (sample, (t, state, contacts)) in kept.samples.iter().zip(&seen) {
        assert_eq!((sample.time, &sample.contacts), (*t, contacts));
        // Another order of the same series: its remainder and rounding.
        assert!(sample.state.max_difference(state) < 1e-14);
    }
    assert_eq!(arrival.switches, kept.switches());
    assert_eq!(flow.advance(&start, 30.0).unwrap(), arrival);
}

#[test]
fn the_ledger_of_a_ring_balances_and_the_antisymmetric_stiffness_does_work() {
    let chain = everything(6, 0.3).chain().unwrap();
    let trajectory =
        SparseFlow::new(&chain).trajectory(&scattered(&chain, 1.5), Sampling { interval: 1.0, t_end: 100.0 }).unwrap();
    // Rounding of some 1e4 terms of size below 1, the energy being about 10.
    assert!(trajectory.energy_residual() < 1e-11, "{:e}", trajectory.energy_residual());
    let works = trajectory.last().unwrap().ledger.works;
    assert!(works.circulatory.abs() > 0.01 && works.friction < -1.0 && works.self_excitation > 0.1, "{works:?}");
}

#[test]
fn a_motion_without_friction_diverges_at_the_time_of_its_exponential() {
    let air = Aerodynamics::Coefficients {
        coefficients: vec![InfluenceCoefficient { offset: 0, real: 0.0, imaginary: -0.2 }],
        reference_frequency: 1.0,
    };
    let disk = BladedDisk { aerodynamics: Some(air), ..BladedDisk::ring(3, 0.0) };
    let chain = disk.chain().unwrap();
    let flow = SparseFlow::new(&chain).with_amplitude_bound(50.0).unwrap();
    let start = State { positions: vec![1.0; 3], ..State::rest(&chain) };
    let Outcome::Diverged { time, .. } = flow.advance(&start, 200.0).unwrap().outcome else { panic!("bounded") };
    // x = exp(0.1 t) (cos w t - 0.1/w sin w t), w^2 = 0.99.
    let w = 0.99_f64.sqrt();
    let x = |t: f64| (0.1 * t).exp() * ((w * t).cos() - 0.1 / w * (w * t).sin());
    assert!((x(time).abs() - 50.0).abs() < 1e-11, "{time} {}", x(time));
    let earlier = (0..(time / 0.001) as usize).map(|n| x(n as f64 * 0.001).abs()).fold(0.0, f64::max);
    assert!(earlier <= 50.0);
}

fn carried(flow: &impl TangentFlow, start: &State, tangents: DMatrix<f64>, span: f64) -> (DVector<f64>, DMatrix<f64>) {
    let (mut y, mut tangents) = (DVector::from_iterator(flow.dimension(), start.components()), tangents);
    flow.carry(&mut y, &mut tangents, span).unwrap_or_else(|error| panic!("{error}"));
    (y, tangents)
}

#[test]
fn the_tangent_of_two_masses_is_that_of_the_two_mass_flow() {
    let rig = TwoMassRig::new(RigParameters::default()).unwrap();
    let start = State::two_mass([1.3, 0.5, 0.2, -0.5, 0.4]);
    let (_, a) = carried(&SparseFlow::new(rig.chain()), &start, DMatrix::identity(5, 5), 50.0);
    let (_, b) = carried(&TwoMassFlow::new(&rig), &start, DMatrix::identity(5, 5), 50.0);
    assert!((&a - &b).amax() < 1e-12 * b.amax(), "{:e}", (&a - &b).amax());
}

#[test]
fn the_tangent_of_a_ring_is_the_derivative_of_its_motion() {
    let chain = everything(3, 0.3).chain().unwrap();
    let flow = SparseFlow::new(&chain);
    let start = scattered(&chain, 1.5);
    let n = flow.dimension();
    let (_, tangents) = carried(&flow, &start, DMatrix::identity(n, n), 25.0);
    let h = 1e-6;
    let moved = |i: usize, by: f64| {
        let mut y: Vec<f64> = start.components().collect();
        y[i] += by;
        let state = State::from_components(&y, &chain).unwrap();
        let end: Vec<f64> = flow.advance(&state, 25.0).unwrap().state.components().collect();
        DVector::from_vec(end)
    };
    for i in 0..n {
        let difference = (moved(i, h) - moved(i, -h)) / (2.0 * h);
        // Central differences: rounding 1e-14/1e-6 and third derivatives times 1e-12.
        assert!(
            (tangents.column(i) - &difference).amax() < 2e-6,
            "{i}: {:e}",
            (tangents.column(i) - difference).amax()
        );
    }
}

#[test]
fn a_motion_cut_in_pieces_carries_the_same_tangents() {
    let chain = everything(3, 0.3).chain().unwrap();
    let flow = SparseFlow::new(&chain);
    let start = scattered(&chain, 1.5);
    let n = flow.dimension();
    let (whole_end, whole) = carried(&flow, &start, DMatrix::identity(n, n), 12.0);
    let (middle, first) = carried(&flow, &start, DMatrix::identity(n, n), 5.3);
    let middle = State::from_components(middle.as_slice(), &chain).unwrap();
    let (end, second) = carried(&flow, &middle, first, 6.7);
    assert!((end - whole_end).amax() < 1e-12 && (second - &whole).amax() < 1e-12 * whole.amax());
    // The field is carried into itself.
    let y = DVector::from_iterator(n, start.components());
    let field = flow.vector_field(&y).unwrap();
    let (end, carried_field) = carried(&flow, &start, DMatrix::from_columns(&[field]), 12.0);
    assert!((flow.vector_field(&end).unwrap() - carried_field.column(0)).amax() < 1e-11);
}
