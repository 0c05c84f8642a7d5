//! The rig in the engine: bodies, joints, limits, failures, repeatability.

use super::convergence::{PERIOD, START};
use rapier3d_f64::prelude as rapier;
use stickslip::dynamics::{Flow, Outcome, Sampling, State};
use stickslip::engine::{
    BodyRole, EngineError, EngineFlow, EngineSettings, Joints, Precision, RigGeometry, Scheme, trajectory_hash,
};
use stickslip::model::{ChainBuilder, ContactState, RigParameters, TwoMassRig};

const SAMPLING: Sampling = Sampling { interval: 0.25, t_end: 50.0 };

fn flow(xi1: f64, settings: EngineSettings) -> EngineFlow {
    let rig = TwoMassRig::new(RigParameters { xi1, ..Default::default() }).unwrap();
    EngineFlow::new(rig.chain(), settings).unwrap()
}

fn all_settings() -> Vec<EngineSettings> {
    let mut all = Vec::new();
    for base in [EngineSettings::default_for(0.01), EngineSettings::rapier_defaults()] {
        for precision in [Precision::Double, Precision::Single] {
            for joints in [Joints::Impulse, Joints::Multibody] {
                all.push(EngineSettings { precision, joints, ..base });
            }
        }
    }
    all
}

#[test]
fn joints_carry_gravity_without_drifting() {
    for settings in all_settings() {
        let drift = flow(-0.06, settings).record(&State::two_mass(START), SAMPLING).unwrap().drift;
        println!("{settings:?}: {drift:?}");
        // A joint that gave way would fall 9.81 t^2/2, 1e4 in this time. 1e-6 is 17 roundings in f32 of a length of 1.
        assert!(drift.lateral < 1e-6 && drift.rotation < 1e-6, "{settings:?}: {drift:?}");
    }
}

#[test]
fn the_engines_own_poses_follow_the_motion() {
    let geometry = RigGeometry { carriage: [0.3, 0.2, 0.1], offset: [2.0, 0.0, 0.5], rail: [5.0, 0.1, 0.6] };
    for settings in all_settings() {
        let flow = flow(-0.06, settings).with_geometry(geometry).unwrap();
        let recording = flow.record(&State::two_mass(START), SAMPLING).unwrap();
        assert_eq!(recording.poses.len(), recording.trajectory.samples.len());
        for (bodies, sample) in recording.poses.iter().zip(&recording.trajectory.samples) {
            assert_eq!(bodies.len(), 3);
            assert_eq!(
                (bodies[0].role, bodies[0].half_extents),
                (BodyRole::Rail, [5.0f64, 0.1, 0.6].map(|x| round(x, settings)))
            );
            for (i, body) in bodies[1..].iter().enumerate() {
                let expected = [2.0 * i as f64 + sample.state.positions[i], 0.0, 0.5 * i as f64];
                assert_eq!(body.role, BodyRole::Carriage(i));
                // Joint drift, and the rounding of an f32 near 4.
                let near = body.translation.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6);
                assert!(near && (body.rotation[3] - 1.0).abs() < 1e-6, "{settings:?} {body:?}");
            }
        }
    }
}

fn round(x: f64, settings: EngineSettings) -> f64 {
    if settings.precision == Precision::Single { f64::from(x as f32) } else { x }
}

#[test]
fn geometry_does_not_change_the_motion() {
    let settings = EngineSettings::default_for(0.01);
    let run = |flow: EngineFlow| flow.trajectory(&State::two_mass(START), SAMPLING).unwrap();
    let plain = run(flow(-0.06, settings));
    let geometry = RigGeometry { carriage: [3.0, 0.2, 0.1], offset: [2.0, 0.3, 0.0], rail: [5.0, 0.1, 0.6] };
    let other = run(flow(-0.06, settings).with_geometry(geometry).unwrap());
    // 5000 steps with roundings of 4e-16 each in positions near 2.
    let difference = plain.samples.iter().zip(&other.samples).map(|(a, b)| a.state.max_difference(&b.state));
    assert!(difference.fold(0.0, f64::max) < 1e-11);
}

#[test]
fn the_slider_force_never_exceeds_its_limit() {
    for settings in all_settings() {
        let motion = flow(-0.15, settings).trajectory(&State::two_mass(START), SAMPLING).unwrap();
        assert!(motion.switches() > 20);
        let forces = motion.samples.iter().map(|s| &s.state).chain(motion.events.iter().map(|e| &e.state));
        assert!(forces.map(|state| state.slider_forces[0].abs()).fold(0.0, f64::max) == 1.0);
    }
}

