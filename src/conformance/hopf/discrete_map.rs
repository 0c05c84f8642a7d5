//! Maps of the complete discrete state: the engine, and the difference equation that its configuration should be.

use super::HopfError;
use crate::conformance::{Bench, Configuration, DifferenceEquation};
use crate::dynamics::State;
use crate::engine::{DiscreteState, EngineFlow, Stepped};
use crate::model::OscillatorChain;

/// What makes steps of one length.
pub(in crate::conformance) trait DiscreteMap {
    /// The discrete state from which a motion starts.
    fn start(&self, initial: &State) -> Result<DiscreteState, HopfError>;

    fn steps(&self, from: &DiscreteState, count: u64) -> Result<Stepped, HopfError>;
}

/// Whose bifurcation is looked for.
#[derive(Clone, Copy)]
pub enum Source<'a> {
    /// The engine, as the bench builds it.
    Engine(&'a dyn Bench),
    /// The difference equation that the configuration should be.
    Theory,
}

impl Source<'_> {
    pub(in crate::conformance) fn map(
        self,
        chain: &OscillatorChain,
        configuration: Configuration,
        step: f64,
    ) -> Result<Box<dyn DiscreteMap>, HopfError> {
        Ok(match self {
            Self::Engine(bench) => {
                let flow = bench.free(chain, configuration, step).map_err(|error| HopfError::Bench(Box::new(error)))?;
                Box::new(flow)
            }
            Self::Theory => Box::new(Equation {
                remembers: configuration.settings(step).remembers_acceleration(),
                equation: DifferenceEquation::new(chain, configuration, step),
            }),
        })
    }
}

impl std::fmt::Debug for Source<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Engine(_) => "Engine",
            Self::Theory => "Theory",
        })
    }
}

impl DiscreteMap for EngineFlow {
    fn start(&self, initial: &State) -> Result<DiscreteState, HopfError> {
        Ok(self.discrete_start(initial)?)
    }

    fn steps(&self, from: &DiscreteState, count: u64) -> Result<Stepped, HopfError> {
        Ok(self.steps_from(from, count)?)
    }
}

/// [`DifferenceEquation`] with what is needed to cut its motions anywhere.
struct Equation {
    equation: DifferenceEquation,
    remembers: bool,
}

impl DiscreteMap for Equation {
    /// As the engine starts, with the stagger of the scheme: a guess for Newton's method, no more.
    fn start(&self, initial: &State) -> Result<DiscreteState, HopfError> {
        let State { positions: x, velocities: v, slider_forces: f } = initial;
        let a = self.equation.acceleration_after(x, v, f, &vec![0.0; x.len()]);
        let back: Vec<f64> = a.iter().map(|a| -a).collect();
        Ok(DiscreteState {
            positions: x.clone(),
            engine_velocities: self.equation.recorded(v, &back),
            slider_forces: f.clone(),
            past_accelerations: if self.remembers { a } else { Vec::new() },
        })
    }

    fn steps(&self, from: &DiscreteState, count: u64) -> Result<Stepped, HopfError> {
        let DiscreteState { positions: mut x, engine_velocities: mut w, slider_forces: mut f, past_accelerations } =
            from.clone();
        let mut past = if self.remembers { past_accelerations } else { vec![0.0; x.len()] };
        let mut a = self.equation.acceleration_after(&x, &w, &f, &past);
        let mut first_velocities = [self.equation.recorded(&w, &a), Vec::new()];
        let mut switches = Vec::new();
        let mut limits = at_limit(&f);
        for n in 0..count {
            let next = self.equation.advance(&mut x, &mut w, &mut f, &a);
            past = std::mem::replace(&mut a, next);
            if n == 0 {
                first_velocities[1] = self.equation.recorded(&w, &a);
            }
            let now = at_limit(&f);
            if now != limits {
                switches.push(n);
                limits = now;
            }
        }
        let past_accelerations = if self.remembers { past } else { Vec::new() };
        let end = DiscreteState { positions: x, engine_velocities: w, slider_forces: f, past_accelerations };
        Ok(Stepped { end, first_velocities, switches })
    }
}

fn at_limit(slider_forces: &[f64]) -> Vec<bool> {
    slider_forces.iter().map(|f| f.abs() >= 1.0).collect()
}
