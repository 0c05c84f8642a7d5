//! Steps per second of a bladed disk in Rapier against the number of blades, and where the time goes: `disk_engine_cost [f32]`.
//!
//! The whole step is measured on a fed ring with a contact at every foot. The force laws (hook) are measured alone, on the same chain; what is
//! left is Rapier's own step, handing over forces and reading back the motion. Times are CPU times (of Linux; elsewhere wall times), the least of
//! several repetitions.

use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;
use stickslip::dynamics::{Sampling, State};
use stickslip::engine::{DiskFlow, EngineSettings, ForceLaw, JenkinsElements, Known, LinearForces, Precision};
use stickslip::model::{Aerodynamics, BladedDisk, ContactPlace, FrictionContacts, InfluenceCoefficient};

const STEPS_PER_PERIOD: f64 = 1024.0;
const REPETITIONS: usize = 7;

type Failure = Box<dyn std::error::Error>;

fn disk(sectors: usize) -> BladedDisk {
    let l = |offset, real, imaginary| InfluenceCoefficient { offset, real, imaginary };
    BladedDisk {
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        aerodynamics: Some(Aerodynamics::Coefficients {
            coefficients: vec![l(0, 0.0, -0.03), l(1, 0.03, 0.0), l(-1, -0.03, 0.0)],
            reference_frequency: 1.0,
        }),
        ..BladedDisk::ring(sectors, 0.1)
    }
}

/// CPU time of this process's main thread in seconds, from the kernel where it tells.
fn cpu_seconds(clock: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| clock.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

/// Least seconds per call of `work`, which makes `calls` of them.
fn least(calls: usize, mut work: impl FnMut() -> Result<(), Failure>) -> Result<f64, Failure> {
    let clock = Instant::now();
    let mut best = f64::INFINITY;
    for _ in 0..REPETITIONS {
        let from = cpu_seconds(clock);
        work()?;
        best = best.min((cpu_seconds(clock) - from) / calls as f64);
    }
    Ok(best)
}

fn main() -> Result<(), Failure> {
    let single = std::env::args().any(|argument| argument == "f32");
    let precision = if single { Precision::Single } else { Precision::Double };
    println!("{precision:?}, impulse joints, one substep, {STEPS_PER_PERIOD} steps per period of 2 pi");
    println!("blades  us/step  hook us  rapier us  steps/s  periods/s");
    for blades in [3, 12, 24, 100, 200, 500, 1000] {
        let disk = disk(blades);
        let chain = disk.chain()?;
        let settings = EngineSettings { precision, ..EngineSettings::default_for(TAU / STEPS_PER_PERIOD) };
        let flow = DiskFlow::new(&disk, settings)?;
        let positions: Vec<f64> = (0..blades).map(|i| 1.5 * (2.4 * (i * i) as f64 + 0.3).sin()).collect();
        let start = State { positions: positions.clone(), ..State::rest(&chain) };
        let steps = (200_000 / blades).clamp(200, 20_000);
        // Building the world is left out: the same motion, longer, less the shorter.
        let run = |steps: usize| {
            let t_end = steps as f64 * settings.step;
            flow.observe(&start, Sampling { interval: t_end, t_end }, |_, _, _| {}).map(|_| ())
        };
        let long = least(1, || Ok(run(2 * steps)?))?;
        let short = least(1, || Ok(run(steps)?))?;
        let whole = (long - short) / steps as f64;
        let laws: [Box<dyn ForceLaw>; 2] =
            [Box::new(LinearForces::of(&chain)), Box::new(JenkinsElements(chain.jenkins().to_vec()))];
        let (mut forces, mut sliders) = (vec![0.0; blades], vec![0.0; blades]);
        let moved: Vec<f64> = positions.iter().map(|x| x + 1e-3).collect();
        // Long against the ticks of the clock.
        let calls = 10_000_000 / blades;
        let hook = least(calls, || {
            for _ in 0..calls {
                forces.fill(0.0);
                for law in &laws {
                    law.move_sliders(&positions, black_box(&moved), &mut sliders);
                    let known = Known { time: 0.0, positions: &moved, velocities: &positions, slider_forces: &sliders };
                    law.add_force(black_box(&known), &mut forces);
                }
            }
            Ok(())
        })?;
        println!(
            "{blades:>6}  {:>7.2}  {:>7.2}  {:>9.2}  {:>7.0}  {:>9.2}",
            1e6 * whole,
            1e6 * hook,
            1e6 * (whole - hook),
            1.0 / whole,
            1.0 / (whole * STEPS_PER_PERIOD)
        );
    }
    Ok(())
}