#[test]
fn a_sticking_motion_has_no_event() {
    let start = State::two_mass([0.1, -0.1, 0.0, 0.05, 0.1]);
    let step = 0.01;
    for scheme in [Scheme::SecondOrder, Scheme::AveragedFriction] {
        let settings = EngineSettings { scheme, ..EngineSettings::default_for(step) };
        let motion = flow(-0.06, settings).trajectory(&start, SAMPLING).unwrap();
        assert!(motion.events.is_empty());
        assert!(motion.samples.iter().all(|sample| sample.contacts == [ContactState::Stick]));
        assert_eq!(motion.last().unwrap().ledger.works.friction, 0.0);
        let largest =
            |of: &dyn Fn(&State) -> f64| motion.samples.iter().map(|s| of(&s.state).abs()).fold(0.0, f64::max);
        let apart = largest(&|state| state.slider_forces[0] - state.positions[0]);
        // The element is a spring then: f = x1, up to the rounding of 5000 increments. Averaged, the slider is carried at half steps, as the mean of two
        // positions: a h^2/8 beside x1 where it is recorded, and as much at the start; a is at most (1 + 2 kappa) times the largest position.
        let rounding = 1e-12;
        let averaging =
            1.2 * largest(&|state| state.positions[0]).max(largest(&|state| state.positions[1])) * step * step / 4.0;
        let allowed = if scheme == Scheme::AveragedFriction { averaging + rounding } else { rounding };
        assert!(apart < allowed, "{scheme:?}: {apart:e}, allowed {allowed:e}");
    }
}

#[test]
fn samples_are_where_they_were_asked_for_and_start_with_the_initial_state() {
    let start = State::two_mass(START);
    for settings in all_settings() {
        let sampling = Sampling { interval: 0.0371, t_end: 1.0 };
        let motion = flow(-0.06, settings).trajectory(&start, sampling).unwrap();
        assert_eq!(motion.samples[0].state, start);
        assert!(motion.samples.iter().map(|sample| sample.time).eq(sampling.times()));
    }
}

#[test]
fn a_run_repeats_bit_by_bit_on_any_thread() {
    for settings in all_settings() {
        let run = || trajectory_hash(&flow(-0.06, settings).trajectory(&State::two_mass(START), SAMPLING).unwrap());
        let here = run();
        let elsewhere = std::thread::scope(|scope| scope.spawn(run).join().unwrap());
        assert_eq!(here, elsewhere, "{settings:?}");
        assert_eq!(here.len(), 64);
    }
    let hash = |step| {
        trajectory_hash(
            &flow(-0.06, EngineSettings::default_for(step)).trajectory(&State::two_mass(START), SAMPLING).unwrap(),
        )
    };
    assert_ne!(hash(0.01), hash(0.005), "other numbers have another hash");
}

#[test]
fn divergence_is_an_outcome() {
    let motion = flow(-0.5, EngineSettings::default_for(0.01))
        .with_amplitude_bound(20.0)
        .unwrap()
        .trajectory(&State::two_mass(START), Sampling { interval: 0.25, t_end: 500.0 })
        .unwrap();
    let Outcome::Diverged { time, bound } = motion.outcome else { panic!("{:?}", motion.outcome) };
    assert_eq!(bound, 20.0);
    assert!(motion.samples.iter().all(|s| s.time < time && s.state.positions.iter().all(|x| x.abs() <= 20.0)));
}

#[test]
fn speeds_beyond_rapiers_default_cap_are_kept() {
    let chain = ChainBuilder::new(vec![1.0]).build().unwrap();
    let start = State { positions: vec![0.0], velocities: vec![1000.0], slider_forces: vec![] };
    for joints in [Joints::Impulse, Joints::Multibody] {
        let settings = EngineSettings { joints, ..EngineSettings::default_for(0.125) };
        let flow = EngineFlow::new(&chain, settings).unwrap().with_amplitude_bound(1e6).unwrap();
        let motion = flow.trajectory(&start, Sampling { interval: 1.0, t_end: 10.0 }).unwrap();
        assert_eq!(motion.last().unwrap().state.positions, [10_000.0]);
        assert_eq!(motion.last().unwrap().state.velocities, [1000.0]);
    }
}

