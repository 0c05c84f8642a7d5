//! Taylor coefficients of a motion in one contact pattern, row by row: index k, then the oscillator or element.

use super::super::series::{ORDER, Series};
use super::system::SparseSystem;
use crate::model::ContactState;

/// Highest order p of a series: of velocities and forces; positions have one more.
pub(super) const HIGHEST_ORDER: usize = ORDER;

/// Coefficients of positions and of elongations of the elements, and the forces at the start.
#[derive(Debug, Clone, Default)]
pub(in crate::exact) struct TaylorSeries {
    order: usize,
    oscillators: usize,
    sliders: usize,
    positions: Vec<f64>,
    elongations: Vec<f64>,
    forces: Vec<f64>,
    /// `k/R` of sticking elements, 0 of slipping ones.
    active: Vec<f64>,
}

impl TaylorSeries {
    /// Of the highest order, from `y = (x, v, f)`.
    pub(in crate::exact) fn full(system: &SparseSystem, y: &[f64], contacts: &[ContactState]) -> Self {
        let mut series = Self::default();
        series.expand(system, y, contacts, HIGHEST_ORDER);
        series
    }

    /// Of order `order` from `y = (x, v, f)`, in place of what was there.
    pub(super) fn expand(&mut self, system: &SparseSystem, y: &[f64], contacts: &[ContactState], order: usize) {
        let (n, m) = (system.oscillators, system.elements.len());
        (self.order, self.oscillators, self.sliders) = (order, n, m);
        self.positions.resize((order + 2) * n, 0.0);
        self.elongations.resize((order + 2) * m, 0.0);
        self.positions[..2 * n].copy_from_slice(&y[..2 * n]);
        self.forces.clear();
        self.forces.extend_from_slice(&y[2 * n..]);
        self.active.clear();
        let stiffness = system.elements.iter().map(|element| element.normalised_stiffness);
        self.active.extend(stiffness.zip(contacts).map(|(k, contact)| if contact.is_stick() { k } else { 0.0 }));
        for k in 0..order + 2 {
            let row = &self.positions[k * n..(k + 1) * n];
            for (u, element) in self.elongations[k * m..(k + 1) * m].iter_mut().zip(&system.elements) {
                *u = element.elongation(row);
            }
            if k < order {
                self.next_row(system, k);
            }
        }
    }

    /// `x_(k+2)` from `x_k` and `x_(k+1)`.
    fn next_row(&mut self, system: &SparseSystem, k: usize) {
        let (n, m) = (self.oscillators, self.sliders);
        let (known, rest) = self.positions.split_at_mut((k + 2) * n);
        let (x, v) = known[k * n..].split_at(n);
        let next = &mut rest[..n];
        let up = (k + 1) as f64;
        for (i, a) in next.iter_mut().enumerate() {
            let (mut stiff, mut damp) = (0.0, 0.0);
            for entry in &system.entries[system.starts[i]..system.starts[i + 1]] {
                stiff += entry.stiffness * x[entry.column];
                damp += entry.damping * v[entry.column];
            }
            *a = stiff + up * damp;
        }
        for (j, element) in system.elements.iter().enumerate() {
            let force = if k == 0 { self.forces[j] } else { self.active[j] * self.elongations[k * m + j] };
            next[element.first] += element.accelerations[0] * force;
            if let Some(second) = element.second {
                next[second] -= element.accelerations[1] * force;
            }
        }
        let scale = -1.0 / (up * (up + 1.0));
        next.iter_mut().for_each(|a| *a *= scale);
    }

    /// `y = (x, v, f)` at a time since the start of the series, into `y`; forces clamped to -1 to 1.
    pub(in crate::exact) fn state(&self, time: f64, y: &mut [f64]) {
        self.linear_state(time, y);
        y[2 * self.oscillators..].iter_mut().for_each(|f| *f = f.clamp(-1.0, 1.0));
    }

    /// The same without clamping, as tangents need it.
    pub(super) fn linear_state(&self, time: f64, y: &mut [f64]) {
        let (n, m, p) = (self.oscillators, self.sliders, self.order);
        let (x, rest) = y.split_at_mut(n);
        let (v, f) = rest.split_at_mut(n);
        x.copy_from_slice(&self.positions[(p + 1) * n..]);
        v.iter_mut().zip(&*x).for_each(|(v, x)| *v = (p + 1) as f64 * x);
        f.fill(0.0);
        for k in (1..=p).rev() {
            let row = &self.positions[k * n..(k + 1) * n];
            for ((x, v), c) in x.iter_mut().zip(v.iter_mut()).zip(row) {
                *x = *x * time + c;
                *v = *v * time + k as f64 * c;
            }
            f.iter_mut().zip(&self.elongations[k * m..(k + 1) * m]).for_each(|(f, u)| *f = (*f + u) * time);
        }
        x.iter_mut().zip(&self.positions[..n]).for_each(|(x, c)| *x = *x * time + c);
        for (j, f) in f.iter_mut().enumerate() {
            *f = self.forces[j] + self.active[j] * *f;
        }
    }

    /// For every element a bound on how far its elongation (`rates` false) or elongation rate (true) goes from its start within `span`.
    pub(super) fn excursions(&self, span: f64, rates: bool, into: &mut Vec<f64>) {
        let (m, p) = (self.sliders, self.order);
        into.clear();
        into.resize(m, 0.0);
        for k in (1..=p).rev() {
            let (row, factor) = if rates { (k + 1, (k + 1) as f64) } else { (k, 1.0) };
            let row = &self.elongations[row * m..(row + 1) * m];
            into.iter_mut().zip(row).for_each(|(sum, u)| *sum = (*sum + factor * u.abs()) * span);
        }
    }

    pub(super) fn elongation_rate(&self, element: usize) -> f64 {
        self.elongations[self.sliders + element]
    }

    /// `sign f_j - 1` over `[0, span]`; `scale` as in [`Series::new`], the terms of the series not counted.
    pub(super) fn force_excess(&self, element: usize, sign: f64, span: f64) -> Series {
        let m = self.sliders;
        let mut c = self.coefficients(|k| sign * self.active[element] * self.elongations[k * m + element]);
        c[0] = sign * self.forces[element];
        let size = size(&c, span);
        c[0] -= 1.0;
        Series::new(c, span, size + 1.0)
    }

    /// `-sign` times the elongation rate over `[0, span]`.
    pub(super) fn stop_excess(&self, element: usize, sign: f64, span: f64, scale: f64) -> Series {
        let m = self.sliders;
        let c = self.coefficients(|k| -sign * (k + 1) as f64 * self.elongations[(k + 1) * m + element]);
        Series::new(c, span, size(&c, span) + scale)
    }

    /// `sign x_i - bound` over `[0, span]`.
    pub(super) fn position_excess(&self, oscillator: usize, sign: f64, bound: f64, span: f64) -> Series {
        let mut c = self.coefficients(|k| sign * self.positions[k * self.oscillators + oscillator]);
        let size = size(&c, span);
        c[0] -= bound;
        Series::new(c, span, size + bound)
    }

    fn coefficients(&self, of: impl Fn(usize) -> f64) -> [f64; ORDER + 1] {
        std::array::from_fn(|k| if k <= self.order { of(k) } else { 0.0 })
    }
}

fn size(c: &[f64; ORDER + 1], span: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, q| sum * span + q.abs())
}
