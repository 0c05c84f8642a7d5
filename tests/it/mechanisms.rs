//! Rapier's own springs and friction against closed forms.

use stickslip::conformance::linear_mechanisms::{Oscillator, damping_error, frequency_shift, measure, step_map};
use stickslip::engine::mechanism::LinearMechanism;
use stickslip::engine::{EngineSettings, Joints, Precision};

#[test]
#[ignore]
fn probe() {
    for mechanism in LinearMechanism::ALL {
        for joints in [Joints::Impulse, Joints::Multibody] {
            for precision in [Precision::Double, Precision::Single] {
                for step in [1.0 / 60.0, 1.0 / 240.0, 1.0 / 960.0] {
                    for substeps in [1, 2, 4, 8] {
                        let settings =
                            EngineSettings { step, substeps, joints, precision, ..EngineSettings::rapier_defaults() };
                        let o = Oscillator::unit();
                        match measure(&stickslip::conformance::Rapier, mechanism, o, settings, 100.0) {
                            Err(e) => {
                                println!("{e}");
                            }
                            Ok(None) => println!("none"),
                            Ok(Some(m)) => {
                                let law = damping_error(mechanism, o, step, substeps);
                                let shift = frequency_shift(mechanism, o, step, substeps);
                                let map = step_map(mechanism, o, step, substeps);
                                println!(
                                    "{:28} {:9} {} 1/{:<4.0} n={} xi {:+.6e} law {:+.6e} ratio-1 {:+.1e} map {:+.6e} | shift {:+.4e} law {:+.4e} rel {:+.1e}",
                                    mechanism.words(),
                                    joints.word(),
                                    precision.word(),
                                    1.0 / step,
                                    substeps,
                                    m.damping,
                                    law,
                                    m.damping / law - 1.0,
                                    map.damping,
                                    m.angular_frequency - 1.0,
                                    shift,
                                    (m.angular_frequency - 1.0) / shift - 1.0
                                );
                            }
                        }
                    }
                }
            }
        }
    }
}

#[test]
#[ignore]
fn probe_friction() {
    use stickslip::conformance::native_friction::*;
    use stickslip::engine::mechanism::*;
    let makings = {
        let mut all = vec![];
        for mechanism in [FrictionMechanism::CoulombContact, FrictionMechanism::SimplifiedContact] {
            for spring in [ElementSpring::Hook, ElementSpring::SpringJoint] {
                for mass in [0.01, 0.001] {
                    all.push(Making::new(mechanism, mass, spring));
                }
            }
        }
        all
    };
    for making in makings {
        for (step, substeps) in [(1.0 / 60.0, 1), (1.0 / 60.0, 4), (1.0 / 240.0, 1), (1.0 / 240.0, 4), (1.0 / 960.0, 1)]
        {
            let joints =
                if making.mechanism == FrictionMechanism::JointFriction { Joints::Multibody } else { Joints::Impulse };
            let settings = EngineSettings {
                step,
                substeps,
                joints,
                precision: Precision::Double,
                ..EngineSettings::rapier_defaults()
            };
            println!(
                "== {} ms={} spring {} {} 1/{:.0} n={}",
                making.mechanism.words(),
                making.slider_mass,
                making.spring.words(),
                joints.word(),
                1.0 / step,
                substeps
            );
            match hysteresis(&stickslip::conformance::Rapier, making, settings) {
                Ok(h) => println!(
                    "   area {:.4} slip {:.4?} max {:.4} start {:.4?} stop {:.4?}",
                    h.loop_area, h.slip_force, h.largest_force, h.slip_start_delay, h.slip_stop_delay
                ),
                Err(e) => println!("   {e}"),
            }
            match hold(&stickslip::conformance::Rapier, making, settings) {
                Ok(h) => println!("   hold settled {:.3e} creep {:.3e}", h.settled, h.creep_rate),
                Err(e) => println!("   {e}"),
            }
            match stick(&stickslip::conformance::Rapier, making, settings) {
                Ok(o) => {
                    println!("   stick xi {:+.3e} w/w0-1 {:+.3e}", o.damping, o.angular_frequency / 2f64.sqrt() - 1.0)
                }
                Err(e) => println!("   {e}"),
            }
            match ride(&stickslip::conformance::Rapier, making, settings) {
                Ok(o) => println!("   ride xi {:+.3e} w-1 {:+.3e}", o.damping, o.angular_frequency - 1.0),
                Err(e) => println!("   {e}"),
            }
            match decay(&stickslip::conformance::Rapier, making, settings) {
                Ok(o) => println!("   decay {:.5} exact {:.5}", o[0], o[1]),
                Err(e) => println!("   {e}"),
            }
        }
    }
}

