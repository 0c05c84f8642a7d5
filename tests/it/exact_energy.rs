//! The energy ledger of the exact flows: stored energy against works that are computed from the motion, not from the balance.

use stickslip::dynamics::{Flow, Sampling, State};
use stickslip::exact::{ChainFlow, TwoMassFlow};
use stickslip::model::{RigParameters, TwoMassRig};

const START: [f64; 5] = [1.2226496266, 0.9053979113, 0.0, -0.5377904062, 1.0];

fn rig() -> TwoMassRig {
    TwoMassRig::new(RigParameters::default()).unwrap()
}

#[test]
fn the_residual_of_the_two_mass_flow_stays_at_rounding() {
    let sampling = Sampling { interval: 0.5, t_end: 1000.0 };
    let trajectory = TwoMassFlow::new(&rig()).trajectory(&State::two_mass(START), sampling).unwrap();
    // Required: 1e-10 per 1000 time units; about 2e4 summed terms of rounding 1e-17 and 600 events.
    assert!(trajectory.energy_residual() <= 1e-10, "{:e}", trajectory.energy_residual());
    let works = trajectory.last().unwrap().ledger.works;
    // The balance is one of large numbers, or it would prove little.
    assert!(works.self_excitation > 50.0 && works.friction < -50.0 && works.circulatory == 0.0, "{works:?}");
}

#[test]
fn the_residual_does_not_depend_on_the_sampling() {
    let flow = TwoMassFlow::new(&rig());
    for interval in [0.013, 0.77, 200.0] {
        let trajectory = flow.trajectory(&State::two_mass(START), Sampling { interval, t_end: 200.0 }).unwrap();
        assert!(trajectory.energy_residual() <= 2e-11, "{interval}: {:e}", trajectory.energy_residual());
    }
}

#[test]
fn the_residual_of_the_chain_flow_stays_at_rounding() {
    let sampling = Sampling { interval: 1.0, t_end: 1000.0 };
    let trajectory = ChainFlow::new(rig().chain()).trajectory(&State::two_mass(START), sampling).unwrap();
    assert!(trajectory.energy_residual() <= 1e-10, "{:e}", trajectory.energy_residual());
}

#[test]
fn the_works_do_not_balance_the_energy_of_another_rig() {
    // Negative control: the same motion booked with the stored energy of a rig with 0.1 % more friction intensity.
    let p = RigParameters::default();
    let other = TwoMassRig::new(RigParameters { gamma: p.gamma * 1.001, ..p }).unwrap();
    let stored = |state: &State| other.chain().stored_energy(&state.positions, &state.velocities, &state.slider_forces);
    let sampling = Sampling { interval: 1.0, t_end: 100.0 };
    let trajectory = TwoMassFlow::new(&rig()).trajectory(&State::two_mass(START), sampling).unwrap();
    let start = stored(&trajectory.samples[0].state);
    let residual = |s: &stickslip::dynamics::Sample| (stored(&s.state) - start - s.ledger.works.total()).abs();
    assert!(trajectory.samples.iter().map(residual).fold(0.0, f64::max) > 1e-5);
}
