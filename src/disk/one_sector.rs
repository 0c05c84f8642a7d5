//! A travelling-wave limit cycle of a tuned ring from one sector alone.
//!
//! All blades do the same, each a time `sigma/w` after the one before, so the contacts of one sector decide the motion. With `theta = w t` and
//! the elongation `u(theta) = sum_h Re U_h exp(i h theta)` over odd h,
//!
//! ```text
//! U_h + H_h(w) f_h[u] = 0,   H_h = R c_h^T Z_h^-1 conj(c_h),   Z_h = -h^2 w^2 M + i h w D(h sigma) + K(h sigma)
//! ```
//!
//! where `c_h` takes the motion of a sector to the elongation of its contact: 1 for a blade at its foot, `1 - exp(-i h sigma)` between neighbours.
//! Measured from a reversal `u'(0) = 0`, `u(0) = u_max`, the force obeys over half a period
//!
//! ```text
//! f = 1 - (u(0) - u)/e  for 0 <= theta <= tau,   f = -1 for tau <= theta <= pi,   u(0) - u(tau) = 2 e,
//! f_h = 2/(i h pi e) int_0^tau u' exp(-i h theta) dtheta      (by parts; f is continuous)
//! ```
//!
//! and the integrals of products of harmonics are known in closed form: no time is discretised, and no code is shared with the exact
//! flow. Left out are the harmonics beyond the last; `f_h = O(1/h^2)` and `H_h = O(1/h^2)`, so the error of the amplitude falls at least with the
//! third power of their number. With one harmonic this is the describing function.
//!
//! Assumptions: a ring with one group of contacts on all sectors; contacts that reverse twice and slip twice in a period; odd symmetry.

use super::error::DiskError;
use crate::dynamics::State;
use crate::model::{BladedDisk, ContactPlace, NodalDiameter};
use nalgebra::{Complex, DMatrix, DVector};
use std::f64::consts::PI;

type C = Complex<f64>;

/// Harmonics of the describing function, and enough for 1e-10 in the amplitude.
pub const DESCRIBING_FUNCTION: usize = 1;
pub const MANY_HARMONICS: usize = 256;

/// Largest amplitude looked at, in units of the slip elongation.
const LARGEST_AMPLITUDE: f64 = 100.0;
/// Largest residual of a converged wave, relative to the amplitude.
const RESIDUAL: f64 = 1e-13;
const MOST_STEPS: usize = 60;

/// A travelling-wave limit cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct TravellingWave {
    pub wave: NodalDiameter,
    pub angular_frequency: f64,
    /// Largest displacement of a blade.
    pub amplitude: f64,
    /// Largest elongation of a contact.
    pub elongation: f64,
    /// `theta` from a reversal to the next slip.
    pub sticking_angle: f64,
    /// Complex amplitudes of the odd harmonics 1, 3, 5, ... of each oscillator of sector 0.
    pub harmonics: Vec<DVector<C>>,
    slip_elongation: f64,
    place: ContactPlace,
    contact: Vec<C>,
}

/// The linear side of one sector.
struct Sector<'a> {
    disk: &'a BladedDisk,
    wave: NodalDiameter,
    mass: Vec<f64>,
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
    slip_force: f64,
    slip_elongation: f64,
    place: ContactPlace,
}

impl TravellingWave {
    /// The wave of least amplitude beyond the slip limit with `count` odd harmonics, for the disk without its mistuning.
    ///
    /// # Errors
    /// [`DiskError::NotOneGroup`] unless the disk is a ring with one group of contacts on all sectors; [`DiskError::NoWave`] where friction
    /// finds no balance up to 100 slip elongations (waves the air damps among them); [`DiskError::NoConvergence`].
    pub fn of(disk: &BladedDisk, wave: NodalDiameter, count: usize) -> Result<Self, DiskError> {
        let sector = Sector::new(disk, wave)?;
        let (guess, w) = sector.describing_function()?;
        let mut solver = Balance { sector: &sector, u: vec![C::ZERO; count.max(1)], tau: 0.0, powers: Vec::new() };
        solver.u[0] = C::from(guess);
        let w = solver.solve(guess, w)?;
        if solver.falls() { Ok(solver.wave(w)) } else { Err(DiskError::ManyReversals { wave: wave.signed() }) }
    }

    /// The state of the whole ring at the time at which the contact of sector 0 reverses at f = +1.
    #[must_use]
    pub fn state(&self) -> State {
        let n = self.wave.sectors();
        let size = self.harmonics.first().map_or(0, DVector::len);
        let theta = |j: usize| -self.wave.multiple(j as i64);
        let of = |part: usize, j: usize, rate: bool| {
            let terms = self.harmonics.iter().enumerate().map(|(k, x)| {
                let h = (2 * k + 1) as f64;
                let factor = if rate { C::i() * h * self.angular_frequency } else { C::from(1.0) };
                (factor * x[part] * C::from_polar(1.0, h * theta(j))).re
            });
            terms.sum::<f64>()
        };
        let all =
            |rate| (0..size).flat_map(|part| (0..n).map(move |j| (part, j))).map(|(p, j)| of(p, j, rate)).collect();
        State {
            positions: all(false),
            velocities: all(true),
            slider_forces: (0..n).map(|j| self.force(theta(j))).collect(),
        }
    }

