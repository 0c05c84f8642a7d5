//! The difference equation that a configuration with hooked force laws should be. Rapier moves positions n times a step with a velocity
//! that grows under one and the same force, so that with `a_i = M^-1 F(x_i, u_i, f_i)`
//!
//! ```text
//! x_(i+1) = x_i + h w_i + c h^2 a_i,   w_(i+1) = w_i + h a_i,   c = (n + 1)/(2 n)
//! u_i = w_i + p a_(i-1)                what the force laws are told; p = s with prediction, else 0
//! v_i = w_i + s a_i                    what is recorded;  w_0 = v_0 - s a_0
//! s = h/(2 n) if velocities are taken to be s early, 0 if they are taken at face value
//! f_(i+1) = f_i + (k/R)(u_(i+1) - u_i), cut off at -1 and 1
//! ```
//!
//! and where friction is averaged, f is carried half a step before x:
//!
//! ```text
//! a_i = M^-1 F(x_i, u_i, mean of f along w_i t + a_(i-1) t^2/2, 0 < t < h),     f_(i+1) = f along w_i t + a_i t^2/2,  at t = h
//! ```
//!
//! Written out here a second time, from the equations and in plain f64, so that a report row can tell an engine that behaves as its
//! configuration must from one that does not. For `f = 0` it is linear: its eigenvalues mu give the frequency `arg(mu)/h` and the
//! damping `-2 ln|mu|/h` of every mode. For one undamped oscillator of frequency w, with `r = w^2 h^2` and `e = 1 - c`:
//!
//! ```text
//! xi_num = -w^2 h e (1 + O(r)),     w_num - w = w r (1/24 - c e/4 - 3 e^2/8) + O(r^2).
//! ```

use super::Configuration;
use crate::dynamics::{Outcome, Sample, State, Trajectory};
use crate::engine::{DEFAULT_AMPLITUDE_BOUND, Scheme};
use crate::model::{EnergyLedger, JenkinsElement, LinearMode, OscillatorChain};
use nalgebra::{Complex, DMatrix};

/// The difference equation of a chain in a configuration.
#[derive(Debug, Clone)]
pub struct DifferenceEquation {
    chain: OscillatorChain,
    /// `M^-1 K` and `M^-1 (D + S)`.
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
    step: f64,
    /// c
    lift: f64,
    /// s
    stagger: f64,
    /// p
    prediction: f64,
    /// Whether the first force already sees `w_0`.
    lagging: bool,
    /// Whether `f` is the slider force half a step before the positions, and the force its mean over the step.
    averages: bool,
}

