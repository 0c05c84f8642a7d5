//! The linear system of a chain while a given set of its Jenkins elements sticks, for `y = (x, v, f)`:
//!
//! ```text
//! x' = v,   M v' = -K x - (D + S) v - sum_j R_j f_j b_j,   f_j' = (k_j/R_j) b_j^T v  (stick)  or  0  (slip)
//! ```
//!
//! With the slider forces in the state the system is homogeneous, `y' = A y`, whatever the equilibria and eigenvectors are:
//! `y(t) = exp(A t) y(0)` holds for singular stiffness, repeated eigenvalues and overdamping alike. The exponential acts on a
//! vector, cell by cell: `exp(A t) y = sum_k (A t)^k y / k!` on cells with `|A| t <= 1/2` (in a norm that scales positions
//! with the fastest frequency), exact to rounding.

use super::series::{ORDER, Series};
use crate::model::OscillatorChain;
use nalgebra::{DMatrix, DVector};

/// |A| times the width of a cell, as [`Series`] assumes.
const CELL_ANGLE: f64 = 0.5;

#[derive(Debug, Clone)]
pub(super) struct Pattern {
    matrix: DMatrix<f64>,
    /// Width of a cell; infinite where nothing moves but uniformly.
    pub(super) cell: f64,
}

impl Pattern {
    pub(super) fn new(chain: &OscillatorChain, sticking: &[bool]) -> Self {
        Self { matrix: extended_matrix(chain, sticking), cell: CELL_ANGLE / fastest_rate(chain) }
    }

    /// The motion from `y` over one cell.
    pub(super) fn expand(&self, y: &DVector<f64>) -> Expansion {
        let mut terms = Vec::with_capacity(ORDER + 1);
        terms.push(y.clone());
        for k in 1..=ORDER {
            let next = (&self.matrix * &terms[k - 1]) / k as f64;
            terms.push(next);
        }
        Expansion { terms }
    }
}

/// Taylor terms `A^k y / k!`.
#[derive(Debug, Clone)]
pub(super) struct Expansion {
    terms: Vec<DVector<f64>>,
}

impl Expansion {
    pub(super) fn at(&self, time: f64) -> DVector<f64> {
        let mut sum = self.terms[ORDER].clone();
        for term in self.terms[..ORDER].iter().rev() {
            sum *= time;
            sum += term;
        }
        sum
    }

    /// `sign * functional(y(t)) + offset` over `[0, span]`; `scale` as in [`Series::new`], the terms of the series not counted.
    pub(super) fn series(
        &self,
        functional: impl Fn(&[f64]) -> f64,
        sign: f64,
        offset: f64,
        span: f64,
        scale: f64,
    ) -> Series {
        let mut coefficients: [f64; ORDER + 1] = std::array::from_fn(|k| sign * functional(self.terms[k].as_slice()));
        let size = largest(&coefficients, span);
        coefficients[0] += offset;
        Series::new(coefficients, span, size + scale)
    }

    /// Bound on |y_i| over `[0, span]`.
    pub(super) fn bound(&self, index: usize, span: f64) -> f64 {
        largest(&std::array::from_fn(|k| self.terms[k][index]), span)
    }
}

fn largest(coefficients: &[f64; ORDER + 1], span: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, q| if *q == 0.0 && sum == 0.0 { 0.0 } else { sum * span + q.abs() })
}

/// The matrix `A` of the system, of size 2N + m for N oscillators and m elements.
pub(super) fn extended_matrix(chain: &OscillatorChain, sticking: &[bool]) -> DMatrix<f64> {
    let (n, m) = (chain.oscillators(), chain.sliders());
    let mut matrix = DMatrix::zeros(2 * n + m, 2 * n + m);
    let damping = chain.total_damping();
    for row in 0..n {
        matrix[(row, n + row)] = 1.0;
        for column in 0..n {
            matrix[(n + row, column)] = -chain.stiffness()[(row, column)] / chain.mass()[row];
            matrix[(n + row, n + column)] = -damping[(row, column)] / chain.mass()[row];
        }
    }
    for (j, (element, stuck)) in chain.jenkins().iter().zip(sticking).enumerate() {
        let mut direction = vec![0.0; n];
        element.attachment.scatter(1.0, &mut direction);
        for (i, b) in direction.iter().enumerate() {
            matrix[(n + i, 2 * n + j)] = -element.slip_force * b / chain.mass()[i];
            if *stuck {
                matrix[(2 * n + j, n + i)] = element.normalised_stiffness() * b;
            }
        }
    }
    matrix
}

/// Bound on the norm of the system matrix in any contact state, with positions and spring elongations `R f/k` scaled by `w`,
/// the square root of the largest row sum of `M^-1 (|K| + sum_j k_j |b_j| |b_j|^T)`: the rows are at most `w` for positions,
/// `2 w` for sliders and `w` plus the row sum of `M^-1 |D + S|` for velocities.
fn fastest_rate(chain: &OscillatorChain) -> f64 {
    let mut stiffness = chain.stiffness().abs();
    for element in chain.jenkins() {
        let mut direction = vec![0.0; chain.oscillators()];
        element.attachment.scatter(1.0, &mut direction);
        let direction = DVector::from_vec(direction).abs();
        stiffness += element.stiffness * &direction * direction.transpose();
    }
    let largest_row = |matrix: &DMatrix<f64>| {
        matrix.row_iter().zip(chain.mass().iter()).map(|(row, mass)| row.abs().sum() / mass).fold(0.0, f64::max)
    };
    let frequency = largest_row(&stiffness).sqrt();
    (2.0 * frequency).max(frequency + largest_row(&chain.total_damping()))
}
