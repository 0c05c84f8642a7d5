//! The engine as a map of its own complete discrete state: what n steps of length h make of it.
//!
//! ```text
//! z_n = (x_n, w_n, f_n, a_(n-1)),   z_(n+1) = G_h(z_n)
//! ```
//!
//! with w the engine's velocities, f the slider forces and a the acceleration of the step before, which only a scheme that
//! predicts velocities remembers. G_h does not depend on n: making n and then m steps is making n + m steps, to rounding, although the
//! world is built anew in between (joint drift across the rail, not part of z, starts again from zero and does not act on x).
//! Periodic orbits and multipliers of the engine are those of G_h^n.

use super::EngineError;
use super::flow::{EngineFlow, Run};
use crate::dynamics::{State, StateError};

/// All that the engine's coming steps depend on, in the order of [`Self::components`].
#[derive(Debug, Clone, PartialEq)]
pub struct DiscreteState {
    /// Displacements x, length N.
    pub positions: Vec<f64>,
    /// The engine's own velocities w, length N; see [`super::Scheme`] for their time.
    pub engine_velocities: Vec<f64>,
    /// Normalised slider forces, one per Jenkins element, |f| <= 1; those at the time of w where friction is averaged.
    pub slider_forces: Vec<f64>,
    /// Accelerations in the step that led here: length N, or empty if the scheme remembers none
    /// ([`super::EngineSettings::remembers_acceleration`]).
    pub past_accelerations: Vec<f64>,
}

/// What n steps made of a discrete state.
#[derive(Debug, Clone, PartialEq)]
pub struct Stepped {
    pub end: DiscreteState,
    /// Velocities of the recorded motion (`w_n + s a_n`, see [`super::Scheme`]) at the start and after the first step, length N each.
    pub first_velocities: [Vec<f64>; 2],
    /// Numbers of the steps (the first is 0) in which an element reached or left its limit. As long as they stay the same, the end depends
    /// on the start smoothly; for linear forces it is an affine function of it.
    pub switches: Vec<u64>,
}

impl DiscreteState {
    /// All components in the order x, w, f, a.
    pub fn components(&self) -> impl Iterator<Item = f64> + '_ {
        let Self { positions, engine_velocities, slider_forces, past_accelerations } = self;
        positions.iter().chain(engine_velocities).chain(slider_forces).chain(past_accelerations).copied()
    }

    /// Largest difference of any component. States of one flow only.
    #[must_use]
    pub fn max_difference(&self, other: &Self) -> f64 {
        self.components().zip(other.components()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}

impl EngineFlow {
    /// The discrete state from which a recorded motion starts: velocities s earlier, and the present acceleration remembered, so that the
    /// velocity predicted at the start is the given one.
    ///
    /// # Errors
    /// [`EngineError`] for a state that cannot start a motion.
    pub fn discrete_start(&self, initial: &State) -> Result<DiscreteState, EngineError> {
        let run = Run::start(self, initial.clone().validated(self.chain())?)?;
        Ok(self.discrete_state(&run))
    }

    /// Makes `count` steps from a complete discrete state.
    ///
    /// # Errors
    /// [`EngineError::InitialState`] for a state that does not fit the flow, and whatever stops a motion.
    pub fn steps_from(&self, start: &DiscreteState, count: u64) -> Result<Stepped, EngineError> {
        self.check(start)?;
        let mut run = Run::resume(self, start)?;
        let mut first_velocities = [run.now.state.velocities.clone(), run.now.state.velocities.clone()];
        let mut switches = Vec::new();
        for n in 0..count {
            run.step(n)?;
            if n == 0 {
                first_velocities[1].clone_from(&run.now.state.velocities);
            }
            if run.slider_switched() {
                switches.push(n);
            }
        }
        Ok(Stepped { end: self.discrete_state(&run), first_velocities, switches })
    }

    fn discrete_state(&self, run: &Run<'_>) -> DiscreteState {
        let remembered = self.settings().remembers_acceleration();
        DiscreteState {
            positions: run.now.state.positions.clone(),
            engine_velocities: run.engine_velocities.clone(),
            slider_forces: run.carried_sliders().to_vec(),
            past_accelerations: if remembered { run.past_acceleration.clone() } else { Vec::new() },
        }
    }

    /// What [`State::validated`] does not see.
    fn check(&self, start: &DiscreteState) -> Result<(), StateError> {
        let expected = if self.settings().remembers_acceleration() { self.chain().oscillators() } else { 0 };
        let (field, found) = ("past_accelerations", start.past_accelerations.len());
        if found != expected {
            return Err(StateError::WrongLength {
                field,
                found,
                expected,
                per: "oscillator, if the scheme remembers it",
            });
        }
        match start.past_accelerations.iter().position(|a| !a.is_finite()) {
            Some(index) => Err(StateError::NotFinite { field, index, found: start.past_accelerations[index] }),
            None => Ok(()),
        }
    }
}
