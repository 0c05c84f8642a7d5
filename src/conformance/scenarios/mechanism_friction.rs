//! A Jenkins element (stiffness kt = 1, slip force R = 1) by each mechanism that Rapier has; motions in
//! [`crate::conformance::native_friction`].
//!
//! What theory predicts, with the slider mass ms, the substep `d = h/n`, and for contacts the compliance `q = kt d^2/ms`: Rapier moves a
//! touching body with the friction impulse of the substep before, so that each increase dF of the load moves the slider by dF d^2/ms.
//!
//! ```text
//! loop area        4 (a - (1 + q)),  and up to 4 v_c sqrt(ms) of ringing,   v_c the speed at the corner
//! largest force    1 + v_c sqrt(ms)
//! held by F        slider moves F q/(1 + q);    joint friction creeps by F/(ms d wJ^2), wJ = 2 pi 1e6;    limited motor by F/1e6
//! stick            angular frequency sqrt(1 + 1/(1 + q));    ride  1/sqrt(1 + ms/(1 - ms))
//! ```

use crate::conformance::linear_mechanisms::{Oscillator, damping_error};
use crate::conformance::native_friction::{self, AMPLITUDE, HELD_FORCE, HOLDING_TIME, Making, Threefold};
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{Basis, Configuration, ConformanceError, Judgement, Mechanism, RIGHT, Row, Subject};
use crate::engine::mechanism::{ElementSpring, FrictionMechanism, LinearMechanism};
use crate::engine::{EngineError, Joints, Precision, Scheme};
use crate::exact::TwoMassFlow;
use crate::model::{RigParameters, TwoMassRig};
use crate::orbit::limit_cycle;
use std::f64::consts::TAU;

/// Jenkins elements made of Rapier's own friction.
#[derive(Debug, Clone, Copy)]
pub struct MechanismFriction;

const ID: &str = "native_friction";
const STEPS: [u32; 3] = [377, 1508, 6032];
/// Softness of a multibody joint, which its friction shares: Rapier's default natural frequency of 1e6.
const JOINT_FREQUENCY: f64 = TAU * 1e6;
/// Force per speed with which a limited motor holds.
const HOLDING_DAMPING: f64 = 1e6;

/// Prefix of the variants on the two-mass rig, which take long.
const ON_THE_RIG: &str = "limit cycle ";

const VARIANTS: [(&str, f64, ElementSpring); 4] = [
    ("slider 0.01, spring as hook", 0.01, ElementSpring::Hook),
    ("slider 0.001, spring as hook", 0.001, ElementSpring::Hook),
    ("slider 0.01, spring joint", 0.01, ElementSpring::SpringJoint),
    ("slider 0.001, spring joint", 0.001, ElementSpring::SpringJoint),
];

const MECHANISMS: [(Mechanism, FrictionMechanism); 6] = [
    (Mechanism::Hook, FrictionMechanism::Hook),
    (Mechanism::SaturatingMotor, FrictionMechanism::SaturatingMotor),
    (Mechanism::LimitedMotor, FrictionMechanism::LimitedMotor),
    (Mechanism::JointFriction, FrictionMechanism::JointFriction),
    (Mechanism::CoulombContact, FrictionMechanism::CoulombContact),
    (Mechanism::SimplifiedContact, FrictionMechanism::SimplifiedContact),
];

