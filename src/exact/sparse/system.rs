//! The matrices of a chain by their entries that are not zero, divided by the masses.

use super::series::HIGHEST_ORDER;
use crate::model::{Attachment, JenkinsElement, OscillatorChain};

/// One entry of a row of `M^-1 K` and `M^-1 (D + S)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub(super) column: usize,
    pub(super) stiffness: f64,
    pub(super) damping: f64,
}

/// A Jenkins element: its ends, `k/R`, and the accelerations `R/m` its unit force gives them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element {
    pub(super) first: usize,
    pub(super) second: Option<usize>,
    pub(super) normalised_stiffness: f64,
    pub(super) accelerations: [f64; 2],
    /// `R/k`: the spring is elongated by `R f/k`.
    elongation_per_force: f64,
}

impl Element {
    pub(super) fn elongation(&self, values: &[f64]) -> f64 {
        values[self.first] - self.second.map_or(0.0, |second| values[second])
    }
}

#[derive(Debug, Clone)]
pub(in crate::exact) struct SparseSystem {
    pub(super) oscillators: usize,
    pub(super) elements: Vec<Element>,
    /// Entries of row i: `starts[i]..starts[i + 1]`.
    pub(super) starts: Vec<usize>,
    pub(super) entries: Vec<Entry>,
    /// `w` and `r` of the module head.
    pub(super) frequency: f64,
    pub(super) rate: f64,
    /// Width of the cell of every order in which its series is the motion to 1e-17.
    cells: Vec<f64>,
}

impl SparseSystem {
    pub(super) fn new(chain: &OscillatorChain) -> Self {
        let n = chain.oscillators();
        let damping = chain.total_damping();
        let (mut starts, mut entries) = (vec![0], Vec::new());
        for row in 0..n {
            let mass = chain.mass()[row];
            for column in 0..n {
                let (k, d) = (chain.stiffness()[(row, column)], damping[(row, column)]);
                if k != 0.0 || d != 0.0 {
                    entries.push(Entry { column, stiffness: k / mass, damping: d / mass });
                }
            }
            starts.push(entries.len());
        }
        let element = |element: &JenkinsElement| {
            let (first, second) = match element.attachment {
                Attachment::Ground(i) => (i, None),
                Attachment::Between(i, j) => (i, Some(j)),
            };
            let acceleration = |i: usize| element.slip_force / chain.mass()[i];
            Element {
                first,
                second,
                normalised_stiffness: element.normalised_stiffness(),
                accelerations: [acceleration(first), second.map_or(0.0, acceleration)],
                elongation_per_force: element.slip_force / element.stiffness,
            }
        };
        let elements = chain.jenkins().iter().map(element).collect();
        let (frequency, rate) = rates(chain, &starts, &entries);
        let width = |order| if rate > 0.0 { cell_angle(order) / rate } else { f64::INFINITY };
        let cells = (0..=HIGHEST_ORDER).map(width).collect();
        Self { oscillators: n, elements, starts, entries, frequency, rate, cells }
    }

    pub(super) fn length(&self) -> usize {
        2 * self.oscillators + self.elements.len()
    }

    /// Width of the cell of `order`, at most the highest.
    pub(super) fn cell(&self, order: usize) -> f64 {
        self.cells[order]
    }

    /// The longest cell of all orders.
    pub(in crate::exact) fn longest_cell(&self) -> f64 {
        self.cell(HIGHEST_ORDER)
    }

    /// `max(w |x|, |v|, w |R f/k|)` for `y = (x, v, f)`.
    pub(super) fn norm(&self, y: &[f64]) -> f64 {
        let n = self.oscillators;
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let springs = self.elements.iter().zip(&y[2 * n..]).map(|(e, f)| e.elongation_per_force * f.abs());
        (self.frequency * largest(&y[..n]).max(springs.fold(0.0, f64::max))).max(largest(&y[n..2 * n]))
    }

    /// `M^-1 (-K x - (D + S) v - sum R f b)`, into `target`.
    pub(super) fn acceleration(&self, x: &[f64], v: &[f64], forces: impl Iterator<Item = f64>, target: &mut [f64]) {
        for (i, a) in target.iter_mut().enumerate() {
            let row = &self.entries[self.starts[i]..self.starts[i + 1]];
            *a = -row.iter().map(|e| e.stiffness * x[e.column] + e.damping * v[e.column]).sum::<f64>();
        }
        for (element, force) in self.elements.iter().zip(forces) {
            target[element.first] -= element.accelerations[0] * force;
            if let Some(second) = element.second {
                target[second] += element.accelerations[1] * force;
            }
        }
    }
}

/// `r h` at which the remainder of the series of order p is 1e-17, by bisection of an increasing function.
fn cell_angle(order: usize) -> f64 {
    let remainder = |angle: f64| {
        let term = (1..=order + 1).fold(1.0, |term, k| term * angle / k as f64);
        term / (1.0 - angle / (order + 2) as f64)
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if remainder(middle) < 1e-17 { low = middle } else { high = middle }
    }
    low
}

/// `w` and `r`.
fn rates(chain: &OscillatorChain, starts: &[usize], entries: &[Entry]) -> (f64, f64) {
    let n = chain.oscillators();
    let row_sum = |i: usize, part: fn(&Entry) -> f64| {
        entries[starts[i]..starts[i + 1]].iter().map(|e| part(e).abs()).sum::<f64>()
    };
    let mut stiffness: Vec<f64> = (0..n).map(|i| row_sum(i, |e| e.stiffness)).collect();
    let damping = (0..n).map(|i| row_sum(i, |e| e.damping)).fold(0.0, f64::max);
    let mut widest: f64 = 1.0;
    for element in chain.jenkins() {
        let ends = element.attachment.direction().count() as f64;
        widest = widest.max(ends);
        for (i, _) in element.attachment.direction() {
            stiffness[i] += element.stiffness * ends / chain.mass()[i];
        }
    }
    let frequency = stiffness.into_iter().fold(0.0, f64::max).sqrt();
    (frequency, (frequency * widest).max(frequency + damping))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cell_of_order_16_is_where_the_remainder_is_1e_17() {
        let angle = cell_angle(16);
        let factorial = (1..=17).map(f64::from).product::<f64>();
        let remainder = angle.powi(17) / factorial / (1.0 - angle / 18.0);
        assert!((remainder / 1e-17 - 1.0).abs() < 1e-12, "{angle} {remainder:e}");
        assert!((6..16).all(|order| cell_angle(order) < cell_angle(order + 1)));
    }
}
