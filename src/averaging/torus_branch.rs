//! Branches of limit cycles of the slow flow over xi1 by pseudo-arclength: unknowns `(y, T, xi1)`, divided by their scales.
//!
//! A branch begins at a secondary Hopf point, in the plane of the pair of eigenvectors, or at a period doubling, along the eigenvector
//! of the multiplier -1 with twice the period.

use super::error::AveragingError;
use super::fixed_points::SlowHopf;
use super::slow_flow::SlowFlow;
use super::torus::{Precision, SlowReturn, SlowTorus, carried};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use std::f64::consts::TAU;

type Unknowns = SVector<f64, 5>;

const MAX_CORRECTIONS: usize = 7;
/// Newton steps this short, relative to the scales, end the search along a branch: convergence is quadratic.
const ROUGH: f64 = 1e-6;
const SMALLEST_STEP: f64 = 1e-9;
/// Largest change of the trace of the monodromy matrix in a step, so that no multiplier passes -1 twice unseen.
const LARGEST_CHANGE: f64 = 0.6;
const GROWTH: f64 = 1.6;
/// Distance from a Hopf point at which the torus is picked up, relative to the scales.
const FIRST_AMPLITUDE: f64 = 0.01;
/// Multiplier that a doubled cycle should have where it is picked up: near 1, but well away from it.
const PICKED_UP: (f64, f64) = (0.5, 0.98);

/// A point of a branch.
#[derive(Debug, Clone)]
pub(super) struct TorusBranch {
    flow: SlowFlow,
    scales: Unknowns,
    u: Unknowns,
    tangent: Unknowns,
    /// Point and normal of the phase condition.
    anchor: (Vector3<f64>, Vector3<f64>),
    pub(super) torus: SlowTorus,
    step: f64,
}

fn state(u: &Unknowns) -> Vector3<f64> {
    u.fixed_rows::<3>(0).into_owned()
}

/// What counts as a unit: amplitudes are of order 1, periods as they are, and xi1 acts on a time scale of 1/xi1.
fn scales(period: f64, xi1: f64) -> Unknowns {
    Unknowns::from([1.0, 1.0, 1.0, period, xi1.abs()])
}

impl TorusBranch {
    /// The branch that leaves a secondary Hopf point.
    ///
    /// # Errors
    /// As [`Self::advance`].
    pub(super) fn from_hopf(flow: &SlowFlow, hopf: &SlowHopf) -> Result<Self, AveragingError> {
        let (real, imaginary) = plane_of_the_pair(&hopf.point.jacobian, hopf.slow_angular_frequency);
        let period = TAU / hopf.slow_angular_frequency;
        let u = Unknowns::from([hopf.point.state[0], hopf.point.state[1], hopf.point.state[2], period, hopf.point.xi1]);
        Self::leaving(flow, u, real, imaginary, FIRST_AMPLITUDE)
    }

    /// The doubled branch that leaves a cycle with multiplier -1.
    ///
    /// # Errors
    /// [`AveragingError::TorusLost`] if no doubled cycle is found, and as [`Self::advance`].
    pub(super) fn from_doubling(flow: &SlowFlow, at: &SlowTorus, first: f64) -> Result<Self, AveragingError> {
        let rate = flow.with_xi1(at.xi1)?.slow_rate(&at.start).rate;
        let direction = flipped_direction(&at.monodromy);
        let along = rate.normalize();
        let direction = (direction - along * along.dot(&direction)).normalize();
        let u = Unknowns::from([at.start[0], at.start[1], at.start[2], 2.0 * at.period, at.xi1]);
        let mut amplitude = first;
        for _ in 0..30 {
            let branch = Self::leaving(flow, u, direction, along, amplitude);
            let leading = branch.as_ref().map(|branch| branch.torus.multipliers()[0].re);
            match leading {
                Ok(m) if m > PICKED_UP.1 => amplitude *= 1.7,
                Ok(m) if m < PICKED_UP.0 => amplitude *= 0.6,
                Err(_) => amplitude *= 0.5,
                Ok(_) => return branch,
            }
        }
        Err(AveragingError::TorusLost {
            xi1: at.xi1,
            period: 2.0 * at.period,
            reason: "no stable cycle of twice the period leaves the doubling".to_owned(),
        })
    }

