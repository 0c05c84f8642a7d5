//! Event location: nothing missed, nothing invented, ties and touches as documented.

use crate::independent::{Search, SlowRig, Switch, Y};
use nalgebra::{Matrix5, Vector5};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::dynamics::{Event, EventKind, Flow, Outcome, Sampling, State};
use stickslip::exact::{ChainFlow, Representation, TwoMassFlow};
use stickslip::model::{Attachment, ChainBuilder, ContactState, Direction, JenkinsElement, RigParameters, TwoMassRig};

const T_END: f64 = 40.0;

/// Parameters of the model's whole range, overdamped and uncoupled ones among them, and a start of the same order as the slip
/// limit, one in four of them at the slip force.
fn random_case(random: &mut ChaCha8Rng) -> (RigParameters, Y) {
    let overdamped = random.random_bool(0.05);
    let p = RigParameters {
        xi1: if overdamped { random.random_range(0.5..3.0) } else { random.random_range(-0.2..0.02) },
        xi2: if overdamped { random.random_range(0.5..3.0) } else { random.random_range(0.0..0.1) },
        kappa: if random.random_bool(0.05) { 0.0 } else { random.random_range(0.0..1.0) },
        gamma: random.random_range(0.05..1.0),
    };
    let mut y: Y = std::array::from_fn(|_| random.random_range(-3.0..3.0));
    y[4] = if random.random_bool(0.25) { y[4].signum() } else { y[4] / 3.0 };
    (p, y)
}

fn cases(count: usize) -> impl Iterator<Item = (RigParameters, Y)> {
    let mut random = ChaCha8Rng::seed_from_u64(1659);
    (0..count).map(move |_| random_case(&mut random))
}

fn rig(p: RigParameters) -> TwoMassRig {
    TwoMassRig::new(p).unwrap()
}

fn exact_switches(p: RigParameters, y: Y) -> Vec<Event> {
    let motion = TwoMassFlow::new(&rig(p)).solve(&State::two_mass(y), T_END).unwrap();
    motion.events().iter().filter(|event| event.kind != EventKind::Grazing).cloned().collect()
}

/// Times agree to the rounding of the state divided by the rate at which the guard is crossed.
fn assert_same(found: &[Event], expected: &[Switch], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!(found.kind, expected.kind, "{what}");
        let allowed = 1e-11 / expected.rate.min(1.0);
        assert!((found.time - expected.time).abs() <= allowed, "{what}: {} {expected:?}", found.time);
    }
}

#[test]
fn no_switch_is_missed_in_2000_random_motions() {
    let (mut switches, mut modal) = (0, 0);
    for (index, (p, y)) in cases(2000).enumerate() {
        let expected = SlowRig { p }.switches(y, T_END, Search::Certified);
        assert_same(&exact_switches(p, y), &expected, &format!("case {index}: {p:?} {y:?}"));
        switches += expected.len();
        modal += usize::from(TwoMassFlow::new(&rig(p)).representation() == Representation::Modal);
    }
    // The comparison is about something: both representations, and events in number.
    assert!(switches > 20_000 && modal > 1500 && modal < 1990, "{switches} {modal}");
}

#[test]
fn plain_sampling_misses_switches_in_the_same_motions() {
    // Negative control: without the certificate a double crossing between two samples is lost.
    let wrong = |interval: f64| {
        cases(500)
            .filter(|&(p, y)| {
                let slow = SlowRig { p };
                let expected = slow.switches(y, T_END, Search::Certified);
                slow.switches(y, T_END, Search::Sampled(interval)).len() != expected.len()
            })
            .count()
    };
    let (fine, coarse) = (wrong(0.125), wrong(0.25));
    assert!(fine > 0 && coarse > fine, "{fine} {coarse}");
}