impl DifferenceEquation {
    #[must_use]
    pub fn new(chain: &OscillatorChain, configuration: Configuration, step: f64) -> Self {
        let n = configuration.substeps as f64;
        let early = 0.5 * step / n;
        let (stagger, prediction) = match configuration.scheme {
            Scheme::SecondOrder | Scheme::AveragedFriction => (early, early),
            Scheme::LaggingDamping => (early, 0.0),
            Scheme::Plain => (0.0, 0.0),
        };
        let per_mass = |matrix: &DMatrix<f64>| {
            DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] / chain.mass()[i])
        };
        Self {
            chain: chain.clone(),
            stiffness: per_mass(chain.stiffness()),
            damping: per_mass(&chain.total_damping()),
            step,
            lift: (n + 1.0) / (2.0 * n),
            stagger,
            prediction,
            lagging: configuration.scheme == Scheme::LaggingDamping,
            averages: configuration.scheme == Scheme::AveragedFriction,
        }
    }

    /// The motion from `initial`: every `stride`-th of `steps` steps, the start included. Contacts and energies are left empty.
    #[must_use]
    pub fn motion(&self, initial: &State, steps: u32, stride: u32) -> Trajectory {
        let State { positions: mut x, velocities, slider_forces: mut f } = initial.clone();
        let mut a = self.acceleration(&x, &velocities, &f);
        let mut w: Vec<f64> = velocities.iter().zip(&a).map(|(v, a)| v - self.stagger * a).collect();
        if self.lagging {
            a = self.acceleration(&x, &w, &f);
        }
        if self.averages {
            f = self.half_a_step_before(&w, &f, &a);
            a = self.acceleration_after(&x, &w, &f, &a);
        }
        let mut samples = vec![bare_sample(0.0, initial.clone())];
        for i in 1..=steps {
            a = self.advance(&mut x, &mut w, &mut f, &a);
            let time = f64::from(i) * self.step;
            if x.iter().any(|x| x.abs() > DEFAULT_AMPLITUDE_BOUND) {
                let outcome = Outcome::Diverged { time, bound: DEFAULT_AMPLITUDE_BOUND };
                return Trajectory { samples, events: Vec::new(), outcome };
            }
            if i % stride == 0 {
                let (velocities, slider_forces) = (self.recorded(&w, &a), self.recorded_sliders(&w, &f, &a));
                samples.push(bare_sample(time, State { positions: x.clone(), velocities, slider_forces }));
            }
        }
        Trajectory { samples, events: Vec::new(), outcome: Outcome::Completed }
    }

    /// One step under the acceleration `a`; returns the next one.
    pub(super) fn advance(&self, x: &mut [f64], w: &mut [f64], f: &mut [f64], a: &[f64]) -> Vec<f64> {
        let h = self.step;
        let elongation = |j: usize, x: &[f64]| self.chain.jenkins()[j].attachment.elongation(x);
        let old: Vec<f64> = (0..f.len()).map(|j| elongation(j, x)).collect();
        if self.averages {
            self.drag(f, w, a, h);
        }
        for j in 0..x.len() {
            x[j] += h * w[j] + self.lift * h * h * a[j];
            w[j] += h * a[j];
        }
        if !self.averages {
            for (j, (force, old)) in f.iter_mut().zip(old).enumerate() {
                let stiffness = self.chain.jenkins()[j].normalised_stiffness();
                *force = (*force + stiffness * (elongation(j, x) - old)).clamp(-1.0, 1.0);
            }
        }
        self.acceleration_after(x, w, f, a)
    }

    /// Slider forces along velocities `w + a t`, `0 < t < time`; returns their means.
    fn drag(&self, f: &mut [f64], w: &[f64], a: &[f64], time: f64) -> Vec<f64> {
        let one = |(element, f): (&JenkinsElement, &mut f64)| {
            let of = |values: &[f64]| element.normalised_stiffness() * element.attachment.elongation(values);
            let (end, mean) = dragged(*f, of(w), of(a), time);
            *f = end;
            mean
        };
        self.chain.jenkins().iter().zip(f).map(one).collect()
    }

    /// Sticking sliders are moved back by the elongation gained in half a step.
    fn half_a_step_before(&self, w: &[f64], f: &[f64], a: &[f64]) -> Vec<f64> {
        let half = 0.5 * self.step;
        let moved = |v: &[f64], j: usize| {
            self.chain.jenkins()[j].normalised_stiffness() * self.chain.jenkins()[j].attachment.elongation(v)
        };
        let before = |(j, f): (usize, &f64)| match f.abs() < 1.0 {
            true => (f - half * moved(w, j) - 0.5 * half * half * moved(a, j)).clamp(-1.0, 1.0),
            false => *f,
        };
        f.iter().enumerate().map(before).collect()
    }

    /// At the time of the positions.
    fn recorded_sliders(&self, w: &[f64], f: &[f64], a: &[f64]) -> Vec<f64> {
        let mut f = f.to_vec();
        if self.averages {
            self.drag(&mut f, w, a, 0.5 * self.step);
        }
        f
    }

    /// Where the step before was made under the acceleration `past`.
    pub(super) fn acceleration_after(&self, x: &[f64], w: &[f64], f: &[f64], past: &[f64]) -> Vec<f64> {
        let told: Vec<f64> = w.iter().zip(past).map(|(w, a)| w + self.prediction * a).collect();
        if self.averages {
            let means = self.drag(&mut f.to_vec(), w, past, self.step);
            return self.acceleration(x, &told, &means);
        }
        self.acceleration(x, &told, f)
    }

    /// `v = w + s a`
    pub(super) fn recorded(&self, w: &[f64], a: &[f64]) -> Vec<f64> {
        w.iter().zip(a).map(|(w, a)| w + self.stagger * a).collect()
    }

    fn acceleration(&self, x: &[f64], u: &[f64], f: &[f64]) -> Vec<f64> {
        let n = x.len();
        let mut a = vec![0.0; n];
        for (element, force) in self.chain.jenkins().iter().zip(f) {
            element.attachment.scatter(-element.slip_force * force, &mut a);
        }
        for (i, a) in a.iter_mut().enumerate() {
            *a /= self.chain.mass()[i];
            for j in 0..n {
                *a -= self.stiffness[(i, j)] * x[j] + self.damping[(i, j)] * u[j];
            }
        }
        a
    }

    /// Modes of the equation with all elements sticking, in order of angular frequency. Those that die out within a few steps, which the
    /// remembered acceleration adds, are left out, and so are overdamped ones.
    #[must_use]
    pub fn modes(&self) -> Vec<LinearMode> {
        let sticking = vec![true; self.chain.sliders()];
        let n = self.chain.oscillators();
        let system = self.chain.system_matrix(&sticking);
        let (k, d) = (system.view((n, 0), (n, n)), system.view((n, n), (n, n)));
        let (h, one) = (self.step, DMatrix::<f64>::identity(n, n));
        // Columns x, w, a; the new acceleration is k x' + d (w' + p a).
        let position = [one.clone(), &one * h, &one * (self.lift * h * h)];
        let velocity = [DMatrix::zeros(n, n), one.clone(), &one * h];
        let mut matrix = DMatrix::zeros(3 * n, 3 * n);
        for block in 0..3 {
            let told = if block == 2 { &velocity[2] + &one * self.prediction } else { velocity[block].clone() };
            matrix.view_mut((0, block * n), (n, n)).copy_from(&position[block]);
            matrix.view_mut((n, block * n), (n, n)).copy_from(&velocity[block]);
            matrix.view_mut((2 * n, block * n), (n, n)).copy_from(&(k * &position[block] + d * told));
        }
        let mut modes: Vec<LinearMode> = matrix
            .complex_eigenvalues()
            .iter()
            .filter(|mu| mu.im > 0.0 && mu.norm() > 0.5)
            .map(|mu: &Complex<f64>| LinearMode { angular_frequency: mu.arg() / h, damping: -2.0 * mu.norm().ln() / h })
            .collect();
        modes.sort_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency));
        modes
    }
}

