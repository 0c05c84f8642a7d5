//! Complex modal coordinates of the two-mass rig in one contact state.
//!
//! With two underdamped modes, eigenvalues `l_j` (Im > 0) and equilibrium `z*`, the state `z = (x1, x2, v1, v2)` is
//!
//! ```text
//! z(t) - z* = Re( c1 e^(l1 t) w1 + c2 e^(l2 t) w2 ),     w_j = (1, r_j, l_j, l_j r_j) / n_j,
//! r_j = -(d2 l_j - k) / (l_j^2 + d1 l_j + k22) = -(l_j^2 + d1 l_j + k11) / (d2 l_j - k)
//! ```
//!
//! Of the two forms of `r_j` the one with the larger sum is taken: for weak coupling the other sum is a rounding. Then both rows of the
//! eigenvalue equation hold to rounding, also where eigenvalues are nearly equal. Where both stiffnesses are equal, the modes are exactly in
//! phase and out of phase.
//!
//! The scale `n_j` is chosen so that the event function is the plain sum `q = Re c1 + Re c2`: `n_j = 1` while sticking
//! (`q = x1 - x1*`), `n_j = l_j` while slipping (`q = v1`). Coordinates are stored as four reals `(Re c1, Im c1, Re c2, Im c2)`
//! and multiplied by exponentials stored as `(Re, -Im, Re, -Im)`, so that `q` after a time h is the dot product with `e^(l h)`.
//!
//! Not every parameter set has such coordinates. Overdamped and nearly repeated eigenvalues, and modes that mass 1 does
//! not see, have `Modes::new` return `None`; the chain's series then takes over.

use super::modal_root::{FINE, LOCAL};
use super::series::{ORDER, Series};
use nalgebra::{Complex, Matrix4, Vector4};

/// Most cells in a block of the table, after which bounds are taken anew.
const MOST_CELLS: usize = 64;
/// Largest growth of a mode over a block, which its bounds have to allow for.
const MOST_GROWTH: f64 = 2.0;
/// Width of a cell times the fastest rate: small enough that few cells near a guard are doubtful, large enough that a phase
/// has about ten.
pub(super) const CELL_ANGLE: f64 = 0.25;
/// Largest condition number of the eigenvector matrix (unit columns) for which modal coordinates lose at most three digits.
const LARGEST_CONDITION: f64 = 1e3;
/// Smallest Im l / |l| taken as underdamped.
const SMALLEST_SINE: f64 = 1e-2;

pub(super) type Modal = [f64; 4];

/// Which quantity is the plain sum of the coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scaling {
    Position,
    Velocity,
}

/// Stiffness and damping of one contact state: `[[stiffness1, -kappa], [-kappa, stiffness2]]`, `[[d1, d2], [d2, d1]]`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coefficients {
    pub(super) stiffness1: f64,
    pub(super) stiffness2: f64,
    pub(super) kappa: f64,
    pub(super) d1: f64,
    pub(super) d2: f64,
}

#[derive(Debug, Clone)]
pub(super) struct Modes {
    eigenvalues: [Complex<f64>; 2],
    pub(super) to_physical: Matrix4<f64>,
    pub(super) to_modal: Matrix4<f64>,
    /// Width of a cell.
    pub(super) cell: f64,
    /// Number of cells in a block.
    pub(super) cells: usize,
    /// `M2 width^2/8` of a block is the dot product with `(|c1|, |c2|)`; likewise `M3 width/3`, and the largest |x - x*|.
    pub(super) bulge_weights: [f64; 2],
    pub(super) jerk_weights: [f64; 2],
    pub(super) amplitude_weights: [f64; 2],
    /// Exponentials over 0, 1, ..., `cells` cells.
    pub(super) coarse: Vec<Modal>,
    /// Exponentials over 0, 1, ..., `FINE` fine steps.
    pub(super) fine: [Modal; FINE + 1],
    /// `l^k / k!`.
    pub(super) powers: [Modal; LOCAL + 1],
}

impl Coefficients {
    pub(super) fn characteristic(&self, l: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
        let first = l * (l + self.d1) + self.stiffness1;
        let second = l * (l + self.d1) + self.stiffness2;
        let coupling = l * self.d2 - self.kappa;
        let value = first * second - coupling * coupling;
        let slope = (l * 2.0 + self.d1) * (first + second) - coupling * (2.0 * self.d2);
        (value, slope)
    }

