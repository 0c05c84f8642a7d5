//! Motions that stand at their slip limit: |f| = 1 with v1 = 0, where the first derivative that is not zero decides.
//!
//! Expected numbers were computed outside the project: Taylor series of order 30 in 50 digits from equations (1)-(3), switches by halving.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::dynamics::{Event, EventKind, Sampling, State};
use stickslip::exact::{ChainFlow, ExactTrajectory, Representation, SparseFlow, TwoMassFlow};
use stickslip::model::{ContactState, RigParameters, TwoMassRig};

fn rig(p: RigParameters) -> TwoMassRig {
    TwoMassRig::new(p).unwrap()
}

/// The motion by each of the three closed forms.
fn motions(p: RigParameters, start: [f64; 5], t_end: f64) -> [ExactTrajectory; 3] {
    let (rig, start) = (rig(p), State::two_mass(start));
    [
        TwoMassFlow::new(&rig).solve(&start, t_end).unwrap(),
        ChainFlow::new(rig.chain()).solve(&start, t_end).unwrap(),
        SparseFlow::new(rig.chain()).solve(&start, t_end).unwrap(),
    ]
}

fn switches(motion: &ExactTrajectory) -> Vec<&Event> {
    motion.events().iter().filter(|event| event.kind != EventKind::Grazing).collect()
}

struct Reference {
    p: RigParameters,
    start: [f64; 5],
    t_end: f64,
    switches: usize,
    last: f64,
    end: [f64; 5],
}

/// Small motions beside the slip limit, an equilibrium of slip 500 slip lengths away, and nearly equal modes.
fn references() -> [Reference; 4] {
    [
        Reference {
            p: RigParameters { xi1: -0.06, xi2: 0.011, kappa: 0.05, gamma: 1e-5 },
            start: [1e-5, 5e-5, 0.0, -2e-5, 1.0],
            t_end: 12.0,
            switches: 3,
            last: 11.801871594062282,
            end: [2.6920825764479507e-5, 6.460220877889885e-5, 2.4987157151508894e-5, 5.688322741577475e-6, 1.0],
        },
        Reference {
            p: RigParameters { xi1: -0.06, xi2: 0.011, kappa: 0.1, gamma: 1e-4 },
            start: [-1e-4, 1e-4, 0.0, 1e-4, 1.0],
            t_end: 12.0,
            switches: 3,
            last: 8.068732474280427,
            end: [
                -1.382636074243643e-4,
                8.354139375144827e-5,
                9.156515041344473e-5,
                1.042365121345392e-4,
                0.9998841365193802,
            ],
        },
        Reference {
            p: RigParameters { xi1: -0.01, xi2: 0.011, kappa: 0.002, gamma: 1.0 },
            start: [1.0, 1.0, 0.0, 0.0, 1.0],
            t_end: 200.0,
            switches: 126,
            last: 198.09428380292553,
            end: [0.32397048172732923, 0.9647873184756645, 0.9631544229300533, 1.7123506732349827, 0.34638017163617935],
        },
        Reference {
            p: RigParameters { xi1: 1e-12, xi2: 1e-12, kappa: 1e-15, gamma: 0.1 },
            start: [2.0, 1.0, 0.3, 0.5, 0.3],
            t_end: 30.0,
            switches: 18,
            last: 28.934724732017866,
            end: [
                -0.6235708851960119,
                -0.3397643621542505,
                1.0796391713195759,
                1.0651573490209212,
                -0.3635898098491824,
            ],
        },
    ]
}

#[test]
fn motions_beside_the_slip_limit_switch_when_they_do() {
    for Reference { p, start, t_end, switches: expected, last, end } in references() {
        for motion in motions(p, start, t_end) {
            let found = switches(&motion);
            assert_eq!(found.len(), expected, "{p:?}");
            let state = motion.state_at(t_end).unwrap().state;
            // 200 time units with an equilibrium 500 slip lengths away: three digits of 1e-16, over 126 switches.
            let allowed = 1e-11;
            assert!((found[expected - 1].time - last).abs() < allowed, "{p:?}: {}", found[expected - 1].time);
            assert!(state.max_difference(&State::two_mass(end)) < allowed, "{p:?}: {state:?}");
        }
    }
}

#[test]
fn nearly_equal_modes_keep_the_energy_balance() {
    for exponent in 6..=16 {
        let tiny = 10_f64.powi(-exponent);
        for (xi, kappa) in [(1e-12, tiny), (tiny, 1e-15), (tiny, tiny)] {
            let p = RigParameters { xi1: xi, xi2: xi, kappa, gamma: 0.1 };
            let [modal, dense, _] = motions(p, [2.0, 1.0, 0.3, 0.5, 0.3], 30.0);
            // A double energy of size 2, some 20 switches.
            let residual = modal.sampled(Sampling { interval: 1.0, t_end: 30.0 }).unwrap().energy_residual();
            assert!(residual < 1e-13, "{p:?}: {residual:e}");
            let [a, b] = [&modal, &dense].map(|motion| motion.state_at(30.0).unwrap().state);
            assert!(a.max_difference(&b) < 1e-12, "{p:?}: {a:?} {b:?}");
        }
    }
}

