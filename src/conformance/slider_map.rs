//! The difference equation that a Jenkins element made of a slider body amounts to, its spring a force law: what the engine should do,
//! step by step, without the engine.
//!
//! With forces found at the start of a step of n substeps `d = h/n`, and `clamp` to the friction impulse `R d`, a substep is
//!
//! ```text
//! carriages      w += d a,   x += d w
//! dry friction   w_s += d F/ms,   w_s += clamp(-ms w_s)/ms,   s += d w_s
//! contact        w_s += d F/ms + p/ms,   s += d w_s,   p' = clamp(p - ms w_s),   w_s += (p' - p)/ms      p from the substep before
//! saturating     w += clamp(-d kt (x + d w)/(1 + d^2 kt/m))/m
//! ```
//!
//! All in f64, but for one rounding of an f32 engine that does not average out. A saturated motor adds the same `R d/m` substep after substep to
//! a velocity that is a whole number of spacings u, so that it is rounded to `u round(R d/(m u))` each time and in the same sense. On
//! `x = cos t` (m = 1) the spacing is `u_k = 2^-(23 + k)` while `2^-k < |v| < 2^(1 - k)`, and the mean of `F cos t`, which makes the shift of the frequency, has
//! weight 2^-k there:
//!
//! ```text
//! w = 1 + (2 R/pi) sum_k 2^-k u_k round(R d/u_k)/(R d),     and at most 2 u_1/(3 pi d) of it is rounding,  u_1 = 2^-24
//! ```
//!
//! R = 0.001 at 6032 steps of 4 substeps: `R d/u_1 = 4.37` becomes 4, and the sum shifts w by -2.42e-5 (measured: -2.41e-5). The other increments, `d a`
//! and `d w`, change from step to step by many spacings, and their roundings average out.

use super::native_friction::{Driven, Making};
use crate::engine::mechanism::{ElementSpring, FrictionMechanism};
use crate::engine::{EngineSettings, Precision, Scheme};
use crate::model::{OscillatorChain, PrescribedMotion};

/// A chain with an element of stiffness and slip force on oscillator 0.
#[derive(Debug, Clone)]
pub struct SliderMap<'a> {
    pub chain: &'a OscillatorChain,
    pub stiffness: f64,
    pub slip_force: f64,
    pub making: Making,
    pub settings: EngineSettings,
}

/// Where a motion starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    pub positions: Vec<f64>,
    pub velocities: Vec<f64>,
    /// Force in the element.
    pub force: f64,
}

struct Motion {
    x: Vec<f64>,
    w: Vec<f64>,
    before: Vec<f64>,
    slider: f64,
    slider_velocity: f64,
    impulse: f64,
}

impl Motion {
    fn at_rest(x: Vec<f64>) -> Self {
        let still = vec![0.0; x.len()];
        Self { x, w: still.clone(), before: still, slider: 0.0, slider_velocity: 0.0, impulse: 0.0 }
    }
}