#[test]
fn degenerate_parameters_are_solved_by_series() {
    let start = [1.3, -0.4, 0.2, 0.8, 0.1];
    for (p, representation) in [
        (RigParameters { xi1: 3.0, xi2: 5.0, kappa: 0.1, gamma: 0.5 }, Representation::Series),
        (RigParameters { xi1: -0.05, xi2: -0.05, kappa: 0.0, gamma: 0.5 }, Representation::Series),
        // Slipping, with d1 = 0: a double eigenvalue at gamma = 2 |d2| - d2^2, exactly and nearly.
        (RigParameters { xi1: -0.05, xi2: 0.05, kappa: 0.0, gamma: 0.0975 }, Representation::Series),
        (RigParameters { xi1: -0.05, xi2: 0.05, kappa: 1e-9, gamma: 0.0975 + 1e-9 }, Representation::Series),
        // Nearly equal eigenvalues with orthogonal modes do no harm.
        (RigParameters { xi1: -0.05, xi2: -0.05, kappa: 1e-7, gamma: 1e-7 }, Representation::Modal),
        // Slipping, mass 1 then hangs on nothing.
        (RigParameters { xi1: -0.05, xi2: 0.01, kappa: 0.0, gamma: 1.0 }, Representation::Series),
        (RigParameters::default(), Representation::Modal),
    ] {
        assert_eq!(TwoMassFlow::new(&rig(p)).representation(), representation, "{p:?}");
        let expected = SlowRig { p }.switches(start, T_END, Search::Certified);
        assert_same(&exact_switches(p, start), &expected, &format!("{p:?}"));
    }
}

#[test]
fn a_double_crossing_between_ends_of_equal_slope_is_found() {
    // f - 1 = c + k ((t - s)^3 - 3 w^2 (t - s)) for small t: a maximum of 7e-5 k at t = s - w = 0.02, then a fall and another rise.
    // Ends 0.2 apart both lie below 1 with rising force, so neither signs nor slopes there show it.
    let (k, s, w) = (0.05, 0.12, 0.1);
    let c = -0.00193 * k;
    let wanted = [1.0 + c + k * (3.0 * w * w * s - s * s * s), k * 3.0 * (s * s - w * w), -6.0 * k * s, 6.0 * k, 0.0];
    let p = RigParameters::default();
    let slow = SlowRig { p };
    // The derivatives are linear in the state: solve for it.
    let columns: Vec<Vector5<f64>> =
        (0..5).map(|i| slow.force_derivatives(std::array::from_fn(|j| f64::from(u8::from(i == j)))).into()).collect();
    let state = Matrix5::from_columns(&columns).try_inverse().unwrap() * Vector5::from(wanted);
    let start: Y = state.into();
    let expected = slow.switches(start, T_END, Search::Certified);
    assert!(expected[0].kind == EventKind::StickToSlip && expected[0].time < 0.02, "{:?}", expected[0]);
    assert_same(&exact_switches(p, start), &expected, "two-mass flow");
    // Negative control: sampling at the ends of the first cell sees nothing there.
    assert!(slow.switches(start, T_END, Search::Sampled(0.2))[0].time > 0.2);
}

/// Undamped in-phase motion `x1 = x2 = A sin t`, sticking, with `f = A sin t`.
fn in_phase(amplitude: f64) -> (TwoMassRig, State) {
    let p = RigParameters { xi1: 0.0, xi2: 0.0, kappa: 0.1, gamma: 0.5 };
    (rig(p), State::two_mass([0.0, 0.0, amplitude, amplitude, 0.0]))
}

#[test]
fn touching_the_slip_force_is_grazing_and_not_slip() {
    let (rig, start) = in_phase(1.0);
    let (two_mass, chain) = (TwoMassFlow::new(&rig), ChainFlow::new(rig.chain()));
    for motion in [two_mass.solve(&start, 9.0).unwrap(), chain.solve(&start, 9.0).unwrap()] {
        let times: Vec<f64> = motion.events().iter().map(|event| event.time).collect();
        assert!(motion.events().iter().all(|event| event.kind == EventKind::Grazing), "{:?}", motion.events());
        // Peaks at pi/2 + n pi; a maximum is located to the root of the rounding, 1e-8.
        let expected = [0.5, 1.5, 2.5].map(|n: f64| n * std::f64::consts::PI);
        assert_eq!(times.len(), 3);
        assert!(times.iter().zip(expected).all(|(t, e)| (t - e).abs() < 1e-7), "{times:?}");
        // Nothing has changed: the motion goes on as the same sine.
        let state = motion.state_at(9.0).unwrap().state;
        assert!((state.positions[0] - 9.0_f64.sin()).abs() < 1e-14);
    }
}