/// The stop operator `f -> clamp(f + u)` along `u = r t + b t^2/2`: its value at the end, and its mean. The integral is that of `f + u`, less the
/// area by which it exceeds the limit, after the time at which it gets there.
fn dragged(f: f64, r: f64, b: f64, time: f64) -> (f64, f64) {
    let turn = -r / b;
    if turn > 0.0 && turn < time {
        let (middle, first) = dragged(f, r, b, turn);
        // From rest: the rate at the turning point is zero, and never negative zero over b.
        let (end, second) = dragged(middle, 0.0, b, time - turn);
        return (end, (first * turn + second * (time - turn)) / time);
    }
    let u = |t: f64| r * t + b * t * t / 2.0;
    let area = |t: f64| f * t + r * t * t / 2.0 + b * t * t * t / 6.0;
    let beyond = (f + u(time)).abs() - 1.0;
    if beyond <= 0.0 {
        return (f + u(time), area(time) / time);
    }
    let limit = (f + u(time)).signum();
    // Backwards from the end, where the rate v is not zero: u(time) - u(time - s) = v s - b s^2/2 = the excess.
    let (v, excess) = (limit * (r + b * time), beyond);
    let s = (2.0 * excess / (v + (v * v - 2.0 * limit * b * excess).max(0.0).sqrt())).min(time);
    let over = excess * s - v * s * s / 2.0 + limit * b * s * s * s / 6.0;
    (limit, (area(time) - limit * over) / time)
}

/// A sample of which only time and state are known.
pub(super) fn bare_sample(time: f64, state: State) -> Sample {
    Sample { time, state, contacts: Vec::new(), ledger: EnergyLedger::default() }
}

/// Numerical damping of an undamped oscillator with its spring as a hook, `-w^2 h (1 - (n + 1)/(2 n))`.
#[must_use]
pub fn hook_damping(angular_frequency: f64, step: f64, substeps: usize) -> f64 {
    let n = substeps as f64;
    -angular_frequency * angular_frequency * step * (1.0 - (n + 1.0) / (2.0 * n))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::ChainBuilder;

    fn oscillator(damping: f64) -> OscillatorChain {
        ChainBuilder::new(vec![1.0]).ground_spring(0, 1.0).ground_damper(0, damping).build().unwrap()
    }

    fn mode(damping: f64, substeps: usize, scheme: Scheme, step: f64) -> LinearMode {
        let configuration = Configuration { substeps, scheme, ..Configuration::SAMPLED_FRICTION };
        DifferenceEquation::new(&oscillator(damping), configuration, step).modes()[0]
    }

    #[test]
    fn eigenvalues_follow_the_formulae_for_an_undamped_oscillator() {
        let h = 0.01f64;
        for n in [1, 2, 4, 8] {
            let found = mode(0.0, n, Scheme::Plain, h);
            let (c, e) = ((n as f64 + 1.0) / (2.0 * n as f64), 1.0 - (n as f64 + 1.0) / (2.0 * n as f64));
            let shift = h * h * (1.0 / 24.0 - c * e / 4.0 - 3.0 * e * e / 8.0);
            // The next terms are a factor h^2 = 1e-4 smaller; rounding of the logarithm, 1e-16/h.
            assert!((found.damping - hook_damping(1.0, h, n)).abs() < 1e-4 * h + 1e-13, "{n}: {found:?}");
            assert!((found.angular_frequency - 1.0 - shift).abs() < 1e-8 + 1e-13, "{n}: {found:?}");
        }
    }

    #[test]
    fn the_prediction_makes_damping_second_order() {
        let error = |scheme, h| (mode(0.2, 1, scheme, h).damping - 0.2).abs();
        // Halving the step divides errors by 4 and by 2, within the next order in h = 0.02.
        assert!((error(Scheme::SecondOrder, 0.02) / error(Scheme::SecondOrder, 0.01) - 4.0).abs() < 0.2);
        assert!((error(Scheme::LaggingDamping, 0.02) / error(Scheme::LaggingDamping, 0.01) - 2.0).abs() < 0.1);
    }
}
