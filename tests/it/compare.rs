//! The comparison passes the right engine and fails wrong ones.

use super::convergence::{PERIOD, START};
use nalgebra::DMatrix;
use std::sync::Arc;
use stickslip::compare::{Agreement, CompareError, Expectation, Motion, compare, compare_flows, max_state_error};
use stickslip::dynamics::{Flow, Sampling, State, Trajectory};
use stickslip::engine::{
    Dampers, EngineFlow, EngineSettings, ForceLaw, JenkinsElements, Known, Precision, Scheme, SelfExcitation, Springs,
    laws_of,
};
use stickslip::exact::TwoMassFlow;
use stickslip::model::{OscillatorChain, RigParameters, TwoMassRig};

const STEP: f64 = PERIOD / 4096.0;
/// 25 periods, 159 time units.
const SAMPLING: Sampling = Sampling { interval: PERIOD / 64.0, t_end: 25.0 * PERIOD };

fn rig(xi1: f64) -> TwoMassRig {
    TwoMassRig::new(RigParameters { xi1, ..Default::default() }).unwrap()
}

fn judged(rig: &TwoMassRig, engine: &EngineFlow, start: [f64; 5], expected: &Expectation) -> Agreement {
    let exact = TwoMassFlow::new(rig);
    let agreement = compare_flows(&exact, engine, &State::two_mass(start), SAMPLING, expected).unwrap();
    printed(agreement)
}

fn printed(agreement: Agreement) -> Agreement {
    for check in &agreement.checks {
        println!("{} {:.2e} of {:.2e}", check.name, check.found, check.tolerance);
    }
    agreement
}

fn failed(agreement: &Agreement) -> Vec<&str> {
    agreement.checks.iter().filter(|check| !check.passed).map(|check| check.name).collect()
}

fn expected() -> Expectation {
    Expectation::regular(SAMPLING.t_end, STEP)
}

#[test]
fn the_engine_agrees_with_the_exact_motion() {
    // Beside the unstable limit cycle; on a torus; growing from rest through stick into slip; a stable limit cycle; large.
    for (xi1, start) in [
        (-0.06, START),
        (-0.06, [1.4, 0.2, 0.3, 0.5, 0.2]),
        (-0.06, [0.02, 0.01, 0.0, 0.0, 0.02]),
        (-0.02, [1.0, 1.0, 0.0, 0.0, 0.9]),
        (-0.10, [2.5, -1.5, 0.0, 1.0, 1.0]),
    ] {
        let rig = rig(xi1);
        let engine = EngineFlow::new(rig.chain(), EngineSettings::default_for(STEP)).unwrap();
        let agreement = judged(&rig, &engine, start, &expected());
        assert!(agreement.passed, "xi1 = {xi1}: {:?}", failed(&agreement));
        assert!(
            agreement.checks.len() == 5 && agreement.amplitude_error.is_some() && agreement.frequency_error.is_some()
        );
    }
}

#[test]
fn single_precision_agrees_within_its_rounding() {
    let rig = rig(-0.06);
    let settings = EngineSettings { precision: Precision::Single, ..EngineSettings::default_for(STEP) };
    let engine = EngineFlow::new(rig.chain(), settings).unwrap();
    let expected = Expectation { unit_roundoff: 2f64.powi(-24), ..expected() };
    assert!(judged(&rig, &engine, START, &expected).passed);
}

/// A slider that loads and slips, but keeps its force when the motion turns round.
#[derive(Debug)]
struct NoUnloading(JenkinsElements);

impl ForceLaw for NoUnloading {
    fn add_force(&self, known: &Known<'_>, force: &mut [f64]) {
        self.0.add_force(known, force);
    }

    fn move_sliders(&self, from: &[f64], to: &[f64], slider_forces: &mut [f64]) {
        let before = slider_forces.to_vec();
        self.0.move_sliders(from, to, slider_forces);
        for (f, old) in slider_forces.iter_mut().zip(before) {
            if f.abs() < old.abs() {
                *f = old;
            }
        }
    }
}

fn linear_laws(chain: &OscillatorChain, damping: DMatrix<f64>) -> Vec<Arc<dyn ForceLaw>> {
    vec![
        Arc::new(Springs(chain.stiffness().clone())),
        Arc::new(Dampers(damping)),
        Arc::new(SelfExcitation(chain.self_excitation().clone())),
    ]
}

#[test]
fn wrong_laws_fail() {
    let rig = rig(-0.06);
    let chain = rig.chain();
    let friction = || Arc::new(JenkinsElements(chain.jenkins().to_vec()));
    let mut no_unloading = linear_laws(chain, chain.damping().clone());
    no_unloading.push(Arc::new(NoUnloading(JenkinsElements(chain.jenkins().to_vec()))));
    let mut sign_error = linear_laws(chain, -chain.damping());
    sign_error.push(friction());
    let mut slightly_off = linear_laws(chain, 1.001 * chain.damping());
    slightly_off.push(friction());
    let frictionless = linear_laws(chain, chain.damping().clone());
    for (name, laws) in [
        ("no unloading", no_unloading),
        ("sign of damping", sign_error),
        ("damping 0.1 % off", slightly_off),
        ("no friction", frictionless),
    ] {
        let engine = EngineFlow::new(chain, EngineSettings::default_for(STEP)).unwrap().with_laws(laws).unwrap();
        println!("{name}");
        let agreement = judged(&rig, &engine, START, &expected());
        let failed = failed(&agreement);
        assert!(!agreement.passed && failed.contains(&"max_state_error"), "{name}: {failed:?}");
        assert!(failed.contains(&"energy_residual"), "{name}: the ledger of the rig must not close: {failed:?}");
    }
    // The right laws given by hand pass, so the failures are those of the laws.
    let right = EngineFlow::new(chain, EngineSettings::default_for(STEP)).unwrap().with_laws(laws_of(chain)).unwrap();
    assert!(judged(&rig, &right, START, &expected()).passed);
}

