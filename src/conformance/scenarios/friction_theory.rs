//! What theory predicts of a Jenkins element made by Rapier's own means: kt = 1, R = 1, slider mass ms, substep `d = h/n`, and for contacts
//! the compliance `q = kt d^2/ms`: Rapier moves a
//! touching body with the friction impulse of the substep before, so that each increase dF of the load moves the slider by dF d^2/ms.
//!
//! ```text
//! loop area        4 (a - (1 + q)) without a slider body;  with one, see `slider_body`, less 4 q
//! largest force    1 + v_c sqrt(ms),   v_c the speed at the corner
//! held by F        slider moves F q/(1 + q);    joint friction creeps by F/(ms d wJ^2), wJ = 2 pi 1e6;    limited motor by F/1e6
//! stick            angular frequency sqrt(1 + 1/(1 + q));    on a spring joint sqrt(2 - (e/(1 + e))^2), see `lag`;    ride  1/sqrt(1 + ms/(1 - ms))
//! ```

use crate::conformance::linear_mechanisms::{Oscillator, damping_error};
use crate::conformance::native_friction::{self, AMPLITUDE, HELD_FORCE, HOLDING_TIME, Hysteresis, Making, RIDING_TIME};
use crate::conformance::slider_body;
use crate::conformance::{Basis, Configuration, Judgement, RIGHT, Row, Subject};
use crate::engine::Joints;
use crate::engine::mechanism::{ElementSpring, FrictionMechanism, LinearMechanism};
use std::f64::consts::TAU;

/// Softness of a multibody joint, which its friction shares: Rapier's default natural frequency of 1e6.
const JOINT_FREQUENCY: f64 = TAU * 1e6;
/// Force per speed with which a limited motor holds.
const HOLDING_DAMPING: f64 = 1e6;

/// A slip phase of the driven element, in time units: from a corner to the next reversal.
const SLIP_PHASE: f64 = TAU / 4.0;

/// How a slider's own oscillation ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ringing {
    /// Stays below the motion.
    Small,
    /// Grows to about its size: what is measured depends on how it started.
    Undecided,
    /// Grows beyond it.
    Tears,
}

/// What is expected of an element at a step, see the head of this file.
pub(super) struct Theory {
    making: Making,
    configuration: Configuration,
    pub step: f64,
    /// Zero without a slider body.
    slider_mass: f64,
    /// `q`, zero but for contacts.
    compliance: f64,
}

impl Theory {
    pub fn of(making: Making, configuration: Configuration, step: f64) -> Self {
        let slider_mass = if making.mechanism.has_slider_body() { making.slider_mass } else { 0.0 };
        let substep = step / configuration.substeps as f64;
        let compliance = match making.mechanism {
            FrictionMechanism::CoulombContact | FrictionMechanism::SimplifiedContact => substep * substep / slider_mass,
            _ => 0.0,
        };
        Self { making, configuration, step, slider_mass, compliance }
    }

    fn substep(&self) -> f64 {
        self.step / self.configuration.substeps as f64
    }

    /// Rate at which the slider's own oscillation on its spring grows: a hooked spring held over n substeps has the damping
    /// `-ws^2 h (1 - (n + 1)/(2 n))` with `ws^2 = kt/ms`, and nothing but slip takes energy out of it.
    fn ringing_growth(&self) -> f64 {
        if self.slider_mass == 0.0 || self.making.spring != ElementSpring::Hook {
            return 0.0;
        }
        let n = self.configuration.substeps as f64;
        0.5 * self.step / self.slider_mass * (1.0 - (n + 1.0) / (2.0 * n))
    }

    /// What becomes of the ringing, at first about as large as the slider's mass times the motion, 1e-3 of it or more, while the carriage rides on its
    /// element.
    pub fn ringing(&self) -> Ringing {
        let growth = self.ringing_growth() * RIDING_TIME;
        if growth > 1e6_f64.ln() {
            Ringing::Tears
        } else if growth > 1e3_f64.ln() {
            Ringing::Undecided
        } else {
            Ringing::Small
        }
    }

    /// `e = d^2/ms` of a slider that its joint holds, on a spring joint: the spring joint is solved with the slider's mass behind it, which takes
    /// the part `e/(1 + e)` off its damping and off the force that makes the slider creep.
    fn lag(&self) -> f64 {
        let held = matches!(self.making.mechanism, FrictionMechanism::LimitedMotor | FrictionMechanism::JointFriction);
        if held && self.making.spring == ElementSpring::SpringJoint {
            self.substep().powi(2) / self.slider_mass
        } else {
            0.0
        }
    }

    /// Whether steps resolve the slider's own oscillation on its spring joint, as what is said of its slip assumes.
    pub fn resolves_the_slider(&self) -> bool {
        self.lag() < 0.1
    }

    /// Whether the way a contact yields in a substep of a motion of size 0.5 is less than half a spacing of the slider's stored position,
    /// which is near -4: then it does not yield at all, and its slider does not move.
    pub fn yielding_is_lost(&self) -> bool {
        let force_per_time = HELD_FORCE * std::f64::consts::SQRT_2;
        self.compliance > 0.0
            && force_per_time * self.substep() * self.compliance < 4.0 * self.configuration.unit_roundoff()
    }

