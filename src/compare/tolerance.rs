//! How far a correct second-order solver may be from the exact motion, with reasons.
//!
//! For a step h (angular frequency near 1), the largest component A of the motion and time t:
//!
//! ```text
//! state, amplitude   A h^2 (1 + t/12) e^(lambda t)
//! energy residual    A^2 h^2 (1 + t/12), of each contact
//! frequency          h^2 (1/12 + 4 A e^(lambda t)/t)
//! ```
//!
//! The leapfrog runs ahead by `h^2/24` of the phase per unit of time, so that a component A is off by `A h^2 t/24`; the return
//! mapping misses each extreme of the elongation by up to `h^2 A/8`, and what it missed is forgotten with the next slip. The sum with a
//! factor of two is the bracket. The energy misses twice a period what friction would have done over the missed extreme, `h^2 A/8`, and
//! the trapezoidal works are off by `h^2/12` of powers below A^2; it is measured along the tested motion itself and does not grow with
//! lambda. The frequency has the leapfrog's `h^2/24` and the errors of the first and last zero, again times two. Errors grow along the reference motion with its own rate lambda, which the caller knows: zero on a stable
//! motion, `ln|mu|/T` on an unstable orbit of multiplier mu and period T, the largest Lyapunov exponent on a chaotic one.
//!
//! All are cut off at 1 % of the motion: a coarse step or a long unstable record then fails, even if the solver is as good as its order.

use super::CompareError;
use serde::Serialize;

/// What kind of motion the reference is, which decides what can agree beyond the horizon.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Errors stay in proportion to time: amplitude and frequency agree as well as states do.
    Regular,
    /// Trajectories part: beyond the horizon only averages can agree, to within their own statistical error.
    Chaotic,
}

/// What the comparison has to know beforehand.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Expectation {
    /// Time up to which states are compared.
    pub horizon: f64,
    /// Time step of the tested solver.
    pub step: f64,
    /// Growth rate lambda of small differences along the reference motion.
    pub growth_rate: f64,
    /// Unit roundoff of the tested solver's numbers: 2^-53 for f64, 2^-24 for f32.
    pub unit_roundoff: f64,
    pub motion: Motion,
    /// Largest lateral displacement and rotation (rad) of a carriage off its rail, where the tested solver has joints.
    pub joint_drift: Option<[f64; 2]>,
}

impl Expectation {
    /// Growth rate beside the limit cycle of the nominal rig at xi1 = -0.06: half-period multipliers 0.977968 +- 0.248221 i, so
    /// ln 1.00898 over half a period of 3.17496.
    pub const NOMINAL_GROWTH_RATE: f64 = 0.002816;

    /// A regular motion of the nominal rig, computed in f64 without joints to look at.
    #[must_use]
    pub fn regular(horizon: f64, step: f64) -> Self {
        Self {
            horizon,
            step,
            growth_rate: Self::NOMINAL_GROWTH_RATE,
            unit_roundoff: f64::EPSILON / 2.0,
            motion: Motion::Regular,
            joint_drift: None,
        }
    }

    pub(super) fn validated(self) -> Result<Self, CompareError> {
        let positive = "finite and greater than 0";
        let not_negative = "finite and not negative";
        for (field, found, strict) in [
            ("horizon", self.horizon, true),
            ("step", self.step, true),
            ("growth_rate", self.growth_rate, false),
            ("unit_roundoff", self.unit_roundoff, false),
        ] {
            let allowed = if strict { positive } else { not_negative };
            if !(found.is_finite() && found >= 0.0 && (found > 0.0 || !strict)) {
                return Err(CompareError::OutOfRange { field, found, allowed });
            }
        }
        Ok(self)
    }
}

/// No tolerance of states, energy, or the cycles of a regular motion exceeds this part of the motion, however coarse the step or long the
/// record: who reads *passed* may rely on 1 %. Averages of a chaotic motion are judged by their statistical error, which may be larger.
pub const LARGEST_TOLERANCE: f64 = 0.01;

/// What follows from an [`Expectation`] for motions whose largest component is `scale`, recorded up to `t_end`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Tolerances {
    pub state: f64,
    pub amplitude: f64,
    pub frequency: f64,
    pub energy: f64,
    /// Both lateral (length) and rotation (rad).
    pub joint_drift: f64,
}

impl Tolerances {
    #[must_use]
    pub fn of(expected: &Expectation, scale: f64, t_end: f64) -> Self {
        let Expectation { horizon, step, growth_rate, unit_roundoff, .. } = *expected;
        let growth = |t: f64| (growth_rate * t).exp();
        // Per unit of the scale, along a motion whose differences do not grow.
        let local = |t: f64| step * step * (1.0 + t / 12.0) + unit_roundoff * rounding_growth(t, step);
        let at_the_ends = 4.0 * scale * (step * step + unit_roundoff * rounding_growth(t_end, step)) / t_end;
        let capped = |tolerance: f64, whole: f64| tolerance.min(LARGEST_TOLERANCE * whole);
        Self {
            state: capped(scale * local(horizon) * growth(horizon), scale),
            amplitude: capped(scale * local(t_end) * growth(t_end), scale),
            frequency: capped(step * step / 12.0 + at_the_ends * growth(t_end), 1.0),
            energy: capped(scale * scale * local(t_end), scale * scale),
            joint_drift: 1e-6,
        }
    }
}

/// Rounding of positions (once a step, of random sign), and of the step itself (once and for all, so that time runs wrong by one
/// unit roundoff).
fn rounding_growth(t: f64, step: f64) -> f64 {
    (t / step).sqrt() + t
}
