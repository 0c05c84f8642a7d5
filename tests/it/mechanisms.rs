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
