//! Pseudo-arclength continuation of a curve `G(u) = 0` with n equations for n + 1 unknowns:
//!
//! ```text
//! predictor  u* = u + ds t,     corrector  G(u) = 0,  t . (u - u*) = 0,     t the unit tangent, J t = 0
//! ```
//!
//! in unknowns divided by their scales. Folds are ordinary points of the corrector: its bordered matrix stays regular there.
//!
//! A step is accepted only if the corrector converges within a few iterations, the tangent turns by a small angle, and the
//! chord agrees with the mean of the tangents at its ends. A smooth curve obeys all three for small enough steps; on a jump to
//! another branch the corrector leads away to one side, and the chord then leans against both tangents. Refused steps are halved.
//! Branches closer than about `ds (0.0005 + 0.05 turn)` cannot be told apart in this way.

use super::error::OrbitError;
use nalgebra::{DMatrix, DVector};

const MAX_CORRECTIONS: usize = 6;
/// Largest angle by which the tangent may turn in a step, rad, and the part of it that steps aim at.
const LARGEST_TURN: f64 = 0.15;
const DESIRED_PART: f64 = 1.0 / 3.0;
/// Angle between the chord and the mean tangent, relative to the turn: 0 for a circle; and what is allowed in any case.
const LARGEST_LEAN: f64 = 0.05;
const HARMLESS_LEAN: f64 = 5e-4;
const FIRST_STEP: f64 = 0.01;
const SMALLEST_STEP: f64 = 1e-7;

/// What is followed.
pub(super) trait Equations {
    /// Residual (length n) and its derivative (n x (n + 1)) at `u` (length n + 1).
    fn evaluate(&self, u: &DVector<f64>) -> Result<(DVector<f64>, DMatrix<f64>), OrbitError>;

    /// What counts as a unit of each unknown near `u`.
    fn scales(&self, u: &DVector<f64>) -> DVector<f64>;

    /// Whether a residual is zero to rounding.
    fn vanishes(&self, u: &DVector<f64>, residual: &DVector<f64>) -> bool;
}

/// How boldly a curve is followed.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepControl {
    pub(super) largest_step: f64,
    pub(super) largest_turn: f64,
    pub(super) largest_lean: f64,
}

impl StepControl {
    pub(super) fn up_to(largest_step: f64) -> Self {
        Self { largest_step, largest_turn: LARGEST_TURN, largest_lean: LARGEST_LEAN }
    }
}

#[derive(Debug, Clone)]
pub(super) struct Curve {
    pub(super) u: DVector<f64>,
    /// Of length 1 when divided by the scales at `u`.
    pub(super) tangent: DVector<f64>,
    step: f64,
    control: StepControl,
}

impl Curve {
    /// Starts at `u`, on the curve, in the direction that has a positive component along `heading`.
    pub(super) fn new(
        equations: &impl Equations,
        u: DVector<f64>,
        heading: &DVector<f64>,
        control: StepControl,
    ) -> Result<Self, OrbitError> {
        let (residual, jacobian) = equations.evaluate(&u)?;
        let tangent = tangent(&jacobian, heading, &equations.scales(&u))
            .ok_or_else(|| OrbitError::singular(u.as_slice(), residual.amax()))?;
        Ok(Self { u, tangent, step: FIRST_STEP.min(control.largest_step), control })
    }

    /// Starts on the curve that leaves `u` in the direction `tangent` (of length 1 in scaled unknowns), `step` away from `u`:
    /// where curves cross, the tangent is not determined at `u` itself.
    pub(super) fn leaving(
        equations: &impl Equations,
        u: &DVector<f64>,
        tangent: DVector<f64>,
        step: f64,
        control: StepControl,
    ) -> Result<Self, OrbitError> {
        let scales = equations.scales(u);
        let at_crossing = Self { u: u.clone(), tangent, step, control };
        let predicted = u + &at_crossing.tangent * step;
        let (found, _) = at_crossing.corrected(equations, predicted, &scales)?;
        Self::new(equations, found, &at_crossing.tangent, control)
    }

