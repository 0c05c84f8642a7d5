//! Root of the event function in a cell, to full precision and without transcendental functions.
//!
//! The estimate is moved to the nearest of 16 fine nodes of the cell, whose exponentials are tabulated; from there Halley's
//! method runs on the Taylor polynomial of degree 6, which is the function to rounding at that distance.

use super::modal::{Modal, Modes, dot, rotated};

/// Fine steps in a cell.
pub(super) const FINE: usize = 16;
/// Highest power of the local polynomial around a fine node: |l| dt is at most 0.75 * 0.25/16 = 0.012 there, and the first term
/// left out 0.012^7/7! = 7e-18.
pub(super) const LOCAL: usize = 6;

impl Modes {
    /// Root of `q = level` in the cell that starts at `c`, given an estimate `guess` in `[0, cell]`: time and coordinates there.
    /// `None` if the iteration does not settle in the cell. The caller has proved that there is one root.
    #[inline]
    pub(super) fn root(&self, c: &Modal, level: f64, guess: f64) -> Option<(f64, Modal)> {
        let fine_step = self.cell / FINE as f64;
        let mut time = guess;
        for _ in 0..3 {
            let node = (time / fine_step).round().clamp(0.0, FINE as f64);
            let at_node = rotated(c, &self.fine[node as usize]);
            let mut q = [0.0; LOCAL + 1];
            for (q, power) in q.iter_mut().zip(&self.powers) {
                *q = dot(&at_node, power);
            }
            q[0] -= level;
            if let Some(delta) = local_root(&q, 0.75 * fine_step) {
                let time = node * fine_step + delta;
                let inside = time >= -f64::EPSILON * self.cell && time <= self.cell * (1.0 + f64::EPSILON);
                return inside.then(|| (time, rotated(&at_node, &self.local_exponential(delta))));
            }
            // The estimate was off by more than a fine step: move on from a Newton step.
            time = node * fine_step - q[0] / q[1];
            if !(0.0..=self.cell).contains(&time) {
                return None;
            }
        }
        None
    }

    /// `e^(l t)` for |t| of at most a fine step.
    #[inline]
    fn local_exponential(&self, t: f64) -> Modal {
        let mut sum = self.powers[LOCAL];
        for power in self.powers[..LOCAL].iter().rev() {
            for (sum, power) in sum.iter_mut().zip(power) {
                *sum = *sum * t + power;
            }
        }
        sum
    }
}

/// Smallest root of a polynomial close to 0, at most `reach` away, by Halley's method.
#[inline]
fn local_root(q: &[f64; LOCAL + 1], reach: f64) -> Option<f64> {
    let halley = |value: f64, slope: f64, half_curvature: f64| value * slope / (slope * slope - value * half_curvature);
    let mut delta = -halley(q[0], q[1], q[2]);
    for _ in 0..6 {
        if delta.is_nan() || delta.abs() > reach {
            return None;
        }
        let (mut value, mut slope) = (0.0, 0.0);
        for &coefficient in q.iter().rev() {
            slope = slope * delta + value;
            value = value * delta + coefficient;
        }
        let step = halley(value, slope, q[2] + 3.0 * q[3] * delta);
        delta -= step;
        // The next step would be the cube of this one, relative to the cell.
        if step.abs() < 1e-5 * reach {
            return Some(delta);
        }
    }
    None
}