impl Scenario for MechanismFriction {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Jenkins element by each mechanism"
    }

    fn description(&self) -> &'static str {
        "A spring (1) and a dry-friction slider (slip force 1) in series: as force law; as motor of limited force without a slider; as slider body \
         held by a motor of limited force, by joint friction, or by Coulomb contact. Measured: loop area, forces and switching times \
         under x = 1.5 sin t, motion of a slider that should stick, frequencies in stick and slip, decay, limit cycle at ξ1 = -0.03. \
         What each gets wrong: a saturating motor has no hysteresis at all; a slider body adds its mass in slip, overshoots the slip force and \
         rings (with a hooked spring and several substeps ever louder); a contact gives way in stick by F d²/ms; a limited motor creeps at \
         F/c, joint friction at F/(ms d ωJ²)."
    }

    fn reference(&self) -> &'static str {
        "closed forms of the Jenkins element, exact flow of the chain, exact limit cycle by shooting"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        let steps = match depth {
            Depth::Quick => STEPS[..2].to_vec(),
            Depth::Full => STEPS.to_vec(),
        };
        let mut cases = Vec::new();
        for (mechanism, friction) in MECHANISMS {
            let variants = if friction.has_slider_body() { &VARIANTS[..] } else { &VARIANTS[..1] };
            for (variant, _, _) in variants {
                let variant = if friction.has_slider_body() { *variant } else { "" };
                for configuration in configurations(mechanism) {
                    let once = is_quick(configuration);
                    let quick = once && !variant.ends_with("joint");
                    let mut add = |variant: String, steps: &[u32], quick: bool| {
                        let depth = if quick { Depth::Quick } else { Depth::Full };
                        cases.push(Case {
                            scenario: ID.to_owned(),
                            variant,
                            configuration,
                            steps: steps.to_vec(),
                            depth,
                        });
                    };
                    add(variant.to_owned(), &steps, quick);
                    if once {
                        add(format!("{ON_THE_RIG}{variant}"), &STEPS[..2], false);
                    }
                }
            }
        }
        cases
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let subject = subject(self, case);
        let (_, slider_mass, spring) =
            VARIANTS.into_iter().find(|(variant, ..)| case.variant.ends_with(variant)).unwrap_or(VARIANTS[0]);
        let mechanism = MECHANISMS.iter().find(|(word, _)| *word == case.configuration.mechanism).map(|(_, m)| *m);
        let Some(mechanism) = mechanism else {
            return Err(ConformanceError::NoMechanism { mechanism: case.configuration.mechanism.word() });
        };
        if let Err(missing) = mechanism.available_on(case.configuration.joints) {
            return Ok(vec![subject.not_run("loop_area", &missing.to_string())]);
        }
        let making = Making::new(mechanism, slider_mass, spring);
        let mut rows = Vec::new();
        for &steps in &case.steps {
            let at = subject.at(steps, TAU);
            if case.variant.starts_with(ON_THE_RIG) {
                rows.extend(limit_cycle_rows(&at, bench, making, TAU / f64::from(steps))?);
                continue;
            }
            let theory = Theory::of(making, case.configuration, TAU / f64::from(steps));
            let settings = case.configuration.settings(theory.step);
            rows.extend(at.rows("loop_area", native_friction::hysteresis(bench, making, settings), |h| {
                theory.hysteresis_rows(&at, &h)
            }));
            rows.extend(
                at.rows("creep_rate", native_friction::hold(bench, making, settings), |h| theory.hold_rows(&at, h)),
            );
            rows.extend(at.rows("stick_frequency", native_friction::stick(bench, making, settings), |found| {
                let exact = 2f64.sqrt();
                let frequency = theory.stick_frequency();
                vec![
                    judged(
                        &at,
                        "stick_frequency",
                        frequency,
                        found.angular_frequency,
                        theory.stick_frequency_tolerance(),
                    )
                    .against(exact, RIGHT * exact),
                    judged(
                        &at,
                        "stick_damping",
                        theory.stick_damping(),
                        found.damping,
                        theory.stick_damping_tolerance(),
                    )
                    .against(0.0, 2.0 * RIGHT / (10.0 * TAU)),
                ]
            }));
            rows.extend(at.rows("ride_frequency", native_friction::ride(bench, making, settings), |found| {
                let (expected, tolerance) = theory.ride_frequency();
                vec![judged(&at, "ride_frequency", expected, found.angular_frequency, tolerance).against(1.0, RIGHT)]
            }));
            rows.extend(at.rows("third_maximum", native_friction::decay(bench, making, settings), |decay| {
                vec![predicted(&at, "third_maximum", decay)]
            }));
        }
        Ok(rows)
    }
}

/// A measurement that failed is a failed row: a slider that rings itself to pieces is a result. Rapier's refusals are not run.
trait Rows {
    fn rows<T>(
        &self,
        quantity: &str,
        measured: Result<T, ConformanceError>,
        of: impl FnOnce(T) -> Vec<Row>,
    ) -> Vec<Row>;
}

impl Rows for Subject {
    fn rows<T>(
        &self,
        quantity: &str,
        measured: Result<T, ConformanceError>,
        of: impl FnOnce(T) -> Vec<Row>,
    ) -> Vec<Row> {
        match measured {
            Ok(measured) => of(measured),
            Err(ConformanceError::Engine(missing @ EngineError::Unavailable { .. })) => {
                vec![self.not_run(quantity, &missing.to_string())]
            }
            Err(error) => vec![self.failed(quantity, &error.to_string())],
        }
    }
}

