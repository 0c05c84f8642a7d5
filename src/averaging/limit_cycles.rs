//! Limit cycles of the slow flow: its fixed points with free frequency.
//!
//! In complex amplitudes a fixed point solves `c1 A1 + c A2 = 0`, `c A1 + c2 A2 = 0`, so that
//!
//! ```text
//! F(tau, w, xi1) = c1 c2 - c^2 = 0,   A2/A1 = -c/c2 = -c1/c
//! c1 = w^2 - (1-g+k) - g keq - i (d1 w + g w deq),   c2 = w^2 - (1+k) - i d1 w,   c = k - i d2 w.
//! ```
//!
//! Two real equations for three real unknowns: a curve, followed by pseudo-arclength from `tau = pi` (a1 = 1), `w = 1`, `xi1 = 0`. The
//! sticking angle tau stands for the amplitude, `a1 = 2/(1 - cos tau)`, because F is smooth in it through a1 = 1. Where the curve
//! turns in xi1 the cycles have a fold; for some parameters it turns in a1 as well.

use super::describing::{DescribingFunction, amplitude_at};
use super::error::AveragingError;
use crate::model::RigParameters;
use nalgebra::{Complex, Matrix2x3, Matrix3, Vector3};
use std::f64::consts::PI;

const MAX_CORRECTIONS: usize = 8;
/// Residual of F, a product of numbers below 10, to rounding.
const RESIDUAL: f64 = 1e-14;

/// One limit cycle with its self-excitation. The phase of mass 1 is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlowLimitCycle {
    pub xi1: f64,
    pub amplitude: f64,
    /// A2/A1.
    pub ratio: Complex<f64>,
    pub angular_frequency: f64,
}

impl SlowLimitCycle {
    /// `(a1, Re B, Im B)`, the state of the slow flow.
    #[must_use]
    pub fn slow_state(&self) -> Vector3<f64> {
        Vector3::new(1.0, self.ratio.re, self.ratio.im) * self.amplitude
    }
}

/// The coefficients c1, c2, c at a slow amplitude and frequency.
pub(super) struct Coefficients {
    pub(super) first: Complex<f64>,
    pub(super) second: Complex<f64>,
    pub(super) coupling: Complex<f64>,
}

impl Coefficients {
    pub(super) fn new(p: &RigParameters, d: &DescribingFunction, w: f64) -> Self {
        let (d1, d2) = (0.5 * (p.xi1 + p.xi2), 0.5 * (p.xi1 - p.xi2));
        let stiffness = 1.0 - p.gamma + p.kappa + p.gamma * d.stiffness;
        Self {
            first: Complex::new(w * w - stiffness, -(d1 * w + p.gamma * d.damping)),
            second: Complex::new(w * w - 1.0 - p.kappa, -d1 * w),
            coupling: Complex::new(p.kappa, -d2 * w),
        }
    }
}

/// The curve of limit cycles; points are `(tau, w, xi1)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct LimitCycleCurve {
    parameters: RigParameters,
}

impl LimitCycleCurve {
    /// Where the element begins to slip.
    pub(super) const START: [f64; 3] = [PI, 1.0, 0.0];

    /// # Errors
    /// [`AveragingError::Parameter`] and [`AveragingError::NoCoupling`].
    pub(super) fn new(parameters: RigParameters) -> Result<Self, AveragingError> {
        let parameters = parameters.validated()?;
        if parameters.kappa <= 0.0 {
            return Err(AveragingError::NoCoupling { kappa: parameters.kappa });
        }
        Ok(Self { parameters })
    }

    fn at(&self, xi1: f64) -> RigParameters {
        RigParameters { xi1, ..self.parameters }
    }

    pub(super) fn cycle(&self, u: &Vector3<f64>) -> SlowLimitCycle {
        let c = Coefficients::new(&self.at(u[2]), &DescribingFunction::at_angle(u[0]), u[1]);
        // Both are equal on the curve; the larger divisor rounds less.
        let ratio =
            if c.second.norm_sqr() > c.coupling.norm_sqr() { -c.coupling / c.second } else { -c.first / c.coupling };
        SlowLimitCycle { xi1: u[2], amplitude: amplitude_at(u[0]), ratio, angular_frequency: u[1] }
    }

    /// `(Re F, Im F)` and its derivative over `(tau, w, xi1)`.
    pub(super) fn evaluate(&self, u: &Vector3<f64>) -> ([f64; 2], Matrix2x3<f64>) {
        let [tau, w, xi1] = [u[0], u[1], u[2]];
        let (p, g) = (self.at(xi1), self.parameters.gamma);
        let Coefficients { first, second, coupling } = Coefficients::new(&p, &DescribingFunction::at_angle(tau), w);
        let (d1, d2) = (0.5 * (p.xi1 + p.xi2), 0.5 * (p.xi1 - p.xi2));
        // keq' = 2 sin^2(tau)/pi, (w deq)' = sin(2 tau)/pi
        let over_tau = -g / PI * Complex::new(2.0 * tau.sin().powi(2), (2.0 * tau).sin()) * second;
        let diagonal_over_w = Complex::new(2.0 * w, -d1);
        let over_w = diagonal_over_w * (first + second) - 2.0 * coupling * Complex::new(0.0, -d2);
        let half_w = Complex::new(0.0, -0.5 * w);
        let over_xi1 = half_w * (first + second - 2.0 * coupling);
        let value = first * second - coupling * coupling;
        let columns = [over_tau, over_w, over_xi1];
        (
            [value.re, value.im],
            Matrix2x3::from_fn(|row, column| if row == 0 { columns[column].re } else { columns[column].im }),
        )
    }

    /// Unit tangent; its sign is arbitrary.
    pub(super) fn tangent(&self, u: &Vector3<f64>) -> Vector3<f64> {
        let (_, jacobian) = self.evaluate(u);
        jacobian.row(0).transpose().cross(&jacobian.row(1).transpose()).normalize()
    }

    /// The point of the curve nearest to `guess` in the plane normal to `normal`.
    pub(super) fn corrected(&self, guess: Vector3<f64>, normal: &Vector3<f64>) -> Option<Vector3<f64>> {
        let mut u = guess;
        for _ in 0..MAX_CORRECTIONS {
            let (value, jacobian) = self.evaluate(&u);
            if value[0].abs().max(value[1].abs()) <= RESIDUAL {
                return Some(u);
            }
            let system = Matrix3::from_rows(&[jacobian.row(0).into(), jacobian.row(1).into(), normal.transpose()]);
            let step = system.lu().solve(&Vector3::new(value[0], value[1], normal.dot(&(u - guess))))?;
            u -= step;
            if step.norm() <= 1e-14 {
                return Some(u);
            }
        }
        None
    }

    /// The curve from a1 = 1 on in steps of `step`, towards larger amplitudes first.
    pub(super) fn walk(self, step: f64) -> impl Iterator<Item = Option<Vector3<f64>>> {
        let mut u = Vector3::from(Self::START);
        let mut tangent = Vector3::new(-1.0, 0.0, 0.0);
        std::iter::from_fn(move || {
            let next = self.corrected(u + tangent * step, &tangent);
            if let Some(next) = next {
                let new = self.tangent(&next);
                tangent = if new.dot(&tangent) < 0.0 { -new } else { new };
                u = next;
            }
            Some(next)
        })
    }
}