    /// The two eigenvalues with positive imaginary part, slow one first; `None` if a mode is not underdamped.
    fn eigenvalues(&self) -> Option<[Complex<f64>; 2]> {
        if self.is_symmetric() {
            let [in_phase, out_of_phase] = [1.0, -1.0].map(|ratio| self.symmetric_eigenvalue(ratio));
            return Some([in_phase?, out_of_phase?]);
        }
        let Self { stiffness1, stiffness2, kappa, d1, d2 } = *self;
        #[rustfmt::skip]
        let system = Matrix4::new(
            0.0, 0.0, 1.0, 0.0,
            0.0, 0.0, 0.0, 1.0,
            -stiffness1, kappa, -d1, -d2,
            kappa, -stiffness2, -d2, -d1,
        );
        let all = nalgebra::linalg::Schur::try_new(system, f64::EPSILON, 10_000)?.complex_eigenvalues();
        let mut upper = all.iter().filter(|l| l.im > SMALLEST_SINE * l.norm()).map(|&l| self.polished(l));
        let (first, second) = (upper.next()?, upper.next()?);
        Some(if first.im <= second.im { [first, second] } else { [second, first] })
    }

    /// Whether both masses are held alike.
    fn is_symmetric(&self) -> bool {
        self.stiffness1 == self.stiffness2
    }

    /// Of the mode `x2 = ratio x1`, ratio +1 or -1, of a symmetric rig: `l^2 + (d1 + ratio d2) l + k11 - ratio kappa = 0`.
    fn symmetric_eigenvalue(&self, ratio: f64) -> Option<Complex<f64>> {
        let half_damping = 0.5 * (self.d1 + ratio * self.d2);
        let stiffness = self.stiffness1 - ratio * self.kappa;
        let sine = (stiffness - half_damping * half_damping).sqrt();
        (sine > SMALLEST_SINE * stiffness.sqrt()).then(|| self.polished(Complex::new(-half_damping, sine)))
    }

    /// `r = x2/x1` of the mode of an eigenvalue.
    fn ratio(&self, l: Complex<f64>) -> Complex<f64> {
        let rows = [self.stiffness1, self.stiffness2].map(|stiffness| l * (l + self.d1) + stiffness);
        let coupling = l * self.d2 - self.kappa;
        if rows[1].norm() >= rows[0].norm() { -coupling / rows[1] } else { -rows[0] / coupling }
    }

    /// Two Newton steps on the characteristic polynomial: the QR iteration leaves a few roundings, and an error in an
    /// eigenvalue grows with time.
    fn polished(&self, start: Complex<f64>) -> Complex<f64> {
        (0..2).fold(start, |l, _| {
            let (value, slope) = self.characteristic(l);
            let step = value / slope;
            if step.norm() < 1e-8 * l.norm() { l - step } else { l }
        })
    }
}

impl Modes {
    pub(super) fn new(coefficients: &Coefficients, scaling: Scaling, cell: f64) -> Option<Self> {
        let eigenvalues = coefficients.eigenvalues()?;
        let ratios = if coefficients.is_symmetric() {
            [1.0, -1.0].map(|ratio| Complex::new(ratio, 0.0))
        } else {
            eigenvalues.map(|l| coefficients.ratio(l))
        };
        let vectors = [0, 1].map(|j: usize| {
            let (l, ratio) = (eigenvalues[j], ratios[j]);
            let scale = match scaling {
                Scaling::Position => Complex::new(1.0, 0.0),
                Scaling::Velocity => l,
            };
            [Complex::new(1.0, 0.0) / scale, ratio / scale, l / scale, l * ratio / scale]
        });
        let to_physical = Matrix4::from_fn(|row, column| {
            let entry = vectors[column / 2][row];
            if column % 2 == 0 { entry.re } else { -entry.im }
        });
        let to_modal = well_conditioned_inverse(&to_physical)?;
        let fastest_growth = eigenvalues.iter().map(|l| l.re.max(0.0)).fold(0.0, f64::max);
        let cells = ((MOST_GROWTH.ln() / (fastest_growth * cell)) as usize).clamp(1, MOST_CELLS);
        let block = cell * cells as f64;
        let rates = eigenvalues.map(|l| l.norm());
        let growth = eigenvalues.map(|l| (l.re.max(0.0) * block).exp());
        let position = [0, 1].map(|j: usize| vectors[j][0].norm().max(vectors[j][1].norm()));
        Some(Self {
            eigenvalues,
            to_physical,
            to_modal,
            cell,
            cells,
            bulge_weights: [0, 1].map(|j| rates[j].powi(2) * growth[j] * cell * cell / 8.0),
            jerk_weights: [0, 1].map(|j| rates[j].powi(3) * growth[j] * cell / 3.0),
            amplitude_weights: [0, 1].map(|j| position[j] * growth[j]),
            coarse: (0..=cells).map(|n| exponential(&eigenvalues, n as f64 * cell)).collect(),
            fine: std::array::from_fn(|n| exponential(&eigenvalues, n as f64 * cell / FINE as f64)),
            powers: std::array::from_fn(|k| scaled_power(&eigenvalues, k)),
        })
    }