    /// Position and time of the corner after the lower reversal.
    fn corner(&self) -> (f64, f64) {
        let position = (2.0 * (1.0 + self.compliance) - AMPLITUDE).min(AMPLITUDE);
        (position, (position / AMPLITUDE).asin())
    }

    /// By how much a slider body exceeds the slip force.
    fn overshoot(&self) -> f64 {
        let (position, _) = self.corner();
        (AMPLITUDE * AMPLITUDE - position * position).sqrt() * self.slider_mass.sqrt()
    }

    /// Area of the loop, and how far off it may be, where no difference equation is known.
    fn loop_area(&self) -> (f64, f64) {
        let massless = native_friction::EXACT_LOOP_AREA;
        let yielding = 4.0 * self.compliance;
        let coarse = 4.0 * self.step * self.step;
        if self.slider_mass == 0.0 {
            return (massless - yielding, coarse);
        }
        let area = slider_body::loop_area(AMPLITUDE, self.slider_mass);
        // A spring joint damps the ringing at the rate kt d/(2 ms). It takes from the area no more than this part of
        // what ringing adds.
        let damped = 1.0 - (-0.5 * self.substep() / self.slider_mass * SLIP_PHASE).exp();
        // What yields is loaded by the overshoot too.
        (area - yielding, damped * (area - massless) + yielding * self.overshoot() + coarse)
    }

    /// `map` is the same motion by the difference equation, where one is known.
    pub fn hysteresis_rows(&self, at: &Subject, found: &Hysteresis, map: Option<&Hysteresis>) -> Vec<Row> {
        let exact = native_friction::EXACT_LOOP_AREA;
        let coarse = 4.0 * self.step * self.step;
        // The corner of an element without mass, and the time in which a slider of its own frequency 1/sqrt(ms) gets going.
        let inertia = 2.0 * self.slider_mass.sqrt() + 2.0 * self.step;
        let late =
            self.corner().1 - (2.0 - AMPLITUDE).atan2((AMPLITUDE * AMPLITUDE - (2.0 - AMPLITUDE).powi(2)).sqrt());
        // The slider is damped or driven by its spring's mechanism, by the part ws d within a period of its ringing.
        let within = 0.1 + self.substep() / self.slider_mass.sqrt().max(self.substep());
        let overshoot = self.overshoot();
        let largest = judged(at, "largest_force", 1.0 + overshoot, found.largest_force, within * overshoot + coarse);
        let mut rows = vec![largest.against(1.0, RIGHT)];
        let of_cycle = |quantity: &str, exact: f64, limit: f64, number: fn(&Hysteresis) -> f64, formula: (f64, f64)| {
            let row = match map {
                Some(map) => self.mapped(at, quantity, exact, number(found), number(map)),
                None => judged(at, quantity, formula.0, number(found), formula.1),
            };
            row.against(exact, limit)
        };
        rows.push(of_cycle("loop_area", exact, RIGHT * exact, |h| h.loop_area, self.loop_area()));
        let mean = (1.0, 0.5 * overshoot + coarse);
        rows.push(of_cycle("mean_slip_force", 1.0, RIGHT, |h| h.slip_force[0], mean));
        let delays = [
            ("slip_start_delay", late, found.slip_start_delay, map.map(|map| map.slip_start_delay)),
            ("slip_stop_delay", 0.0, found.slip_stop_delay, map.map(|map| map.slip_stop_delay)),
        ];
        for (quantity, expected, delay, map) in delays {
            if map.is_none() && self.ringing_growth() * SLIP_PHASE > 1.0 {
                let reason = "no delay is predicted: the slider's ringing grows several times over within a slip phase";
                rows.push(at.not_run(quantity, reason));
                continue;
            }
            rows.push(match (delay, map) {
                (Some(delay), Some(Some(map))) => self.delayed(at, quantity, delay, map),
                (Some(delay), _) => judged(at, quantity, expected, delay, inertia),
                (None, _) => at.failed(quantity, "the slider never slips"),
            });
            if let Some(row) = rows.pop() {
                rows.push(row.against(0.0, RIGHT * TAU / 4.0));
            }
        }
        rows
    }

    /// A row about a number of the cycle that the difference equation gives.
    fn mapped(&self, at: &Subject, quantity: &str, exact: f64, found: f64, expected: f64) -> Row {
        let roundoff = 1e3 * at.configuration.unit_roundoff();
        let tolerance = (1e-3 + roundoff) * exact.abs() + 0.02 * (expected - exact).abs();
        let limit = match quantity {
            "loop_area" => format!(" ({:.5} for small steps)", slider_body::loop_area(AMPLITUDE, self.slider_mass)),
            _ => String::new(),
        };
        let reason = format!(
            "the difference equation of the slider{limit}; tolerance: 0.1 %, for creep and rounding, and 2 % of the \
             predicted error, for contacts that are solved by iteration; right: within 1 %"
        );
        at.row(quantity, Judgement { basis: Basis::DifferenceEquation, expected, found, tolerance, reason })
    }

