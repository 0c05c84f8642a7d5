//! Fixed points of the slow flow, which are the limit cycles of the rig, with their stability and bifurcations.
//!
//! With trace T, sum of principal minors S and determinant D of the derivative of the slow flow, a pair of eigenvalues `+- i Omega` solves
//! `S T - D = 0`, `Omega^2 = S > 0`: there a torus with the slow frequency Omega is born (secondary Hopf). Folds are turning points of the
//! curve of limit cycles in xi1 and do not depend on how w varies with the energy.
//!
//! Both are found by Newton's method on the extended system; the residuals are exact, gradients of the test functions are central
//! differences of exact derivatives, which affects the rate of convergence alone.

use super::energy_frequency::EnergyFrequency;
use super::error::AveragingError;
use super::limit_cycles::{LimitCycleCurve, SlowLimitCycle};
use super::slow_flow::SlowFlow;
use crate::model::RigParameters;
use nalgebra::{Complex, Matrix3, Matrix4, RowVector4, Vector3, Vector4};

const MAX_STEPS: usize = 30;
/// Newton steps this short end the search: states are of order 1, and the next step would be rounding.
const LAST_STEP: f64 = 1e-12;
/// Step of the central differences, small against 1 and large against the spacing of the nodes of w(E).
const DIFFERENCE: f64 = 1e-5;
/// Limit cycles looked at for a change of sign.
const SCAN: usize = 4000;

/// A fixed point with the derivative of the slow flow there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlowFixedPoint {
    pub xi1: f64,
    /// `(a1, Re B, Im B)`
    pub state: Vector3<f64>,
    pub angular_frequency: f64,
    pub energy: f64,
    pub jacobian: Matrix3<f64>,
}

impl SlowFixedPoint {
    #[must_use]
    pub fn eigenvalues(&self) -> Vector3<Complex<f64>> {
        self.jacobian.complex_eigenvalues()
    }

    #[must_use]
    pub fn stable(&self) -> bool {
        self.eigenvalues().iter().all(|value| value.re < 0.0)
    }
}

/// A secondary Hopf point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlowHopf {
    pub point: SlowFixedPoint,
    /// Angular frequency Omega of the torus born there, in the slow flow.
    pub slow_angular_frequency: f64,
    /// Whether it lies beyond the first fold, where the cycle is unstable in another direction as well.
    pub beyond_fold: bool,
}

/// A fold of the limit cycles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlowFold {
    pub cycle: SlowLimitCycle,
}

/// The limit cycle of the slow flow on the branch before its first fold.
///
/// # Errors
/// [`AveragingError::NoLimitCycle`], and [`AveragingError::NoConvergence`].
pub fn fixed_point(flow: &SlowFlow) -> Result<SlowFixedPoint, AveragingError> {
    let xi1 = flow.parameters().xi1;
    let cycles: Vec<&SlowLimitCycle> = before_fold(flow.frequency());
    let reached = cycles.last().map_or(1.0, |cycle| cycle.amplitude);
    let missing = || AveragingError::NoLimitCycle { xi1, amplitude: reached };
    let pair = cycles.windows(2).find(|pair| pair[0].xi1 > xi1 && pair[1].xi1 <= xi1).ok_or_else(missing)?;
    let part = (xi1 - pair[0].xi1) / (pair[1].xi1 - pair[0].xi1);
    fixed_point_near(flow, pair[0].slow_state().lerp(&pair[1].slow_state(), part))
}

/// Newton's method from a guess.
///
/// # Errors
/// [`AveragingError::NoConvergence`].
pub fn fixed_point_near(flow: &SlowFlow, guess: Vector3<f64>) -> Result<SlowFixedPoint, AveragingError> {
    let mut state = guess;
    let mut residual = f64::INFINITY;
    for _ in 0..MAX_STEPS {
        let found = flow.slow_rate(&state);
        residual = found.rate.amax();
        let Some(step) = found.jacobian.lu().solve(&found.rate) else { break };
        state -= step;
        if step.amax() <= LAST_STEP * state.amax() {
            return Ok(at(flow, state));
        }
    }
    Err(AveragingError::NoConvergence {
        what: "a fixed point of the slow flow",
        at: state.as_slice().to_vec(),
        residual,
    })
}

