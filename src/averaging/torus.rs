//! Limit cycles of the slow flow, which are limit tori of the rig, by shooting:
//!
//! ```text
//! Phi_T(y) - y = 0,      n . (y - y0) = 0,      y = (a1, Re B, Im B)
//! ```
//!
//! with the flow Phi and its exact derivatives over y, T and xi1 from the variational equations, integrated beside. The phase condition cuts
//! the cycle by the plane through a known point `y0`, normal to the cycle there. Of the three multipliers one is 1, along the flow; the others
//! solve `m^2 - (tr M - 1) m + det M = 0`.

use super::error::AveragingError;
use super::integration::{Ending, Field, Tolerance, integrate};
use super::slow_flow::SlowFlow;
use nalgebra::{Complex, Matrix3, Vector3};

/// How closely cycles are integrated and located. The knots of a PCHIP, at which the derivative of the field has a kink, would cost thousands
/// of steps at the tolerance of the converged relation, and its own error is 1e-5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Precision {
    tolerance: Tolerance,
    /// Newton step, relative to the scales, and width of a bracket, relative to xi1, that end the search for a doubling.
    pub(super) last_step: f64,
    pub(super) width: f64,
}

impl Precision {
    pub(super) fn of(flow: &SlowFlow) -> Self {
        let [relative, last_step, width] =
            if flow.frequency().is_smooth() { [1e-11, 1e-9, 1e-11] } else { [1e-8, 1e-6, 1e-7] };
        Self { tolerance: Tolerance { relative, absolute: 0.1 * relative, longest_step: 10.0 }, last_step, width }
    }
}

/// The flow over a time with its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SlowReturn {
    pub(super) end: Vector3<f64>,
    pub(super) monodromy: Matrix3<f64>,
    pub(super) xi1_derivative: Vector3<f64>,
    pub(super) end_rate: Vector3<f64>,
}

/// State (3), derivative over the initial state (9, by columns), derivative over xi1 (3).
struct Variational<'a>(&'a SlowFlow);

impl Field<15> for Variational<'_> {
    fn rate(&self, y: &[f64; 15], rate: &mut [f64; 15]) {
        let found = self.0.slow_rate(&Vector3::new(y[0], y[1], y[2]));
        rate[..3].copy_from_slice(found.rate.as_slice());
        let tangents = found.jacobian * Matrix3::from_column_slice(&y[3..12]);
        rate[3..12].copy_from_slice(tangents.as_slice());
        let forced = found.jacobian * Vector3::new(y[12], y[13], y[14]) + found.xi1_derivative;
        rate[12..].copy_from_slice(forced.as_slice());
    }

    fn guards(&self, y: &[f64; 15]) -> [f64; 2] {
        self.0.kinks(&Vector3::new(y[0], y[1], y[2]))
    }

    fn has_left(&self, y: &[f64; 15]) -> bool {
        // The reduced state is singular at a1 = 0, and no motion crosses it.
        y[0] <= 0.0
            || self.0.energy_and_frequency(&Vector3::new(y[0], y[1], y[2])).0 >= self.0.frequency().largest_energy()
    }
}

pub(super) fn carried(flow: &SlowFlow, start: Vector3<f64>, duration: f64) -> Result<SlowReturn, AveragingError> {
    let mut y = [0.0; 15];
    y[..3].copy_from_slice(start.as_slice());
    (y[3], y[7], y[11]) = (1.0, 1.0, 1.0);
    match integrate(&Variational(flow), y, duration, Precision::of(flow).tolerance, |_, _| {})? {
        Ending::Left { time } => {
            Err(AveragingError::Left { from: start.as_slice().to_vec(), time, end: flow.frequency().largest_energy() })
        }
        Ending::Completed(y) => {
            let end = Vector3::new(y[0], y[1], y[2]);
            Ok(SlowReturn {
                end,
                monodromy: Matrix3::from_column_slice(&y[3..12]),
                xi1_derivative: Vector3::new(y[12], y[13], y[14]),
                end_rate: flow.slow_rate(&end).rate,
            })
        }
    }
}

/// A limit cycle of the slow flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlowTorus {
    pub xi1: f64,
    /// `(a1, Re B, Im B)` at one point of the cycle.
    pub start: Vector3<f64>,
    pub period: f64,
    pub monodromy: Matrix3<f64>,
    /// Largest component of `Phi_T(y) - y`.
    pub residual: f64,
}

impl SlowTorus {
    /// The two multipliers besides the 1 along the flow, the larger modulus first.
    #[must_use]
    pub fn multipliers(&self) -> [Complex<f64>; 2] {
        let half = 0.5 * (self.monodromy.trace() - 1.0);
        let determinant = self.monodromy.determinant();
        let discriminant = half * half - determinant;
        if discriminant < 0.0 {
            let root = (-discriminant).sqrt();
            return [Complex::new(half, root), Complex::new(half, -root)];
        }
        // The smaller from the product, without cancellation.
        let larger = half + discriminant.sqrt().copysign(half);
        let smaller = if larger == 0.0 { 0.0 } else { determinant / larger };
        [Complex::new(larger, 0.0), Complex::new(smaller, 0.0)]
    }

    #[must_use]
    pub fn stable(&self) -> bool {
        self.multipliers()[0].norm() < 1.0
    }

    /// Zero where a multiplier is -1: `(1 + m1)(1 + m2)`.
    #[must_use]
    pub fn doubling_test(&self) -> f64 {
        self.monodromy.trace() + self.monodromy.determinant()
    }
}
