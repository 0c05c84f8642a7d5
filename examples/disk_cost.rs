//! Wall time of long exact motions of a fed ring: `disk_cost BLADES PERIODS`, from irregular displacements.

use std::f64::consts::TAU;
use std::time::Instant;
use stickslip::dynamics::State;
use stickslip::exact::SparseFlow;
use stickslip::model::{Aerodynamics, BladedDisk, ContactPlace, FrictionContacts, InfluenceCoefficient};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse::<usize>());
    let blades = numbers.next().transpose()?.unwrap_or(100);
    let periods = numbers.next().transpose()?.unwrap_or(1000);
    let fed = InfluenceCoefficient { offset: 0, real: 0.0, imaginary: -0.03 };
    let chain = BladedDisk {
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        aerodynamics: Some(Aerodynamics::Coefficients { coefficients: vec![fed], reference_frequency: 1.0 }),
        ..BladedDisk::ring(blades, 0.1)
    }
    .chain()?;
    let positions = (0..blades).map(|i| 1.5 * (2.4 * (i * i) as f64 + 0.3).sin()).collect();
    let start = State { positions, ..State::rest(&chain) };
    let clock = Instant::now();
    let arrival = SparseFlow::new(&chain).advance(&start, periods as f64 * TAU)?;
    let seconds = clock.elapsed().as_secs_f64();
    println!(
        "N = {blades}: {periods} periods in {seconds:.2} s, {} events, {:.2} us per event",
        arrival.switches,
        1e6 * seconds / arrival.switches.max(1) as f64
    );
    Ok(())
}