#[test]
fn a_body_that_rapier_quarantines_is_an_error() {
    // The force 1e300 is finite, but moves the carriage beyond every number in one step of 1e10.
    let chain = ChainBuilder::new(vec![1.0]).ground_spring(0, 1e300).build().unwrap();
    let start = State { positions: vec![1.0], velocities: vec![0.0], slider_forces: vec![] };
    let settings = EngineSettings { scheme: Scheme::Plain, ..EngineSettings::default_for(1e10) };
    let flow = EngineFlow::new(&chain, settings).unwrap();
    let error = flow.trajectory(&start, Sampling { interval: 1e10, t_end: 1e11 }).unwrap_err();
    assert!(matches!(&error, EngineError::Quarantined { found, .. } if found == &["carriage 0"]), "{error}");
    let stiffer = ChainBuilder::new(vec![1.0]).ground_spring(0, 1e308).build().unwrap();
    let start = State { positions: vec![10.0], ..start };
    let error = EngineFlow::new(&stiffer, settings).unwrap().trajectory(&start, SAMPLING).unwrap_err();
    assert!(matches!(error, EngineError::ForceNotFinite { oscillator: 0, .. }), "{error}");
}

#[test]
fn what_cannot_be_used_is_named() {
    let rig = TwoMassRig::new(RigParameters::default()).unwrap();
    let message = |settings| EngineFlow::new(rig.chain(), settings).unwrap_err().to_string();
    assert!(message(EngineSettings::default_for(-0.01)).contains("step = -0.01"));
    assert!(message(EngineSettings { substeps: 0, ..EngineSettings::default_for(0.01) }).contains("substeps = 0"));
    let usual = flow(-0.06, EngineSettings::default_for(0.01));
    let refused = |sampling| usual.trajectory(&State::two_mass(START), sampling).unwrap_err().to_string();
    assert!(refused(Sampling { interval: 0.0, t_end: 1.0 }).contains("sampling.interval = 0"));
    assert!(refused(Sampling { interval: 0.1, t_end: f64::NAN }).contains("sampling.t_end = NaN"));
    let tiny = EngineSettings { precision: Precision::Single, ..EngineSettings::default_for(1e-60) };
    let error = flow(-0.06, tiny).trajectory(&State::two_mass(START), Sampling { interval: 1e-60, t_end: 1e-60 });
    assert!(error.unwrap_err().to_string().contains("step = 0.000"));
    assert!(usual.trajectory(&State::two_mass([0.0, 0.0, 0.0, 0.0, 1.5]), SAMPLING).is_err());
}

/// Why the velocity of a carriage on a multibody joint is read from the generalized velocity: the body's own is one substep old. Used in
/// a force law, it makes every scheme first order.
#[test]
fn the_velocity_of_a_body_on_a_multibody_joint_is_one_substep_old() {
    let mut world = rapier::PhysicsWorld::default();
    world.integration_parameters.num_solver_iterations = 1;
    let rail = world.insert_body(rapier::RigidBodyBuilder::fixed());
    let shape = rapier::ColliderBuilder::cuboid(0.5, 0.5, 0.5).mass(1.0);
    let (body, _) = world.insert(rapier::RigidBodyBuilder::dynamic().can_sleep(false), shape);
    let joint = world.insert_multibody_joint(rail, body, rapier::PrismaticJoint::new(rapier::Vector::X)).unwrap();
    world.bodies[body].add_force(rapier::Vector::X, true);
    let mut generalized = vec![0.0];
    for _ in 0..5 {
        world.step();
        let (multibody, _) = world.multibody_joints.get(joint).unwrap();
        let velocity = multibody.generalized_velocity()[0];
        assert_eq!(world.bodies[body].linvel().x, *generalized.last().unwrap());
        generalized.push(velocity);
    }
    assert!(generalized.windows(2).all(|pair| pair[1] > pair[0]));
}

/// The slider is part of the state: a motion taken up again from any sample goes on as before.
#[test]
fn a_motion_can_be_taken_up_from_any_sample() {
    let step = 1.0 / 512.0;
    let flow = flow(-0.06, EngineSettings::default_for(step));
    let whole = flow.trajectory(&State::two_mass(START), Sampling { interval: 1.0, t_end: 20.0 }).unwrap();
    for n in [1, 5, 10] {
        let rest = Sampling { interval: 1.0, t_end: 20.0 - n as f64 };
        let resumed = flow.trajectory(&whole.samples[n].state, rest).unwrap();
        let difference = resumed.last().unwrap().state.max_difference(&whole.samples[20].state);
        // The new start sets the velocity half a step back once more, an error of order h^2 = 4e-6.
        assert!(difference < 4e-6, "{difference:e}");
    }
}

#[test]
fn steps_are_counted() {
    let settings = EngineSettings::default_for(PERIOD / 256.0);
    let recording = flow(-0.06, settings).record(&State::two_mass(START), Sampling { interval: PERIOD, t_end: PERIOD });
    assert_eq!(recording.unwrap().steps, 256);
}
