//! The engine's secondary Hopf point: a zero of `|mu(xi1)| - 1`, by the secant method within a bracket, the orbit followed along.
//!
//! The modulus jumps where, as xi1 changes, the end of the stick phase moves from one step into the next, because the number of steps in which
//! a perturbation feels the spring of the friction element changes by one. Where it jumps across 1, the place of the jump is
//! the Hopf point: the orbit is stable on one side and unstable on the other.

use super::{CycleProblem, DiscreteOrbit, HopfError};
use nalgebra::Complex;
use rayon::prelude::*;

/// Distance of the second point of the secant from the first.
const FIRST_STEP: f64 = 2e-4;
/// Longer steps may lead out of the range in which the last orbit starts Newton's method.
const LONGEST_STEP: f64 = 4e-3;
/// The search ends where |mu| is this near to 1: it is known to about 1e-10 and changes by 0.2 to 0.4 per unit of xi1.
const EXCESS: f64 = 4e-10;
/// It also ends in a bracket this narrow.
const NARROWEST: f64 = 2e-9;
/// At a jump no derivative is found once a switch lies within the shortest difference of a grid time; in a bracket this narrow, that
/// means that the jump is found.
const JUMP_BRACKET: f64 = 1e-5;
const MAX_STEPS: usize = 60;
/// The modulus is bent by a few units per square of xi1: from this far a linear step is right to 1e-12.
const ONE_STEP: f64 = 1e-7;
/// A phase that puts a switch on a grid time is moved by this part of the spacing of the phases, at most [`MOVES`] times.
const MOVE: f64 = 0.07;
const MOVES: u32 = 3;

/// A secondary Hopf point of the engine at one phase.
#[derive(Debug, Clone, PartialEq)]
pub struct HopfPoint {
    pub xi1: f64,
    /// Half the width of the bracket at a jump, else the resolution of the multipliers.
    pub uncertainty: f64,
    /// By how much |mu| jumps there; zero where it passes through 1.
    pub jump: f64,
    pub phase: f64,
    /// Steps n per period.
    pub steps: u64,
    /// Change of the modulus with xi1; not to be relied on at a jump.
    pub slope: f64,
    /// The multiplier on (or, at a jump, next to) the unit circle, above the real axis, of the closing map.
    pub multiplier: Complex<f64>,
    pub orbit: DiscreteOrbit,
}

/// The secondary Hopf point near `guess` (a value of xi1), for the configuration, steps and phase of `problem`.
///
/// # Errors
/// [`HopfError::NoHopf`] if the search does not end, and what the orbits return.
pub fn secondary_hopf(problem: &CycleProblem<'_>, guess: f64) -> Result<HopfPoint, HopfError> {
    let first = Candidate::new(problem.at(guess).orbit()?, guess)?;
    let xi1 = guess + FIRST_STEP;
    let second = Candidate::new(problem.at(xi1).orbit_near(&first.orbit)?, xi1)?;
    let mut search = Search { bracket: [None, None], before: first.clone(), now: first };
    search.take(second);
    for _ in 0..MAX_STEPS {
        if search.now.excess().abs() <= EXCESS {
            return Ok(search.now.point(problem, search.slope(), 0.0, EXCESS));
        }
        if let Some(point) = search.jump(problem, NARROWEST) {
            return Ok(point);
        }
        let Some(xi1) = search.next() else { break };
        match problem.at(xi1).orbit_near(&search.now.orbit) {
            Ok(orbit) => search.take(Candidate::new(orbit, xi1)?),
            Err(error @ HopfError::SwitchOnGrid { .. }) => return search.jump(problem, JUMP_BRACKET).ok_or(error),
            Err(error) => return Err(error),
        }
    }
    let (xi1, excess) = (search.now.xi1, search.now.excess());
    Err(HopfError::NoHopf { xi1, excess, iterations: MAX_STEPS })
}

/// The same, next to a point that is known for another map of the same settings: from its orbit, and by one step along its slope if that is
/// enough, else by the whole search from `guess`.
///
/// # Errors
/// As [`secondary_hopf`].
pub fn secondary_hopf_near(problem: &CycleProblem<'_>, known: &HopfPoint, guess: f64) -> Result<HopfPoint, HopfError> {
    if known.jump == 0.0
        && let Ok(orbit) = problem.at(known.xi1).orbit_near(&known.orbit)
    {
        let here = Candidate::new(orbit, known.xi1)?;
        if here.excess().abs() <= ONE_STEP {
            let point = here.point(problem, known.slope, 0.0, EXCESS);
            return Ok(HopfPoint { xi1: known.xi1 - here.excess() / known.slope, ..point });
        }
    }
    // Not from the point itself: at a jump a switch lies on a grid time there.
    secondary_hopf(problem, guess)
}