    /// The point of the curve in the plane across the chord from `from` to `to`, at `part` of its length, with the tangent there.
    pub(super) fn on_chord(
        equations: &impl Equations,
        from: &DVector<f64>,
        to: &DVector<f64>,
        part: f64,
    ) -> Result<(DVector<f64>, DVector<f64>), OrbitError> {
        let scales = equations.scales(from);
        let chord = to - from;
        let along = &chord / chord.component_div(&scales).norm();
        let start = Self { u: from.clone(), tangent: along, step: 0.0, control: StepControl::up_to(0.0) };
        let (u, jacobian) = start.corrected(equations, from + &chord * part, &scales)?;
        let scales = equations.scales(&u);
        let tangent = tangent(&jacobian, &chord, &scales).ok_or_else(|| OrbitError::singular(u.as_slice(), 0.0))?;
        Ok((u, tangent))
    }

    /// The same with another longest step.
    pub(super) fn limited_to(self, largest_step: f64) -> Self {
        let step = self.step.min(largest_step);
        Self { step, control: StepControl { largest_step, ..self.control }, ..self }
    }

    /// One step along the curve, as long as can be trusted.
    pub(super) fn advance(&mut self, equations: &impl Equations) -> Result<(), OrbitError> {
        loop {
            match self.attempt(equations) {
                Ok((u, tangent, turn)) => {
                    (self.u, self.tangent) = (u, tangent);
                    let factor = (DESIRED_PART * self.control.largest_turn / turn.max(1e-6)).clamp(0.5, 2.0);
                    self.step = (self.step * factor).min(self.control.largest_step);
                    return Ok(());
                }
                Err(_) if self.step > SMALLEST_STEP => self.step *= 0.5,
                Err(source) => {
                    let at = self.u.as_slice().to_vec();
                    return Err(OrbitError::StepTooSmall { at, step: self.step, source: Box::new(source) });
                }
            }
        }
    }

    fn attempt(&self, equations: &impl Equations) -> Result<(DVector<f64>, DVector<f64>, f64), OrbitError> {
        let predicted = &self.u + &self.tangent * self.step;
        let scales = equations.scales(&self.u);
        let (u, jacobian) = self.corrected(equations, predicted, &scales)?;
        let tangent =
            tangent(&jacobian, &self.tangent, &scales).ok_or_else(|| OrbitError::singular(u.as_slice(), 0.0))?;
        let [before, after, chord] =
            [&self.tangent, &tangent, &(&u - &self.u)].map(|v| v.component_div(&scales).normalize());
        let turn = angle(&before, &after);
        let lean = angle(&chord, &(&before + &after).normalize());
        let allowed_lean = HARMLESS_LEAN + self.control.largest_lean * turn;
        if turn > self.control.largest_turn || lean > allowed_lean {
            return Err(OrbitError::Jump { turn, allowed_turn: self.control.largest_turn, lean, allowed_lean });
        }
        let tangent = &tangent / tangent.component_div(&equations.scales(&u)).norm();
        Ok((u, tangent, turn))
    }

    /// Newton's method in the plane through the predicted point across the tangent.
    fn corrected(
        &self,
        equations: &impl Equations,
        predicted: DVector<f64>,
        scales: &DVector<f64>,
    ) -> Result<(DVector<f64>, DMatrix<f64>), OrbitError> {
        let mut u = predicted;
        let mut found = f64::INFINITY;
        for _ in 0..MAX_CORRECTIONS {
            let (residual, jacobian) = equations.evaluate(&u)?;
            if equations.vanishes(&u, &residual) {
                return Ok((u, jacobian));
            }
            found = residual.amax();
            let across = self.tangent.component_div(scales);
            let step = bordered(&jacobian, &across, scales)
                .lu()
                .solve(&residual.push(0.0))
                .filter(|step| step.iter().all(|c| c.is_finite()))
                .ok_or_else(|| OrbitError::singular(u.as_slice(), found))?;
            u -= step.component_mul(scales);
        }
        Err(OrbitError::no_convergence(u.as_slice(), found, MAX_CORRECTIONS))
    }
}

fn angle(a: &DVector<f64>, b: &DVector<f64>) -> f64 {
    2.0 * (0.5 * (a - b).norm()).min(1.0).asin()
}