#[test]
fn first_order_schemes_and_rapiers_defaults_fail() {
    let rig = rig(-0.06);
    for settings in [
        EngineSettings { scheme: Scheme::LaggingDamping, ..EngineSettings::default_for(STEP) },
        EngineSettings { scheme: Scheme::Plain, ..EngineSettings::default_for(STEP) },
        EngineSettings { substeps: 4, ..EngineSettings::default_for(STEP) },
        EngineSettings::rapier_defaults(),
    ] {
        let engine = EngineFlow::new(rig.chain(), settings).unwrap();
        let expected = Expectation::regular(SAMPLING.t_end, settings.step);
        let agreement = judged(&rig, &engine, START, &expected);
        assert!(failed(&agreement).contains(&"max_state_error"), "{settings:?}");
    }
}

#[test]
fn a_chaotic_motion_is_judged_by_averages_beyond_a_short_horizon() {
    let rig = rig(-0.155);
    let sampling = Sampling { interval: 0.1, t_end: 2000.0 };
    let step = 0.1 / 32.0;
    let exact = TwoMassFlow::new(&rig).trajectory(&State::two_mass(START), sampling).unwrap();
    let run = |chain: &OscillatorChain| {
        let engine = EngineFlow::new(chain, EngineSettings::default_for(step)).unwrap();
        engine.trajectory(&State::two_mass(START), sampling).unwrap()
    };
    // A bound on the growth over this short time: |lambda| of chaos at this parameter is below 0.05.
    let expected = Expectation { motion: Motion::Chaotic, growth_rate: 0.05, ..Expectation::regular(40.0, step) };
    let judge = |tested: &Trajectory, expected: &Expectation| printed(compare(&exact, tested, expected).unwrap());
    let engine = run(rig.chain());
    let agreement = judge(&engine, &expected);
    let averages = |agreement: &Agreement| {
        let of = |name| agreement.checks.iter().find(|check| check.name == name).unwrap().passed;
        (of("max_state_error"), of("amplitude_error"), of("frequency_error"))
    };
    assert_eq!(averages(&agreement), (true, true, true));
    // The trajectories themselves have parted, and another rig has other averages.
    assert!(agreement.max_state_error < 1e-3);
    let whole = max_state_error(&exact, &engine, 2000.0).unwrap();
    assert!(whole > 0.1, "{whole}");
    // However long the horizon, the tolerance stays at 1 % of the motion, and parted trajectories fail it.
    let (state, ..) = averages(&judge(&engine, &Expectation { horizon: 2000.0, ..expected }));
    assert!(!state);
    let other = TwoMassRig::new(RigParameters { xi1: -0.12, ..Default::default() }).unwrap();
    // Its frequency is too near to tell in this time.
    let (state, amplitude, _) = averages(&judge(&run(other.chain()), &expected));
    assert!(!state && !amplitude);
}

#[test]
fn motions_that_cannot_be_compared_are_refused() {
    let rig = rig(-0.06);
    let exact = TwoMassFlow::new(&rig);
    let run = |interval, t_end| exact.trajectory(&State::two_mass(START), Sampling { interval, t_end }).unwrap();
    let reference = run(0.1, 10.0);
    let with =
        |tested: &Trajectory, horizon| compare(&reference, tested, &Expectation::regular(horizon, 0.01)).unwrap_err();
    assert!(matches!(with(&run(0.1, 9.0), 5.0), CompareError::DifferentLengths { reference: 101, tested: 91 }));
    assert!(matches!(with(&run(0.09, 9.0), 5.0), CompareError::DifferentTimes { index: 1, .. }));
    assert!(matches!(with(&reference, 11.0), CompareError::Horizon { .. }));
    assert!(matches!(with(&reference, f64::NAN), CompareError::OutOfRange { field: "horizon", .. }));
    let empty = Trajectory { samples: vec![], ..reference.clone() };
    assert!(matches!(compare(&empty, &empty, &Expectation::regular(1.0, 0.01)), Err(CompareError::Empty)));
    let same = compare(&reference, &reference, &Expectation::regular(10.0, 0.01)).unwrap();
    assert!(same.passed && same.max_state_error == 0.0 && same.amplitude_error == Some(0.0));
}

#[test]
fn an_agreement_has_the_fields_of_the_report() {
    let rig = rig(-0.06);
    let engine = EngineFlow::new(rig.chain(), EngineSettings::default_for(STEP)).unwrap();
    let start = State::two_mass(START);
    let recording = engine.record(&start, SAMPLING).unwrap();
    let exact = TwoMassFlow::new(&rig).trajectory(&start, SAMPLING).unwrap();
    let drift = [recording.drift.lateral, recording.drift.rotation];
    let expected = Expectation { joint_drift: Some(drift), ..expected() };
    let agreement = serde_json::to_value(compare(&exact, &recording.trajectory, &expected).unwrap()).unwrap();
    for field in ["horizon", "max_state_error", "amplitude_error", "frequency_error", "energy_residual"] {
        assert!(agreement[field].is_f64(), "{field}");
    }
    assert_eq!(agreement["passed"], true);
    assert_eq!(agreement["checks"].as_array().unwrap().len(), 7);
    assert!(agreement["checks"].as_array().unwrap().iter().all(|check| !check["reason"].as_str().unwrap().is_empty()));
}
