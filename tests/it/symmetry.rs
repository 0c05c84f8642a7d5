//! Odd symmetry: `-y(t)` is the solution from `-y(0)`.

use stickslip::dynamics::{Flow, Sampling, State};
use stickslip::exact::{ChainFlow, SparseFlow, TwoMassFlow};
use stickslip::model::{ContactState, RigParameters, TwoMassRig};

fn mirrored(contact: ContactState) -> ContactState {
    match contact {
        ContactState::Stick => ContactState::Stick,
        ContactState::Slip(direction) => ContactState::Slip(direction.opposite()),
    }
}

fn assert_odd<F: Flow>(flow: &F) {
    let initial = State::two_mass([1.1, 0.7, 0.2, -0.5, 0.3]);
    let sampling = Sampling { interval: 0.37, t_end: 300.0 };
    let motion = flow.trajectory(&initial, sampling).unwrap();
    let mirror = flow.trajectory(&initial.mirrored(), sampling).unwrap();
    assert!(motion.switches() > 100, "the motion should slip often");
    assert_eq!(motion.events.len(), mirror.events.len());
    for (a, b) in motion.samples.iter().zip(&mirror.samples) {
        assert_eq!(a.state, b.state.mirrored(), "{} at {}", flow.name(), a.time);
        assert_eq!(a.contacts[0], mirrored(b.contacts[0]));
        assert_eq!(a.ledger.works.friction, b.ledger.works.friction);
    }
}

#[test]
fn the_mirrored_start_gives_the_mirrored_motion() {
    let rig = TwoMassRig::new(RigParameters::default()).unwrap();
    // Every operation is odd or even in the state, so the numbers are the same to the bit.
    assert_odd(&TwoMassFlow::new(&rig));
    assert_odd(&ChainFlow::new(rig.chain()));
    assert_odd(&SparseFlow::new(rig.chain()));
}

#[test]
fn the_half_period_map_is_half_of_the_motion() {
    use stickslip::dynamics::{HalfPeriodMap, ReversalPoint};
    let flow = TwoMassFlow::new(&TwoMassRig::new(RigParameters::default()).unwrap());
    let start = ReversalPoint::new(1.25, 0.9, -0.52);
    let first = flow.half_return(start).unwrap();
    let second = flow.half_return(first.image).unwrap();
    let initial = State::two_mass([start[0], start[1], 0.0, start[2], 1.0]);
    let motion = flow.solve(&initial, 10.0).unwrap();
    let whole = &motion.events()[3];
    // Two maps, one of them mirrored back, against one motion over four events: a few roundings.
    assert!((whole.time - (first.duration + second.duration)).abs() < 1e-13);
    let expected = State::two_mass([second.image[0], second.image[1], 0.0, second.image[2], 1.0]);
    assert!(whole.state.max_difference(&expected) < 1e-13);
}
