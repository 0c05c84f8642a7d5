//! What f32 does to the force of a saturated motor. Substep after substep it adds the same impulse `R d` to the velocity, which is a whole number
//! of spacings u: what arrives is `u round(R d/u)`. On `x = cos t` the motor's `F = R sign(x)` shifts the frequency by the mean of `F cos t`, half of which
//! comes from `|v| > 1/2` (u = 2^-24), a quarter from half that speed and half that spacing, and so on:
//!
//! ```text
//! shift in f32 - shift = (2 R/pi) sum_k 2^-k (u_k round(R d/u_k)/(R d) - 1),    u_k = 2^-(23 + k),    k = 1, 2, ...
//! ```

use std::f64::consts::{PI, TAU};
use stickslip::conformance::native_friction::{Making, RIDING_TIME};
use stickslip::conformance::oscillation::Oscillation;
use stickslip::conformance::slider_map::{SliderMap, Start};
use stickslip::conformance::{Configuration, Depth, Rapier, Verdict, registry, rounding_floor};
use stickslip::engine::mechanism::{
    ElementSpring, FrictionElement, FrictionMechanism, MechanismFlow, MechanismRig, MechanismSample,
};
use stickslip::engine::{EngineSettings, Joints, Precision, Scheme};
use stickslip::model::{ChainBuilder, OscillatorChain};

/// Spacing of f32 from 1/2 to 1.
const SPACING: f64 = f32::EPSILON as f64 / 2.0;

/// A carriage of mass 1 on a hooked spring of stiffness 1 and a motor of stiffness 1 and limited force.
#[derive(Clone, Copy)]
struct Ride {
    limit: f64,
    settings: EngineSettings,
}

impl Ride {
    fn new(limit: f64, steps: u32, substeps: usize) -> Self {
        let (precision, joints, scheme) = (Precision::Single, Joints::Impulse, Scheme::Plain);
        Self { limit, settings: EngineSettings { step: TAU / f64::from(steps), substeps, precision, joints, scheme } }
    }

    /// With a limit whose impulse is that many spacings at 1/2 < |v| < 1, at 6032 steps of 4 substeps.
    fn of_spacings(spacings: f64) -> Self {
        Self::new(spacings * SPACING * 6032.0 * 4.0 / TAU, 6032, 4)
    }

    fn on(self, precision: Precision, joints: Joints) -> Self {
        Self { settings: EngineSettings { precision, joints, ..self.settings }, ..self }
    }

    fn substep(self) -> f64 {
        self.settings.step / self.settings.substeps as f64
    }

    fn steps(self) -> u64 {
        (RIDING_TIME / self.settings.step).round() as u64
    }

    fn chain() -> OscillatorChain {
        ChainBuilder::new(vec![1.0]).ground_spring(0, 1.0).build().unwrap()
    }

    fn making() -> Making {
        Making::new(FrictionMechanism::SaturatingMotor, 0.01, ElementSpring::Hook)
    }

    fn frequency_of(self, positions: &[f64]) -> f64 {
        Oscillation::of(positions, self.settings.step).unwrap().angular_frequency
    }

    fn in_engine(self) -> f64 {
        let Making { mechanism, slider_mass, spring, .. } = Self::making();
        let element =
            FrictionElement { carriage: 0, stiffness: 1.0, slip_force: self.limit, mechanism, slider_mass, spring };
        let rig = MechanismRig { friction: Some(element), ..MechanismRig::of(Self::chain()) };
        let start = MechanismSample::at(vec![1.0], vec![0.0], self.limit);
        let motion = MechanismFlow::new(rig, self.settings).unwrap().run(&start, self.steps(), 1).unwrap();
        self.frequency_of(&motion.samples.iter().map(|sample| sample.positions[0]).collect::<Vec<f64>>())
    }

    /// By the difference equation, with increments as they arrive in its precision.
    fn predicted(self) -> f64 {
        let (chain, making, settings) = (Self::chain(), Self::making(), self.settings);
        let map = SliderMap { chain: &chain, stiffness: 1.0, slip_force: self.limit, making, settings };
        let start = Start { positions: vec![1.0], velocities: vec![0.0], force: self.limit };
        self.frequency_of(&map.positions(&start, self.steps()).unwrap())
    }

