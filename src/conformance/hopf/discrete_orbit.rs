//! Newton's method for a periodic orbit of the engine, its step length unknown, and the multipliers of the orbit.
//!
//! Unknowns are `u = (x1, x2, w1, w2, [a1, a2,] h)`; the slider force is at its limit f = 1 by the phase condition, since mass 1 still moves
//! out just before it reverses. It ends at f = -1 whatever u is, which makes one multiplier exactly zero; the others are the eigenvalues
//! of the derivative of the rest.
//!
//! The engine is opaque, so derivatives are central differences. While the switches keep their places among the steps, the end is an affine
//! function of the start: there is no truncation error, and the longest difference that moves no switch is the best. Rounding
//! is about 1e-16 sqrt(n), 5e-15 at n = 2048, so a difference of 1e-4 knows the derivative to 5e-11 (1e-7: 5e-8). The derivative with
//! respect to h is not affine, but serves Newton's method only.

use super::HopfError;
use super::discrete_map::{DiscreteMap, Source};
use crate::conformance::Configuration;
use crate::dynamics::{Closure, State};
use crate::engine::{DiscreteState, Stepped};
use crate::exact::TwoMassFlow;
use crate::model::{RigParameters, TwoMassRig};
use crate::orbit::limit_cycle;
use nalgebra::{Complex, DMatrix, DVector};

/// Differences of the state (of order 1) tried, the longest first.
const DIFFERENCES: [f64; 4] = [1e-4, 1e-5, 1e-6, 1e-7];
/// Relative difference of the step: shifts the end by the time 6e-6, with a truncation error of about 1e-11.
const STEP_DIFFERENCE: f64 = 1e-6;
/// Largest residual of a converged orbit: about a hundred roundings (1e-16 sqrt(n), n up to 10^4) of a state of order 1.
const RESIDUAL: f64 = 1e-12;
/// Quadratic convergence needs 3 to 5 from the exact orbit.
const MAX_ITERATIONS: usize = 20;
/// A residual that falls less than this in one iteration asks for a new derivative.
const SLOW: f64 = 0.1;
/// Fewer steps than this resolve no stick phase.
const FEWEST_STEPS: u64 = 8;

/// Which periodic orbit of the engine. The step is found.
#[derive(Debug, Clone, Copy)]
pub struct CycleProblem<'a> {
    pub source: Source<'a>,
    pub configuration: Configuration,
    pub parameters: RigParameters,
    /// Steps n over one period of the oscillation.
    pub steps: u64,
    /// Fraction phi of the first step at which mass 1 reverses, in [0, 1).
    pub phase: f64,
    /// [`Closure::HalfPeriod`] uses the odd symmetry and needs an even n.
    pub closure: Closure,
}

/// A periodic orbit of the engine.
#[derive(Debug, Clone, PartialEq)]
pub struct DiscreteOrbit {
    pub start: DiscreteState,
    /// Step length h.
    pub step: f64,
    /// n h.
    pub period: f64,
    /// Derivative of the closing map over the state without the slider force, at fixed h.
    pub jacobian: DMatrix<f64>,
    /// Derivative of all equations over all unknowns.
    derivative: DMatrix<f64>,
    /// Steps of the closing map in which the element reached or left its limit.
    pub switches: Vec<u64>,
    pub residual: f64,
}

impl DiscreteOrbit {
    /// Eigenvalues of [`Self::jacobian`], largest modulus first: one near 1 (along the orbit), a pair, a real one, and, where the
    /// scheme remembers accelerations, two that are zero but for the damping over half a step.
    #[must_use]
    pub fn multipliers(&self) -> Vec<Complex<f64>> {
        let mut values: Vec<Complex<f64>> = self.jacobian.complex_eigenvalues().iter().copied().collect();
        values.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
        values
    }

    /// The multiplier of largest modulus above the real axis.
    #[must_use]
    pub fn pair(&self) -> Option<Complex<f64>> {
        self.multipliers().into_iter().find(|value| value.im > 0.0)
    }
}

