//! Lyapunov spectra of the exact flow: against Floquet multipliers, on the torus, in chaos, and against the volume law.

use nalgebra::Matrix4;
use stickslip::chaos::{LyapunovOutcome, LyapunovPlan, LyapunovSpectrum, Window, lyapunov_spectrum};
use stickslip::dynamics::{EventKind, State};
use stickslip::exact::TwoMassFlow;
use stickslip::model::{RigParameters, TwoMassRig};
use stickslip::orbit::{PeriodicOrbit, limit_cycle};

pub fn flow_at(xi1: f64) -> TwoMassFlow {
    TwoMassFlow::new(&TwoMassRig::new(RigParameters { xi1, ..Default::default() }).unwrap())
}

pub fn orbit_at(xi1: f64) -> PeriodicOrbit {
    let p = RigParameters { xi1, ..Default::default() };
    limit_cycle(p, |p| Ok(TwoMassFlow::new(&TwoMassRig::new(p)?))).unwrap()
}

/// The limit cycle with mass 2 displaced.
pub fn beside_the_limit_cycle(xi1: f64, displacement: f64) -> State {
    let mut state = orbit_at(xi1).reversal();
    state.positions[1] += displacement;
    state
}

fn outcome(xi1: f64, initial: &State, transient: f64, length: f64) -> LyapunovOutcome {
    lyapunov_spectrum(&flow_at(xi1), initial, LyapunovPlan::new(Window { transient, length })).unwrap()
}

fn spectrum(xi1: f64, initial: &State, transient: f64, length: f64) -> LyapunovSpectrum {
    outcome(xi1, initial, transient, length).spectrum().unwrap().clone()
}

#[test]
fn on_the_stable_limit_cycle_the_spectrum_is_that_of_its_multipliers() {
    let orbit = orbit_at(-0.03);
    let half_period = 0.5 * orbit.period;
    let mut expected: Vec<f64> =
        orbit.section_multipliers().iter().map(|m| m.norm().ln() / half_period).chain([0.0]).collect();
    expected.sort_by(|a, b| b.total_cmp(a));
    let found = spectrum(-0.03, &orbit.reversal(), 20_000.0, 20_000.0);
    assert_eq!((found.exponents.len(), found.vanished), (4, 1));
    for (found, expected) in found.exponents.iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
}

#[test]
fn a_torus_has_two_zero_exponents() {
    let found = spectrum(-0.06, &beside_the_limit_cycle(-0.06, 1e-2), 20_000.0, 400_000.0);
    for i in [0, 1] {
        assert!(found.exponents[i].abs() < 3.0 * found.standard_errors[i], "{found:?}");
        assert!(found.standard_errors[i] < 2e-5, "the error bar should be small against the other exponents");
    }
    assert!(found.exponents[2] < -1e-3);
}

#[test]
fn chaos_has_a_positive_exponent() {
    let found = spectrum(-0.155, &beside_the_limit_cycle(-0.155, 1e-3), 2_000.0, 400_000.0);
    // Measured: 0.00502 with an error bar of 7e-5.
    assert!(found.exponents[0] > 10.0 * found.standard_errors[0], "{found:?}");
    // Along the flow, and along the phase of the fast oscillation, which the slow flow does not depend on.
    assert!(found.exponents[1].abs() < 3.0 * found.standard_errors[1], "{found:?}");
    assert!(found.exponents[3] < -0.1);
}

#[test]
fn a_motion_that_diverges_has_no_exponents() {
    let found = outcome(-0.2, &beside_the_limit_cycle(-0.2, 1e-3), 0.0, 20_000.0);
    assert!(matches!(found, LyapunovOutcome::Diverged { time, .. } if time > 10.0 && time < 20_000.0));
}

#[test]
fn five_exponents_remain_where_the_element_never_slips() {
    // Sticking linear system: modes of damping xi1 and xi2 contract at half of these, and the held slider is neutral.
    let small = State::two_mass([0.1, 0.05, 0.0, 0.02, 0.1]);
    let found = spectrum(0.01, &small, 10_000.0, 10_000.0);
    for (found, expected) in found.exponents.iter().zip([0.0, -0.005, -0.005, -0.0055, -0.0055]) {
        // The frame separates 0.0055 from 0.005 only as e^(-5e-4 t): 7e-3 after the transient, on a rate of 5e-4.
        assert!((found - expected).abs() < 1e-5, "{found} {expected}");
    }
    assert_eq!(found.exponents.len(), 5);
}

/// `exp(K t)` of the rig without its slider, `z = (x1, x2, v1, v2)`, and the equilibrium per slider position.
fn stick_volume_factor(p: RigParameters, duration: f64) -> f64 {
    let (d1, d2, k) = (0.5 * (p.xi1 + p.xi2), 0.5 * (p.xi1 - p.xi2), p.kappa);
    #[rustfmt::skip]
    let system = Matrix4::new(
        0.0, 0.0, 1.0, 0.0,
        0.0, 0.0, 0.0, 1.0,
        -(1.0 + k), k, -d1, -d2,
        k, -(1.0 + k), -d2, -d1,
    );
    let rest = -system.try_inverse().unwrap() * nalgebra::Vector4::new(0.0, 0.0, p.gamma, 0.0);
    let back = (system * -duration).exp();
    // Psi(T) = (1 - Phi(T)) rest, so Phi^-1 Psi = (Phi^-1 - 1) rest.
    1.0 + (back * rest - rest)[0]
}

/// A slip phase contracts volumes in `(x, v)` by `e^(-(xi1 + xi2) t)`. A stick phase starts with df = 0, so the slider is moved by
/// `da = dx1`, and `dz(T) = Phi dz + Psi da = (Phi + Psi e1^T) dz`; the next slip wipes df out. Hence a factor
/// `det Phi (1 + e1^T Phi^-1 Psi)` per stick phase.
#[test]
fn volumes_contract_as_the_switches_demand() {
    for xi1 in [-0.03, -0.06, -0.155] {
        let p = RigParameters { xi1, ..Default::default() };
        let flow = flow_at(xi1);
        let initial = beside_the_limit_cycle(xi1, 1e-3);
        let motion = flow.solve(&initial, 4000.0).unwrap();
        let events: Vec<_> = motion.events().iter().filter(|event| event.kind != EventKind::Grazing).collect();
        // Windows that begin and end in the middle of a slip phase, where df = 0.
        let middle_of_slip = |from: f64| {
            let onset = events.iter().position(|e| e.time > from && e.kind == EventKind::StickToSlip).unwrap();
            (onset, 0.5 * (events[onset].time + events[onset + 1].time))
        };
        let ((first, start), (last, end)) = (middle_of_slip(100.0), middle_of_slip(3900.0));
        let sticks = events[first..=last].windows(2).filter(|pair| pair[0].kind == EventKind::SlipToStick);
        let sum: f64 = sticks.map(|pair| stick_volume_factor(p, pair[1].time - pair[0].time).abs().ln()).sum();
        let expected = -(p.xi1 + p.xi2) + sum / (end - start);
        let found = spectrum(xi1, &initial, start, end - start);
        let found: f64 = found.convergence.last().unwrap().exponents.iter().sum();
        // An identity up to rounding: 8e-11 measured in chaos, where two computations of one motion separate by e^(0.005 t)
        // from 1e-13 on; 1e-14 on the limit cycle.
        assert!((found - expected).abs() < 1e-8, "{found} {expected}");
        // Negative control: without the slider's memory the sum would be the trace.
        assert!((found + p.xi1 + p.xi2).abs() > 1e-2);
    }
}
