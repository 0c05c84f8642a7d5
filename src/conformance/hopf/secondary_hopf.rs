//! The engine's secondary Hopf point: the secant method on `|mu(xi1)| - 1`, the orbit followed along.

use super::{CycleProblem, DiscreteOrbit, HopfError};
use nalgebra::Complex;
use rayon::prelude::*;

/// Distance of the second point of the secant from the first.
const FIRST_STEP: f64 = 2e-4;
/// Longer steps may lead out of the range in which the last orbit starts Newton's method.
const LONGEST_STEP: f64 = 4e-3;
/// Last step of the secant: |mu| is known to about 1e-10 and changes by 0.2 per unit of xi1, so that xi1 is known to 1e-9.
const LAST_STEP: f64 = 2e-9;
const MAX_STEPS: usize = 25;

/// A secondary Hopf point of the engine at one phase.
#[derive(Debug, Clone, PartialEq)]
pub struct HopfPoint {
    pub xi1: f64,
    pub phase: f64,
    /// Steps n per period.
    pub steps: u64,
    /// The multiplier on the unit circle, above the real axis, of the closing map.
    pub multiplier: Complex<f64>,
    pub orbit: DiscreteOrbit,
}

/// The secondary Hopf point nearest to `guess` (a value of xi1), for the settings, steps and phase of `problem`.
///
/// # Errors
/// [`HopfError::NoHopf`] if the secant method does not converge, and what the orbits return.
pub fn secondary_hopf(problem: &CycleProblem, guess: f64) -> Result<HopfPoint, HopfError> {
    let mut before = Candidate::new(problem.at(guess).orbit()?, guess)?;
    let xi1 = guess + FIRST_STEP;
    let mut now = Candidate::new(problem.at(xi1).orbit_near(&before.orbit)?, xi1)?;
    for _ in 0..MAX_STEPS {
        let step = -now.excess() * (now.xi1 - before.xi1) / (now.excess() - before.excess());
        if !step.is_finite() {
            break;
        }
        let step = step.clamp(-LONGEST_STEP, LONGEST_STEP);
        let xi1 = now.xi1 + step;
        let next = Candidate::new(problem.at(xi1).orbit_near(&now.orbit)?, xi1)?;
        (before, now) = (now, next);
        if step.abs() <= LAST_STEP {
            let Candidate { xi1, multiplier, orbit } = now;
            return Ok(HopfPoint { xi1, phase: problem.phase, steps: problem.steps, multiplier, orbit });
        }
    }
    Err(HopfError::NoHopf { xi1: now.xi1, excess: now.excess(), iterations: MAX_STEPS })
}

/// An orbit on the way to the Hopf point.
struct Candidate {
    xi1: f64,
    multiplier: Complex<f64>,
    orbit: DiscreteOrbit,
}

impl Candidate {
    fn new(orbit: DiscreteOrbit, xi1: f64) -> Result<Self, HopfError> {
        let multiplier = orbit.pair().ok_or(HopfError::NoPair { xi1 })?;
        Ok(Self { xi1, multiplier, orbit })
    }

    fn excess(&self) -> f64 {
        self.multiplier.norm() - 1.0
    }
}

/// Hopf points at `count` phases spread evenly over a step, `phi = (i + 1/2)/count`, in parallel and in their order.
pub fn over_phases(problem: &CycleProblem, count: usize, guess: f64) -> Vec<Result<HopfPoint, HopfError>> {
    let phase = |i: usize| (i as f64 + 0.5) / count as f64;
    (0..count).into_par_iter().map(|i| secondary_hopf(&CycleProblem { phase: phase(i), ..*problem }, guess)).collect()
}

/// xi1 at the Hopf point where the step has a prescribed length: `problem.steps` is a guess; n is moved to the even number n whose
/// orbits, together with those of n + 2, have steps on both sides of `step`, and xi1 is interpolated between them linearly over h. The
/// curvature left out is that of the shift itself over a relative change 2/n of the step.
///
/// # Errors
/// As [`secondary_hopf`], and [`HopfError::StepNotBracketed`].
pub fn at_step(problem: &CycleProblem, step: f64, guess: f64) -> Result<f64, HopfError> {
    let mut steps = problem.steps & !1;
    let mut range = [f64::NAN; 2];
    for _ in 0..MAX_STEPS {
        let long = secondary_hopf(&CycleProblem { steps, ..*problem }, guess)?;
        let short = secondary_hopf(&CycleProblem { steps: steps + 2, ..*problem }, long.xi1)?;
        range = [short.orbit.step, long.orbit.step];
        if range[0] <= step && step <= range[1] {
            let part = (step - range[0]) / (range[1] - range[0]);
            return Ok(short.xi1 + part * (long.xi1 - short.xi1));
        }
        steps = 2 * (long.orbit.period / step / 2.0).floor() as u64;
    }
    Err(HopfError::StepNotBracketed { step, range, counts: [steps, steps + 2] })
}