impl<'a> CycleProblem<'a> {
    /// Half-period map of the nominal rig.
    #[must_use]
    pub fn symmetric(source: Source<'a>, configuration: Configuration, steps: u64, phase: f64) -> Self {
        let (parameters, closure) = (RigParameters::default(), Closure::HalfPeriod);
        Self { source, configuration, parameters, steps, phase, closure }
    }

    /// With another self-excitation.
    #[must_use]
    pub fn at(self, xi1: f64) -> Self {
        Self { parameters: RigParameters { xi1, ..self.parameters }, ..self }
    }

    /// The orbit, started from the exact one.
    ///
    /// # Errors
    /// [`HopfError`] for settings outside their range and if Newton's method does not converge.
    pub fn orbit(&self) -> Result<DiscreteOrbit, HopfError> {
        self.orbit_from(&self.guess()?, None)
    }

    /// The orbit, started from another one of the same settings, steps and phase.
    ///
    /// # Errors
    /// As [`Self::orbit`].
    pub fn orbit_near(&self, other: &DiscreteOrbit) -> Result<DiscreteOrbit, HopfError> {
        self.orbit_from(&unknowns(&other.start, other.step), Some(&other.derivative))
    }

    /// Newton's method with an old derivative as long as that serves: the map is nearly affine, and the derivative is what costs.
    fn orbit_from(&self, guess: &DVector<f64>, old: Option<&DMatrix<f64>>) -> Result<DiscreteOrbit, HopfError> {
        self.check()?;
        let xi1 = self.parameters.xi1;
        let mut u = guess.clone();
        let mut derivative = old.cloned();
        let mut last = f64::INFINITY;
        for _ in 0..MAX_ITERATIONS {
            let (r, stepped) = self.residual(&u)?;
            let residual = r.amax();
            if residual <= RESIDUAL {
                let derivative = self.derivative(&u, &stepped.switches)?;
                return self.closed(&u, derivative, stepped, residual);
            }
            let current = match derivative.filter(|_| residual < SLOW * last) {
                Some(old) => old,
                None => self.derivative(&u, &stepped.switches)?,
            };
            let correction = current.clone().lu().solve(&r).filter(|step| step.iter().all(|c| c.is_finite()));
            u -= correction.ok_or(HopfError::Singular { step: u[u.len() - 1], xi1 })?;
            (derivative, last) = (Some(current), residual);
        }
        Err(HopfError::NoOrbit { xi1, iterations: MAX_ITERATIONS, residual: last, allowed: RESIDUAL })
    }

    fn closed(
        &self,
        u: &DVector<f64>,
        derivative: DMatrix<f64>,
        stepped: Stepped,
        residual: f64,
    ) -> Result<DiscreteOrbit, HopfError> {
        let (found, xi1) = (stepped.end.slider_forces[0], self.parameters.xi1);
        if found != self.sign() {
            return Err(HopfError::NotSlipping { xi1, found });
        }
        let d = u.len() - 1;
        let step = u[d];
        Ok(DiscreteOrbit {
            start: discrete_state(u),
            step,
            period: step * self.steps as f64,
            jacobian: derivative.view((0, 0), (d, d)) + DMatrix::identity(d, d),
            derivative,
            switches: stepped.switches,
            residual,
        })
    }

    /// Closing defect of the state without f, then the phase condition.
    fn residual(&self, u: &DVector<f64>) -> Result<(DVector<f64>, Stepped), HopfError> {
        let d = u.len() - 1;
        let stepped = self.map(u[d])?.steps(&discrete_state(u), self.count())?;
        let end = unknowns(&stepped.end, 0.0);
        let [v0, v1] = &stepped.first_velocities;
        let reversal = (1.0 - self.phase) * v0[0] + self.phase * v1[0];
        let residual = DVector::from_fn(d + 1, |i, _| if i < d { self.sign() * end[i] - u[i] } else { reversal });
        Ok((residual, stepped))
    }

