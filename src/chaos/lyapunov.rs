//! Lyapunov spectrum from the exact tangent flow, by discrete QR.
//!
//! An orthonormal frame Q is carried along the motion over an interval h and orthonormalised again,
//!
//! ```text
//! D phi_h(y_n) Q_n = Q_{n+1} R_{n+1},     l_i = average over n of log|r_ii| / h
//! ```
//!
//! (G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn, Meccanica 15 (1980) 9-30). There is no error of integration in it: the tangent
//! is that of the flow, saltation at the switches included. The average is the weighted Birkhoff average with batch-mean error
//! bars (`average`).
//!
//! A slip wipes the slider force out of every perturbation, so one direction of the frame vanishes: its exponent is minus
//! infinity. Such a direction is recognised by `|r_ii|` at rounding and leaves the frame; the spectrum has one exponent fewer.
//! Where the element never slips all of them remain. One exponent of a bounded motion that is no equilibrium is 0, along the flow.

use super::average::{birkhoff_average, standard_error};
use super::error::ChaosError;
use super::window::Window;
use crate::dynamics::{Outcome, State, TangentFlow};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// A direction that shrinks to this fraction of the largest over one interval has vanished: rounding leaves some 1e-15 of it, and a rate
/// fast enough to be taken for that would be -27/h.
const VANISHED: f64 = 1e-12;
/// 1/golden ratio, whose multiples modulo 1 are spread evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_8;
/// Most points of the convergence record.
const MOST_RECORDED: usize = 200;
/// Fewest intervals, ten in each batch.
const FEWEST_INTERVALS: usize = 200;

/// How long to average, and how often to orthonormalise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LyapunovPlan {
    /// The frame aligns itself in the transient.
    pub window: Window,
    /// Time between orthonormalisations; shortened so that the window is a whole number of intervals.
    pub interval: f64,
}

impl LyapunovPlan {
    /// With an interval of 5: the fastest contraction of the rig stays above 1e-3 over it.
    #[must_use]
    pub fn new(window: Window) -> Self {
        Self { window, interval: 5.0 }
    }
}

/// Plain averages over the window up to time `t`, counted from the start of the window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConvergencePoint {
    pub t: f64,
    pub exponents: Vec<f64>,
}

/// Exponents in descending order as the frame gives them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LyapunovSpectrum {
    pub exponents: Vec<f64>,
    /// Standard error of each exponent.
    pub standard_errors: Vec<f64>,
    /// Directions wiped out by slip: exponents of minus infinity, not listed.
    pub vanished: usize,
    pub convergence: Vec<ConvergencePoint>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LyapunovOutcome {
    Bounded(LyapunovSpectrum),
    /// The motion left every bound at this time: it has no exponents.
    Diverged {
        time: f64,
        bound: f64,
    },
}

impl LyapunovOutcome {
    /// `None` where the motion diverged.
    #[must_use]
    pub fn spectrum(&self) -> Option<&LyapunovSpectrum> {
        match self {
            Self::Bounded(spectrum) => Some(spectrum),
            Self::Diverged { .. } => None,
        }
    }
}

/// Lyapunov spectrum of the motion from `initial`, averaged over the window.
///
/// # Errors
/// [`ChaosError::OutOfRange`] for plans that cannot be used, [`ChaosError::TooShort`] for windows of fewer than 200 intervals,
/// [`ChaosError::Flow`] if the flow fails. Divergence is an outcome.
pub fn lyapunov_spectrum<F: TangentFlow>(
    flow: &F,
    initial: &State,
    plan: LyapunovPlan,
) -> Result<LyapunovOutcome, ChaosError> {
    let window = plan.window.validated()?;
    ChaosError::require_positive("interval", plan.interval)?;
    let [settling, count] = [window.transient, window.length].map(|span| (span / plan.interval).ceil() as usize);
    if count < FEWEST_INTERVALS {
        let (quantity, of) = ("a Lyapunov spectrum", "intervals");
        return Err(ChaosError::TooShort { quantity, of, needed: FEWEST_INTERVALS, found: count });
    }
    let mut frame = Frame::new(initial, flow.dimension());
    for n in 0..settling {
        let interval = window.transient / settling as f64;
        if let Step::Diverged { time, bound } = frame.advance(flow, interval)? {
            return Ok(LyapunovOutcome::Diverged { time: n as f64 * interval + time, bound });
        }
    }
    let interval = window.length / count as f64;
    let mut growth: Vec<Vec<f64>> = vec![Vec::with_capacity(count); frame.directions()];
    for n in 0..count {
        match frame.advance(flow, interval)? {
            Step::Diverged { time, bound } => {
                let time = window.transient + n as f64 * interval + time;
                return Ok(LyapunovOutcome::Diverged { time, bound });
            }
            Step::Grown { logarithms, vanished } => {
                vanished.iter().rev().for_each(|&index| drop(growth.remove(index)));
                growth.iter_mut().zip(logarithms).for_each(|(series, log)| series.push(log / interval));
            }
        }
    }
    Ok(LyapunovOutcome::Bounded(LyapunovSpectrum {
        exponents: growth.iter().map(|series| birkhoff_average(series)).collect(),
        standard_errors: growth.iter().filter_map(|series| standard_error(series)).collect(),
        vanished: flow.dimension() - frame.directions(),
        convergence: convergence(&growth, interval),
    }))
}

