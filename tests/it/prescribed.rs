//! Hysteresis under prescribed motion: loop area, corners, ledger.

use stickslip::dynamics::{EventKind, Flow, Sampling, State, Trajectory};
use stickslip::exact::PrescribedFlow;
use stickslip::model::{Attachment, ChainBuilder, JenkinsElement, OscillatorChain, PrescribedMotion};

const R: f64 = 0.4;
const K: f64 = 0.8;
const MOTION: PrescribedMotion = PrescribedMotion { amplitude: 1.7, angular_frequency: 0.9 };

fn chain(attachment: Attachment) -> OscillatorChain {
    ChainBuilder::new(vec![1.3, 0.7])
        .ground_spring(0, 0.5)
        .coupling_spring(0, 1, 0.2)
        .ground_damper(0, 0.03)
        .self_excited(0, -0.05)
        .jenkins(JenkinsElement { attachment, stiffness: K, slip_force: R })
        .build()
        .unwrap()
}

fn start(force: f64) -> State {
    State {
        positions: vec![0.0, 0.25],
        velocities: vec![MOTION.amplitude * MOTION.angular_frequency, 0.0],
        slider_forces: vec![force],
    }
}

fn period() -> f64 {
    2.0 * std::f64::consts::PI / MOTION.angular_frequency
}

fn trajectory(force: f64, periods: f64, samples_per_period: f64) -> Trajectory {
    let sampling = Sampling { interval: period() / samples_per_period, t_end: periods * period() };
    PrescribedFlow::new(&chain(Attachment::Ground(0)), MOTION).unwrap().trajectory(&start(force), sampling).unwrap()
}

#[test]
fn the_loop_encloses_4_r_times_amplitude_less_slip_limit() {
    let friction = |trajectory: &Trajectory, n: usize| trajectory.samples[n].ledger.works.friction;
    let trajectory = trajectory(0.0, 4.0, 1.0);
    let expected = 4.0 * R * (MOTION.amplitude - R / K);
    for n in 1..4 {
        let lost = friction(&trajectory, n) - friction(&trajectory, n + 1);
        assert!((lost - expected).abs() < 1e-14, "{lost} {expected}");
    }
    // Initial loading slides a distance of a - R/k in the first quarter, less than the 2 (a - R/k) of a half loop.
    let first = -friction(&trajectory, 1);
    assert!(first < expected - 0.1, "{first}");
}

#[test]
fn corners_and_reversals_come_at_their_times() {
    let trajectory = trajectory(0.0, 2.0, 10.0);
    let (a, w, pi) = (MOTION.amplitude, MOTION.angular_frequency, std::f64::consts::PI);
    // Loading from 0: x = R/k. Unloading from a: x = a - 2 R/k on the way down; then x = -a + 2 R/k on the way up.
    let loading = (R / K / a).asin();
    let corner = ((a - 2.0 * R / K) / a).asin();
    let expected = [
        (loading, EventKind::StickToSlip),
        (0.5 * pi, EventKind::SlipToStick),
        (pi - corner, EventKind::StickToSlip),
        (1.5 * pi, EventKind::SlipToStick),
        (2.0 * pi - corner, EventKind::StickToSlip),
        (2.5 * pi, EventKind::SlipToStick),
        (3.0 * pi - corner, EventKind::StickToSlip),
        (3.5 * pi, EventKind::SlipToStick),
        (4.0 * pi - corner, EventKind::StickToSlip),
    ];
    let found = &trajectory.events;
    // The last corner lies before the end at 4 pi only if arcsin is positive: it is.
    assert_eq!(found.len(), expected.len());
    for (event, (angle, kind)) in found.iter().zip(expected) {
        assert_eq!(event.kind, kind);
        assert!((event.time - angle / w).abs() < 1e-14, "{event:?} {}", angle / w);
    }
    assert!(corner > 0.0);
}

#[test]
fn the_drive_balances_the_ledger() {
    for force in [0.0, 1.0, -1.0, 0.7] {
        let trajectory = trajectory(force, 10.0, 37.0);
        // A few thousand terms of order 0.1 to rounding.
        assert!(trajectory.energy_residual() < 1e-12, "{:e}", trajectory.energy_residual());
        let works = trajectory.last().unwrap().ledger.works;
        // Over whole periods from the second on the drive pays for friction and damping, and is paid by self-excitation.
        let cycle = std::f64::consts::PI * MOTION.amplitude.powi(2) * MOTION.angular_frequency;
        assert!((works.damping + 0.03 * cycle * 10.0).abs() < 1e-11);
        assert!((works.self_excitation - 0.05 * cycle * 10.0).abs() < 1e-11);
        assert!(works.drive > 0.0);
    }
}

#[test]
fn an_element_between_oscillators_feels_the_motion_from_either_end() {
    let sampling = Sampling { interval: 0.1, t_end: 20.0 };
    let run = |attachment| {
        PrescribedFlow::new(&chain(attachment), MOTION).unwrap().trajectory(&start(0.0), sampling).unwrap()
    };
    let [ground, forwards, backwards] =
        [Attachment::Ground(0), Attachment::Between(0, 1), Attachment::Between(1, 0)].map(run);
    for ((g, f), b) in ground.samples.iter().zip(&forwards.samples).zip(&backwards.samples) {
        assert_eq!(g.state.slider_forces[0], f.state.slider_forces[0]);
        assert_eq!(g.state.slider_forces[0], -b.state.slider_forces[0]);
    }
    assert!(backwards.energy_residual() < 1e-12);
    // An element at the resting oscillator carries its force unchanged.
    let resting = PrescribedFlow::new(&chain(Attachment::Ground(1)), MOTION).unwrap();
    let trajectory = resting.trajectory(&start(0.4), sampling).unwrap();
    assert!(trajectory.events.is_empty() && trajectory.samples.iter().all(|s| s.state.slider_forces[0] == 0.4));
}

#[test]
fn an_amplitude_at_the_slip_limit_touches_and_below_it_nothing_happens() {
    let events = |amplitude: f64| {
        let motion = PrescribedMotion { amplitude, angular_frequency: 1.0 };
        let initial = State { velocities: vec![amplitude, 0.0], ..start(0.0) };
        let flow = PrescribedFlow::new(&chain(Attachment::Ground(0)), motion).unwrap();
        flow.trajectory(&initial, Sampling { interval: 1.0, t_end: 6.0 }).unwrap().events
    };
    assert!(events(0.99 * R / K).is_empty());
    let touches = events(R / K);
    assert_eq!(touches.len(), 2);
    assert!(touches.iter().all(|event| event.kind == EventKind::Grazing));
    assert_eq!(events(1.01 * R / K).iter().filter(|event| event.kind == EventKind::StickToSlip).count(), 2);
}

#[test]
fn a_start_off_the_motion_is_refused() {
    let flow = PrescribedFlow::new(&chain(Attachment::Ground(0)), MOTION).unwrap();
    let sampling = Sampling { interval: 1.0, t_end: 1.0 };
    let message = |state: State| flow.trajectory(&state, sampling).unwrap_err().to_string();
    let moved = State { positions: vec![0.1, 0.0], ..start(0.0) };
    assert!(message(moved).contains("positions[0] = 0.1 does not agree"));
    let drifting = State { velocities: vec![start(0.0).velocities[0], 0.2], ..start(0.0) };
    assert!(message(drifting).contains("velocities[1] = 0.2"));
    assert!(PrescribedFlow::new(&chain(Attachment::Ground(0)), PrescribedMotion { amplitude: 0.0, ..MOTION }).is_err());
}