    /// A first cycle at a distance from `u` in a direction; the phase is fixed normal to `along`.
    fn leaving(
        flow: &SlowFlow,
        u: Unknowns,
        direction: Vector3<f64>,
        along: Vector3<f64>,
        amplitude: f64,
    ) -> Result<Self, AveragingError> {
        let scales = scales(u[3], u[4]);
        let tangent = Unknowns::from([direction[0], direction[1], direction[2], 0.0, 0.0]);
        let guess = u + tangent * amplitude;
        let anchor = (state(&u), along);
        let (found, returned) = corrected(flow, guess, &scales, &tangent, &anchor, ROUGH)?;
        let chord = (found - u).component_div(&scales).normalize();
        let torus = torus_at(&found, &returned);
        let mut branch =
            Self { flow: flow.clone(), scales, u: found, tangent: chord, anchor, torus, step: 2.0 * amplitude };
        branch.renew(&returned)?;
        Ok(branch)
    }

    /// Moves the phase condition to the present cycle and takes the tangent there.
    fn renew(&mut self, returned: &SlowReturn) -> Result<(), AveragingError> {
        let along = self.flow.with_xi1(self.u[4])?.slow_rate(&state(&self.u)).rate.normalize();
        self.anchor = (state(&self.u), along);
        self.scales = scales(self.u[3], self.u[4]);
        let system = bordered(returned, &self.scales, &self.tangent, &self.anchor);
        let mut right = Unknowns::zeros();
        right[4] = 1.0;
        let tangent = system.lu().solve(&right).ok_or_else(|| self.lost("the tangent is not defined"))?;
        self.tangent = tangent.normalize();
        Ok(())
    }

    /// Whether the rate at the start turned round in the step from `before`: the start then passed a fixed point, to which the cycle
    /// shrank, and lies on the far side of it. On a cycle of finite size a step turns the rate by a small angle only.
    pub(super) fn reversed_since(&self, before: &Self) -> bool {
        self.anchor.1.dot(&before.anchor.1) < 0.0
    }

    fn lost(&self, reason: &str) -> AveragingError {
        AveragingError::TorusLost { xi1: self.u[4], period: self.u[3], reason: reason.to_owned() }
    }

    /// The next cycle of the branch.
    ///
    /// # Errors
    /// [`AveragingError::TorusLost`] where the branch cannot be followed.
    pub(super) fn advance(&mut self) -> Result<(), AveragingError> {
        let mut reason = "steps became too short".to_owned();
        while self.step > SMALLEST_STEP {
            let guess = self.u + self.tangent.component_mul(&self.scales) * self.step;
            let found = corrected(&self.flow, guess, &self.scales, &self.tangent, &self.anchor, ROUGH);
            match found {
                Ok((u, returned)) => {
                    let torus = torus_at(&u, &returned);
                    let change = (torus.monodromy.trace() - self.torus.monodromy.trace()).abs();
                    if change <= LARGEST_CHANGE {
                        (self.u, self.torus) = (u, torus);
                        self.renew(&returned)?;
                        self.step *= (0.7 * LARGEST_CHANGE / change).clamp(0.5, GROWTH);
                        return Ok(());
                    }
                }
                Err(error) => reason = error.to_string(),
            }
            self.step *= 0.5;
        }
        Err(self.lost(&reason))
    }

    /// The doubling between the present cycle and a later one: the root of the test function, with a cycle solved for at each xi1.
    ///
    /// # Errors
    /// [`AveragingError::NoConvergence`] and what shooting returns.
    pub(super) fn doubling(&self, later: &Self) -> Result<SlowTorus, AveragingError> {
        let precision = Precision::of(&self.flow);
        let mut ends = [(0.0, self.torus.doubling_test()), (1.0, later.torus.doubling_test())];
        let normal = (later.u - self.u).component_div(&self.scales).normalize();
        let length = (later.u[4] - self.u[4]).abs();
        let mut residual = f64::INFINITY;
        let mut last = None::<f64>;
        for _ in 0..60 {
            let part = ends[0].0 + (ends[1].0 - ends[0].0) * ends[0].1 / (ends[0].1 - ends[1].1);
            let guess = self.u.lerp(&later.u, part);
            let (u, returned) = corrected(&self.flow, guess, &self.scales, &normal, &self.anchor, precision.last_step)?;
            let torus = torus_at(&u, &returned);
            residual = torus.doubling_test();
            let moved = last.map_or(f64::INFINITY, |before| (before - u[4]).abs());
            if moved <= precision.width * u[4].abs()
                || (ends[1].0 - ends[0].0).abs() * length <= precision.width * u[4].abs()
            {
                return Ok(torus);
            }
            last = Some(u[4]);
            if (residual < 0.0) == (ends[0].1 < 0.0) {
                ends[0] = (part, residual);
                ends[1].1 *= 0.5;
            } else {
                ends[1] = (part, residual);
                ends[0].1 *= 0.5;
            }
        }
        Err(AveragingError::NoConvergence { what: "a period doubling", at: self.u.as_slice().to_vec(), residual })
    }
}

