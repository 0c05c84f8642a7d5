//! One oscillator with its spring and damper realised by each mechanism that Rapier has; closed forms in
//! [`crate::conformance::linear_mechanisms`].

use crate::conformance::linear_mechanisms::{Oscillator, damping_error, measure, step_map};
use crate::conformance::oscillation::Oscillation;
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{
    Basis, Configuration, ConformanceError, FORMULA_TOLERANCE, Judgement, Mechanism, RIGHT, Row, Subject,
    rounding_floor,
};
use crate::engine::mechanism::LinearMechanism;
use crate::engine::{Joints, Precision, Scheme};
use std::f64::consts::TAU;

/// Numerical damping and frequency of each linear mechanism.
#[derive(Debug, Clone, Copy)]
pub struct MechanismLinear;

const ID: &str = "linear_mechanisms";
/// Steps per period: 1/60, 1/240 and 1/960 of the unit of time, to 1e-5.
const STEPS: [u32; 3] = [377, 1508, 6032];
const DURATION: f64 = 60.0;

const VARIANTS: [(&str, Oscillator); 2] = [
    ("undamped", Oscillator { mass: 1.0, stiffness: 1.0, damping: 0.0 }),
    ("mass 2, damping -0.06", Oscillator { mass: 2.0, stiffness: 2.0, damping: -0.12 }),
];

const MECHANISMS: [(Mechanism, LinearMechanism); 5] = [
    (Mechanism::Hook, LinearMechanism::Hook),
    (Mechanism::MotorForceBased, LinearMechanism::MotorForceBased),
    (Mechanism::MotorAccelerationBased, LinearMechanism::MotorAccelerationBased),
    (Mechanism::SpringJoint, LinearMechanism::SpringJoint),
    (Mechanism::MultibodySpring, LinearMechanism::MultibodySpring),
];

impl Scenario for MechanismLinear {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Springs and dampers by each mechanism"
    }

    fn description(&self) -> &'static str {
        "m x'' + c x' + k x = 0 from x = 1 at rest, 60 time units, spring and damper as force law before each step (hook), joint motor (force or \
         acceleration based), spring joint, or spring of a multibody joint. Measured: damping by the decay of the peaks, frequency. \
         What each gets wrong: the hook with n > 1 substeps pumps energy in, by -ω² h (1 - (n+1)/(2n)), and with one substep is only fast by \
         ω² h²/24; everything of Rapier's own is backward Euler, damps by +ω² h/n and is slow by ω² h²/(3 n²), also with negative \
         damping. An acceleration-based motor takes stiffness and damping per mass. A motor or multibody spring cannot share its axis \
         with another motor."
    }

    fn reference(&self) -> &'static str {
        "closed form of the oscillator; eigenvalues of the step map in closed form"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        let steps = match depth {
            Depth::Quick => STEPS[..2].to_vec(),
            Depth::Full => STEPS.to_vec(),
        };
        let case = |variant: &str, configuration: Configuration| Case {
            scenario: ID.to_owned(),
            variant: variant.to_owned(),
            configuration,
            steps: steps.clone(),
            depth: if is_quick(configuration) { Depth::Quick } else { Depth::Full },
        };
        VARIANTS
            .iter()
            .flat_map(|(variant, _)| configurations().map(|c| case(variant, c)).collect::<Vec<_>>())
            .collect()
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let subject = subject(self, case);
        let known =
            |name: &str| VARIANTS.iter().find(|(variant, _)| *variant == name).map(|(_, oscillator)| *oscillator);
        let oscillator = known(&case.variant).unwrap_or_else(Oscillator::unit);
        let mechanism = MECHANISMS.iter().find(|(word, _)| *word == case.configuration.mechanism).map(|(_, m)| *m);
        let Some(mechanism) = mechanism else {
            return Err(ConformanceError::NoMechanism { mechanism: case.configuration.mechanism.word() });
        };
        if let Err(missing) = mechanism.available_on(case.configuration.joints) {
            return Ok(vec![subject.not_run("damping", &missing.to_string())]);
        }
        let mut rows = Vec::new();
        for &steps in &case.steps {
            let (at, step) = (subject.at(steps, TAU), TAU / f64::from(steps));
            match measure(bench, mechanism, oscillator, case.configuration.settings(step), DURATION)? {
                Some(found) => rows.extend(rows_of(&at, mechanism, oscillator, found)),
                None => rows.push(at.failed("damping", "the motion is no oscillation")),
            }
        }
        Ok(rows)
    }
}

/// Damping against its formula, frequency against the step map.
fn rows_of(at: &Subject, mechanism: LinearMechanism, oscillator: Oscillator, found: Oscillation) -> [Row; 2] {
    let Subject { configuration, dt, .. } = at;
    let step = dt.unwrap_or_default();
    let exact = oscillator.exact();
    let floor = rounding_floor(*configuration, 1.0, DURATION, step);
    // Peaks are found by a parabola, with an error of up to h^4/16; a slope through points each off by e is off by at most 3 e/T.
    let slope = 6.0 * (step.powi(4) / 16.0 + floor) / DURATION;
    let formula = damping_error(mechanism, oscillator, step, configuration.substeps);
    let damping = Judgement {
        basis: Basis::Formula,
        expected: exact.damping + formula,
        found: found.damping,
        tolerance: FORMULA_TOLERANCE * formula.abs() + slope,
        reason: "2 % of the formula for the damping it adds, and what rounding does; right: amplitude within 1 % after ten periods".to_owned(),
    };
    let map = step_map(mechanism, oscillator, step, configuration.substeps);
    // Both ends of the record move by a rounding floor; zeros of the cubic are off by less than h^5.
    let ends = 2.0 * (floor + step.powi(5)) / DURATION;
    let frequency = Judgement {
        basis: Basis::DifferenceEquation,
        expected: map.angular_frequency,
        found: found.angular_frequency,
        tolerance: FORMULA_TOLERANCE * (map.angular_frequency - exact.angular_frequency).abs() + ends,
        reason: "2 % of the shift of the step map, and what rounding does; right: within 1 %".to_owned(),
    };
    [
        at.row("damping", damping).against(exact.damping, 2.0 * RIGHT / (10.0 * TAU)).with_floor(slope),
        at.row("angular_frequency", frequency).against(exact.angular_frequency, RIGHT).with_floor(ends),
    ]
}

fn configurations() -> impl Iterator<Item = Configuration> {
    MECHANISMS.into_iter().flat_map(|(mechanism, _)| {
        [Joints::Impulse, Joints::Multibody].into_iter().flat_map(move |joints| {
            [Precision::Double, Precision::Single].into_iter().flat_map(move |precision| {
                let of =
                    move |substeps| Configuration { precision, joints, mechanism, substeps, scheme: Scheme::Plain };
                [1, 2, 4, 8].into_iter().map(of)
            })
        })
    })
}

fn is_quick(configuration: Configuration) -> bool {
    matches!(configuration.substeps, 1 | 4)
        && (configuration.precision == Precision::Double || configuration.substeps == 4)
}