/// The Jacobian in scaled unknowns with one more row.
fn bordered(jacobian: &DMatrix<f64>, row: &DVector<f64>, scales: &DVector<f64>) -> DMatrix<f64> {
    let (n, columns) = jacobian.shape();
    DMatrix::from_fn(n + 1, columns, |i, j| if i < n { jacobian[(i, j)] * scales[j] } else { row[j] })
}

fn tangent(jacobian: &DMatrix<f64>, heading: &DVector<f64>, scales: &DVector<f64>) -> Option<DVector<f64>> {
    let mut right = DVector::zeros(heading.len());
    right[heading.len() - 1] = 1.0;
    let scaled = bordered(jacobian, &heading.component_div(scales), scales).lu().solve(&right)?;
    scaled.iter().all(|c| c.is_finite()).then(|| scaled.normalize().component_mul(scales))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two parabolas `y = x^2` and `y = x^2 + gap`, both zeros of one equation.
    struct TwoParabolas {
        gap: f64,
    }

    impl Equations for TwoParabolas {
        fn evaluate(&self, u: &DVector<f64>) -> Result<(DVector<f64>, DMatrix<f64>), OrbitError> {
            let (x, first) = (u[0], u[1] - u[0] * u[0]);
            let second = first - self.gap;
            let sum = first + second;
            Ok((DVector::from_element(1, first * second), DMatrix::from_row_slice(1, 2, &[-2.0 * x * sum, sum])))
        }

        fn scales(&self, _: &DVector<f64>) -> DVector<f64> {
            DVector::from_element(2, 1.0)
        }

        fn vanishes(&self, _: &DVector<f64>, residual: &DVector<f64>) -> bool {
            residual[0].abs() < 1e-14
        }
    }

    /// Largest distance in y from the upper parabola, followed (tangents lead to the lower one) from x = -2 to 2.
    fn strays(control: StepControl) -> f64 {
        let equations = TwoParabolas { gap: -0.02 };
        let heading = DVector::from_row_slice(&[1.0, 0.0]);
        let mut curve = Curve::new(&equations, DVector::from_row_slice(&[-2.0, 4.0]), &heading, control).unwrap();
        let mut farthest = 0.0_f64;
        while curve.u[0] < 2.0 {
            curve.advance(&equations).unwrap();
            farthest = farthest.max((curve.u[1] - curve.u[0] * curve.u[0]).abs());
        }
        farthest
    }

    #[test]
    fn long_steps_allowed_do_not_lead_to_a_branch_close_by() {
        assert!(strays(StepControl::up_to(1.0)) < 1e-10);
    }

    #[test]
    fn without_the_checks_the_step_would_jump() {
        let careless = StepControl { largest_step: 1.0, largest_turn: f64::INFINITY, largest_lean: f64::INFINITY };
        assert!(strays(careless) > 0.01);
    }

    /// The unit circle, two folds in each unknown.
    struct Circle;

    impl Equations for Circle {
        fn evaluate(&self, u: &DVector<f64>) -> Result<(DVector<f64>, DMatrix<f64>), OrbitError> {
            let residual = DVector::from_element(1, u.norm_squared() - 1.0);
            Ok((residual, DMatrix::from_row_slice(1, 2, &[2.0 * u[0], 2.0 * u[1]])))
        }

        fn scales(&self, _: &DVector<f64>) -> DVector<f64> {
            DVector::from_element(2, 1.0)
        }

        fn vanishes(&self, _: &DVector<f64>, residual: &DVector<f64>) -> bool {
            residual[0].abs() < 1e-14
        }
    }

    #[test]
    fn a_closed_curve_is_followed_all_the_way_round() {
        let heading = DVector::from_row_slice(&[0.0, 1.0]);
        let start = DVector::from_row_slice(&[1.0, 0.0]);
        let mut curve = Curve::new(&Circle, start, &heading, StepControl::up_to(0.1)).unwrap();
        let (mut angle, mut before) = (0.0, 0.0_f64);
        while angle < std::f64::consts::TAU {
            curve.advance(&Circle).unwrap();
            let now = curve.u[1].atan2(curve.u[0]);
            let turned = (now - before).rem_euclid(std::f64::consts::TAU);
            assert!(turned > 0.0 && turned < 0.2, "backwards or too far: {turned}");
            (angle, before) = (angle + turned, now);
        }
    }
}