    #[must_use]
    pub fn period(&self) -> f64 {
        std::f64::consts::TAU / self.angular_frequency
    }

    /// Contact force at a phase, in units of the slip force.
    fn force(&self, theta: f64) -> f64 {
        let turn = theta.rem_euclid(2.0 * PI);
        let (phase, sign) = if turn >= PI { (turn - PI, -1.0) } else { (turn, 1.0) };
        if phase >= self.sticking_angle {
            return -sign;
        }
        let drop = self.elongation - value(&self.contact, phase);
        sign * (1.0 - drop / self.slip_elongation).clamp(-1.0, 1.0)
    }

    #[must_use]
    pub fn place(&self) -> ContactPlace {
        self.place
    }
}

/// `sum_h Re U_h exp(i h theta)` over odd h.
fn value(u: &[C], theta: f64) -> f64 {
    let (mut turn, step) = (C::from_polar(1.0, theta), C::from_polar(1.0, 2.0 * theta));
    let mut sum = 0.0;
    for c in u {
        sum += (c * turn).re;
        turn *= step;
    }
    sum
}

impl<'a> Sector<'a> {
    fn new(disk: &'a BladedDisk, wave: NodalDiameter) -> Result<Self, DiskError> {
        let [contacts] = disk.friction.as_slice() else { return Err(DiskError::NotOneGroup) };
        if !disk.tuned().is_cyclic()? || contacts.sectors.is_some() {
            return Err(DiskError::NotOneGroup);
        }
        let chain = disk.tuned().chain()?;
        let element = chain.jenkins()[0];
        Ok(Self {
            disk,
            wave,
            mass: (0..disk.oscillators_per_sector()).map(|a| chain.mass()[a * disk.sectors]).collect(),
            stiffness: chain.stiffness().clone(),
            damping: chain.total_damping(),
            slip_force: element.slip_force,
            slip_elongation: 1.0 / element.normalised_stiffness(),
            place: contacts.place,
        })
    }

    /// `c_h`: elongation of a contact per motion of the oscillators of its sector.
    fn direction(&self, harmonic: usize) -> DVector<C> {
        let mut c = DVector::zeros(self.mass.len());
        c[0] = C::from(1.0);
        match self.place {
            ContactPlace::Foot if c.len() > 1 => c[1] = C::from(-1.0),
            ContactPlace::Foot => {}
            ContactPlace::NextBlade => c[0] -= C::from_polar(1.0, -self.wave.multiple(harmonic as i64)),
        }
        c
    }

    /// Motion of the sector per unit force of harmonic h of its contact, `-R Z_h^-1 conj(c_h)`.
    fn response(&self, harmonic: usize, w: f64) -> Option<DVector<C>> {
        let h = harmonic as f64;
        let seen = NodalDiameter::new(self.wave.signed() * harmonic as i64, self.disk.sectors);
        let [k, d] = [&self.stiffness, &self.damping].map(|matrix| self.disk.wave_block(matrix, seen));
        let mut z = k + d * (C::i() * h * w);
        for (a, mass) in self.mass.iter().enumerate() {
            z[(a, a)] -= C::from(h * h * w * w * mass);
        }
        z.lu().solve(&self.direction(harmonic).map(|c| -self.slip_force * c.conj()))
    }

    /// `H_h`, infinite at a resonance without damping.
    fn compliance(&self, harmonic: usize, w: f64) -> C {
        self.response(harmonic, w).map_or(C::from(f64::INFINITY), |x| -self.direction(harmonic).dot(&x))
    }

    /// `1 + H_1 N(a)` made regular, `1/H_1(w) + N(a)` with N the force per elongation of a harmonic motion of amplitude a.
    fn balance(&self, amplitude: f64, w: f64) -> C {
        let e = self.slip_elongation;
        let tau = if amplitude > e { (1.0 - 2.0 * e / amplitude).acos() } else { PI };
        let in_phase = (2.0 * tau - (2.0 * tau).sin()) / (2.0 * PI * e);
        C::new(in_phase, tau.sin().powi(2) / (PI * e)) + 1.0 / self.compliance(1, w)
    }

