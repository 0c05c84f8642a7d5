//! The motions of an amplitude diagram: which solver, from which start.

use super::super::analysis::exact_flow;
use super::super::motions;
use crate::averaging::{AveragingError, EnergyFrequency, RestoredSlowFlow};
use crate::chaos::{Criteria, KnownCycle};
use crate::dynamics::{Sampled, State};
use crate::engine::{EngineError, EngineFlow, EngineSettings};
use crate::exact::TwoMassFlow;
use crate::model::{ParameterError, RigParameters, TwoMassRig};
use crate::orbit::OrbitError;
use clap::ValueEnum;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Start where there is no limit cycle: beyond the slip limit, as its orbits are.
const ELSEWHERE: [f64; 5] = [1.2, 0.9, 0.0, -0.5, 1.0];
/// Steps of the engine per period of the sticking in-phase mode, unless told otherwise: a second a value.
pub const ENGINE_STEPS: f64 = 256.0;
/// Samples per period of that mode between which the engine's motion is interpolated, where its steps are shorter.
const ENGINE_SAMPLES: f64 = 256.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Solver {
    /// The closed-form solution.
    Exact,
    /// The rig in the Rapier engine.
    Rapier,
    /// Amplitudes and phases from the averaged equations, the fast oscillation restored.
    SlowFlow,
}

impl Solver {
    pub fn word(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Rapier => "rapier",
            Self::SlowFlow => "slow-flow",
        }
    }

    /// A cycle of the engine closes to the order of its scheme only, because its reversals fall at other places within a step each time.
    pub fn criteria(self, engine: &EngineSettings) -> Criteria {
        let exact = Criteria::default();
        match self {
            Self::Exact | Self::SlowFlow => exact,
            Self::Rapier => Criteria { recurrence: exact.recurrence.max(engine.step * engine.step), ..exact },
        }
    }
}

/// Why a motion could not be set up.
#[derive(Debug, thiserror::Error)]
pub enum Unprepared {
    #[error(transparent)]
    Orbit(#[from] OrbitError),
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    Averaging(#[from] AveragingError),
}

/// Beside the exact limit cycle, where there is one.
pub fn start(p: RigParameters) -> Result<State, OrbitError> {
    match motions::exact_limit_cycle(p) {
        Ok(orbit) => {
            let mut state = orbit.reversal();
            state.positions[1] += 0.001;
            Ok(state)
        }
        Err(OrbitError::NoGuess { .. } | OrbitError::BeyondFold { .. } | OrbitError::Unbounded { .. }) => {
            Ok(State::two_mass(ELSEWHERE))
        }
        Err(error) => Err(error),
    }
}

/// The slow flow and a state beside its own limit cycle, where there is one; `frequency` is that of the same xi2, kappa and gamma.
pub fn slow_flow(
    p: RigParameters,
    frequency: &Arc<EnergyFrequency>,
) -> Result<(RestoredSlowFlow, State), AveragingError> {
    let flow = RestoredSlowFlow::at(p, frequency)?;
    let state = match flow.limit_cycle() {
        Ok(mut state) => {
            state.positions[1] += 0.001;
            state
        }
        Err(AveragingError::NoLimitCycle { .. }) => State::two_mass(ELSEWHERE),
        Err(error) => return Err(error),
    };
    Ok((flow, state))
}

pub fn in_engine(p: RigParameters, settings: EngineSettings) -> Result<Sampled<EngineFlow>, Unprepared> {
    let flow = EngineFlow::new(TwoMassRig::new(p)?.chain(), settings)?;
    let steps = (TAU / ENGINE_SAMPLES / settings.step).round().max(1.0);
    Ok(Sampled::new(flow, steps * settings.step)?)
}

/// The exact limit cycle, where there is one: its multipliers decide what motions near it settle to.
pub fn known_cycle(p: RigParameters) -> Option<KnownCycle> {
    let orbit = motions::exact_limit_cycle(p).ok()?;
    Some(KnownCycle { reversal: orbit.reversal(), leading_multiplier: orbit.section_multipliers()[0].norm() })
}

/// The exact flow, and where its motion starts.
pub fn prepare(p: RigParameters) -> Result<(TwoMassFlow, State), Unprepared> {
    Ok((exact_flow(p)?, start(p)?))
}