fn at(flow: &SlowFlow, state: Vector3<f64>) -> SlowFixedPoint {
    let found = flow.slow_rate(&state);
    let (energy, angular_frequency) = flow.energy_and_frequency(&state);
    SlowFixedPoint { xi1: flow.parameters().xi1, state, angular_frequency, energy, jacobian: found.jacobian }
}

fn before_fold(frequency: &EnergyFrequency) -> Vec<&SlowLimitCycle> {
    let mut cycles: Vec<&SlowLimitCycle> = Vec::new();
    for (_, cycle) in frequency.branch() {
        if cycles.last().is_some_and(|last| cycle.xi1 > last.xi1) {
            break;
        }
        cycles.push(cycle);
    }
    cycles
}

/// All secondary Hopf points along the branch, from a1 = 1 on. The parameter xi1 of `flow` is of no effect.
///
/// # Errors
/// [`AveragingError::NoConvergence`].
pub fn hopf_points(flow: &SlowFlow) -> Result<Vec<SlowHopf>, AveragingError> {
    let frequency = flow.frequency();
    let fold_amplitude = before_fold(frequency).len();
    let cycles: Vec<(usize, &SlowLimitCycle)> = frequency.branch().map(|(_, cycle)| cycle).enumerate().collect();
    let stride = (cycles.len() / SCAN).max(1);
    // At a1 = 1 itself the derivative of the field jumps.
    let scanned: Vec<(usize, Vector4<f64>)> = cycles
        .iter()
        .skip(1)
        .step_by(stride)
        .map(|(index, cycle)| (*index, cycle.slow_state().push(cycle.xi1)))
        .collect();
    let tests = scanned.iter().map(|(_, u)| test(flow, u)).collect::<Result<Vec<_>, _>>()?;
    let mut found = Vec::new();
    for (pair, test) in scanned.windows(2).zip(tests.windows(2)) {
        if (test[0].0 < 0.0) == (test[1].0 < 0.0) || test[0].1 <= 0.0 {
            continue;
        }
        let u = hopf_near(flow, pair[0].1.lerp(&pair[1].1, test[0].0 / (test[0].0 - test[1].0)))?;
        let (_, squared) = self::test(flow, &u)?;
        let point = at(&flow.with_xi1(u[3])?, u.fixed_rows::<3>(0).into_owned());
        let beyond_fold = pair[0].0 >= fold_amplitude;
        found.push(SlowHopf { point, slow_angular_frequency: squared.sqrt(), beyond_fold });
    }
    Ok(found)
}

/// `(S T - D, S)` at `(state, xi1)`.
fn test(flow: &SlowFlow, u: &Vector4<f64>) -> Result<(f64, f64), AveragingError> {
    let j = flow.with_xi1(u[3])?.slow_rate(&u.fixed_rows::<3>(0).into_owned()).jacobian;
    let minor = |a: usize, b: usize| j[(a, a)] * j[(b, b)] - j[(a, b)] * j[(b, a)];
    let minors = minor(0, 1) + minor(0, 2) + minor(1, 2);
    Ok((minors * j.trace() - j.determinant(), minors))
}

