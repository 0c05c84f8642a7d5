//! The Jenkins element in the engine under prescribed motion `x_0 = a sin(w t)`: initial loading, loop area, energy balance.

use std::f64::consts::{FRAC_PI_2, TAU};
use stickslip::compare::{max_state_error, observed_order};
use stickslip::dynamics::{EventKind, Flow, Sample, Sampling, State, Trajectory};
use stickslip::engine::{EngineError, EngineSettings, Precision, PrescribedFlow};
use stickslip::exact;
use stickslip::model::{PrescribedMotion, RigParameters, TwoMassRig};

fn cycles(amplitude: f64, steps_per_cycle: u32, precision: Precision) -> Trajectory {
    let rig = TwoMassRig::new(RigParameters::default()).unwrap();
    let step = TAU / f64::from(steps_per_cycle);
    let settings = EngineSettings { precision, ..EngineSettings::default_for(step) };
    let motion = PrescribedMotion { amplitude, angular_frequency: 1.0 };
    let flow = PrescribedFlow::new(rig.chain(), motion, settings).unwrap();
    flow.trajectory(&start(amplitude), Sampling { interval: step, t_end: 3.0 * TAU }).unwrap()
}

fn start(speed: f64) -> State {
    State::two_mass([0.0, 0.0, speed, 0.0, 0.0])
}

/// Area of the loop of slider force over elongation in the last cycle, by the trapezoidal rule.
fn loop_area(motion: &Trajectory) -> f64 {
    let last: Vec<&Sample> = motion.samples.iter().filter(|sample| sample.time >= 2.0 * TAU - 1e-9).collect();
    let area = |pair: &[&Sample]| {
        let (a, b) = (&pair[0].state, &pair[1].state);
        0.5 * (a.slider_forces[0] + b.slider_forces[0]) * (b.positions[0] - a.positions[0])
    };
    last.windows(2).map(area).sum()
}

#[test]
fn the_loop_has_the_area_4_times_a_minus_1() {
    for amplitude in [1.5, 2.0, 5.0] {
        for precision in [Precision::Double, Precision::Single] {
            let area = loop_area(&cycles(amplitude, 4000, precision));
            // Each extreme is missed by up to a h^2/8 and each corner cut by as much: 8 a h^2/8 in all, with h = 2 pi/4000; f32 adds
            // 4000 roundings of 6e-8 a.
            let tolerance = amplitude * 2.5e-6 + if precision == Precision::Single { 2.4e-4 * amplitude } else { 0.0 };
            assert!((area - 4.0 * (amplitude - 1.0)).abs() <= tolerance, "{precision:?} a = {amplitude}: {area}");
        }
    }
}

#[test]
fn the_area_is_second_order_where_reversals_miss_the_samples() {
    // 4 k + 2 steps a cycle put the extremes half-way between samples, the worst case.
    let error = |steps: u32| {
        let area = loop_area(&cycles(2.0, steps, Precision::Double));
        (TAU / f64::from(steps), (area - 4.0).abs())
    };
    let order = observed_order(&[error(126), error(254), error(510), error(1022)]).unwrap();
    // Slip corners fall anywhere between samples and scatter the errors.
    assert!((order.slope - 2.0).abs() < 0.2, "{order:?}");
}

#[test]
fn below_the_slip_displacement_the_element_is_a_spring() {
    let motion = cycles(0.9, 1000, Precision::Double);
    assert!(motion.events.is_empty());
    for sample in &motion.samples {
        // Rounding: increments of a sum that returns to the same values.
        assert!((sample.state.slider_forces[0] - sample.state.positions[0]).abs() < 1e-13);
    }
    assert!(loop_area(&motion).abs() < 1e-13);
    assert_eq!(motion.last().unwrap().ledger.works.friction, 0.0);
}

#[test]
fn the_first_loading_starts_from_the_unloaded_element() {
    let motion = cycles(2.0, 4000, Precision::Double);
    for sample in motion.samples.iter().filter(|sample| sample.time < FRAC_PI_2) {
        let expected = sample.state.positions[0].min(1.0);
        assert!((sample.state.slider_forces[0] - expected).abs() < 1e-13, "t = {}", sample.time);
    }
    // Slip begins at x = 1, arcsin(1/2) = pi/6, and ends at the first extreme, pi/2: second order in h = 1.6e-3, so 1e-5 is
    // four times h^2.
    let times: Vec<f64> = motion.events.iter().take(2).map(|event| event.time).collect();
    assert!((times[0] - TAU / 12.0).abs() < 1e-5 && (times[1] - FRAC_PI_2).abs() < 1e-5, "{times:?}");
    let kinds: Vec<EventKind> = motion.events.iter().map(|event| event.kind).collect();
    assert_eq!(kinds[..3], [EventKind::StickToSlip, EventKind::SlipToStick, EventKind::StickToSlip]);
    assert_eq!(kinds.len(), 12, "four a cycle");
}

#[test]
fn the_drive_pays_for_friction() {
    let motion = cycles(2.0, 4000, Precision::Double);
    let works = motion.last().unwrap().ledger.works;
    // Two full loops and a first cycle that lacks the quarter before the first slip: slid 1 less of 4, so 2 * 4 + 3 slip lengths of
    // force gamma = 1/2. Each corner off by at most a h^2/2 = 2.5e-6, twelve of them.
    assert!((works.friction + 0.5 * 11.0).abs() < 3e-5, "{works:?}");
    // Second order: 1 unit of energy times h^2 = 2.5e-6, twelve events.
    assert!(motion.energy_residual() < 3e-5, "{:e}", motion.energy_residual());
    assert!(works.drive > 4.0);
}

#[test]
fn a_motion_that_starts_elsewhere_is_refused() {
    let rig = TwoMassRig::new(RigParameters::default()).unwrap();
    let motion = PrescribedMotion { amplitude: 1.0, angular_frequency: 1.0 };
    let flow = PrescribedFlow::new(rig.chain(), motion, EngineSettings::default_for(0.01)).unwrap();
    for (state, field) in [([0.5, 0.0, 1.0, 0.0, 0.0], "positions"), ([0.0, 0.0, 0.0, 0.0, 0.0], "velocities")] {
        let error = flow.trajectory(&State::two_mass(state), Sampling { interval: 0.1, t_end: 1.0 }).unwrap_err();
        assert!(matches!(error, EngineError::OffPrescribedMotion { field: f, index: 0, .. } if f == field), "{error}");
    }
}

#[test]
fn it_converges_to_the_closed_form_with_second_order() {
    let rig = TwoMassRig::new(RigParameters::default()).unwrap();
    let motion = PrescribedMotion { amplitude: 2.0, angular_frequency: 0.9 };
    let sampling = Sampling { interval: 0.1, t_end: 30.0 };
    let exact = exact::PrescribedFlow::new(rig.chain(), motion).unwrap();
    let reference = exact.trajectory(&start(1.8), sampling).unwrap();
    let error = |step| {
        let flow = PrescribedFlow::new(rig.chain(), motion, EngineSettings::default_for(step)).unwrap();
        let tested = flow.trajectory(&start(1.8), sampling).unwrap();
        assert_eq!(tested.switches(), reference.switches());
        (step, max_state_error(&reference, &tested, 30.0).unwrap())
    };
    let order = observed_order(&[error(0.1), error(0.05), error(0.025), error(0.0125), error(0.00625)]).unwrap();
    // Extremes fall anywhere between samples; only the worst of nine counts.
    assert!((order.slope - 2.0).abs() < 0.3, "{order:?}");
}