    /// Width of a cell that suits these coefficients.
    pub(super) fn suitable_cell(coefficients: &[&Coefficients]) -> Option<f64> {
        let mut fastest = 0.0_f64;
        for set in coefficients {
            fastest = set.eigenvalues()?.iter().map(|l| l.norm()).fold(fastest, f64::max);
        }
        Some(CELL_ANGLE / fastest)
    }

    /// The coordinates nearest to `c`, a few roundings away, with `q = value`.
    #[inline]
    pub(super) fn with_value(&self, mut c: Modal, value: f64) -> Modal {
        c[0] += value - (c[0] + c[2]);
        c
    }

    /// The coordinates near `c`, a few roundings away, with the same `q` and `q' = 0`.
    #[inline]
    pub(super) fn without_slope(&self, mut c: Modal) -> Modal {
        c[1] += self.slope(&c) / self.eigenvalues[0].im;
        c
    }

    /// Coordinates after a time of any length.
    pub(super) fn after(&self, c: &Modal, time: f64) -> Modal {
        rotated(c, &self.turn(time))
    }

    /// The exponentials over `time`: [`rotated`] by the result is [`Self::after`].
    pub(super) fn turn(&self, time: f64) -> Modal {
        exponential(&self.eigenvalues, time)
    }

    /// First derivative of the event function.
    #[inline]
    pub(super) fn slope(&self, c: &Modal) -> f64 {
        dot(c, &self.powers[1])
    }

    /// Second derivative of the event function.
    #[inline]
    pub(super) fn curvature(&self, c: &Modal) -> f64 {
        2.0 * dot(c, &self.powers[2])
    }

    /// Taylor coefficients of the event function over a cell, from `c`.
    pub(super) fn coefficients(&self, c: &Modal) -> [f64; ORDER + 1] {
        let mut terms = [Complex::new(c[0], c[1]), Complex::new(c[2], c[3])];
        std::array::from_fn(|k| {
            if k > 0 {
                for (term, l) in terms.iter_mut().zip(&self.eigenvalues) {
                    *term *= l / k as f64;
                }
            }
            terms[0].re + terms[1].re
        })
    }

    /// Taylor coefficients of `x1 - x1*` or `x2 - x2*` (`index` 0 or 1) over a cell, from `c`.
    pub(super) fn position_series(&self, c: &Modal, index: usize, sign: f64, offset: f64, scale: f64) -> Series {
        let row = self.to_physical.row(index);
        // As an event function: the coordinates multiplied by the vector's entry.
        let weighted: Modal = std::array::from_fn(|i| match i % 2 {
            0 => row[i] * c[i] + row[i + 1] * c[i + 1],
            _ => row[i - 1] * c[i] - row[i] * c[i - 1],
        });
        let mut coefficients = self.coefficients(&weighted).map(|q| sign * q);
        coefficients[0] += offset;
        Series::new(coefficients, self.cell, scale)
    }
}

#[inline]
pub(super) fn dot(c: &Modal, e: &Modal) -> f64 {
    (c[0] * e[0] + c[1] * e[1]) + (c[2] * e[2] + c[3] * e[3])
}

/// Both complex products `c_j e_j`.
#[inline]
pub(super) fn rotated(c: &Modal, e: &Modal) -> Modal {
    [c[0] * e[0] + c[1] * e[1], c[1] * e[0] - c[0] * e[1], c[2] * e[2] + c[3] * e[3], c[3] * e[2] - c[2] * e[3]]
}

/// `(|c1|, |c2|)`.
#[inline]
pub(super) fn magnitudes(c: &Modal) -> [f64; 2] {
    [(c[0] * c[0] + c[1] * c[1]).sqrt(), (c[2] * c[2] + c[3] * c[3]).sqrt()]
}

fn exponential(eigenvalues: &[Complex<f64>; 2], time: f64) -> Modal {
    let [first, second] = eigenvalues.map(|l| (l * time).exp());
    [first.re, -first.im, second.re, -second.im]
}

fn scaled_power(eigenvalues: &[Complex<f64>; 2], exponent: usize) -> Modal {
    let power = |l: Complex<f64>| (1..=exponent).fold(Complex::new(1.0, 0.0), |power, k| power * l / k as f64);
    let [first, second] = eigenvalues.map(power);
    [first.re, -first.im, second.re, -second.im]
}

fn well_conditioned_inverse(matrix: &Matrix4<f64>) -> Option<Matrix4<f64>> {
    let lengths = Vector4::from_fn(|column, _| matrix.column(column).norm());
    let unit = Matrix4::from_fn(|row, column| matrix[(row, column)] / lengths[column]);
    if !unit.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let singular = unit.singular_values();
    if singular.max() > LARGEST_CONDITION * singular.min() {
        return None;
    }
    let inverse = matrix.try_inverse()?;
    // One Newton step on the inverse, to rounding.
    Some(inverse * (Matrix4::identity() * 2.0 - matrix * inverse))
}