fn hopf_near(flow: &SlowFlow, guess: Vector4<f64>) -> Result<Vector4<f64>, AveragingError> {
    let mut u = guess;
    let mut residual = f64::INFINITY;
    for _ in 0..MAX_STEPS {
        let found = flow.with_xi1(u[3])?.slow_rate(&u.fixed_rows::<3>(0).into_owned());
        let value = found.rate.push(test(flow, &u)?.0);
        residual = value.amax();
        let mut gradient = RowVector4::zeros();
        for i in 0..4 {
            let step = Vector4::ith(i, DIFFERENCE);
            gradient[i] = (test(flow, &(u + step))?.0 - test(flow, &(u - step))?.0) / (2.0 * DIFFERENCE);
        }
        let mut system = Matrix4::zeros();
        system.fixed_view_mut::<3, 3>(0, 0).copy_from(&found.jacobian);
        system.fixed_view_mut::<3, 1>(0, 3).copy_from(&found.xi1_derivative);
        system.set_row(3, &gradient);
        let Some(step) = system.lu().solve(&value) else { break };
        u -= step;
        if step.amax() <= LAST_STEP {
            return Ok(u);
        }
    }
    Err(AveragingError::NoConvergence { what: "a secondary Hopf point", at: u.as_slice().to_vec(), residual })
}

/// The folds of the limit cycles up to an amplitude, from a1 = 1 on. The energy plays no part; xi1 of `parameters` is of no effect.
///
/// # Errors
/// [`AveragingError::Parameter`], [`AveragingError::NoCoupling`], [`AveragingError::BranchLost`] and [`AveragingError::NoConvergence`].
pub fn folds(parameters: RigParameters, largest_amplitude: f64) -> Result<Vec<SlowFold>, AveragingError> {
    /// Steps of the curve, arclength in `(tau, w, xi1)`, and how many: any branch reaches amplitude 50 in a tenth of them.
    const STEP: f64 = 1e-3;
    const MOST_STEPS: usize = 50_000;
    let curve = LimitCycleCurve::new(parameters)?;
    let mut last = Vector3::from(LimitCycleCurve::START);
    let mut found = Vec::new();
    // Towards smaller xi1, where the branch leaves a1 = 1.
    let mut falling = true;
    for next in curve.walk(STEP).take(MOST_STEPS) {
        let Some(next) = next else {
            let cycle = curve.cycle(&last);
            let (amplitude, angular_frequency, xi1) = (cycle.amplitude, cycle.angular_frequency, cycle.xi1);
            let (energy, wanted) = (f64::NAN, f64::NAN);
            return Err(AveragingError::BranchLost { amplitude, angular_frequency, xi1, energy, wanted });
        };
        if (next[2] < last[2]) != falling {
            found.push(SlowFold { cycle: curve.cycle(&fold_near(&curve, last)?) });
            falling = !falling;
        }
        last = next;
        if curve.cycle(&last).amplitude > largest_amplitude {
            break;
        }
    }
    Ok(found)
}

fn fold_near(curve: &LimitCycleCurve, guess: Vector3<f64>) -> Result<Vector3<f64>, AveragingError> {
    // The tangent has no xi1-component where the derivative over (tau, w) is singular.
    let test = |u: &Vector3<f64>| {
        let (_, j) = curve.evaluate(u);
        j[(0, 0)] * j[(1, 1)] - j[(0, 1)] * j[(1, 0)]
    };
    let mut u = guess;
    let mut residual = f64::INFINITY;
    for _ in 0..MAX_STEPS {
        let (value, jacobian) = curve.evaluate(&u);
        let value = Vector3::new(value[0], value[1], test(&u));
        residual = value.amax();
        let gradient = Vector3::from_fn(|i, _| {
            let step = Vector3::ith(i, DIFFERENCE);
            (test(&(u + step)) - test(&(u - step))) / (2.0 * DIFFERENCE)
        });
        let system = Matrix3::from_rows(&[jacobian.row(0).into(), jacobian.row(1).into(), gradient.transpose()]);
        let Some(step) = system.lu().solve(&value) else { break };
        u -= step;
        if step.amax() <= LAST_STEP {
            return Ok(u);
        }
    }
    Err(AveragingError::NoConvergence { what: "a fold of the limit cycles", at: u.as_slice().to_vec(), residual })
}