/// Running means, at most [`MOST_RECORDED`] of them, the last one over the whole window.
fn convergence(growth: &[Vec<f64>], interval: f64) -> Vec<ConvergencePoint> {
    let count = growth.iter().map(Vec::len).min().unwrap_or(0);
    let stride = count.div_ceil(MOST_RECORDED).max(1);
    let mut sums = vec![0.0; growth.len()];
    let mut record = Vec::new();
    for n in 0..count {
        sums.iter_mut().zip(growth).for_each(|(sum, series)| *sum += series[n]);
        let intervals = n + 1;
        if intervals % stride == 0 || intervals == count {
            let exponents = sums.iter().map(|sum| sum / intervals as f64).collect();
            record.push(ConvergencePoint { t: intervals as f64 * interval, exponents });
        }
    }
    record
}

/// A motion with its orthonormal frame.
struct Frame {
    state: DVector<f64>,
    directions: DMatrix<f64>,
}

enum Step {
    /// `log r_ii` of the directions that remain, and the indices of those that vanished, ascending.
    Grown { logarithms: Vec<f64>, vanished: Vec<usize> },
    /// Time since the start of the step.
    Diverged { time: f64, bound: f64 },
}

impl Frame {
    /// The first frame is generic, without random numbers: one of the coordinate directions could be invariant, and an
    /// exponent would then be found in the wrong place.
    fn new(initial: &State, dimension: usize) -> Self {
        let state = DVector::from_vec(initial.components().collect());
        let generic = |row: usize, column: usize| ((row * dimension + column + 1) as f64 * GOLDEN).fract() - 0.5;
        let mut frame = Self { state, directions: DMatrix::from_fn(dimension, dimension, generic) };
        frame.directions += DMatrix::identity(dimension, dimension);
        frame.orthonormalised();
        frame
    }

    fn directions(&self) -> usize {
        self.directions.ncols()
    }

    fn advance<F: TangentFlow>(&mut self, flow: &F, duration: f64) -> Result<Step, ChaosError> {
        let outcome = flow
            .carry(&mut self.state, &mut self.directions, duration)
            .map_err(|source| ChaosError::flow("tangent".to_owned(), source))?;
        match outcome {
            Outcome::Diverged { time, bound } => Ok(Step::Diverged { time, bound }),
            Outcome::Completed => Ok(self.orthonormalised()),
        }
    }

