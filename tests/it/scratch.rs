use stickslip::dynamics::*;
use stickslip::engine::*;
use stickslip::model::*;

#[test]
fn scratch() {
    let rig = TwoMassRig::new(RigParameters::default()).unwrap();
    let period = std::f64::consts::TAU / 0.98948851;
    let start = State::two_mass([1.2226496266, 0.9053979113, 0.0, -0.5377904062, 1.0]);
    let run = |settings: EngineSettings| {
        let flow = EngineFlow::new(rig.chain(), settings).unwrap();
        let t0 = std::time::Instant::now();
        let r = flow.record(&start, Sampling { interval: period / 64.0, t_end: 10.0 * period }).unwrap();
        (r, t0.elapsed())
    };
    let (reference, _) = run(EngineSettings::default_for(period / 65536.0));
    println!(
        "events {} drift {:?} residual {:e}",
        reference.trajectory.events.len(),
        reference.drift,
        reference.trajectory.energy_residual()
    );
    for joints in [Joints::Impulse, Joints::Multibody] {
        for precision in [Precision::Double, Precision::Single] {
            for scheme in [Scheme::SecondOrder, Scheme::LaggingDamping, Scheme::Plain] {
                for n in [64.0, 256.0, 512.0, 1024.0, 2048.0, 4096.0, 16384.0] {
                    let s = EngineSettings { joints, precision, scheme, ..EngineSettings::default_for(period / n) };
                    let (r, t) = run(s);
                    let e = r
                        .trajectory
                        .samples
                        .iter()
                        .zip(&reference.trajectory.samples)
                        .map(|(a, b)| a.state.max_difference(&b.state))
                        .fold(0.0, f64::max);
                    println!(
                        "{joints:?} {precision:?} {scheme:?} {n}: {e:.3e} residual {:.2e} drift {:.1e} {:.1e} {:.2} us/step, {} events",
                        r.trajectory.energy_residual(),
                        r.drift.lateral,
                        r.drift.rotation,
                        t.as_secs_f64() * 1e6 / r.steps as f64,
                        r.trajectory.events.len()
                    );
                }
            }
        }
    }
}