fn torus_at(u: &Unknowns, returned: &SlowReturn) -> SlowTorus {
    let start = state(u);
    let residual = (returned.end - start).amax();
    SlowTorus { xi1: u[4], start, period: u[3], monodromy: returned.monodromy, residual }
}

/// Newton's method in the plane through `guess` normal to `normal`, scaled.
fn corrected(
    flow: &SlowFlow,
    guess: Unknowns,
    scales: &Unknowns,
    normal: &Unknowns,
    anchor: &(Vector3<f64>, Vector3<f64>),
    last_step: f64,
) -> Result<(Unknowns, SlowReturn), AveragingError> {
    let mut u = guess;
    let mut residual = f64::INFINITY;
    for _ in 0..MAX_CORRECTIONS {
        if !(u[3] > 0.0 && u[0] > 0.0 && u[3] < 3.0 * scales[3]) {
            break;
        }
        let returned = carried(&flow.with_xi1(u[4])?, state(&u), u[3])?;
        let gap = returned.end - state(&u);
        residual = gap.amax();
        let phase = anchor.1.dot(&(state(&u) - anchor.0));
        let off = normal.dot(&(u - guess).component_div(scales));
        let value = Unknowns::from([gap[0], gap[1], gap[2], phase, off]);
        let Some(step) = bordered(&returned, scales, normal, anchor).lu().solve(&value) else { break };
        u -= step.component_mul(scales);
        if step.amax() <= last_step {
            // The derivatives are those before the last step, which is as small as asked.
            return Ok((u, returned));
        }
    }
    Err(AveragingError::NoConvergence { what: "a cycle of the slow flow", at: guess.as_slice().to_vec(), residual })
}

/// Derivative of closure, phase condition and step condition over the scaled unknowns.
fn bordered(
    returned: &SlowReturn,
    scales: &Unknowns,
    normal: &Unknowns,
    anchor: &(Vector3<f64>, Vector3<f64>),
) -> SMatrix<f64, 5, 5> {
    let mut system = SMatrix::<f64, 5, 5>::zeros();
    system.fixed_view_mut::<3, 3>(0, 0).copy_from(&(returned.monodromy - Matrix3::identity()));
    system.fixed_view_mut::<3, 1>(0, 3).copy_from(&returned.end_rate);
    system.fixed_view_mut::<3, 1>(0, 4).copy_from(&returned.xi1_derivative);
    system.fixed_view_mut::<1, 3>(3, 0).copy_from(&anchor.1.transpose());
    for column in 0..5 {
        for row in 0..4 {
            system[(row, column)] *= scales[column];
        }
    }
    system.set_row(4, &normal.transpose());
    system
}

/// Two unit vectors that span the eigenspace of `+- i omega`: one in it, and the rate of the linear motion through that one.
fn plane_of_the_pair(jacobian: &Matrix3<f64>, omega: f64) -> (Vector3<f64>, Vector3<f64>) {
    // J^2 + omega^2 vanishes there: the two smallest singular directions.
    let squared = jacobian * jacobian + Matrix3::identity() * (omega * omega);
    let shape = (squared.transpose() * squared).symmetric_eigen();
    let largest = shape.eigenvalues.imax();
    let real = shape.eigenvectors.column((largest + 1) % 3).into_owned();
    // Made perpendicular to its rate by going on along the cycle: any start will do, so the rate serves as it is.
    let rate = (jacobian * real).normalize();
    (real, rate)
}

/// The eigenvector of the multiplier nearest to -1.
fn flipped_direction(monodromy: &Matrix3<f64>) -> Vector3<f64> {
    let shifted = monodromy + Matrix3::identity();
    let squared = (shifted.transpose() * shifted).symmetric_eigen();
    squared.eigenvectors.column(squared.eigenvalues.imin()).into_owned()
}