impl SliderMap<'_> {
    /// Positions of oscillator 0 after 0, 1, ... `steps` steps; `None` where no difference equation is known: for slider bodies on a spring joint.
    #[must_use]
    pub fn positions(&self, start: &Start, steps: u64) -> Option<Vec<f64>> {
        if !self.is_known() {
            return None;
        }
        let mut motion = Motion {
            w: start.velocities.clone(),
            before: start.velocities.clone(),
            slider: start.positions[0] - start.force / self.stiffness,
            ..Motion::at_rest(start.positions.clone())
        };
        let mut positions = vec![motion.x[0]];
        for _ in 0..steps {
            self.step(&mut motion);
            positions.push(motion.x[0]);
        }
        Some(positions)
    }

    /// With oscillator 0 moved by hand, from a slider without force, after 0, 1, ... `steps` steps. `None` as for
    /// [`Self::positions`], and for a motor that saturates: its force is found from the motion that it is to change.
    #[must_use]
    pub fn driven(&self, prescribed: PrescribedMotion, steps: u64) -> Option<Vec<Driven>> {
        if !self.is_known() || self.making.mechanism == FrictionMechanism::SaturatingMotor {
            return None;
        }
        let d = self.settings.step / self.settings.substeps as f64;
        let x = prescribed.position(0.0);
        let mut motion = Motion { slider: x, ..Motion::at_rest(vec![x]) };
        let mut points = Vec::new();
        for n in 0..=steps {
            motion.x[0] = prescribed.position(n as f64 * self.settings.step);
            self.follow(&mut motion);
            let force = self.stiffness * (motion.x[0] - motion.slider);
            points.push(Driven { x: motion.x[0], slider: motion.slider, force });
            (0..self.settings.substeps).for_each(|_| self.friction(&mut motion, force, d));
        }
        Some(points)
    }

    fn is_known(&self) -> bool {
        !self.making.mechanism.has_slider_body() || self.making.spring == ElementSpring::Hook
    }

    /// The slider of a hook is taken along.
    fn follow(&self, motion: &mut Motion) {
        if self.making.mechanism == FrictionMechanism::Hook {
            let reach = self.slip_force / self.stiffness;
            motion.slider = motion.slider.clamp(motion.x[0] - reach, motion.x[0] + reach);
        }
    }

    fn step(&self, motion: &mut Motion) {
        let d = self.settings.step / self.settings.substeps as f64;
        let lead = if self.settings.scheme == Scheme::Plain { 0.0 } else { 0.5 / self.settings.substeps as f64 };
        let known: Vec<f64> = motion.w.iter().zip(&motion.before).map(|(w, before)| w + lead * (w - before)).collect();
        let mut a = self.chain.acceleration(&motion.x, &known, &[]);
        let force = match self.making.mechanism {
            FrictionMechanism::SaturatingMotor => 0.0,
            _ => self.stiffness * (motion.x[0] - motion.slider),
        };
        a[0] -= force / self.chain.mass()[0];
        motion.before.copy_from_slice(&motion.w);
        for _ in 0..self.settings.substeps {
            for (w, a) in motion.w.iter_mut().zip(a.iter()) {
                *w += d * a;
            }
            self.friction(motion, force, d);
            for (x, w) in motion.x.iter_mut().zip(&motion.w) {
                *x += d * w;
            }
        }
        self.follow(motion);
    }

    fn friction(&self, motion: &mut Motion, force: f64, d: f64) {
        let (limit, ms) = (self.slip_force * d, self.making.slider_mass);
        match self.making.mechanism {
            FrictionMechanism::Hook => {}
            FrictionMechanism::SaturatingMotor => {
                let m = self.chain.mass()[0];
                let wanted = -d * self.stiffness * (motion.x[0] + d * motion.w[0]) / (1.0 + d * d * self.stiffness / m);
                motion.w[0] += self.as_added(wanted.clamp(-limit, limit) / m, motion.w[0]);
            }
            FrictionMechanism::LimitedMotor | FrictionMechanism::JointFriction => {
                motion.slider_velocity += d * force / ms;
                motion.slider_velocity += (-ms * motion.slider_velocity).clamp(-limit, limit) / ms;
                motion.slider += d * motion.slider_velocity;
            }
            FrictionMechanism::CoulombContact | FrictionMechanism::SimplifiedContact => {
                motion.slider_velocity += (d * force + motion.impulse) / ms;
                motion.slider += d * motion.slider_velocity;
                let impulse = (motion.impulse - ms * motion.slider_velocity).clamp(-limit, limit);
                motion.slider_velocity += (impulse - motion.impulse) / ms;
                motion.impulse = impulse;
            }
        }
    }

    /// What an increment becomes when the engine adds it to the number it stores for `to`.
    fn as_added(&self, increment: f64, to: f64) -> f64 {
        match self.settings.precision {
            Precision::Double => increment,
            Precision::Single => {
                let stored = to as f32;
                f64::from(stored + increment as f32) - f64::from(stored)
            }
        }
    }
}
