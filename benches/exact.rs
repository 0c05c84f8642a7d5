//! Time per event on the trajectory that leaves the unstable limit cycle at xi1 = -0.06 (to t = 2000, 1260 events): modal
//! coordinates, the general chain, and a library's general solver restarted at events. The error of each in the final state
//! is printed beside its time.

#[path = "../tests/it/general_solver.rs"]
mod general_solver;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use stickslip::dynamics::{HalfPeriodMap, ReversalPoint, State};
use stickslip::exact::{ChainFlow, TwoMassFlow};
use stickslip::model::{RigParameters, TwoMassRig};

const T_END: f64 = 2000.0;
const START: [f64; 5] = [1.2226496266, 0.9053979113, 0.0, -0.5377904062, 1.0];
/// Computed with 50 digits outside this project.
const END: [f64; 5] = [1.17683461371815, 1.142441921330231, -0.00277934897911, -0.307457641547716, 0.99999649751427];

fn report(name: &str, end: &State, switches: usize) {
    println!("{name}: error {:.1e} in the final state, {switches} events", end.max_difference(&State::two_mass(END)));
}

fn events(criterion: &mut Criterion) {
    let rig = TwoMassRig::new(RigParameters::default()).expect("the nominal parameters are valid");
    let (flow, chain, start) = (TwoMassFlow::new(&rig), ChainFlow::new(rig.chain()), State::two_mass(START));
    let mut group = criterion.benchmark_group("events");
    group.throughput(Throughput::Elements(1260));

    let arrival = flow.advance(&start, T_END).expect("the start is valid");
    report("two-mass flow", &arrival.state, arrival.switches);
    group.bench_function("two_mass_flow", |b| b.iter(|| flow.advance(black_box(&start), T_END)));

    let motion = chain.solve(&start, T_END).expect("the start is valid");
    let end = motion.state_at(T_END).expect("the end is part of the motion").state;
    report("chain flow", &end, motion.events().len());
    group.sample_size(20);
    group.bench_function("chain_flow", |b| b.iter(|| chain.solve(black_box(&start), T_END)));

    group.sample_size(10);
    for (name, tolerance) in [("diffsol_tsit45_1e-6", 1e-6), ("diffsol_tsit45_1e-13", 1e-13)] {
        let (end, switches) = general_solver::solve(rig.chain(), &start, T_END, tolerance);
        report(name, &end, switches);
        group.bench_function(name, |b| {
            b.iter(|| general_solver::solve(rig.chain(), black_box(&start), T_END, tolerance))
        });
    }
    group.finish();
}

fn half_period(criterion: &mut Criterion) {
    let flow = TwoMassFlow::new(&TwoMassRig::new(RigParameters::default()).expect("the nominal parameters are valid"));
    let start = ReversalPoint::new(1.2226496, 0.9043979, -0.5377904);
    criterion.bench_function("half_period_map_with_jacobian", |b| b.iter(|| flow.half_return(black_box(start))));
}

criterion_group!(benches, events, half_period);
criterion_main!(benches);