    /// Amplitude and angular frequency by the describing function: the frequency from the real part for every amplitude, and the first
    /// amplitude at which friction balances the air.
    fn describing_function(&self) -> Result<(f64, f64), DiskError> {
        let e = self.slip_elongation;
        let lowest = |modes: Vec<crate::model::TunedMode>| {
            modes.into_iter().find(|mode| mode.wave == self.wave).map(|mode| mode.mode.angular_frequency)
        };
        let no_wave = || DiskError::NoWave { wave: self.wave.signed(), amplitude: LARGEST_AMPLITUDE * e };
        let mut w = lowest(self.disk.tuned_modes(true)?).ok_or_else(no_wave)?;
        let mut at = |a: f64| {
            w = self.frequency(a, w)?;
            Some((self.balance(a, w).im, w))
        };
        let (mut low, mut high) = (e * (1.0 + 1e-9), e);
        let start = at(low).ok_or_else(no_wave)?.0;
        // Below the slip limit only the air acts: a wave it damps has no cycle that grows out of rest.
        if start >= 0.0 {
            return Err(no_wave());
        }
        while high < LARGEST_AMPLITUDE * e {
            high = if high > e { high * 1.05 } else { 1.05 * e };
            if at(high).ok_or_else(no_wave)?.0 > 0.0 {
                break;
            }
            low = high;
        }
        if high >= LARGEST_AMPLITUDE * e {
            return Err(no_wave());
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if at(middle).ok_or_else(no_wave)?.0 < 0.0 { low = middle } else { high = middle }
        }
        let (_, w) = at(high).ok_or_else(no_wave)?;
        Ok((high, w))
    }

    /// Angular frequency at which the real part of the balance vanishes, by the secant method from a neighbour.
    fn frequency(&self, amplitude: f64, near: f64) -> Option<f64> {
        let real = |w: f64| self.balance(amplitude, w).re;
        let (mut a, mut b) = (near, near * (1.0 + 1e-4));
        let (mut fa, mut fb) = (real(a), real(b));
        for _ in 0..MOST_STEPS {
            if (fb - fa).abs() == 0.0 || (b - a).abs() <= 1e-15 * b {
                break;
            }
            let next = b - fb * (b - a) / (fb - fa);
            (a, fa) = (b, fb);
            (b, fb) = (next, real(next));
        }
        (b.is_finite() && b > 0.0 && fb.abs() < 1e-9 * (1.0 + 1.0 / self.slip_elongation)).then_some(b)
    }
}

/// Harmonic balance of the elongation.
struct Balance<'a, 's> {
    sector: &'s Sector<'a>,
    u: Vec<C>,
    tau: f64,
    /// `int_0^tau exp(i m theta) dtheta` for even m from `-2 h_max` to `2 h_max`.
    powers: Vec<C>,
}

impl Balance<'_, '_> {
    /// Newton's method on the two real equations of the fundamental, with the higher harmonics brought into balance at every step.
    fn solve(&mut self, amplitude: f64, w: f64) -> Result<f64, DiskError> {
        let (mut a, mut w) = (amplitude, w);
        let wave = self.sector.wave.signed();
        let mut residual = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let here = self.fundamental(a, w)?;
            residual = here.norm() / a;
            if residual < RESIDUAL {
                return Ok(w);
            }
            let step = 1e-6;
            let by_a = (self.fundamental(a + step, w)? - here) / step;
            let by_w = (self.fundamental(a, w + step)? - here) / step;
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
    fn forces(&mut self) -> Result<Vec<C>, DiskError> {
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
    fn falls(&self) -> bool {
        let values = (0..=128).map(|n| value(&self.u, PI * f64::from(n) / 128.0));
        values.clone().zip(values.skip(1)).all(|(before, after)| after < before)
    }

    fn wave(mut self, w: f64) -> TravellingWave {
        let forces = self.forces().unwrap_or_default();
        let size = self.sector.mass.len();
        let harmonics: Vec<DVector<C>> = forces
            .iter()
            .enumerate()
            .map(|(k, f)| self.sector.response(2 * k + 1, w).map_or(DVector::zeros(size), |x| x * *f))
            .collect();
        let blade: Vec<C> = harmonics.iter().map(|x| x[0]).collect();
        TravellingWave {
            wave: self.sector.wave,
            angular_frequency: w,
            amplitude: largest(&blade),
            elongation: value(&self.u, 0.0),
            sticking_angle: self.tau,
            harmonics,
            slip_elongation: self.sector.slip_elongation,
            place: self.sector.place,
            contact: self.u,
        }
    }
}

/// Largest value of a function with odd harmonics: the best of a grid, then Newton's method on the derivative.
fn largest(x: &[C]) -> f64 {
    let nodes = 64;
    let grid = (0..nodes).map(|n| 2.0 * PI * f64::from(n) / f64::from(nodes));
    let mut theta = grid.max_by(|a, b| value(x, *a).total_cmp(&value(x, *b))).unwrap_or(0.0);
    let derivative = |times: u32| -> Vec<C> {
        x.iter().enumerate().map(|(k, c)| c * (C::i() * (2 * k + 1) as f64).powu(times)).collect()
    };
    let (slope, curvature) = (derivative(1), derivative(2));
    for _ in 0..20 {
        let step = value(&slope, theta) / value(&curvature, theta);
        if !(step.abs() < 0.2) {
            break;
        }
        theta -= step;
    }
    value(x, theta)
}
