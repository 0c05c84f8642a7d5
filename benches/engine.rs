//! Time of one engine step of the two-mass rig, by precision and joints; the work is 1000 steps, recorded once.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use stickslip::dynamics::{Flow, Sampling, State};
use stickslip::engine::{EngineFlow, EngineSettings, Joints, Precision};
use stickslip::model::{RigParameters, TwoMassRig};

const STEPS: u64 = 1000;
const STEP: f64 = 1.0 / 512.0;

fn steps(criterion: &mut Criterion) {
    let rig = TwoMassRig::new(RigParameters::default()).expect("nominal parameters are valid");
    let start = State::two_mass([1.2226496266, 0.9053979113, 0.0, -0.5377904062, 1.0]);
    let t_end = STEPS as f64 * STEP;
    let mut group = criterion.benchmark_group("engine_step");
    group.throughput(Throughput::Elements(STEPS)).sample_size(20);
    for precision in [Precision::Double, Precision::Single] {
        for joints in [Joints::Impulse, Joints::Multibody] {
            let settings = EngineSettings { precision, joints, ..EngineSettings::default_for(STEP) };
            let flow = EngineFlow::new(rig.chain(), settings).expect("the settings are valid");
            group.bench_function(format!("{}/{}", precision.word(), joints.word()), |bencher| {
                bencher.iter(|| flow.trajectory(black_box(&start), Sampling { interval: t_end, t_end }));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);
