//! Harmonic balance of the elongation of a contact; equations in [`super::one_sector`].

use super::error::DiskError;
use super::odd_series::{C, value};
use super::sector::Sector;
use std::f64::consts::PI;

/// Largest residual of a converged wave, relative to the amplitude.
const RESIDUAL: f64 = 1e-13;
const MOST_STEPS: usize = 60;

/// Harmonic balance of the elongation.
pub(super) struct Balance<'a, 's> {
    pub(super) sector: &'s Sector<'a>,
    pub(super) u: Vec<C>,
    pub(super) tau: f64,
    /// `int_0^tau exp(i m theta) dtheta` for even m from `-2 h_max` to `2 h_max`.
    powers: Vec<C>,
}

impl<'a, 's> Balance<'a, 's> {
    /// A harmonic motion of the given amplitude, to start from.
    pub(super) fn new(sector: &'s Sector<'a>, amplitude: f64, count: usize) -> Self {
        let mut u = vec![C::ZERO; count.max(1)];
        u[0] = C::from(amplitude);
        Self { sector, u, tau: 0.0, powers: Vec::new() }
    }

    /// Newton's method on the two real equations of the fundamental, with the higher harmonics brought into balance at every step.
    pub(super) fn solve(&mut self, amplitude: f64, w: f64) -> Result<f64, DiskError> {
        let (mut a, mut w) = (amplitude, w);
        let wave = self.sector.wave.signed();
        let mut residual = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let here = self.fundamental(a, w)?;
            residual = here.norm() / a;
            if residual < RESIDUAL {
                return Ok(w);
            }
            let [step, turn] = [1e-6 * amplitude, 1e-6 * w];
            let by_a = (self.fundamental(a + step, w)? - here) / step;
            let by_w = (self.fundamental(a, w + turn)? - here) / turn;
            let determinant = by_a.re * by_w.im - by_a.im * by_w.re;
            let da = (here.im * by_w.re - here.re * by_w.im) / determinant;
            let dw = (here.re * by_a.im - here.im * by_a.re) / determinant;
            if !(da.is_finite() && dw.is_finite()) {
                break;
            }
            let part = (0.2 * a / da.abs().max(1e-300)).min(1.0);
            (a, w) = (a + part * da, w + part * dw);
        }
        Err(DiskError::NoConvergence { wave, residual })
    }

    /// `U_1/H_1 + f_1` once all other harmonics balance and the reversal is at theta = 0; `a` is the real part of `U_1`.
    fn fundamental(&mut self, a: f64, w: f64) -> Result<C, DiskError> {
        let compliances: Vec<C> = (0..self.u.len()).map(|k| self.sector.compliance(2 * k + 1, w)).collect();
        for _ in 0..MOST_STEPS {
            let tilt: f64 = self.u.iter().enumerate().skip(1).map(|(k, c)| (2 * k + 1) as f64 * c.im).sum();
            self.u[0] = C::new(a, -tilt);
            let forces = self.forces()?;
            let mut change = 0.0_f64;
            for (k, force) in forces.iter().enumerate().skip(1) {
                let next = -compliances[k] * force;
                change = change.max((next - self.u[k]).norm() * (2 * k + 1) as f64);
                self.u[k] = next;
            }
            if change <= 1e-16 * a {
                break;
            }
        }
        let tilt: f64 = self.u.iter().enumerate().skip(1).map(|(k, c)| (2 * k + 1) as f64 * c.im).sum();
        self.u[0] = C::new(a, -tilt);
        Ok(self.u[0] / compliances[0] + self.forces()?[0])
    }

    /// `f_h` for every odd h.
    pub(super) fn forces(&mut self) -> Result<Vec<C>, DiskError> {
        let e = self.sector.slip_elongation;
        self.tau = self.first_slip()?;
        let count = self.u.len();
        let zero = 2 * count as i64;
        let integral = |m: i64| match m {
            0 => C::from(self.tau),
            m => (C::from_polar(1.0, m as f64 * self.tau) - 1.0) / (C::i() * m as f64),
        };
        // m = 2 (number - count) covers g - h and -g - h for odd g, h up to 2 count - 1.
        self.powers = (0..=2 * zero).map(|number| integral(2 * (number - zero))).collect();
        let table = &self.powers;
        let at = |m: i64| table[(m / 2 + zero) as usize];
        // u' = 1/2 sum_g (i g U_g exp(i g theta) + conjugate).
        let rates: Vec<C> = self.u.iter().enumerate().map(|(k, c)| C::i() * (2 * k + 1) as f64 * c * 0.5).collect();
        let force = |h: i64| {
            let sum: C = rates
                .iter()
                .enumerate()
                .map(|(k, rate)| {
                    let g = 2 * k as i64 + 1;
                    rate * at(g - h) + rate.conj() * at(-g - h)
                })
                .sum();
            sum * 2.0 / (C::i() * h as f64 * PI * e)
        };
        Ok((0..count).map(|k| force(2 * k as i64 + 1)).collect())
    }

    /// `tau` with `u(0) - u(tau) = 2 e`: bisection to a bracket of rounding width.
    fn first_slip(&self) -> Result<f64, DiskError> {
        let level = value(&self.u, 0.0) - 2.0 * self.sector.slip_elongation;
        if level < value(&self.u, PI) {
            return Err(DiskError::NoSlip { wave: self.sector.wave.signed(), amplitude: value(&self.u, 0.0) });
        }
        let (mut low, mut high) = (0.0, PI);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if value(&self.u, middle) > level { low = middle } else { high = middle }
        }
        Ok(0.5 * (low + high))
    }

    /// Whether the elongation falls all the way from one reversal to the next, as assumed.
    pub(super) fn falls(&self) -> bool {
        let values = (0..=128).map(|n| value(&self.u, PI * f64::from(n) / 128.0));
        values.clone().zip(values.skip(1)).all(|(before, after)| after < before)
    }
}
