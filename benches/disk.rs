//! Cost of the exact flow of a ring against the number N of blades: one period of a settled motion, events and cells counted.
//!
//! Printed beside the times: events and cost per event. A period has about 4 N events, and an event costs O(N): two factors of the slope.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;
use stickslip::dynamics::State;
use stickslip::exact::SparseFlow;
use stickslip::model::{Aerodynamics, BladedDisk, ContactPlace, FrictionContacts, InfluenceCoefficient, Topology};

/// A ring (a chain for N = 2) fed by -0.03 on every blade, with a contact at every foot.
fn disk(sectors: usize) -> BladedDisk {
    let fed = InfluenceCoefficient { offset: 0, real: 0.0, imaginary: -0.03 };
    BladedDisk {
        topology: if sectors < 3 { Topology::Chain } else { Topology::Ring },
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        aerodynamics: Some(Aerodynamics::Coefficients { coefficients: vec![fed], reference_frequency: 1.0 }),
        ..BladedDisk::ring(sectors, 0.1)
    }
}

/// The flow, and a state after 20 periods from irregular displacements, when all contacts slip.
fn settled(sectors: usize) -> (SparseFlow, State) {
    let chain = disk(sectors).chain().expect("the disk is valid");
    let positions = (0..sectors).map(|i| 4.0 * (2.4 * (i * i) as f64 + 0.3).sin()).collect();
    let start = State { positions, ..State::rest(&chain) };
    let flow = SparseFlow::new(&chain);
    let arrival = flow.advance(&start, 20.0 * TAU).expect("the start is valid");
    (flow, arrival.state)
}

fn period(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("disk_period");
    group.sample_size(10);
    let mut before: Option<(f64, f64)> = None;
    for sectors in [2, 5, 10, 20, 50, 100, 200, 500, 1000] {
        let (flow, start) = settled(sectors);
        let clock = Instant::now();
        let events = flow.advance(&start, TAU).expect("the start is valid").switches;
        let seconds = clock.elapsed().as_secs_f64();
        let slope = before.map_or(f64::NAN, |(n, s)| (seconds / s).ln() / (sectors as f64 / n).ln());
        println!(
            "N = {sectors}: {events} events, {:.2} us per event, slope of the time per period {slope:.2}",
            1e6 * seconds / events.max(1) as f64
        );
        before = Some((sectors as f64, seconds));
        group.throughput(Throughput::Elements(events as u64));
        group.bench_function(BenchmarkId::from_parameter(sectors), |b| b.iter(|| flow.advance(black_box(&start), TAU)));
    }
    group.finish();
}

criterion_group!(benches, period);
criterion_main!(benches);