    /// The sum at the head of this file.
    fn formula(self) -> f64 {
        let impulse = self.limit * self.substep();
        let part = |k: i32| {
            let spacing = SPACING * 2f64.powi(1 - k);
            2f64.powi(-k) * (spacing * (impulse / spacing).round() / impulse - 1.0)
        };
        2.0 * self.limit / PI * (1..50).map(part).sum::<f64>()
    }

    /// What roundings at random do to the frequency, four times their usual size.
    fn at_random(self) -> f64 {
        // In f32.
        4.0 * rounding_floor(Configuration::ENGINE_DEFAULTS, 1.0, RIDING_TIME, self.substep()) / RIDING_TIME
    }
}

#[test]
fn f32_rounds_the_impulse_of_a_saturated_motor_in_the_same_sense_at_every_substep() {
    let ladder = [(1508, 1), (1508, 4), (6032, 1), (6032, 2), (6032, 4), (12_064, 4)];
    let rides = ladder.map(|(steps, substeps)| Ride::new(1e-3, steps, substeps));
    // Just below and above four and a half spacings, 2 % apart: the shift changes its sign.
    let jump = [4.45, 4.55].map(Ride::of_spacings);
    for ride in rides.into_iter().chain(jump) {
        let (found, exact_arithmetic) = (ride.in_engine(), ride.on(Precision::Double, Joints::Impulse).predicted());
        let (formula, random) = (ride.formula(), ride.at_random());
        let what = format!("{:?}: {:e}, formula {formula:e}", ride.settings, found - exact_arithmetic);
        assert!((found - exact_arithmetic - formula).abs() < random, "{what}, {random:e}");
        assert!((found - ride.predicted()).abs() < random, "{what}, predicted {:e}", ride.predicted());
        // Both kinds of joints store the velocity alike.
        let multibody = ride.on(Precision::Single, Joints::Multibody).in_engine();
        assert!((multibody - found).abs() < random, "{what}, on multibody joints {multibody:e}");
    }
    assert!(jump[0].formula() < -2.9e-5 && jump[1].formula() > 2.9e-5);
}

/// Negative controls: the same engine with the same step, where the mechanism says that nothing happens, and the prediction without it.
#[test]
fn nothing_is_lost_of_whole_numbers_of_spacings_nor_in_f64() {
    for ride in [4.0, 5.0].map(Ride::of_spacings) {
        let exact_arithmetic = ride.on(Precision::Double, Joints::Impulse).predicted();
        assert!(ride.formula().abs() < 1e-12, "{:e}", ride.formula());
        assert!((ride.in_engine() - exact_arithmetic).abs() < ride.at_random());
    }
    let ride = Ride::new(1e-3, 6032, 4);
    let double = ride.on(Precision::Double, Joints::Impulse);
    // 16 floors of rounding in f64, 1.2e-15 each.
    assert!((double.in_engine() - double.predicted()).abs() < 2e-14);
    assert!((ride.in_engine() - double.predicted()).abs() > 8.0 * ride.at_random());
}

#[test]
fn the_report_predicts_the_frequency_on_a_saturating_motor_in_f32() {
    let scenario = registry().into_iter().find(|scenario| scenario.id() == "native_friction").unwrap();
    let is_motor = |c: Configuration| {
        c.mechanism.word() == "saturating_motor" && c.precision == Precision::Single && c.substeps == 4
    };
    let cases: Vec<_> = scenario.cases(Depth::Full).into_iter().filter(|case| is_motor(case.configuration)).collect();
    assert_eq!(cases.len(), 2, "one for each kind of joints");
    for mut case in cases {
        case.steps = vec![6032];
        let rows = scenario.run(&case, &Rapier).unwrap();
        let row = rows.iter().find(|row| row.quantity == "ride_frequency").unwrap();
        assert_eq!(row.verdict, Verdict::Passed, "{row:?}");
        // Without the rounding of the impulse the row would fail.
        let formula = Ride::new(1e-3, 6032, 4).formula();
        assert!(formula.abs() > 2.0 * row.tolerance.unwrap(), "{formula:e} {row:?}");
    }
}
