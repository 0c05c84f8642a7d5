//! A Jenkins element (stiffness kt = 1, slip force R = 1) by each mechanism that Rapier has; motions in
//! [`crate::conformance::native_friction`].

use super::friction_theory::{Ringing, Theory, judged};
use crate::conformance::experiment::ROUNDINGS;
use crate::conformance::ladder::rounding_floor;
use crate::conformance::native_friction::{self, Making, Threefold, Twofold};
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{Basis, Configuration, ConformanceError, Judgement, Mechanism, RIGHT, Row, Subject, Verdict};
use crate::engine::mechanism::{ElementSpring, FrictionMechanism};
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
            let map = native_friction::predicted_hysteresis(making, settings)?;
            rows.extend(at.rows("loop_area", native_friction::hysteresis(bench, making, settings), |h| {
                let mut rows = theory.hysteresis_rows(&at, &h, map.as_ref());
                if !theory.resolves_the_slider() {
                    rows.iter_mut().for_each(only_told);
                }
                rows
            }));
            rows.extend(
                at.rows("creep_rate", native_friction::hold(bench, making, settings), |h| theory.hold_rows(&at, h)),
            );
            rows.extend(at.rows("stick_frequency", native_friction::stick(bench, making, settings), |found| {
                stick_rows(&at, &theory, found)
            }));
            rows.extend(ride_rows(&at, &theory, native_friction::ride(bench, making, settings)));
            rows.extend(at.rows("third_maximum", native_friction::decay(bench, making, settings), |decay| {
                vec![predicted(&at, "third_maximum", decay)]
            }));
        }
        Ok(rows)
    }
}

/// Frequency and damping of a carriage whose element sticks.
fn stick_rows(at: &Subject, theory: &Theory, (found, map): Twofold) -> Vec<Row> {
    let exact = 2f64.sqrt();
    let frequency = (theory.stick_frequency(), theory.stick_frequency_tolerance());
    let damping = (theory.stick_damping(), theory.stick_damping_tolerance());
    let [of_frequency, of_damping] = [map.map(|map| map.angular_frequency), map.map(|map| map.damping)];
    let rows = [
        oscillation_row(at, "stick_frequency", found.angular_frequency, of_frequency, frequency)
            .against(exact, RIGHT * exact),
        oscillation_row(at, "stick_damping", found.damping, of_damping, damping)
            .against(0.0, 2.0 * RIGHT / (10.0 * TAU)),
    ];
    rows.into_iter().map(|row| if theory.yielding_is_lost() { row.unresolved(LOST) } else { row }).collect()
}

const LOST: &str = "in this precision the contact's yielding per substep is lost in rounding";

/// Against the difference equation, or, where none is known, against a formula with its tolerance.
fn oscillation_row(at: &Subject, quantity: &str, found: f64, map: Option<f64>, formula: (f64, f64)) -> Row {
    // Rounding of the motion over its length: positions are stored at every substep.
    let substep = at.dt.unwrap_or(1.0) / at.configuration.substeps as f64;
    let floor = rounding_floor(at.configuration, 1.0, native_friction::RIDING_TIME, substep);
    let rounding = ROUNDINGS * floor / native_friction::RIDING_TIME;
    let Some(expected) = map else { return judged(at, quantity, formula.0, found, formula.1 + rounding) };
    // Held sliders creep by up to 4e-6 of the force per unit of time (joint friction at the finest step). Without a slider body nothing creeps.
    let bodiless = matches!(at.configuration.mechanism, Mechanism::Hook | Mechanism::SaturatingMotor);
    let creep = if bodiless { 0.0 } else { 8e-6 };
    let tolerance = creep + rounding;
    let reason = if bodiless {
        "the difference equation; tolerance: rounding; right: within 1 %"
    } else {
        "the difference equation of the slider; tolerance: creep of a held slider, 4e-6 on either side, and rounding; right: within 1 %"
    };
    let (basis, reason) = (Basis::DifferenceEquation, reason.to_owned());
    at.row(quantity, Judgement { basis, expected, found, tolerance, reason }).with_floor(floor)
}

