//! All set-ups: those of the scenarios, and motions that are judged by other numbers than the state at their end.

use super::setup::{Judged, Prescribed, Quantity, Setup};
use crate::conformance::{ConformanceError, registry};
use crate::dynamics::{Flow, Sampling, State};
use crate::exact::TwoMassFlow;
use crate::model::{Attachment, ChainBuilder, JenkinsElement, RigParameters, TwoMassRig};
use crate::orbit::limit_cycle;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Samples per period of long motions, whose files would be large otherwise. Maxima between samples are then good to 1e-4.
const SAMPLES: u32 = 32;
/// Slope and limit of the Jenkins element in the nominal rig.
const GAMMA: f64 = 0.5;
/// Of the prescribed motion, in units of the displacement at which slip begins.
const AMPLITUDE: f64 = 2.0;
const CYCLES: u32 = 3;

/// All of them, in the order of the report.
///
/// # Errors
/// [`ConformanceError`] if a reference cannot be computed.
pub fn setups() -> Result<Vec<Setup>, ConformanceError> {
    let mut all = vec![free_flight("free_flight", 0.0)?, free_flight("constant_force", 0.1)?];
    for scenario in registry() {
        all.extend(scenario.setups()?);
    }
    all.extend([hysteresis()?, torus()?, chaos()?]);
    Ok(all)
}

/// `x = t + a t^2/2`, two periods of the oscillators elsewhere.
fn free_flight(name: &str, push: f64) -> Result<Setup, ConformanceError> {
    let chain = ChainBuilder::new(vec![1.0]).build()?;
    let at = |n: u32| {
        let t = TAU / 64.0 * f64::from(n);
        let (positions, velocities) = (vec![t + 0.5 * push * t * t], vec![1.0 + push * t]);
        (t, State { positions, velocities, slider_forces: vec![] })
    };
    let reference: Vec<_> = (0..=128).map(at).collect();
    let setup = Setup::from_parts("free_flight", name, &chain, &reference[0].1, reference.clone());
    Ok(Setup { force: vec![push], ..setup })
}

/// The element carried along `x = 2 sin t`: after the first loading f rises with x until 1 and falls until -1, turn by turn.
fn hysteresis() -> Result<Setup, ConformanceError> {
    let element = JenkinsElement { attachment: Attachment::Ground(0), stiffness: GAMMA, slip_force: GAMMA };
    let chain = ChainBuilder::new(vec![1.0]).jenkins(element).build()?;
    let at = |n: u32| {
        let t = TAU / 64.0 * f64::from(n);
        let (positions, velocities) = (vec![AMPLITUDE * t.sin()], vec![AMPLITUDE * t.cos()]);
        (t, State { positions, velocities, slider_forces: vec![slider_force(t)] })
    };
    let reference: Vec<_> = (0..=64 * CYCLES).map(at).collect();
    let setup = Setup::from_parts("hysteresis", "hysteresis", &chain, &reference[0].1, reference.clone());
    let prescribed = Some(Prescribed { oscillator: 1, amplitude: AMPLITUDE, angular_frequency: 1.0 });
    let judged = Judged { quantities: vec![Quantity::LoopArea], ..setup.judged.clone() };
    Ok(Setup { prescribed, judged, ..setup })
}

/// `min(1, x)` on the first loading; after the turn at `x = +-a` the force has fallen or risen by the way back, down to -+1.
fn slider_force(t: f64) -> f64 {
    let x = AMPLITUDE * t.sin();
    if t <= FRAC_PI_2 {
        return x.min(1.0);
    }
    let turns = ((t - FRAC_PI_2) / PI).floor();
    let side = if turns % 2.0 == 0.0 { 1.0 } else { -1.0 };
    side * (1.0 - (AMPLITUDE - side * x)).max(-1.0)
}

/// The last 250 of 400 periods at xi1 = -0.06.
fn torus() -> Result<Setup, ConformanceError> {
    let from = 150;
    let (setup, period) = of_the_rig("torus", -0.06, 0.3, 400)?;
    let quantities = vec![
        Quantity::LargestMaximum,
        Quantity::SmallestMaximum,
        Quantity::ModulationFrequency,
        Quantity::AngularFrequency,
    ];
    let judged = Judged { state_until: Some(10.0 * period), from: f64::from(from) * period, quantities };
    Ok(Setup { judged, ..setup })
}

/// The state over five periods, means over the last 500 of 600, at xi1 = -0.155.
fn chaos() -> Result<Setup, ConformanceError> {
    let (setup, period) = of_the_rig("chaos", -0.155, 0.01, 600)?;
    let quantities = vec![Quantity::MeanMaximum, Quantity::AngularFrequency];
    let judged = Judged { state_until: Some(5.0 * period), from: 100.0 * period, quantities };
    Ok(Setup { judged, ..setup })
}

/// The exact motion of the nominal rig, x2 moved off the limit cycle, and the cycle's period.
fn of_the_rig(name: &str, xi1: f64, moved: f64, periods: u32) -> Result<(Setup, f64), ConformanceError> {
    let parameters = RigParameters { xi1, ..RigParameters::default() };
    let rig = TwoMassRig::new(parameters)?;
    let orbit = limit_cycle(parameters, |p| Ok(TwoMassFlow::new(&TwoMassRig::new(p)?)))?;
    let mut start = orbit.reversal();
    start.positions[1] += moved;
    let sampling = Sampling { interval: orbit.period / f64::from(SAMPLES), t_end: f64::from(periods) * orbit.period };
    let exact = TwoMassFlow::new(&rig).trajectory(&start, sampling)?;
    let reference = exact.samples.into_iter().map(|sample| (sample.time, sample.state)).collect();
    Ok((Setup::from_parts(name, name, rig.chain(), &start, reference), orbit.period))
}
