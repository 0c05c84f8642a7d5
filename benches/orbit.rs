//! One limit cycle; the branch to amplitude 50 with its special points; the secondary Hopf points and the fold of one rig.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use stickslip::exact::TwoMassFlow;
use stickslip::model::{RigParameter, RigParameters, TwoMassRig};
use stickslip::orbit::{Bifurcation, Branch, Heading, OrbitError, PeriodicOrbit, PseudoArclength, limit_cycle};

type At = fn(RigParameters) -> Result<TwoMassFlow, OrbitError>;

fn at(p: RigParameters) -> Result<TwoMassFlow, OrbitError> {
    Ok(TwoMassFlow::new(&TwoMassRig::new(p)?))
}

fn cycle(p: RigParameters) -> PeriodicOrbit {
    limit_cycle(p, at).expect("the limit cycle exists")
}

fn branch(p: RigParameters, amplitude: f64, enough: impl Fn(&Branch) -> bool) -> Branch {
    let branch = PseudoArclength::new(at as At, p, &cycle(p), RigParameter::Xi1, Heading::Decreasing);
    Branch::follow(branch.expect("the cycle is regular").up_to_amplitude(amplitude), enough)
        .expect("the branch goes on")
}

fn orbits(criterion: &mut Criterion) {
    let p = RigParameters { xi1: -5e-4, ..Default::default() };
    let whole = branch(p, 50.0, |_| false);
    println!("{} orbits and {} special points to amplitude 50", whole.points.len(), whole.special.len());
    let mut group = criterion.benchmark_group("orbit");
    group.sample_size(20);
    group.bench_function("limit cycle at xi1 = -0.06", |b| {
        b.iter(|| cycle(black_box(RigParameters { xi1: -0.06, ..p })));
    });
    group.bench_function("secondary Hopf points and fold", |b| {
        b.iter(|| branch(black_box(p), 50.0, |so_far| so_far.special_of(Bifurcation::Fold).next().is_some()));
    });
    group.bench_function("branch to amplitude 50", |b| b.iter(|| branch(black_box(p), 50.0, |_| false)));
    group.finish();
}

criterion_group!(benches, orbits);
criterion_main!(benches);