#[test]
fn a_hair_more_slips_and_a_hair_less_does_not() {
    // 1e-12 is a thousand times the rounding of f and a millionth of anything sampling would see: slip lasts about 3e-6.
    for (amplitude, slips) in [(1.0 + 1e-12, true), (1.0 - 1e-12, false)] {
        let (rig, start) = in_phase(amplitude);
        for events in [
            TwoMassFlow::new(&rig).solve(&start, 3.0).unwrap().events().to_vec(),
            ChainFlow::new(rig.chain()).solve(&start, 3.0).unwrap().events().to_vec(),
        ] {
            let kinds: Vec<EventKind> = events.iter().map(|event| event.kind).collect();
            let expected = if slips { vec![EventKind::StickToSlip, EventKind::SlipToStick] } else { vec![] };
            assert_eq!(kinds, expected, "{amplitude}");
            if slips {
                // f exceeds 1 while A cos(t - pi/2) > 1: from sqrt(2e-12) before the peak; ends at it. sqrt of the rounding
                // 1e-16/1e-12 of the excess: 1e-4 of it.
                let half_width = (2.0 * (amplitude - 1.0)).sqrt();
                let slip = events[1].time - events[0].time;
                assert!((slip / half_width - 1.0).abs() < 1e-3, "{slip:e} {half_width:e}");
            }
        }
    }
}

#[test]
fn a_motion_at_rest_on_its_slip_limit_stays_there() {
    // (1 - g) x1 + g f = 0 with f = 1: all forces balance. No event, no endless switching.
    let p = RigParameters { kappa: 0.0, ..RigParameters::default() };
    let x1 = -p.gamma / (1.0 - p.gamma);
    let start = State::two_mass([x1, 0.0, 0.0, 0.0, 1.0]);
    let motion = TwoMassFlow::new(&rig(p)).solve(&start, 50.0).unwrap();
    assert_eq!(motion.events().len(), 0);
    assert!(motion.state_at(50.0).unwrap().state.max_difference(&start) < 1e-14);
}

#[test]
fn an_event_at_a_sample_time_is_shown_with_the_state_after_it() {
    let flow = TwoMassFlow::new(&rig(RigParameters::default()));
    let start = State::two_mass([1.2226496266, 0.9053979113, 0.0, -0.5377904062, 1.0]);
    let event = flow.solve(&start, 5.0).unwrap().events()[0].clone();
    assert_eq!(event.kind, EventKind::StickToSlip);
    // Once as an inner sample, once as the end.
    for t_end in [2.0 * event.time, event.time] {
        let trajectory = flow.trajectory(&start, Sampling { interval: event.time, t_end }).unwrap();
        let sample = &trajectory.samples[1];
        assert_eq!(sample.time, event.time);
        assert_eq!(sample.contacts[0], ContactState::Slip(Direction::Negative));
        assert_eq!(trajectory.events[0], event);
        assert!(sample.state.max_difference(&event.state) < 1e-15);
    }
    // A span of zero has one sample.
    assert_eq!(flow.trajectory(&start, Sampling { interval: 1.0, t_end: 0.0 }).unwrap().samples.len(), 1);
    // An instant earlier it has not happened.
    let before = flow.trajectory(&start, Sampling { interval: 1.0, t_end: event.time * (1.0 - 1e-15) }).unwrap();
    assert_eq!(before.events, []);
    assert!(before.last().unwrap().contacts[0].is_stick());
}

#[test]
fn simultaneous_events_come_in_the_order_of_the_elements() {
    // Two equal rigs side by side, not coupled.
    let element = |i| JenkinsElement { attachment: Attachment::Ground(i), stiffness: 0.5, slip_force: 0.5 };
    let chain = ChainBuilder::new(vec![1.0, 1.0])
        .ground_spring(0, 0.5)
        .ground_spring(1, 0.5)
        .jenkins(element(0))
        .jenkins(element(1))
        .build()
        .unwrap();
    let start = State { positions: vec![0.0; 2], velocities: vec![2.0; 2], slider_forces: vec![0.0; 2] };
    let motion = ChainFlow::new(&chain).solve(&start, 20.0).unwrap();
    assert!(motion.events().len() > 6);
    for pair in motion.events().chunks(2) {
        assert_eq!([pair[0].element, pair[1].element], [0, 1]);
        assert_eq!(pair[0].kind, pair[1].kind);
        assert!((pair[0].time - pair[1].time).abs() < 1e-14);
    }
}