    fn delayed(&self, at: &Subject, quantity: &str, found: f64, expected: f64) -> Row {
        let reason = "the difference equation of the slider; tolerance: a step and a half, as times are told in whole \
                      steps; right: within 1 %";
        let (basis, tolerance) = (Basis::DifferenceEquation, 1.5 * self.step);
        at.row(quantity, Judgement { basis, expected, found, tolerance, reason: reason.to_owned() })
    }

    pub fn hold_rows(&self, at: &Subject, found: native_friction::Hold) -> Vec<Row> {
        let creep = match self.making.mechanism {
            FrictionMechanism::LimitedMotor => HELD_FORCE / HOLDING_DAMPING,
            FrictionMechanism::JointFriction => {
                HELD_FORCE / (self.slider_mass * self.substep() * JOINT_FREQUENCY.powi(2))
            }
            _ => 0.0,
        };
        // On an impulse joint the slider's position is stored in space, near -4, and less than half a spacing a substep is lost.
        let half_spacing = 4.0 * self.configuration.unit_roundoff();
        let lost = self.configuration.joints == Joints::Impulse && creep * self.substep() < half_spacing;
        let creep = if lost { 0.0 } else { creep / (1.0 + self.lag()) };
        let settled = HELD_FORCE * self.compliance / (1.0 + self.compliance) + 0.5 * HOLDING_TIME * creep;
        // Positions are stored with the rest position of the slider, at -4: spacing 4 eps. Below 1e-8 creep takes 1e6 time units
        // for 1 % of the slip displacement.
        let resolution = 16.0 * self.configuration.unit_roundoff();
        let row = |quantity: &str, expected: f64, found: f64, limit: f64| {
            let row = judged(at, quantity, expected, found, 0.02 * expected + resolution + 1e-8).against(0.0, limit);
            // What is predicted to be there, but could be lost in rounding altogether, is neither confirmed nor refuted.
            let hidden = expected > 0.0 && expected < 2.0 * resolution;
            if hidden {
                row.unresolved(&format!("{expected:.1e} is predicted, roundings are {resolution:.1e}"))
            } else {
                row
            }
        };
        vec![
            row("held_displacement", settled, found.settled, RIGHT),
            row("creep_rate", creep, found.creep_rate, RIGHT / 1e3),
        ]
    }

    pub fn stick_frequency(&self) -> f64 {
        let lagging = self.lag() / (1.0 + self.lag());
        (1.0 + 1.0 / (1.0 + self.compliance) - lagging * lagging).sqrt()
    }

    pub fn stick_frequency_tolerance(&self) -> f64 {
        // The step itself shifts frequencies by (w h)^2/3 at most, with w^2 = 2; the slider's inertia by its compliance squared.
        0.02 * self.compliance / 4.0 + self.compliance * self.compliance + 2.0 * self.step * self.step + 1e-6
    }

    /// Half of the stiffness is the carriage's hooked spring, half is the element's.
    pub fn stick_damping(&self) -> f64 {
        let unit = Oscillator::unit();
        let of = |mechanism| damping_error(mechanism, unit, self.step, self.configuration.substeps);
        let native = match (self.making.mechanism, self.making.spring) {
            (FrictionMechanism::SaturatingMotor, _) => true,
            (FrictionMechanism::Hook, _) => false,
            (_, spring) => spring == ElementSpring::SpringJoint,
        };
        of(LinearMechanism::Hook)
            + if native { of(LinearMechanism::SpringJoint) / (1.0 + self.lag()) } else { of(LinearMechanism::Hook) }
    }

    pub fn stick_damping_tolerance(&self) -> f64 {
        // A contact's slider on a spring joint lags too, by no more than a held one would.
        let known = self.slider_mass == 0.0 || self.lag() > 0.0;
        let lag = if known { 0.0 } else { self.substep().powi(2) / self.slider_mass.max(self.substep()) };
        0.02 * self.step + (self.compliance + lag) * self.step + 4e-6
    }

    /// The slider rides on its spring: its effective mass is ms/(1 - ms).
    pub fn ride_frequency(&self) -> (f64, f64) {
        let expected = 1.0 / (1.0 + self.slider_mass / (1.0 - self.slider_mass)).sqrt();
        // 3e-5 for the rest of stick; without a slider body a spring that saturates keeps its stiffness near x = 0, 2 R/(pi a).
        let stick = if self.making.mechanism == FrictionMechanism::SaturatingMotor { 1e-3 } else { 3e-5 };
        (expected, 0.02 * (1.0 - expected) + stick + self.step * self.step)
    }
}

/// A row against a formula.
pub(super) fn judged(at: &Subject, quantity: &str, expected: f64, found: f64, tolerance: f64) -> Row {
    let reason = "2 % of the formula, and the next orders in step and slider mass; right: within 1 %".to_owned();
    at.row(quantity, Judgement { basis: Basis::Formula, expected, found, tolerance, reason })
}