/// What is expected of an element at a step, see the head of this file.
struct Theory {
    making: Making,
    configuration: Configuration,
    step: f64,
    /// Zero without a slider body.
    slider_mass: f64,
    /// `q`, zero but for contacts.
    compliance: f64,
}

impl Theory {
    fn of(making: Making, configuration: Configuration, step: f64) -> Self {
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

    fn hysteresis_rows(&self, at: &Subject, found: &native_friction::Hysteresis) -> Vec<Row> {
        let exact = native_friction::EXACT_LOOP_AREA;
        let area = 4.0 * (AMPLITUDE - 1.0 - self.compliance);
        let ringing = 4.0 * self.overshoot();
        let coarse = 4.0 * self.step * self.step;
        // The corner of an element without mass, and the time in which a slider of its own frequency 1/sqrt(ms) gets going.
        let inertia = 2.0 * self.slider_mass.sqrt() + 2.0 * self.step;
        let late =
            self.corner().1 - (2.0 - AMPLITUDE).atan2((AMPLITUDE * AMPLITUDE - (2.0 - AMPLITUDE).powi(2)).sqrt());
        // The slider is damped or driven by its spring's mechanism, by the part ws d within a period of its ringing.
        let within = 0.1 + self.substep() / self.slider_mass.sqrt().max(self.substep());
        let overshoot = self.overshoot();
        let mut rows = vec![
            judged(at, "loop_area", area, found.loop_area, ringing + coarse).against(exact, RIGHT * exact),
            judged(at, "largest_force", 1.0 + overshoot, found.largest_force, within * overshoot + coarse)
                .against(1.0, RIGHT),
            judged(at, "mean_slip_force", 1.0, found.slip_force[0], 0.5 * overshoot + coarse).against(1.0, RIGHT),
        ];
        for (quantity, expected, delay) in
            [("slip_start_delay", late, found.slip_start_delay), ("slip_stop_delay", 0.0, found.slip_stop_delay)]
        {
            rows.push(match delay {
                Some(delay) => judged(at, quantity, expected, delay, inertia).against(0.0, RIGHT * TAU / 4.0),
                None => at.failed(quantity, "the slider never slips"),
            });
        }
        rows
    }

    fn hold_rows(&self, at: &Subject, found: native_friction::Hold) -> Vec<Row> {
        let creep = match self.making.mechanism {
            FrictionMechanism::LimitedMotor => HELD_FORCE / HOLDING_DAMPING,
            FrictionMechanism::JointFriction => {
                HELD_FORCE / (self.slider_mass * self.substep() * JOINT_FREQUENCY.powi(2))
            }
            _ => 0.0,
        };
        let settled = HELD_FORCE * self.compliance / (1.0 + self.compliance) + 0.5 * HOLDING_TIME * creep;
        // Positions are stored with the rest position of the slider, at -4: spacing 4 eps. Below 1e-8 creep takes 1e6 time units
        // for 1 % of the slip displacement.
        let resolution = 16.0 * self.configuration.unit_roundoff();
        vec![
            judged(at, "held_displacement", settled, found.settled, 0.02 * settled + resolution + 1e-8)
                .against(0.0, RIGHT),
            judged(at, "creep_rate", creep, found.creep_rate, 0.02 * creep + resolution + 1e-8)
                .against(0.0, RIGHT / 1e3),
        ]
    }

    fn stick_frequency(&self) -> f64 {
        (1.0 + 1.0 / (1.0 + self.compliance)).sqrt()
    }

    fn stick_frequency_tolerance(&self) -> f64 {
        // The step itself shifts frequencies by (w h)^2/3 at most, with w^2 = 2; the slider's inertia by its compliance squared.
        0.02 * self.compliance / 4.0 + self.compliance * self.compliance + 2.0 * self.step * self.step + 1e-6
    }

    /// Half of the stiffness is the carriage's hooked spring, half is the element's.
    fn stick_damping(&self) -> f64 {
        let unit = Oscillator::unit();
        let of = |mechanism| damping_error(mechanism, unit, self.step, self.configuration.substeps);
        let native = match (self.making.mechanism, self.making.spring) {
            (FrictionMechanism::SaturatingMotor, _) => true,
            (FrictionMechanism::Hook, _) => false,
            (_, spring) => spring == ElementSpring::SpringJoint,
        };
        of(LinearMechanism::Hook) + if native { of(LinearMechanism::SpringJoint) } else { of(LinearMechanism::Hook) }
    }

    fn stick_damping_tolerance(&self) -> f64 {
        // A spring joint sees the slider's mass behind it while it is solved: (ws d)^2/(1 + (ws d)^2) of its damping.
        let lag = self.substep().powi(2) / self.slider_mass.max(self.substep());
        0.02 * self.step + (self.compliance + lag) * self.step + 4e-6
    }

    /// The slider rides on its spring: its effective mass is ms/(1 - ms).
    fn ride_frequency(&self) -> (f64, f64) {
        let expected = 1.0 / (1.0 + self.slider_mass / (1.0 - self.slider_mass)).sqrt();
        // 3e-5 for the rest of stick; without a slider body a spring that saturates keeps its stiffness near x = 0, 2 R/(pi a).
        let stick = if self.making.mechanism == FrictionMechanism::SaturatingMotor { 1e-3 } else { 3e-5 };
        (expected, 0.02 * (1.0 - expected) + stick + self.step * self.step)
    }
}

/// Amplitude and frequency of the two-mass rig against the exact, stable limit cycle at xi1 = -0.03.
fn limit_cycle_rows(at: &Subject, bench: &dyn Bench, making: Making, step: f64) -> Result<Vec<Row>, ConformanceError> {
    let parameters = RigParameters { xi1: -0.03, ..RigParameters::default() };
    let orbit = limit_cycle(parameters, |p| Ok(TwoMassFlow::new(&TwoMassRig::new(p)?)))?;
    let scheme = if at.configuration.substeps == 1 { Scheme::SecondOrder } else { Scheme::Plain };
    let settings = Configuration { scheme, ..at.configuration }.settings(step);
    let measured = native_friction::two_mass(bench, making, parameters, &orbit, settings);
    Ok(at.rows("limit_cycle_largest_maximum", measured, |(found, map)| {
        let row = |quantity: &str, exact: f64, of: fn(&native_friction::RigMotion) -> f64| {
            predicted(at, quantity, Threefold { found: of(&found), predicted: map.as_ref().map(of), exact })
        };
        vec![
            row("limit_cycle_smallest_maximum", orbit.amplitude(), |motion| motion.maxima[0]),
            row("limit_cycle_largest_maximum", orbit.amplitude(), |motion| motion.maxima[1]),
            row("limit_cycle_angular_frequency", orbit.angular_frequency(), |motion| motion.angular_frequency),
        ]
    }))
}

fn judged(at: &Subject, quantity: &str, expected: f64, found: f64, tolerance: f64) -> Row {
    let reason = "2 % of the formula, and the next orders in step and slider mass; right: within 1 %".to_owned();
    at.row(quantity, Judgement { basis: Basis::Formula, expected, found, tolerance, reason })
}

/// A row about a motion that the difference equation predicts, or, where none is known, that passes if it is right.
fn predicted(at: &Subject, quantity: &str, number: Threefold) -> Row {
    let Threefold { found, predicted, exact } = number;
    let right = RIGHT * exact.abs();
    let (basis, expected, tolerance, reason) = match predicted {
        Some(predicted) => {
            // A creeping slider (1e-6 of a unit of time) and rounding, a thousandfold for the time over which errors stay in the motion.
            let tolerance = (1e-3 + 1e3 * at.configuration.unit_roundoff()) * exact.abs();
            let reason = "0.1 % of the difference equation, for creep and rounding; right: within 1 %";
            (Basis::DifferenceEquation, predicted, tolerance, reason)
        }
        None => (Basis::Exact, exact, right, "no difference equation is known: within 1 % of the truth"),
    };
    at.row(quantity, Judgement { basis, expected, found, tolerance, reason: reason.to_owned() }).against(exact, right)
}

fn configurations(mechanism: Mechanism) -> impl Iterator<Item = Configuration> {
    [Joints::Impulse, Joints::Multibody].into_iter().flat_map(move |joints| {
        [Precision::Double, Precision::Single].into_iter().flat_map(move |precision| {
            let of = move |substeps| Configuration { precision, joints, mechanism, substeps, scheme: Scheme::Plain };
            [1, 4].into_iter().map(of)
        })
    })
}

/// Each mechanism once on joints that have it, in f64.
fn is_quick(configuration: Configuration) -> bool {
    let joints = if configuration.mechanism == Mechanism::JointFriction { Joints::Multibody } else { Joints::Impulse };
    configuration.precision == Precision::Double && configuration.joints == joints
}
