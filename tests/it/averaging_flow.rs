//! The slow flow with its fast motion restored, against the exact flow and against itself.

use super::averaging::slow_flow;
use stickslip::averaging::{AveragingError, EnergyDefinition, RestoredSlowFlow};
use stickslip::chaos::{Criteria, MotionClass, Window, classify};
use stickslip::dynamics::{DenseFlow, EventKind, Flow, Motion, Outcome, Sampling, State};
use stickslip::exact::TwoMassFlow;
use stickslip::model::{RigParameters, TwoMassRig};

fn restored(xi1: f64) -> RestoredSlowFlow {
    let p = RigParameters { xi1, ..Default::default() };
    RestoredSlowFlow::new(slow_flow(p, EnergyDefinition::MeanPotential)).unwrap()
}

#[test]
fn a_motion_may_be_cut_anywhere_and_continued() {
    let flow = restored(-0.1);
    let start = State::two_mass([1.3, 0.9, 0.1, -0.4, 0.0]);
    let whole = flow.motion(&start, 300.0).unwrap();
    let half = whole.state(123.4).unwrap();
    let rest = flow.motion(&half, 100.0).unwrap();
    // Tolerance of integration 1e-12 a step and interpolation near 1e-9, over a stretch in which neighbours hardly separate.
    for time in [0.0, 1.7, 50.0, 99.0] {
        let difference = rest.state(time).unwrap().max_difference(&whole.state(123.4 + time).unwrap());
        assert!(difference < 1e-7, "{time}: {difference:e}");
    }
}

#[test]
fn the_restored_state_has_the_velocity_of_its_position_to_averaging_error() {
    // v = Re(i w Z) leaves out the slow rates, which are of the order of the damping and coupling: 0.1.
    let flow = restored(-0.06);
    let motion = flow.motion(&State::two_mass([1.3, 0.9, 0.1, -0.4, 0.0]), 100.0).unwrap();
    let step = 1e-4;
    for n in 1..100 {
        let time = f64::from(n);
        let [before, here, after] = [time - step, time, time + step].map(|t| motion.state(t).unwrap());
        for j in 0..2 {
            let rate = (after.positions[j] - before.positions[j]) / (2.0 * step);
            assert!((rate - here.velocities[j]).abs() < 0.1 * 2.0, "{time} {j}");
        }
    }
}

#[test]
fn at_weak_excitation_the_slow_torus_is_the_exact_one() {
    // Just beyond both secondary Hopf points, and where the cycle is stable: amplitudes agree within the first-harmonic error.
    let window = Window { transient: 4000.0, length: 1000.0 };
    for (xi1, class) in [(-0.02, MotionClass::LimitCycle), (-0.05, MotionClass::Torus)] {
        let slow = restored(xi1);
        let mut start = slow.limit_cycle().unwrap();
        start.positions[1] += 0.05;
        let rig = TwoMassRig::new(RigParameters { xi1, ..Default::default() }).unwrap();
        let found = classify(&slow, &start, window, &Criteria::default()).unwrap();
        let exact = classify(&TwoMassFlow::new(&rig), &start, window, &Criteria::default()).unwrap();
        println!("{xi1} {found:?} {exact:?}");
        assert_eq!((found.class, exact.class), (class, class), "{xi1}");
        let ((high, low), (exact_high, exact_low)) = (found.amplitude_range.unwrap(), exact.amplitude_range.unwrap());
        // Left out are higher harmonics and the slow change within a cycle, both of the order of xi1 and kappa.
        assert!((high / exact_high - 1.0).abs() < 0.05 && (low / exact_low - 1.0).abs() < 0.05, "{xi1}");
    }
}

#[test]
fn the_limit_cycle_has_one_slip_per_half_cycle_and_a_closed_energy_ledger() {
    let flow = restored(-0.03);
    let start = flow.limit_cycle().unwrap();
    let found = flow.trajectory(&start, Sampling { interval: 0.1, t_end: 200.0 }).unwrap();
    let count = |kind| found.events.iter().filter(|event| event.kind == kind).count();
    // 200 time units of frequency 0.996 have 63 half cycles; the first, begun at time 0, is not counted.
    assert!((61..=63).contains(&count(EventKind::StickToSlip)), "{}", count(EventKind::StickToSlip));
    assert_eq!(count(EventKind::StickToSlip), count(EventKind::SlipToStick));
    for event in &found.events {
        // Slip begins and ends at the slip force; times are found to 1e-13.
        assert!((event.state.slider_forces[0].abs() - 1.0).abs() < 1e-9, "{event:?}");
    }
    // The averaged works of a limit cycle cancel; what is left is the ripple of the energy within a cycle.
    let last = found.last().unwrap();
    assert!(last.ledger.works.total().abs() < 1e-3 * last.ledger.works.self_excitation, "{:?}", last.ledger);
    assert!(last.ledger.works.friction < 0.0 && last.ledger.works.self_excitation > 0.0);
}

#[test]
fn motions_that_leave_the_known_energies_diverge_and_are_never_extrapolated() {
    let flow = restored(-0.2);
    let bound = flow.amplitude_bound();
    let motion = flow.motion(&State::two_mass([4.0, 4.0, 0.0, 0.0, 1.0]), 1e4).unwrap();
    assert!(matches!(motion.outcome(), Outcome::Diverged { time, bound: b } if b == bound && time == motion.end()));
    assert!(motion.state(motion.end() + 1.0).is_err());
    let slow = flow.slow();
    assert!(matches!(slow.frequency().at(600.0), Err(AveragingError::BeyondEnergy { .. })));
    let far = State::two_mass([2.0 * bound, 0.0, 0.0, 0.0, 0.0]);
    assert!(matches!(flow.motion(&far, 1.0), Err(AveragingError::StartsBeyondBound { .. })));
}

#[test]
fn amplitudes_pass_through_zero_without_harm() {
    // All in mass 2, sticking: a beat between the modes, in which a1 starts at 0 and a2 comes back to it.
    let flow = restored(-0.001);
    let motion = flow.motion(&State::two_mass([0.0, 0.3, 0.0, 0.0, 0.0]), 200.0).unwrap();
    // The sticking rig is linear: amplitude of mass 1 after half a beat, pi/(sqrt(1.2) - 1), is that of mass 2, but for damping of 0.5 %.
    let half_beat = std::f64::consts::PI / (1.2_f64.sqrt() - 1.0);
    let slow = motion.slow_state(half_beat).unwrap();
    // The averaged equation takes w = 1 for both modes: the beat is off by kappa^2/2 relative, 0.5 %, so is the phase of pi.
    assert!((slow.amplitudes[0].norm() - 0.3).abs() < 0.3 * 0.2, "{slow:?}");
    assert!(slow.amplitudes[1].norm() < 0.05, "{slow:?}");
}
