//! A ring of twelve blades in Rapier against the exact flow: second order over 20 periods.

use std::f64::consts::TAU;
use stickslip::disk::TravellingWave;
use stickslip::dynamics::{Flow, Sampling, State};
use stickslip::engine::{EngineFlow, EngineSettings};
use stickslip::exact::SparseFlow;
use stickslip::model::{
    Aerodynamics, BladedDisk, ContactPlace, FrictionContacts, InfluenceCoefficient, NodalDiameter, OscillatorChain,
};

const PERIODS: f64 = 20.0;

/// Twelve blades with friction at every foot, forward waves fed by the antisymmetric stiffness.
fn ring() -> BladedDisk {
    let l = |offset, real, imaginary| InfluenceCoefficient { offset, real, imaginary };
    BladedDisk {
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        aerodynamics: Some(Aerodynamics::Coefficients {
            coefficients: vec![l(0, 0.0, 0.01), l(1, 0.03, 0.0), l(-1, -0.03, 0.0)],
            reference_frequency: 1.0,
        }),
        ..BladedDisk::ring(12, 0.1)
    }
}

/// Largest difference of any component at 32 times per period.
fn error(chain: &OscillatorChain, start: &State, steps_per_period: f64) -> f64 {
    let sampling = Sampling { interval: TAU / 32.0, t_end: PERIODS * TAU };
    let exact = SparseFlow::new(chain).trajectory(start, sampling).unwrap();
    let settings = EngineSettings::default_for(TAU / steps_per_period);
    let engine = EngineFlow::new(chain, settings).unwrap().trajectory(start, sampling).unwrap();
    assert_eq!(exact.samples.len(), engine.samples.len());
    assert!(exact.switches() > 12 * 4 * 15, "the contacts should slip: {}", exact.switches());
    let pairs = exact.samples.iter().zip(&engine.samples);
    pairs.map(|(a, b)| a.state.max_difference(&b.state)).fold(0.0, f64::max)
}

#[test]
fn twelve_blades_in_rapier_follow_the_exact_ring_with_second_order() {
    let chain = ring().chain().unwrap();
    let wave = TravellingWave::of(&ring(), NodalDiameter::new(3, 12), 32).unwrap();
    let mut start = wave.state();
    // Off the wave, so that every blade does something of its own.
    start.positions.iter_mut().enumerate().for_each(|(j, x)| *x += 0.02 * (2.4 * (j * j) as f64).sin());
    let [coarse, fine] = [1024.0, 4096.0].map(|steps| error(&chain, &start, steps));
    println!("engine against exact, N = 12: {coarse:.2e} at 1024, {fine:.2e} at 4096 steps per period");
    assert!(coarse <= 5e-4, "{coarse:e}");
    assert!(fine <= 3e-5, "{fine:e}");
    let order = (coarse / fine).log2() / 2.0;
    // Events fall at random within a step, which scatters the constant of the error by some ten per cent.
    assert!((order - 2.0).abs() < 0.25, "{order}");
    // Negative control: without the antisymmetric stiffness the motion is another one.
    let other = BladedDisk { aerodynamics: None, ..ring() }.chain().unwrap();
    let sampling = Sampling { interval: TAU, t_end: PERIODS * TAU };
    let [a, b] = [&chain, &other].map(|chain| SparseFlow::new(chain).trajectory(&start, sampling).unwrap());
    assert!(a.samples[20].state.max_difference(&b.samples[20].state) > 0.1);
}