/// Frequency of a carriage that takes its light slider with it, or, where the slider's own ringing is bound to grow, whether the ride is lost.
fn ride_rows(at: &Subject, theory: &Theory, ride: Result<Twofold, ConformanceError>) -> Vec<Row> {
    let (expected, tolerance) = theory.ride_frequency();
    if theory.ringing() == Ringing::Undecided {
        let reason = "nothing is predicted: the ringing of the slider grows to about the size of the motion";
        return vec![at.not_run("ride_frequency", reason)];
    }
    if theory.ringing() == Ringing::Small {
        return at.rows("ride_frequency", ride, |found| {
            let (found, map) = found;
            let map = map.map(|map| map.angular_frequency);
            vec![
                oscillation_row(at, "ride_frequency", found.angular_frequency, map, (expected, tolerance))
                    .against(1.0, RIGHT),
            ]
        });
    }
    let survives = ride.is_ok_and(|(found, _)| (found.angular_frequency - expected).abs() <= tolerance);
    let reason = "1 if the carriage keeps its frequency; lost, since the ringing of a slider on a hooked spring, held over several substeps, \
                  grows by more than a million";
    let found = f64::from(u8::from(survives));
    let judgement =
        Judgement { basis: Basis::Formula, expected: 0.0, found, tolerance: 0.0, reason: reason.to_owned() };
    let row = at.row("ride_survives", judgement).against(1.0, 0.0);
    vec![if theory.yielding_is_lost() { row.unresolved(LOST) } else { row }]
}

/// A measurement that failed is a failed row. Rapier's refusals are not run.
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

/// Amplitude and frequency of the two-mass rig against the exact, stable limit cycle at xi1 = -0.03.
fn limit_cycle_rows(at: &Subject, bench: &dyn Bench, making: Making, step: f64) -> Result<Vec<Row>, ConformanceError> {
    let parameters = RigParameters { xi1: -0.03, ..RigParameters::default() };
    let orbit = limit_cycle(parameters, |p| Ok(TwoMassFlow::new(&TwoMassRig::new(p)?)))?;
    let scheme = if at.configuration.substeps == 1 { Scheme::SecondOrder } else { Scheme::Plain };
    let settings = Configuration { scheme, ..at.configuration }.settings(step);
    let measured = native_friction::two_mass(bench, making, parameters, &orbit, settings);
    if making.mechanism == FrictionMechanism::SaturatingMotor {
        return Ok(vec![divergence_row(at, &measured)]);
    }
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

/// Without hysteresis nothing takes out the energy that the excitation feeds in.
fn divergence_row<T>(at: &Subject, measured: &Result<T, ConformanceError>) -> Row {
    let found = f64::from(u8::from(matches!(measured, Err(ConformanceError::Diverged { .. }))));
    let reason = "1 if the motion grows without bound: a force that is a function of position does no work in a cycle"
        .to_owned();
    at.row("limit_cycle_diverges", Judgement { basis: Basis::Formula, expected: 1.0, found, tolerance: 0.0, reason })
        .against(0.0, 0.0)
}

/// Takes the prediction away from a row: its deviation is told, and judged against the truth alone.
fn only_told(row: &mut Row) {
    row.verdict = Verdict::NotRun;
    (row.expected, row.tolerance, row.basis) = (None, None, None);
    "the step does not resolve the slider's own oscillation, (ws d)^2 > 0.1: told, not judged as predicted; right: within 1 %"
        .clone_into(&mut row.reason);
}

/// A row about a motion that the difference equation predicts, or, where none is known, that passes if it is right.
fn predicted(at: &Subject, quantity: &str, number: Threefold) -> Row {
    let Threefold { found, predicted, exact } = number;
    let right = RIGHT * exact.abs();
    let Some(expected) = predicted else {
        let (basis, expected) = (Basis::Exact, exact);
        let reason = "no difference equation is known of a slider body on a spring joint: its deviation is told, not judged as predicted; right: within 1 %";
        let judgement = Judgement { basis, expected, found, tolerance: right, reason: reason.to_owned() };
        let row = at.row(quantity, judgement).against(exact, right);
        return Row { verdict: Verdict::NotRun, expected: None, tolerance: None, basis: None, ..row };
    };
    // A creeping slider (1e-6 of a unit of time) and rounding, a thousandfold for the time over which errors stay in the motion.
    let tolerance = (1e-3 + 1e3 * at.configuration.unit_roundoff()) * exact.abs();
    let reason = "0.1 % of the difference equation, for creep and rounding; right: within 1 %".to_owned();
    let basis = Basis::DifferenceEquation;
    at.row(quantity, Judgement { basis, expected, found, tolerance, reason }).against(exact, right)
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
