//! Engine against the exact solution: observed order, and the size of the error where it was measured before.

use stickslip::compare::{ObservedOrder, max_state_error, observed_order};
use stickslip::dynamics::{Flow, Sampling, State, Trajectory};
use stickslip::engine::{EngineFlow, EngineSettings, Joints, Precision, Scheme};
use stickslip::exact::{ChainFlow, TwoMassFlow};
use stickslip::model::{Attachment, ChainBuilder, JenkinsElement, OscillatorChain, RigParameters, TwoMassRig};

/// Period of the limit cycle at xi1 = -0.06, from its angular frequency.
pub const PERIOD: f64 = std::f64::consts::TAU / 0.989_488_51;
/// Beside that limit cycle.
pub const START: [f64; 5] = [1.222_649_626_6, 0.905_397_911_3, 0.0, -0.537_790_406_2, 1.0];
const LADDER: [f64; 5] = [256.0, 512.0, 1024.0, 2048.0, 4096.0];
const SAMPLING: Sampling = Sampling { interval: PERIOD / 64.0, t_end: 10.0 * PERIOD };

fn rig() -> TwoMassRig {
    TwoMassRig::new(RigParameters::default()).unwrap()
}

fn reference() -> Trajectory {
    TwoMassFlow::new(&rig()).trajectory(&State::two_mass(START), SAMPLING).unwrap()
}

fn simulated(settings: EngineSettings) -> Trajectory {
    let flow = EngineFlow::new(rig().chain(), settings).unwrap();
    flow.trajectory(&State::two_mass(START), SAMPLING).unwrap()
}

/// Steps and largest state errors over ten periods.
fn ladder(settings: EngineSettings, error: impl Fn(&Trajectory) -> f64) -> Vec<(f64, f64)> {
    let at = |steps: f64| {
        let step = PERIOD / steps;
        (step, error(&simulated(EngineSettings { step, ..settings })))
    };
    LADDER.iter().map(|&steps| at(steps)).collect()
}

fn state_errors(settings: EngineSettings) -> Vec<(f64, f64)> {
    let reference = reference();
    ladder(settings, |tested| max_state_error(&reference, tested, SAMPLING.t_end).unwrap())
}

fn order(ladder: &[(f64, f64)]) -> ObservedOrder {
    let order = observed_order(ladder).unwrap();
    println!("{ladder:?} {order:?}");
    order
}

#[test]
fn the_engine_converges_to_the_exact_motion_with_second_order() {
    // Measured at 4096 steps: 3.6e-6 and 5.5e-6. About a factor 3 for another start of the steps relative to the events.
    for (scheme, at_4096) in [(Scheme::AveragedFriction, 1e-5), (Scheme::SecondOrder, 2e-5)] {
        for joints in [Joints::Impulse, Joints::Multibody] {
            let errors = state_errors(EngineSettings { joints, scheme, ..EngineSettings::default_for(1.0) });
            let order = order(&errors);
            // Second order within 5 %: where reversals fall between samples scatters the single errors.
            assert!((order.slope - 2.0).abs() <= 0.1, "{scheme:?} {joints:?}: {order:?}");
            assert!(errors[4].1 <= at_4096, "{scheme:?} {joints:?}: {errors:?}");
        }
    }
}

#[test]
fn without_the_velocity_prediction_it_is_of_first_order() {
    for (scheme, at_4096) in [(Scheme::LaggingDamping, 1.8e-3), (Scheme::Plain, 2.1e-3)] {
        let errors = state_errors(EngineSettings { scheme, ..EngineSettings::default_for(1.0) });
        let order = order(&errors);
        assert!((order.slope - 1.0).abs() <= 0.1, "{scheme:?}: {order:?}");
        // Measured; a first-order error is smooth in the step, so 10 %.
        assert!((errors[4].1 / at_4096 - 1.0).abs() < 0.1, "{scheme:?}: {errors:?}");
    }
}