/// An orbit on the way to the Hopf point.
#[derive(Debug, Clone)]
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

    fn point(&self, problem: &CycleProblem<'_>, slope: f64, jump: f64, uncertainty: f64) -> HopfPoint {
        let Self { xi1, multiplier, orbit } = self.clone();
        HopfPoint { xi1, uncertainty, jump, slope, phase: problem.phase, steps: problem.steps, multiplier, orbit }
    }
}

/// The last two points, and the latest one on either side: stable, unstable.
struct Search {
    bracket: [Option<Candidate>; 2],
    before: Candidate,
    now: Candidate,
}

impl Search {
    fn take(&mut self, candidate: Candidate) {
        self.before = std::mem::replace(&mut self.now, candidate);
        for known in [&self.before, &self.now] {
            self.bracket[usize::from(known.excess() > 0.0)] = Some(known.clone());
        }
    }

    /// The crossing, if the bracket is at most `narrow`.
    fn jump(&self, problem: &CycleProblem<'_>, narrow: f64) -> Option<HopfPoint> {
        let [Some(stable), Some(unstable)] = &self.bracket else { return None };
        let width = (stable.xi1 - unstable.xi1).abs();
        (width <= narrow).then(|| {
            let jump = unstable.excess() - stable.excess();
            let point = unstable.point(problem, self.slope(), jump, 0.5 * width + EXCESS);
            HopfPoint { xi1: 0.5 * (stable.xi1 + unstable.xi1), ..point }
        })
    }

    fn slope(&self) -> f64 {
        (self.now.excess() - self.before.excess()) / (self.now.xi1 - self.before.xi1)
    }

    /// The secant's zero; the middle of the bracket where that lies outside, or gained little by the last step.
    fn next(&self) -> Option<f64> {
        let (before, now) = (&self.before, &self.now);
        let step = -now.excess() / self.slope();
        if let [Some(stable), Some(unstable)] = &self.bracket {
            let (low, high) = (stable.xi1.min(unstable.xi1), stable.xi1.max(unstable.xi1));
            let secant = now.xi1 + step;
            let slow = now.excess().abs() > 0.1 * before.excess().abs();
            let trusted = secant.is_finite() && low < secant && secant < high && !slow;
            return Some(if trusted { secant } else { 0.5 * (low + high) });
        }
        step.is_finite().then(|| now.xi1 + step.clamp(-LONGEST_STEP, LONGEST_STEP))
    }
}

/// Phases spread evenly over a step. A third of the way into each part, so that none is where the element samples the same
/// displacement twice: with k substeps that is at 1/2 or (k + 1)/(2 k).
#[must_use]
pub fn phases(count: usize) -> Vec<f64> {
    (0..count).map(|i| (i as f64 + 1.0 / 3.0) / count as f64).collect()
}

/// Hopf points at `count` phases ([`phases`]), computed in parallel, in their order.
///
/// # Errors
/// That of the first phase that has none; as [`secondary_hopf`].
pub fn over_phases(problem: &CycleProblem<'_>, count: usize, guess: f64) -> Result<Vec<HopfPoint>, HopfError> {
    let at = |phase| secondary_hopf(&CycleProblem { phase, ..*problem }, guess);
    let found: Vec<_> = phases(count).into_par_iter().map(at).collect();
    // Collected first, so that which error is returned does not depend on which thread was faster.
    found.into_iter().collect()
}

/// Hopf points of a map and of a reference map at `count` phases, computed in parallel, in their order. The reference is searched, the other found
/// next to it. Phases at which either has a switch on a grid time are moved.
///
/// # Errors
/// As [`over_phases`].
pub fn pairs_over_phases(
    problem: &CycleProblem<'_>,
    reference: &CycleProblem<'_>,
    count: usize,
    guess: f64,
) -> Result<Vec<[HopfPoint; 2]>, HopfError> {
    let at = |phase: f64| {
        let known = secondary_hopf(&CycleProblem { phase, ..*reference }, guess)?;
        Ok([secondary_hopf_near(&CycleProblem { phase, ..*problem }, &known, guess)?, known])
    };
    let moved = |phase: f64| {
        let mut found = at(phase);
        for k in 1..=MOVES {
            if !matches!(found, Err(HopfError::SwitchOnGrid { .. })) {
                break;
            }
            found = at(phase + f64::from(k) * MOVE / count as f64);
        }
        found
    };
    let found: Vec<_> = phases(count).into_par_iter().map(moved).collect();
    found.into_iter().collect()
}

/// xi1 at the Hopf point where the step has a prescribed length: `problem.steps` is a guess; n is moved to the even number n whose
/// orbits, together with those of n + 2, have steps on both sides of `step`, and xi1 is interpolated between them linearly over h. The
/// curvature left out is that of the shift itself over a relative change 2/n of the step.
///
/// # Errors
/// As [`secondary_hopf`], and [`HopfError::StepNotBracketed`].
pub fn at_step(problem: &CycleProblem<'_>, step: f64, guess: f64) -> Result<f64, HopfError> {
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
