//! The slow flow: frequency over energy, one motion, the first three period doublings.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::sync::Arc;
use stickslip::averaging::{
    EnergyDefinition, EnergyFrequency, Interpolation, RestoredSlowFlow, SlowFlow, hopf_points, period_doublings,
};
use stickslip::dynamics::DenseFlow;
use stickslip::model::RigParameters;

fn averaging(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("averaging");
    group.sample_size(10);
    let p = RigParameters { xi1: -0.1, ..Default::default() };
    let law = || EnergyFrequency::new(black_box(p), EnergyDefinition::MeanPotential, Interpolation::Converged);
    group.bench_function("frequency over energy", |bencher| bencher.iter(law));
    let frequency = Arc::new(law().expect("the nominal branch reaches energy 500"));
    let restored = RestoredSlowFlow::at(p, &frequency).expect("the nominal rig is valid");
    let start = restored.limit_cycle().expect("the limit cycle exists at xi1 = -0.1");
    group.bench_function("motion over 5000 time units", |bencher| bencher.iter(|| restored.motion(&start, 5000.0)));
    let flow = SlowFlow::new(p, frequency).expect("the nominal rig is valid");
    let hopf = hopf_points(&flow).expect("the branch has Hopf points");
    group.bench_function("three period doublings", |bencher| bencher.iter(|| period_doublings(&flow, &hopf[0], 3)));
    group.finish();
}

criterion_group!(benches, averaging);
criterion_main!(benches);
