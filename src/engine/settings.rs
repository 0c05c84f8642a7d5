//! How the engine is run: step, substeps, precision, joints, and what is done about velocities.

use crate::model::{ParameterError, Range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which build of Rapier integrates the bodies. Force laws are evaluated in f64 in both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// `rapier3d`: poses, velocities and forces are rounded to f32. For the nominal two-mass rig over ten periods the state error stops
    /// falling at about 1e-5, reached at 4096 steps a period (measured: 1.1e-4 at 1024, 1.0e-5 at 4096, 9.2e-6 at 16384; in f64
    /// 1.1e-4, 5.5e-6, 3.6e-7). Choose double precision beyond.
    #[serde(rename = "f32")]
    Single,
    /// `rapier3d-f64`.
    #[serde(rename = "f64")]
    Double,
}

impl Precision {
    /// `f32` or `f64`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Single => "f32",
            Self::Double => "f64",
        }
    }
}

/// How a carriage is held on its rail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Joints {
    /// Six coordinates per carriage, five of them held by the constraint solver.
    Impulse,
    /// One generalized coordinate per carriage: the same motion to rounding, and no drift. The velocity of a *body* on such a joint is the
    /// one before the last substep; force laws that read it make the scheme first order (measured: 5.4e-3 instead of 5.5e-6 over ten
    /// periods at 4096 steps). Here the generalized velocity is read.
    Multibody,
}

impl Joints {
    /// `impulse` or `multibody`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Impulse => "impulse",
            Self::Multibody => "multibody",
        }
    }
}

/// What is done about the fact that Rapier updates velocities first and positions with the new velocities.
///
/// With a force held constant over a step of n substeps Rapier computes, for a force `m a(x, v)` on one carriage,
///
/// ```text
/// w+ = w + h a,    x+ = x + h w + h^2 a (n + 1)/(2 n).
/// ```
///
/// Read as a method for `x' = v` this is first order if `w` stands for the velocity at the same time as `x`; with n = 1 it is the
/// second-order leapfrog if `w` stands for the velocity `s = h/(2 n)` earlier. For n > 1 it pumps energy,
/// `xi_num = -omega^2 h (1 - (n + 1)/(2 n))`, whatever `w` stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// Start with `w_0 = v_0 - s a_0`; forces see `w_n + s a_(n-1)`; recorded velocity `w_n + s a_n`. Second order for one substep.
    SecondOrder,
    /// As `SecondOrder`, with the friction force averaged over the step along its predicted path (see [`super::StepPath`]) instead of sampled at
    /// `t_n`: the derivative of the motion is of second order too (measured: secondary Hopf point at 2048 steps within 1.3e-8, sampled
    /// 1.5e-6).
    AveragedFriction,
    /// As `SecondOrder`, but forces see `w_n`, half a step late: first order wherever there is damping.
    LaggingDamping,
    /// `w` is taken for the velocity, as a plain user of the engine does: first order.
    Plain,
}

impl Scheme {
    /// `second_order`, `averaged_friction`, `lagging_damping` or `plain`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::SecondOrder => "second_order",
            Self::AveragedFriction => "averaged_friction",
            Self::LaggingDamping => "lagging_damping",
            Self::Plain => "plain",
        }
    }
}

/// All that decides the engine's numbers beside the rig and its initial state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EngineSettings {
    /// Time step handed to Rapier, in the chain's unit of time.
    pub step: f64,
    /// Rapier's `num_solver_iterations`, at least 1.
    pub substeps: usize,
    pub precision: Precision,
    pub joints: Joints,
    pub scheme: Scheme,
}

impl EngineSettings {
    /// The second-order configuration: one substep, impulse joints, f64, friction averaged over the step.
    #[must_use]
    pub fn default_for(step: f64) -> Self {
        let (precision, joints, scheme) = (Precision::Double, Joints::Impulse, Scheme::AveragedFriction);
        Self { step, substeps: 1, precision, joints, scheme }
    }

    /// What Rapier does unless told otherwise: steps of 1/60, 4 substeps, velocities at face value, f64.
    #[must_use]
    pub fn rapier_defaults() -> Self {
        Self { step: 1.0 / 60.0, substeps: 4, scheme: Scheme::Plain, ..Self::default_for(1.0 / 60.0) }
    }

    /// The second-order configuration with the largest step that divides `interval` and is at most `longest_step`.
    #[must_use]
    pub fn dividing(interval: f64, longest_step: f64) -> Self {
        Self::default_for(interval / (interval / longest_step - 1e-9).ceil().max(1.0))
    }

    /// Passes the settings through if each lies in its range.
    ///
    /// # Errors
    /// [`ParameterError::OutOfRange`] unless the step is finite and positive and there is at least one substep.
    pub fn validated(self) -> Result<Self, ParameterError> {
        Range::Positive.check("step", self.step)?;
        Range::Positive.check("substeps", self.substeps as f64)?;
        Ok(self)
    }

    /// Whether forces depend on the acceleration of the step before: only where the scheme predicts velocities with it.
    #[must_use]
    pub fn remembers_acceleration(&self) -> bool {
        matches!(self.scheme, Scheme::SecondOrder | Scheme::AveragedFriction)
    }

    pub(super) fn averages_friction(&self) -> bool {
        self.scheme == Scheme::AveragedFriction
    }

    /// `s` of [`Scheme`]: how long before the positions the engine's velocities are taken to be.
    pub(super) fn stagger(&self) -> f64 {
        match self.scheme {
            Scheme::SecondOrder | Scheme::AveragedFriction | Scheme::LaggingDamping => {
                self.step / (2.0 * self.substeps as f64)
            }
            Scheme::Plain => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_substeps_of_nothing_are_refused() {
        for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(EngineSettings::default_for(step).validated().is_err(), "{step}");
        }
        let none = EngineSettings { substeps: 0, ..EngineSettings::default_for(0.01) };
        assert!(none.validated().unwrap_err().to_string().contains("substeps = 0"));
    }

    #[test]
    fn a_step_that_divides_the_interval_is_the_largest_allowed_one() {
        assert_eq!(EngineSettings::dividing(0.1, 0.03).step, 0.1 / 4.0);
        assert_eq!(EngineSettings::dividing(0.1, 0.05).step, 0.05);
        assert_eq!(EngineSettings::dividing(0.1, 1.0).step, 0.1);
    }
}
