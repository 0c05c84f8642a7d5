//! Amplitude diagram and Lyapunov spectrum of the exact flow.
//!
//! A diagram of 100 values, 5000 time units each, on all cores; a spectrum over 100 000 time units of chaos on one.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use stickslip::chaos::{DiagramPlan, LyapunovPlan, Window, amplitude_diagram, lyapunov_spectrum};
use stickslip::dynamics::State;
use stickslip::exact::TwoMassFlow;
use stickslip::model::{RigParameters, TwoMassRig};
use stickslip::orbit::{OrbitError, limit_cycle};

fn flow(p: RigParameters) -> Result<TwoMassFlow, OrbitError> {
    Ok(TwoMassFlow::new(&TwoMassRig::new(p)?))
}

fn beside_the_limit_cycle(xi1: f64) -> Result<(TwoMassFlow, State), OrbitError> {
    let p = RigParameters { xi1, ..Default::default() };
    let mut start = limit_cycle(p, flow)?.reversal();
    start.positions[1] += 1e-3;
    Ok((flow(p)?, start))
}

fn chaos(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("chaos");
    group.sample_size(10);
    let values: Vec<f64> = (1..=100).map(|n| -0.17 * f64::from(n) / 100.0).collect();
    group.bench_function("amplitude diagram, 100 values", |bencher| {
        let plan = DiagramPlan::default();
        bencher.iter(|| amplitude_diagram(black_box(&values), &plan, &[], beside_the_limit_cycle, |_, _, _| {}));
    });
    group.bench_function("Lyapunov spectrum, 1e5 time units", |bencher| {
        let (flow, start) = beside_the_limit_cycle(-0.155).expect("the limit cycle exists at xi1 = -0.155");
        let plan = LyapunovPlan::new(Window { transient: 0.0, length: 1e5 });
        bencher.iter(|| lyapunov_spectrum(&flow, black_box(&start), plan));
    });
    group.finish();
}

criterion_group!(benches, chaos);
criterion_main!(benches);