#[test]
#[ignore]
fn probe_pad() {
    use rapier3d_f64::prelude::*;
    for model in [FrictionModel::Simplified, FrictionModel::Coulomb] {
        let mut w = PhysicsWorld::default();
        w.gravity = Vector::new(0.0, 0.0, 0.0);
        w.integration_parameters.friction_model = model;
        w.integration_parameters.num_solver_iterations = 1;
        w.integration_parameters.max_ccd_substeps = 0;
        let (block, bc) = w.insert(
            RigidBodyBuilder::fixed().translation(Vector::new(0.0, -0.4, 0.0)),
            ColliderBuilder::cuboid(16.0, 0.2, 0.2).friction(0.5),
        );
        let (pad, pc) = w.insert(
            RigidBodyBuilder::dynamic().can_sleep(false).locked_axes(LockedAxes::ROTATION_LOCKED),
            ColliderBuilder::cuboid(0.2, 0.2, 0.2).mass(0.01).friction(0.5),
        );
        for n in 0..200 {
            let b = &mut w.bodies[pad];
            b.reset_forces(false);
            b.add_force(Vector::new(0.5, -2.0, 0.0), true);
            w.step();
            if n % 20 == 0 {
                let c = w.contact_pair(pc, bc).map(|p| {
                    p.manifolds()
                        .iter()
                        .map(|m| {
                            m.points
                                .iter()
                                .map(|p| (p.data.impulse, p.data.tangent_impulse.x, p.data.tangent_impulse.y))
                                .collect::<Vec<_>>()
                        })
                        .collect::<Vec<_>>()
                });
                println!("{model:?} {n} {:?} {:?} {c:?}", w.bodies[pad].translation(), w.bodies[pad].linvel());
            }
        }
        let _ = block;
    }
}

#[test]
#[ignore]
fn probe_rig() {
    use stickslip::conformance::native_friction::*;
    use stickslip::engine::Scheme;
    use stickslip::engine::mechanism::*;
    use stickslip::model::*;
    let args: f64 = std::env::var("XI1").unwrap().parse().unwrap();
    let p = RigParameters { xi1: args, ..Default::default() };
    let orbit =
        stickslip::orbit::limit_cycle(p, |p| Ok(stickslip::exact::TwoMassFlow::new(&TwoMassRig::new(p)?))).unwrap();
    println!("exact {} w {}", orbit.amplitude(), orbit.angular_frequency());
    for (mechanism, mass, spring) in [
        (FrictionMechanism::Hook, 0.01, ElementSpring::Hook),
        (FrictionMechanism::SaturatingMotor, 0.01, ElementSpring::Hook),
        (FrictionMechanism::LimitedMotor, 0.01, ElementSpring::Hook),
        (FrictionMechanism::LimitedMotor, 0.001, ElementSpring::Hook),
        (FrictionMechanism::LimitedMotor, 0.001, ElementSpring::SpringJoint),
        (FrictionMechanism::JointFriction, 0.001, ElementSpring::Hook),
        (FrictionMechanism::CoulombContact, 0.01, ElementSpring::Hook),
        (FrictionMechanism::CoulombContact, 0.001, ElementSpring::Hook),
        (FrictionMechanism::CoulombContact, 0.001, ElementSpring::SpringJoint),
    ] {
        for (step, substeps, scheme) in [
            (1.0 / 240.0, 1, Scheme::SecondOrder),
            (1.0 / 60.0, 1, Scheme::SecondOrder),
            (1.0 / 60.0, 4, Scheme::Plain),
        ] {
            let joints =
                if mechanism == FrictionMechanism::JointFriction { Joints::Multibody } else { Joints::Impulse };
            let settings = EngineSettings { step, substeps, joints, scheme, precision: Precision::Double };
            let m = two_mass(
                &stickslip::conformance::Rapier,
                Making::new(mechanism, mass, spring),
                p,
                &orbit,
                settings,
                1000.0,
            );
            match m {
                Ok(m) => println!(
                    "{} {} {} 1/{:.0} n={}: {:.4} .. {:.4} w {:.6}",
                    mechanism.words(),
                    mass,
                    spring.words(),
                    1.0 / step,
                    substeps,
                    m.maxima[0],
                    m.maxima[1],
                    m.angular_frequency
                ),
                Err(e) => println!(
                    "{} {} {} 1/{:.0} n={}: {e}",
                    mechanism.words(),
                    mass,
                    spring.words(),
                    1.0 / step,
                    substeps
                ),
            }
        }
    }
}