    fn derivative(&self, u: &DVector<f64>, switches: &[u64]) -> Result<DMatrix<f64>, HopfError> {
        let mut derivative = DMatrix::zeros(u.len(), u.len());
        for i in 0..u.len() {
            derivative.set_column(i, &self.column(u, i, switches)?);
        }
        Ok(derivative)
    }

    /// Central difference that moves no switch to another step.
    fn column(&self, u: &DVector<f64>, i: usize, switches: &[u64]) -> Result<DVector<f64>, HopfError> {
        let of_step = i == u.len() - 1;
        for length in DIFFERENCES {
            let difference = if of_step { length / DIFFERENCES[0] * STEP_DIFFERENCE * u[i] } else { length };
            let moved = |by: f64| {
                let mut moved = u.clone();
                moved[i] += by;
                self.residual(&moved)
            };
            let ((plus, after), (minus, before)) = (moved(difference)?, moved(-difference)?);
            if after.switches == switches && before.switches == switches {
                return Ok((plus - minus) / (2.0 * difference));
            }
        }
        let difference = DIFFERENCES[DIFFERENCES.len() - 1];
        Err(HopfError::SwitchOnGrid { xi1: self.parameters.xi1, difference })
    }

    /// The exact orbit, phi h before its reversal (by Taylor's formula), as the engine would start there.
    fn guess(&self) -> Result<DVector<f64>, HopfError> {
        self.check()?;
        let orbit = limit_cycle(self.parameters, |p| Ok(TwoMassFlow::new(&TwoMassRig::new(p)?)))?;
        let step = orbit.period / self.steps as f64;
        let rig = TwoMassRig::new(self.parameters)?;
        let State { positions: x, velocities: v, slider_forces: f } = orbit.reversal();
        let a = rig.chain().acceleration(&x, &v, &f);
        let t = -self.phase * step;
        let at = |i: usize| x[i] + t * (v[i] + 0.5 * t * a[i]);
        let state = State::two_mass([at(0), at(1), v[0] + t * a[0], v[1] + t * a[1], 1.0]);
        Ok(unknowns(&self.map(step)?.start(&state)?, step))
    }

    fn map(&self, step: f64) -> Result<Box<dyn DiscreteMap>, HopfError> {
        self.source.map(TwoMassRig::new(self.parameters)?.chain(), self.configuration, step)
    }

    fn check(&self) -> Result<(), HopfError> {
        let odd = self.closure == Closure::HalfPeriod && !self.steps.is_multiple_of(2);
        if odd || self.steps < FEWEST_STEPS {
            return Err(HopfError::Steps { steps: self.steps });
        }
        if !(0.0..1.0).contains(&self.phase) {
            return Err(HopfError::Phase { phase: self.phase });
        }
        Ok(())
    }

    fn count(&self) -> u64 {
        match self.closure {
            Closure::HalfPeriod => self.steps / 2,
            Closure::FullPeriod { cycles } => self.steps * cycles as u64,
        }
    }

    fn sign(&self) -> f64 {
        if self.closure == Closure::HalfPeriod { -1.0 } else { 1.0 }
    }
}

fn unknowns(state: &DiscreteState, step: f64) -> DVector<f64> {
    let DiscreteState { positions, engine_velocities, past_accelerations, .. } = state;
    let components = positions.iter().chain(engine_velocities).chain(past_accelerations).copied();
    let components: Vec<f64> = components.chain([step]).collect();
    DVector::from_vec(components)
}

fn discrete_state(u: &DVector<f64>) -> DiscreteState {
    let components = &u.as_slice()[..u.len() - 1];
    DiscreteState {
        positions: components[..2].to_vec(),
        engine_velocities: components[2..4].to_vec(),
        slider_forces: vec![1.0],
        past_accelerations: components[4..].to_vec(),
    }
}