/// Rigs and starts that stand at the slip limit, half of them small as the slip force is weak.
fn starts_on_the_limit(count: usize) -> impl Iterator<Item = (RigParameters, [f64; 5])> {
    let mut random = ChaCha8Rng::seed_from_u64(41);
    (0..count).map(move |n| {
        let mut within = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
        let gamma = if n % 4 == 0 { 1.0 } else { 10_f64.powf(within(-5.0, 0.0)) };
        let p = RigParameters {
            xi1: within(-0.15, 0.02),
            xi2: within(0.0, 0.05),
            kappa: 10_f64.powf(within(-3.0, -0.4)),
            gamma,
        };
        let size = if n % 2 == 0 { gamma } else { 1.0 };
        let side = if within(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
        (p, [size * within(-2.0, 2.0), size * within(-2.0, 2.0), 0.0, size * within(-2.0, 2.0), side])
    })
}

const T_END: f64 = 30.0;

/// Switches of equal kind in equal order, times within `allowed`.
fn assert_same_switches(a: &[&Event], b: &[&Event], allowed: f64, what: &str) {
    assert_eq!(a.len(), b.len(), "{what}");
    for (a, b) in a.iter().zip(b) {
        assert_eq!((a.kind, a.element), (b.kind, b.element), "{what}");
        assert!((a.time - b.time).abs() <= allowed, "{what}: {} {}", a.time, b.time);
    }
}

#[test]
fn starts_on_the_limit_switch_alike_in_every_closed_form_and_mirrored_to_the_bit() {
    let (mut total, mut modal) = (0, 0);
    for (p, start) in starts_on_the_limit(1500) {
        let what = format!("{p:?} {start:?}");
        modal += usize::from(TwoMassFlow::new(&rig(p)).representation() == Representation::Modal);
        let [a, b, c] = motions(p, start, T_END);
        total += switches(&a).len();
        // Times of switches at grazing speed are conditioned by sqrt(1e-16) at worst.
        assert_same_switches(&switches(&a), &switches(&b), 1e-8, &what);
        assert_same_switches(&switches(&a), &switches(&c), 1e-8, &what);
        let mirrored = motions(p, start.map(|component| -component), T_END);
        for (motion, mirror) in [a, b, c].iter().zip(&mirrored) {
            assert_eq!(motion.events().len(), mirror.events().len(), "{what}");
            for (event, image) in motion.events().iter().zip(mirror.events()) {
                assert_eq!((event.time, event.kind), (image.time, image.kind), "{what}");
                assert_eq!(event.state, image.state.mirrored(), "{what}");
            }
        }
    }
    // The comparison is about something: both representations, and switches in number.
    assert!(total > 10_000 && modal > 1000 && modal < 1500, "{total} {modal}");
}

#[test]
fn a_motion_taken_up_later_switches_as_before() {
    let mut random = ChaCha8Rng::seed_from_u64(42);
    for (p, start) in starts_on_the_limit(1500) {
        let flow = TwoMassFlow::new(&rig(p));
        let whole = flow.solve(&State::two_mass(start), T_END).unwrap();
        let cut = T_END * random.random::<f64>();
        let middle = whole.state_at(cut).unwrap();
        let rest = flow.solve(&middle.state, T_END - cut).unwrap();
        let later: Vec<&Event> = switches(&whole).into_iter().filter(|event| event.time > cut).collect();
        let found = switches(&rest);
        let what = format!("{p:?} {start:?} cut at {cut}");
        assert_eq!(later.len(), found.len(), "{what}");
        for (expected, event) in later.iter().zip(found) {
            assert_eq!(expected.kind, event.kind, "{what}");
            let rate = match event.kind {
                EventKind::StickToSlip => event.state.velocities[0],
                _ => acceleration(&flow, &event.state),
            };
            // The cut rounds a state of size 1 to 1e-16; a switch at a low rate makes more of it.
            let allowed = 1e-12 + 1e-14 / rate.abs();
            assert!((expected.time - cut - event.time).abs() < allowed, "{what}: {} {rate:e}", event.time);
        }
    }
}

fn acceleration(flow: &TwoMassFlow, state: &State) -> f64 {
    flow.rig().chain().acceleration(&state.positions, &state.velocities, &state.slider_forces)[0]
}

/// x1 = x2 = -f with gamma = 1/2 balances the slip force; the second mass is pulled back and takes the first along.
#[test]
fn a_balanced_start_slips_where_a_later_derivative_says_so() {
    for side in [1.0, -1.0] {
        let p = RigParameters { xi1: 0.0, xi2: 0.0, kappa: 0.059, gamma: 0.5 };
        for motion in motions(p, [-side, -side, 0.0, 0.0, side], 1.0) {
            assert!(matches!(motion.state_at(0.0).unwrap().contacts[0], ContactState::Slip(_)));
            assert!(motion.events().is_empty(), "{:?}", motion.events());
            assert!(side * motion.state_at(1.0).unwrap().state.velocities[0] > 1e-3, "the mass did not move");
        }
    }
}
