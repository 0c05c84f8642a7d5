//! Periodic orbits of any flow with a tangent, by Newton's method on the whole state and the period:
//!
//! ```text
//! s P phi_(c T)(y) = y,   [ s P Phi - 1    c s P F ] [dy]     [ y - s P phi ]
//!                         [   F(y)^T          0    ] [dT]  =  [      0      ]
//! ```
//!
//! with P a permutation of the state, s a sign and c the part of the period after which the symmetric image closes: the identity, 1 and 1
//! for any orbit; -1 and 1/2 for one of odd symmetry; a shift from blade to blade for a travelling wave. The system is solved in the least-squares
//! sense: a contact that never slips leaves its force free.

use super::error::OrbitError;
use crate::dynamics::TangentFlow;
use nalgebra::{Complex, DMatrix, DVector};

/// Newton steps before giving up.
const MOST_STEPS: usize = 40;
/// Largest residual of a converged orbit, per largest component of the state: some hundred roundings carried round.
const RESIDUAL: f64 = 2e-12;
/// Singular values below this part of the largest count as zero.
const RANK: f64 = 1e-11;
/// Shift of the matrix whose eigenvalues are the multipliers, per largest entry.
const SHIFT: f64 = 3.0;
/// Steps of the QR iteration per eigenvalue, as LAPACK allows.
const MOST_SWEEPS: usize = 30;

/// How an orbit closes: component i of the image is `sign` times component `source[i]` of the state `fraction` of a period later.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialClosure {
    pub source: Vec<usize>,
    pub sign: f64,
    pub fraction: f64,
}

/// A periodic orbit of a flow: a state on it, and the derivative of the closing map there.
#[derive(Debug, Clone, PartialEq)]
pub struct FlowOrbit {
    pub state: DVector<f64>,
    pub period: f64,
    pub closure: SpatialClosure,
    /// Derivative of the map that closes the orbit, n x n.
    pub closing: DMatrix<f64>,
    pub residual: f64,
}

impl SpatialClosure {
    /// After the whole period, of a state with `dimension` components.
    #[must_use]
    pub fn full_period(dimension: usize) -> Self {
        Self { source: (0..dimension).collect(), sign: 1.0, fraction: 1.0 }
    }

    /// After half the period with the opposite sign.
    #[must_use]
    pub fn half_period(dimension: usize) -> Self {
        Self { sign: -1.0, fraction: 0.5, ..Self::full_period(dimension) }
    }

    fn image(&self, y: &DVector<f64>) -> DVector<f64> {
        DVector::from_iterator(y.len(), self.source.iter().map(|&i| self.sign * y[i]))
    }

    fn of_rows(&self, m: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| self.sign * m[(self.source[i], j)])
    }
}

impl FlowOrbit {
    #[must_use]
    pub fn angular_frequency(&self) -> f64 {
        std::f64::consts::TAU / self.period
    }

    /// Eigenvalues of the derivative of the closing map, largest modulus first.
    ///
    /// Slip makes many of them zero, and the QR iteration, which stops at entries small against their neighbours on the diagonal, may not end there. It is
    /// tried as it is first, then with the matrix shifted by a multiple of the identity and looser tolerances: eigenvalues are good to 1e-11 of the
    /// largest entry at worst.
    ///
    /// # Errors
    /// [`OrbitError::NoMultipliers`] if no attempt converges.
    pub fn multipliers(&self) -> Result<Vec<Complex<f64>>, OrbitError> {
        let size = self.closing.nrows();
        let shift = SHIFT * self.closing.amax().clamp(1.0, 10.0);
        let attempts = [(0.0, 1.0), (shift, 16.0), (shift, 256.0), (shift, 4096.0)];
        let found = attempts.into_iter().find_map(|(shift, looser)| {
            let shifted = &self.closing + DMatrix::identity(size, size) * shift;
            let tolerance = looser * f64::EPSILON;
            let schur = nalgebra::linalg::Schur::try_new(shifted, tolerance, MOST_SWEEPS * size.max(1))?;
            Some(schur.complex_eigenvalues().iter().map(|value| value - shift).collect::<Vec<_>>())
        });
        let mut values = found.ok_or(OrbitError::NoMultipliers { size })?;
        values.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
        Ok(values)
    }

    /// The largest modulus among the multipliers over a full period, without the `neutral` ones nearest to 1: the one along the motion, and one
    /// for every contact that never slips.
    ///
    /// # Errors
    /// As [`Self::multipliers`].
    pub fn leading_multiplier(&self, neutral: usize) -> Result<f64, OrbitError> {
        let mut values = self.multipliers()?;
        values.sort_by(|a, b| (a - 1.0).norm().total_cmp(&(b - 1.0).norm()));
        Ok(values.iter().skip(neutral).map(|value| value.norm()).fold(0.0, f64::max).powf(1.0 / self.closure.fraction))
    }
}

/// The orbit near `guess` and `period`. `admit` brings a state back into the range of the flow (|f| <= 1) after a step.
///
/// # Errors
/// [`OrbitError::Flow`] if the flow fails, [`OrbitError::NoConvergence`] and [`OrbitError::Singular`] otherwise.
pub fn shoot_flow<T: TangentFlow>(
    flow: &T,
    guess: &DVector<f64>,
    period: f64,
    closure: &SpatialClosure,
    admit: impl Fn(&mut DVector<f64>),
) -> Result<FlowOrbit, OrbitError> {
    let n = flow.dimension();
    let (mut state, mut period) = (guess.clone(), period);
    let mut residual = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let failed = |source: T::Error| OrbitError::Flow { period, source: Box::new(source) };
        let (mut end, mut tangent) = (state.clone(), DMatrix::identity(n, n));
        flow.carry(&mut end, &mut tangent, closure.fraction * period).map_err(failed)?;
        let closing = closure.of_rows(&tangent);
        let defect = &state - closure.image(&end);
        residual = defect.amax();
        if residual <= RESIDUAL * state.amax().max(1.0) {
            return Ok(FlowOrbit { state, period, closure: closure.clone(), closing, residual });
        }
        let field = flow.vector_field(&state).map_err(failed)?;
        let end_field = closure.image(&flow.vector_field(&end).map_err(failed)?) * closure.fraction;
        let step = newton_step(&closing, &end_field, &field, &defect)
            .ok_or_else(|| OrbitError::singular(state.as_slice(), residual))?;
        let part = (0.3 * state.amax().max(1.0) / step.rows(0, n).amax().max(1e-300)).min(1.0);
        state += step.rows(0, n) * part;
        period += part * step[n];
        admit(&mut state);
    }
    Err(OrbitError::no_convergence(state.as_slice(), residual, MOST_STEPS))
}

fn newton_step(
    closing: &DMatrix<f64>,
    end_field: &DVector<f64>,
    field: &DVector<f64>,
    defect: &DVector<f64>,
) -> Option<DVector<f64>> {
    let n = defect.len();
    let matrix = DMatrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
        (true, true) => closing[(i, j)] - f64::from(u8::from(i == j)),
        (true, false) => end_field[i],
        (false, true) => field[j],
        (false, false) => 0.0,
    });
    let right = DVector::from_fn(n + 1, |i, _| if i < n { defect[i] } else { 0.0 });
    let svd = nalgebra::linalg::SVD::try_new(matrix, true, true, f64::EPSILON, 10_000)?;
    let rank = RANK * svd.singular_values.max();
    svd.solve(&right, rank).ok().filter(|step| step.iter().all(|c| c.is_finite()))
}