#[test]
fn a_motion_beyond_the_amplitude_bound_is_an_outcome() {
    let start = State::two_mass([1.2226496266, 0.9053979113, 0.0, -0.5377904062, 1.0]);
    let rig = rig(RigParameters { xi1: -0.18, ..RigParameters::default() });
    let sampling = Sampling { interval: 1.0, t_end: 2000.0 };
    let (two_mass, chain) = (TwoMassFlow::new(&rig), ChainFlow::new(rig.chain()));
    let trajectory = two_mass.trajectory(&start, sampling).unwrap();
    let Outcome::Diverged { time, bound } = trajectory.outcome else { panic!("{:?}", trajectory.outcome) };
    assert_eq!(bound, 1000.0);
    assert!(trajectory.last().unwrap().time < time && trajectory.last().unwrap().time >= time - 1.0);
    let largest = |state: &State| state.positions.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(trajectory.samples.iter().all(|sample| largest(&sample.state) <= bound));
    let at_end = two_mass.solve(&start, 2000.0).unwrap().state_at(time).unwrap().state;
    assert!((largest(&at_end) - bound).abs() < 1e-9);
    // Both representations agree on when; positions grow with rate 0.09 from rounding 1e-13 relative.
    let Outcome::Diverged { time: other, .. } = chain.trajectory(&start, sampling).unwrap().outcome else { panic!() };
    assert!((time - other).abs() < 1e-9, "{time} {other}");
    // Asked for less time, it has not diverged.
    let shorter = Sampling { t_end: time - 1.0, ..sampling };
    assert_eq!(two_mass.trajectory(&start, shorter).unwrap().outcome, Outcome::Completed);
}

#[test]
fn sticking_motion_is_the_sum_of_two_damped_modes() {
    let p = RigParameters { xi1: 0.03, xi2: 0.011, kappa: 0.1, gamma: 0.5 };
    let flow = TwoMassFlow::new(&rig(p));
    // x1 -+ x2 are two single oscillators from rest at 0.4 and 0.2: q'' + xi q' + k q = 0.
    let single = |q0: f64, xi: f64, k: f64, t: f64| {
        let w = (k - xi * xi / 4.0).sqrt();
        q0 * (-xi * t / 2.0).exp() * ((w * t).cos() + xi / (2.0 * w) * (w * t).sin())
    };
    let start = State::two_mass([0.3, 0.1, 0.0, 0.0, 0.3]);
    let motion = flow.solve(&start, 500.0).unwrap();
    assert_eq!(motion.events(), []);
    for t in [0.1, 7.3, 99.0, 500.0] {
        let (sum, difference) = (single(0.4, p.xi1, 1.0, t), single(0.2, p.xi2, 1.0 + 2.0 * p.kappa, t));
        let state = motion.state_at(t).unwrap().state;
        // Phases of 500 rad carry 500 roundings of the frequency.
        assert!((state.positions[0] - 0.5 * (sum + difference)).abs() < 1e-13);
        assert!((state.positions[1] - 0.5 * (sum - difference)).abs() < 1e-13);
        assert!((state.slider_forces[0] - state.positions[0]).abs() < 1e-15);
    }
}

#[test]
fn unusable_input_is_refused_with_a_remedy() {
    let flow = TwoMassFlow::new(&rig(RigParameters::default()));
    let message = |state: [f64; 5], interval, t_end| {
        flow.trajectory(&State::two_mass(state), Sampling { interval, t_end }).unwrap_err().to_string()
    };
    assert!(message([0.0; 5], 0.0, 1.0).contains("sampling.interval = 0 is not allowed"));
    assert!(message([0.0; 5], 1.0, f64::NAN).contains("t_end = NaN"));
    assert!(message([0.0; 5], 1e-12, 1e6).contains("take a longer interval"));
    assert!(message([2000.0, 0.0, 0.0, 0.0, 0.0], 1.0, 1.0).contains("positions[0] = 2000 lies beyond 1000"));
    assert!(message([0.0, 0.0, 0.0, 0.0, 1.1], 1.0, 1.0).contains("f[0] = 1.1"));
    assert!(
        flow.clone().with_amplitude_bound(f64::INFINITY).unwrap_err().to_string().contains("amplitude_bound = inf")
    );
    assert!(flow.solve(&State::two_mass([0.0; 5]), 1.0).unwrap().state_at(1.5).is_err());
}
