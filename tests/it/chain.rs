//! The general chain: against the two-mass flow, against a general ODE solver, against closed forms of one oscillator.

use crate::general_solver;
use nalgebra::DMatrix;
use stickslip::dynamics::{Flow, Sampling, State};
use stickslip::exact::{ChainFlow, TwoMassFlow};
use stickslip::model::{Attachment, ChainBuilder, JenkinsElement, OscillatorChain, RigParameters, TwoMassRig};

const START: [f64; 5] = [1.2226496266, 0.9053979113, 0.0, -0.5377904062, 1.0];

#[test]
fn two_oscillators_move_as_the_two_mass_rig() {
    // Matrix exponential by series against modal coordinates: two representations, one motion. Rounding grows by about 100
    // in 500 time units.
    for xi1 in [-0.03, -0.06, -0.12] {
        let rig = TwoMassRig::new(RigParameters { xi1, ..RigParameters::default() }).unwrap();
        let (chain, two_mass) = (ChainFlow::new(rig.chain()), TwoMassFlow::new(&rig));
        let [a, b] = [chain.solve(&State::two_mass(START), 500.0), two_mass.solve(&State::two_mass(START), 500.0)]
            .map(Result::unwrap);
        assert_eq!(a.events().len(), b.events().len());
        assert!(a.events().len() > 300);
        for (a, b) in a.events().iter().zip(b.events()) {
            assert!((a.time - b.time).abs() < 1e-11 && a.kind == b.kind, "{a:?} {b:?}");
        }
        for t in [0.0, 1.0, 123.4, 500.0] {
            let (a, b) = (a.state_at(t).unwrap(), b.state_at(t).unwrap());
            assert!(a.state.max_difference(&b.state) <= 1e-11, "{xi1} at {t}");
            assert_eq!(a.contacts, b.contacts);
        }
    }
}

/// Five oscillators in a row, unequal, with non-symmetric coupling; elements to ground, and between two of them.
fn five(asymmetry: f64) -> OscillatorChain {
    let element = |attachment, stiffness, slip_force| JenkinsElement { attachment, stiffness, slip_force };
    let influence = DMatrix::from_fn(5, 5, |i, j| if j == (i + 1) % 5 { asymmetry } else { 0.0 });
    let mut builder = ChainBuilder::new(vec![1.0, 1.2, 0.9, 1.1, 1.0])
        .add_self_excitation(&influence)
        .add_stiffness(&(0.5 * influence))
        .jenkins(element(Attachment::Ground(0), 0.5, 0.4))
        .jenkins(element(Attachment::Between(1, 3), 0.8, 0.3))
        .jenkins(element(Attachment::Ground(4), 0.3, 0.6));
    for i in 0..5 {
        builder = builder.ground_spring(i, 0.7 + 0.1 * i as f64).self_excited(i, -0.04).ground_damper(i, 0.01);
    }
    for i in 0..4 {
        builder = builder.coupling_spring(i, i + 1, 0.2).coupling_damper(i, i + 1, 0.01);
    }
    builder.build().unwrap()
}

fn five_start() -> State {
    State {
        positions: vec![1.0, -0.5, 0.8, 0.3, -1.2],
        velocities: vec![0.2, 0.9, -0.4, 0.1, 0.6],
        slider_forces: vec![0.3, -0.8, 0.1],
    }
}

#[test]
fn five_oscillators_with_three_elements_move_as_a_general_solver_says() {
    let chain = five(0.05);
    let motion = ChainFlow::new(&chain).solve(&five_start(), 100.0).unwrap();
    let end = motion.state_at(100.0).unwrap().state;
    let (state, switches) = general_solver::solve(&chain, &five_start(), 100.0, 1e-12);
    let elements = [0, 1, 2].map(|j| motion.events().iter().filter(|event| event.element == j).count());
    assert!(elements.iter().all(|&count| count >= 10), "every element should switch: {elements:?}");
    assert_eq!(motion.events().len(), switches);
    // The solver's tolerance of 1e-12 per step, about 1e4 steps, and its dense output at events.
    let difference = end.max_difference(&state);
    assert!(difference <= 1e-7, "{difference:e}");
    // Negative control: a slightly different chain is told apart.
    let other = ChainFlow::new(&five(0.0501)).solve(&five_start(), 100.0).unwrap();
    assert!(other.state_at(100.0).unwrap().state.max_difference(&state) > 1e-4);
}

#[test]
fn the_ledger_of_five_oscillators_balances_with_circulatory_work() {
    let sampling = Sampling { interval: 0.5, t_end: 300.0 };
    let trajectory = ChainFlow::new(&five(0.05)).trajectory(&five_start(), sampling).unwrap();
    // Rounding of some 1e4 terms of size below 1e-1.
    assert!(trajectory.energy_residual() <= 3e-11, "{:e}", trajectory.energy_residual());
    let works = trajectory.last().unwrap().ledger.works;
    assert!(works.circulatory.abs() > 0.1 && works.damping < -0.1 && works.friction < -1.0, "{works:?}");
    assert_eq!(works.drive, 0.0);
}

#[test]
fn a_sliding_block_on_its_slider_alone_stops_after_v_squared_over_2_r() {
    // Mass 2 on a Jenkins element only: K is zero, all eigenvalues vanish while it slips. From f = 1 with velocity v it
    // decelerates with R/m and turns at t = m v/R, having slid m v^2/(2 R); then it swings on the spring with sqrt(k/m).
    let (mass, r, k, v) = (2.0, 0.3, 1.5, 1.2);
    let chain = ChainBuilder::new(vec![mass])
        .jenkins(JenkinsElement { attachment: Attachment::Ground(0), stiffness: k, slip_force: r })
        .build()
        .unwrap();
    let start = State { positions: vec![0.0], velocities: vec![v], slider_forces: vec![1.0] };
    let motion = ChainFlow::new(&chain).solve(&start, 30.0).unwrap();
    let stop = &motion.events()[0];
    // A handful of cells, each to rounding.
    assert!((stop.time - mass * v / r).abs() < 1e-13);
    assert!((stop.state.positions[0] - mass * v * v / (2.0 * r)).abs() < 1e-13);
    // It swings with amplitude R/k about x - R/k: touches f = -1 after half a period, and f = +1 after a whole one.
    let w = (k / mass).sqrt();
    let swing = motion.state_at(stop.time + 1.0).unwrap().state;
    assert!((swing.slider_forces[0] - w.cos()).abs() < 1e-13);
    let touch = &motion.events()[1];
    assert_eq!(touch.kind, stickslip::dynamics::EventKind::Grazing);
    // A maximum is located to the root of the rounding.
    assert!((touch.time - stop.time - std::f64::consts::PI / w).abs() < 1e-7);
}

#[test]
fn a_chain_without_elements_is_linear() {
    let chain = ChainBuilder::new(vec![1.0]).ground_spring(0, 4.0).ground_damper(0, 0.2).build().unwrap();
    let start = State { positions: vec![1.0], velocities: vec![0.0], slider_forces: vec![] };
    let trajectory = ChainFlow::new(&chain).trajectory(&start, Sampling { interval: 0.1, t_end: 50.0 }).unwrap();
    let w = (4.0_f64 - 0.01).sqrt();
    for sample in &trajectory.samples {
        let t = sample.time;
        let x = (-0.1 * t).exp() * ((w * t).cos() + 0.1 / w * (w * t).sin());
        assert!((sample.state.positions[0] - x).abs() < 1e-14);
    }
}
