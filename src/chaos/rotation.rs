//! Rotation number of a torus on its section at the turning points of mass 1, and the slow period that follows from it.
//!
//! At each turning point of mass 1 (mirrored where it is a minimum) the torus is cut in a closed curve around the limit
//! cycle it grew from. With `theta_n` the angle of the n-th return around the mean in the plane `(x2, v2)`, each axis scaled by
//! its standard deviation, the rotation per half period is the weighted Birkhoff average
//!
//! ```text
//! rho = sum_n w_n (theta_{n+1} - theta_n) / sum_n w_n
//! ```
//!
//! (`average`), which converges faster than any power of N on a smooth quasi-periodic torus. Near the secondary Hopf point rho tends to the argument of
//! the half-period multiplier.

use super::average::birkhoff_average;
use super::envelope::{TurningPoint, turning_points};
use super::error::ChaosError;
use super::window::Window;
use crate::dynamics::{DenseFlow, Motion, Outcome, State};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Fewest returns that are averaged.
const FEWEST_RETURNS: usize = 100;
/// Returns that lie closer together than this do not form a curve but the rounding around a limit cycle.
const SMALLEST_RADIUS: f64 = 1e-9;
const QUANTITY: &str = "a rotation number";

/// How a torus turns.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rotation {
    /// Mean angle per half period (one turning point to the next), in (0, pi), rad.
    pub rotation_number: f64,
    /// Difference between the averages over the two halves of the window.
    pub rotation_error: f64,
    /// Mean time from one turning point to the next.
    pub half_period: f64,
    /// Angular frequency of the modulation, `rotation_number / half_period`.
    pub angular_frequency: f64,
    /// Period of the modulation.
    pub slow_period: f64,
    pub returns: usize,
}

/// Rotation of the torus on which the motion from `initial` lies in the window.
///
/// # Errors
/// [`ChaosError::TooShort`] for fewer than 100 turning points, [`ChaosError::Diverged`], [`ChaosError::NotWinding`] where the returns
/// do not go round their mean at least once (equilibria, limit cycles reached to rounding), and what the flow returns.
pub fn torus_rotation<F: DenseFlow>(flow: &F, initial: &State, window: Window) -> Result<Rotation, ChaosError> {
    let window = window.validated()?;
    let failed = |source| ChaosError::flow(flow.name(), source);
    let motion = flow.motion(initial, window.end()).map_err(failed)?;
    if let Outcome::Diverged { time, .. } = motion.outcome() {
        return Err(ChaosError::Diverged { quantity: QUANTITY, time });
    }
    let returns = turning_points(&motion, window.transient).map_err(failed)?;
    rotation_of(&returns)
}

fn rotation_of(returns: &[TurningPoint]) -> Result<Rotation, ChaosError> {
    let found = returns.len();
    let (Some(first), Some(last), true) = (returns.first(), returns.last(), found >= FEWEST_RETURNS) else {
        return Err(ChaosError::TooShort { quantity: QUANTITY, of: "turning points", needed: FEWEST_RETURNS, found });
    };
    let Some(points) = plane(returns) else {
        return Err(ChaosError::NotWinding { returns: found, turns: 0.0 });
    };
    let steps = angular_steps(&points);
    let turns = steps.iter().sum::<f64>() / TAU;
    if turns.abs() < 1.0 {
        return Err(ChaosError::NotWinding { returns: found, turns });
    }
    let (early, late) = steps.split_at(steps.len() / 2);
    let rotation_number = birkhoff_average(&steps).abs();
    let half_period = (last.time - first.time) / (found - 1) as f64;
    let angular_frequency = rotation_number / half_period;
    Ok(Rotation {
        rotation_number,
        rotation_error: (birkhoff_average(early) - birkhoff_average(late)).abs(),
        half_period,
        angular_frequency,
        slow_period: TAU / angular_frequency,
        returns: found,
    })
}

/// `(x2, v2)` of each return, centred and scaled; `None` where they coincide to rounding.
fn plane(returns: &[TurningPoint]) -> Option<Vec<[f64; 2]>> {
    let axes: [fn(&State) -> f64; 2] = [|state| state.positions[1], |state| state.velocities[1]];
    let count = returns.len() as f64;
    let [first, second] = axes.map(|axis| {
        let values: Vec<f64> = returns.iter().map(|point| axis(&point.state)).collect();
        let mean = values.iter().sum::<f64>() / count;
        let deviation = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt();
        let scaled = values.into_iter().map(|v| (v - mean) / deviation).collect::<Vec<f64>>();
        (deviation > SMALLEST_RADIUS).then_some(scaled)
    });
    Some(first?.into_iter().zip(second?).map(|(a, b)| [a, b]).collect())
}

/// Angles from each point to the next, in (-pi, pi].
fn angular_steps(points: &[[f64; 2]]) -> Vec<f64> {
    let angles: Vec<f64> = points.iter().map(|[a, b]| b.atan2(*a)).collect();
    angles
        .windows(2)
        .map(|pair| {
            let step = pair[1] - pair[0];
            if step > PI {
                step - TAU
            } else if step <= -PI {
                step + TAU
            } else {
                step
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns on an off-centre ellipse traversed with a known mean rotation and a known unevenness.
    fn returns(rotation: f64, radius: f64) -> Vec<TurningPoint> {
        (0..4000)
            .map(f64::from)
            .map(|n| {
                let phase = rotation * n + 0.3 * (rotation * n).sin();
                let (x2, v2) = (0.9 + radius * phase.cos(), -0.5 + 0.3 * radius * (phase + 0.4).sin());
                TurningPoint { time: 3.2 * n, state: State::two_mass([1.2, x2, 0.0, v2, 1.0]) }
            })
            .collect()
    }

    #[test]
    fn the_rotation_number_is_found_to_many_digits() {
        let rotation = rotation_of(&returns(0.24, 0.1)).unwrap();
        // 150 turns, 960 rad: the Fourier transform of the weight is about exp(-2 sqrt(960/2)) = 1e-19 there; what remains is rounding.
        // A plain mean leaves the fraction of a turn at the ends, 0.3/4000 = 1e-4.
        assert!((rotation.rotation_number - 0.24).abs() < 1e-12, "{rotation:?}");
        assert!(rotation.rotation_error < 1e-10);
        assert!((rotation.slow_period - TAU * 3.2 / 0.24).abs() < 1e-9);
    }

    #[test]
    fn a_limit_cycle_has_no_rotation_number() {
        assert!(matches!(rotation_of(&returns(0.24, 0.0)), Err(ChaosError::NotWinding { .. })));
        assert!(matches!(rotation_of(&returns(0.24, 0.1)[..50]), Err(ChaosError::TooShort { found: 50, .. })));
    }
}
