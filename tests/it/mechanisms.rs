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
                        match measure(mechanism, o, settings, 100.0) {
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
        let mut all = vec![
            Making::new(FrictionMechanism::Hook, 0.01, ElementSpring::Hook),
            Making::new(FrictionMechanism::SaturatingMotor, 0.01, ElementSpring::Hook),
        ];
        for mechanism in [
            FrictionMechanism::LimitedMotor,
            FrictionMechanism::JointFriction,
            FrictionMechanism::CoulombContact,
            FrictionMechanism::SimplifiedContact,
        ] {
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
            match hysteresis(making, settings) {
                Ok(h) => println!(
                    "   area {:.4} slip {:.4?} max {:.4} start {:.4?} stop {:.4?}",
                    h.loop_area, h.slip_force, h.largest_force, h.slip_start_delay, h.slip_stop_delay
                ),
                Err(e) => println!("   {e}"),
            }
            match hold(making, settings) {
                Ok(h) => println!("   hold settled {:.3e} creep {:.3e}", h.settled, h.creep_rate),
                Err(e) => println!("   {e}"),
            }
            match stick(making, settings) {
                Ok(o) => {
                    println!("   stick xi {:+.3e} w/w0-1 {:+.3e}", o.damping, o.angular_frequency / 2f64.sqrt() - 1.0)
                }
                Err(e) => println!("   {e}"),
            }
            match ride(making, settings) {
                Ok(o) => println!("   ride xi {:+.3e} w-1 {:+.3e}", o.damping, o.angular_frequency - 1.0),
                Err(e) => println!("   {e}"),
            }
            match decay(making, settings) {
                Ok(o) => println!("   decay {:.5} exact {:.5}", o[0], o[1]),
                Err(e) => println!("   {e}"),
            }
        }
    }
}