#[test]
fn single_precision_stops_improving_at_about_1e_5() {
    let single = |steps| EngineSettings { precision: Precision::Single, ..EngineSettings::default_for(PERIOD / steps) };
    let reference = reference();
    let error = |settings| max_state_error(&reference, &simulated(settings), SAMPLING.t_end).unwrap();
    let (coarse, usual, fine) = (error(single(1024.0)), error(single(4096.0)), error(single(16384.0)));
    println!("f32: {coarse:.3e} {usual:.3e} {fine:.3e}");
    // Still the discretisation: 5.7e-5 in f64.
    assert!(coarse > 3e-5 && coarse < 1e-4);
    assert!(usual <= 3e-5, "{usual:e}");
    // In f64 the error is 3.6e-7 here. Rounding of the step alone, up to 2^-24 of the time, moves a state of speed 1.2 by up to
    // 4.5e-6 in 63 time units; rounding of positions adds as much.
    assert!(fine > 2e-6 && fine < 3e-5, "{fine:e}");
}

#[test]
fn event_times_and_the_energy_residual_converge_with_second_order() {
    let reference = reference();
    let event_error = |tested: &Trajectory| {
        assert_eq!(tested.events.len(), reference.events.len());
        let pairs = tested.events.iter().zip(&reference.events);
        pairs
            .map(|(a, b)| {
                assert_eq!(a.kind, b.kind);
                (a.time - b.time).abs()
            })
            .fold(0.0, f64::max)
    };
    let settings = EngineSettings::default_for(1.0);
    let events = order(&ladder(settings, event_error));
    let energy = order(&ladder(settings, Trajectory::energy_residual));
    // As for the states, with twice the scatter: a single event or residual is looked at, not a smooth distance.
    assert!((events.slope - 2.0).abs() <= 0.2, "{events:?}");
    assert!((energy.slope - 2.0).abs() <= 0.2, "{energy:?}");
}

/// Five masses, circulatory coupling, two sliders, one of them between masses, unequal in everything.
fn general_chain() -> OscillatorChain {
    let mut circulatory = nalgebra::DMatrix::zeros(5, 5);
    (circulatory[(0, 1)], circulatory[(1, 0)]) = (0.03, -0.03);
    let mut builder = ChainBuilder::new(vec![1.0, 1.2, 0.9, 1.1, 1.0]).add_stiffness(&circulatory);
    for i in 0..5 {
        builder = builder.ground_spring(i, 0.8 + 0.05 * i as f64).self_excited(i, -0.03).ground_damper(i, 0.02);
    }
    for i in 0..4 {
        builder = builder.coupling_spring(i, i + 1, 0.1 + 0.01 * i as f64).coupling_damper(i, i + 1, 0.01);
    }
    builder
        .jenkins(JenkinsElement { attachment: Attachment::Ground(0), stiffness: 0.5, slip_force: 0.4 })
        .jenkins(JenkinsElement { attachment: Attachment::Between(2, 3), stiffness: 0.3, slip_force: 0.2 })
        .build()
        .unwrap()
}

#[test]
fn a_general_chain_converges_too_and_off_the_grid() {
    let chain = general_chain();
    let start = State {
        positions: vec![1.0, -0.5, 0.8, -0.9, 0.3],
        velocities: vec![0.1, 0.4, -0.6, 0.2, 0.0],
        slider_forces: vec![0.3, -0.2],
    };
    // 0.37 is no multiple of any of the steps: the engine interpolates.
    let sampling = Sampling { interval: 0.37, t_end: 40.0 };
    let reference = ChainFlow::new(&chain).trajectory(&start, sampling).unwrap();
    let errors: Vec<_> = [0.02, 0.01, 0.005, 0.0025]
        .iter()
        .map(|&step| {
            let flow = EngineFlow::new(&chain, EngineSettings::default_for(step)).unwrap();
            let tested = flow.trajectory(&start, sampling).unwrap();
            assert_eq!(tested.switches(), reference.switches());
            (step, max_state_error(&reference, &tested, 40.0).unwrap())
        })
        .collect();
    let order = order(&errors);
    // Fewer steps a period and more events than above: 10 %.
    assert!((order.slope - 2.0).abs() <= 0.2, "{order:?}");
    assert!(reference.switches() > 10, "{}", reference.switches());
}