    /// Modified Gram-Schmidt, each projection done twice so that the frame is orthonormal to rounding however much it was
    /// squeezed. Columns that depend on earlier ones are taken out.
    fn orthonormalised(&mut self) -> Step {
        let (mut logarithms, mut vanished) = (Vec::new(), Vec::new());
        let mut kept: Vec<DVector<f64>> = Vec::new();
        let scale = self.directions.column_iter().map(|column| column.norm()).fold(0.0, f64::max);
        for (index, column) in self.directions.column_iter().enumerate() {
            let mut direction = column.into_owned();
            for _ in 0..2 {
                for earlier in &kept {
                    let share = earlier.dot(&direction);
                    direction.axpy(-share, earlier, 1.0);
                }
            }
            let length = direction.norm();
            if length > VANISHED * scale {
                logarithms.push(length.ln());
                kept.push(direction / length);
            } else {
                vanished.push(index);
            }
        }
        if vanished.is_empty() {
            self.directions
                .column_iter_mut()
                .zip(&kept)
                .for_each(|(mut column, direction)| column.copy_from(direction));
        } else {
            self.directions = DMatrix::from_columns(&kept);
        }
        Step::Grown { logarithms, vanished }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix2;
    use std::convert::Infallible;

    /// `y' = A y`, whose exponents are the real parts of the eigenvalues of A.
    struct Linear(DMatrix<f64>);

    impl TangentFlow for Linear {
        type Error = Infallible;

        fn dimension(&self) -> usize {
            self.0.nrows()
        }

        fn carry(
            &self,
            state: &mut DVector<f64>,
            tangents: &mut DMatrix<f64>,
            duration: f64,
        ) -> Result<Outcome, Infallible> {
            let flow = (&self.0 * duration).exp();
            *state = &flow * &*state;
            *tangents = flow * &*tangents;
            Ok(Outcome::Completed)
        }

        fn vector_field(&self, state: &DVector<f64>) -> Result<DVector<f64>, Infallible> {
            Ok(&self.0 * state)
        }
    }

    /// The skew tent map with a contracting and a vanishing direction, `(x, y, z) -> (T(x), y/2 + x, 0)`, one step per unit of time: T
    /// expands by `1/p` on `[0, p)` and by `1/(1-p)` on the rest, and leaves lengths invariant.
    struct SkewTent {
        p: f64,
    }

    impl TangentFlow for SkewTent {
        type Error = Infallible;

        fn dimension(&self) -> usize {
            3
        }

        fn carry(
            &self,
            state: &mut DVector<f64>,
            tangents: &mut DMatrix<f64>,
            duration: f64,
        ) -> Result<Outcome, Infallible> {
            for _ in 0..duration.round() as usize {
                let (x, y) = (state[0], state[1]);
                let slope = if x < self.p { 1.0 / self.p } else { -1.0 / (1.0 - self.p) };
                *state =
                    DVector::from_vec(vec![if x < self.p { x * slope } else { (x - 1.0) * slope }, 0.5 * y + x, 0.0]);
                let jacobian = DMatrix::from_row_slice(3, 3, &[slope, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 0.0, 0.0]);
                *tangents = jacobian * &*tangents;
            }
            Ok(Outcome::Completed)
        }

        fn vector_field(&self, state: &DVector<f64>) -> Result<DVector<f64>, Infallible> {
            Ok(DVector::zeros(state.len()))
        }
    }

    fn state(y: &[f64]) -> State {
        State { positions: y.to_vec(), velocities: vec![], slider_forces: vec![] }
    }

    fn spectrum<F: TangentFlow>(flow: &F, y: &[f64], plan: LyapunovPlan) -> LyapunovSpectrum {
        lyapunov_spectrum(flow, &state(y), plan).unwrap().spectrum().unwrap().clone()
    }

    #[test]
    fn a_damped_oscillator_contracts_all_directions_alike() {
        // x'' + 2 D x' + x = 0 with D = 0.1: both exponents are -0.1. Two oscillators of different damping: in order.
        let oscillator = |d: f64| Matrix2::new(0.0, 1.0, -1.0, -2.0 * d);
        let mut matrix = DMatrix::zeros(4, 4);
        matrix.view_mut((0, 0), (2, 2)).copy_from(&oscillator(0.1));
        matrix.view_mut((2, 2), (2, 2)).copy_from(&oscillator(0.03));
        let plan = LyapunovPlan::new(Window { transient: 400.0, length: 5000.0 });
        let found = spectrum(&Linear(matrix), &[1.0, 0.0, 1.0, 0.0], plan);
        for (exponent, expected) in found.exponents.iter().zip([-0.03, -0.03, -0.1, -0.1]) {
            // Quasi-periodic local rates: what the weighted average leaves after 1000 intervals is far below 1e-9; the frame has
            // aligned itself to e^(-0.07 * 400) = 7e-13.
            assert!((exponent - expected).abs() < 1e-9, "{found:?}");
        }
        assert_eq!(found.vanished, 0);
    }

    #[test]
    fn the_exponents_of_a_piecewise_linear_map_are_its_formula() {
        let p = 0.3_f64;
        let expected = -p * p.ln() - (1.0 - p) * (1.0 - p).ln();
        let plan = LyapunovPlan { window: Window { transient: 100.0, length: 20_000.0 }, interval: 1.0 };
        let found = spectrum(&SkewTent { p }, &[0.123_456_789, 0.0, 0.0], plan);
        // The third direction is wiped out by the first step.
        assert_eq!((found.exponents.len(), found.vanished), (2, 1));
        let error = found.standard_errors[0];
        assert!((found.exponents[0] - expected).abs() < 4.0 * error, "{found:?} {expected}");
        // Independent slopes: variance p (1-p) (log(1/p) - log(1/(1-p)))^2, error bar sqrt(variance * 1.6 / N) to a factor 2.
        let deviation = (p * (1.0 - p)).sqrt() * (p.ln() - (1.0 - p).ln()).abs() / 20_000.0_f64.sqrt();
        assert!(error > 0.6 * deviation && error < 2.5 * deviation, "{error:e} {deviation:e}");
        // Areas in (x, y) grow by slope/2 per step, so the second exponent is log(1/2). The plain mean differs from it by the
        // logarithms of the frame's tilt at both ends, each below 2, over the number of steps.
        let plain = found.convergence.last().unwrap();
        assert!((plain.exponents[1] + std::f64::consts::LN_2).abs() < 4.0 / 20_000.0, "{plain:?}");
    }

    #[test]
    fn plans_that_cannot_be_used_are_refused() {
        let flow = SkewTent { p: 0.3 };
        let refused = |transient, length, interval| {
            let plan = LyapunovPlan { window: Window { transient, length }, interval };
            lyapunov_spectrum(&flow, &state(&[0.1, 0.0, 0.0]), plan).is_err()
        };
        assert!(refused(0.0, 100.0, 1.0) && refused(-1.0, 1000.0, 1.0) && refused(0.0, f64::NAN, 1.0));
        assert!(refused(0.0, 1000.0, 0.0) && !refused(0.0, 1000.0, 1.0));
    }
}
