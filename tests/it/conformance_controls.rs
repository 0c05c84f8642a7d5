//! Negative controls: engines with a deliberate fault, which the report must show in red, in the rows it affects and in no others.

use super::conformance::{case, rows};
use std::sync::Arc;
use stickslip::conformance::{Bench, Configuration, ConformanceError, Physics, Row, Verdict};
use stickslip::engine::{
    Dampers, EngineFlow, ForceLaw, JenkinsElements, Known, PrescribedFlow, Scheme, SelfExcitation, Springs,
};
use stickslip::model::{ChainBuilder, JenkinsElement, OscillatorChain, PrescribedMotion};

const STEPS: [u32; 4] = [128, 256, 512, 1024];
const BESIDE: &str = "ten periods beside the cycle at xi1 = -0.06";
const SETTLED: &str = "settled at xi1 = -0.01";
const AVERAGED: Configuration = Configuration::AVERAGED_FRICTION;

/// Friction as a nonlinear spring: it unloads along the curve it was loaded on, so that no energy is lost.
#[derive(Debug)]
struct NoUnloading(JenkinsElements);

impl ForceLaw for NoUnloading {
    fn add_force(&self, known: &Known<'_>, force: &mut [f64]) {
        self.0.add_force(known, force);
    }
    fn move_sliders(&self, _from: &[f64], to: &[f64], slider_forces: &mut [f64]) {
        for (element, f) in self.0.0.iter().zip(slider_forces) {
            let element: &JenkinsElement = element;
            *f = (element.normalised_stiffness() * element.attachment.elongation(to)).clamp(-1.0, 1.0);
        }
    }
}

#[derive(Debug, Clone, Copy)]
enum Fault {
    WrongFriction,
    DampingSign,
    LostHalfStep,
    /// Friction sampled at the steps where its mean was asked for.
    SampledFriction,
}

struct Faulty(Fault);

impl Bench for Faulty {
    fn free(
        &self,
        chain: &OscillatorChain,
        configuration: Configuration,
        step: f64,
    ) -> Result<EngineFlow, ConformanceError> {
        let scheme = match self.0 {
            Fault::LostHalfStep => Scheme::Plain,
            Fault::SampledFriction => Scheme::SecondOrder,
            _ => configuration.scheme,
        };
        let flow = EngineFlow::new(chain, Configuration { scheme, ..configuration }.settings(step))?;
        let sign = if matches!(self.0, Fault::DampingSign) { -1.0 } else { 1.0 };
        let friction = JenkinsElements(chain.jenkins().to_vec());
        let friction: Arc<dyn ForceLaw> =
            if matches!(self.0, Fault::WrongFriction) { Arc::new(NoUnloading(friction)) } else { Arc::new(friction) };
        Ok(flow.with_laws(vec![
            Arc::new(Springs(chain.stiffness().clone())),
            Arc::new(Dampers(sign * chain.damping())),
            Arc::new(SelfExcitation(chain.self_excitation().clone())),
            friction,
        ])?)
    }

    /// Wrong friction here is one that never slips, and so loses nothing.
    fn prescribed(
        &self,
        chain: &OscillatorChain,
        motion: PrescribedMotion,
        configuration: Configuration,
        step: f64,
    ) -> Result<PrescribedFlow, ConformanceError> {
        let strong = |element: &JenkinsElement| JenkinsElement { slip_force: 1e3 * element.slip_force, ..*element };
        let mut builder = ChainBuilder::new(chain.mass().as_slice().to_vec()).add_stiffness(chain.stiffness());
        for element in chain.jenkins() {
            let wrong = matches!(self.0, Fault::WrongFriction);
            builder = builder.jenkins(if wrong { strong(element) } else { *element });
        }
        Ok(PrescribedFlow::new(&builder.build()?, motion, configuration.settings(step))?)
    }
}

fn faulty(fault: Fault, scenario: &str, variant: &str) -> Vec<Row> {
    faulty_at(fault, scenario, variant, Configuration::SAMPLED_FRICTION, &STEPS)
}

/// The diagram is made with friction averaged, as it is used; single motions show more where it is sampled.
fn configuration_of(scenario: &str) -> Configuration {
    if scenario == "amplitude_diagram" { Configuration::AVERAGED_FRICTION } else { Configuration::SAMPLED_FRICTION }
}

fn faulty_at(fault: Fault, scenario: &str, variant: &str, configuration: Configuration, steps: &[u32]) -> Vec<Row> {
    let (scenario, case) = case(scenario, variant, configuration, steps);
    scenario.run(&case, &Faulty(fault)).unwrap()
}

/// Something fails, and nothing that measures the motion passes: whether it stays bounded, or is chaotic, may survive a fault.
fn red(rows: &[Row]) {
    assert!(rows.iter().any(|row| row.verdict == Verdict::Failed), "{rows:#?}");
    let survives = ["bounded", "is_chaotic"];
    for row in rows.iter().filter(|row| row.steps_per_period.is_some() && !survives.contains(&row.quantity.as_str())) {
        assert_ne!(row.verdict, Verdict::Passed, "{row:?}");
    }
}

fn verdicts<'a>(rows: &'a [Row], quantity: &str) -> Vec<&'a Row> {
    rows.iter().filter(|row| row.quantity == quantity).collect()
}

fn all_red(rows: &[Row], quantity: &str) {
    let found = verdicts(rows, quantity);
    assert!(!found.is_empty(), "no rows about {quantity}");
    for row in found {
        assert_ne!(row.verdict, Verdict::Passed, "{row:?}");
    }
    assert!(verdicts(rows, quantity).iter().any(|row| row.verdict == Verdict::Failed), "{quantity}");
}

fn all_green(rows: &[Row]) {
    for row in rows {
        assert_ne!(row.verdict, Verdict::Failed, "{row:?}");
    }
}

#[test]
fn friction_that_does_not_unload_turns_friction_red_and_nothing_else() {
    let decay = faulty(Fault::WrongFriction, "friction_decay", "");
    all_red(&decay, "state_error");
    all_red(&decay, "switching_time");
    all_red(&faulty(Fault::WrongFriction, "limit_cycle", BESIDE), "state_error");
    all_green(&faulty(Fault::WrongFriction, "linear_oscillator", "damping ratio 0.1"));
}

#[test]
fn a_sign_error_in_damping_turns_damped_motions_red() {
    let rows = faulty(Fault::DampingSign, "linear_oscillator", "damping ratio 0.1");
    all_red(&rows, "state_error");
    all_red(&rows, "damping");
    all_red(&faulty(Fault::DampingSign, "coupled_oscillators", ""), "mode_2_damping");
    all_green(&faulty(Fault::DampingSign, "linear_oscillator", "damping ratio 0"));
    all_green(&faulty(Fault::DampingSign, "friction_decay", ""));
}

#[test]
fn a_lost_half_step_turns_state_order_and_switching_times_red() {
    let rows = faulty(Fault::LostHalfStep, "linear_oscillator", "damping ratio 0.1");
    all_red(&rows, "state_error");
    all_red(&rows, "damping");
    let rows = faulty(Fault::LostHalfStep, "limit_cycle", BESIDE);
    all_red(&rows, "state_error");
    let order = verdicts(&rows, "switching_time").into_iter().find(|row| row.steps_per_period.is_none()).unwrap();
    assert_eq!(order.verdict, Verdict::Failed, "{order:?}");
    // First order is what is left.
    assert!((order.order.unwrap() - 1.0).abs() < 0.3, "{order:?}");
}

#[test]
fn every_motion_with_friction_notices_friction_that_does_not_unload() {
    for (scenario, variant, steps) in [
        ("limit_cycle", SETTLED, 128),
        ("energy_ledger", "", 128),
        ("torus", "", 128),
        ("amplitude_diagram", "xi1 = -0.060", 256),
        ("chaos", "", 128),
        ("secondary_hopf", "8 phases", 128),
        ("hysteresis", "", 130),
    ] {
        red(&faulty_at(Fault::WrongFriction, scenario, variant, configuration_of(scenario), &[steps]));
    }
}

#[test]
fn every_motion_with_damping_notices_its_sign() {
    for (scenario, variant, steps) in [
        ("limit_cycle", BESIDE, 128),
        ("limit_cycle", SETTLED, 128),
        ("energy_ledger", "", 128),
        ("torus", "", 128),
        ("amplitude_diagram", "xi1 = -0.060", 256),
        ("chaos", "", 128),
        ("secondary_hopf", "8 phases", 128),
    ] {
        red(&faulty_at(Fault::DampingSign, scenario, variant, configuration_of(scenario), &[steps]));
    }
}

#[test]
fn every_second_order_motion_notices_a_lost_half_step() {
    // Not among them: averages of chaos, which are insensitive to it within their statistical errors.
    for (scenario, variant, steps) in [
        ("negative_damping", "", 128),
        ("friction_decay", "", 128),
        ("limit_cycle", SETTLED, 128),
        ("energy_ledger", "", 128),
        ("torus", "", 128),
        ("amplitude_diagram", "xi1 = -0.060", 256),
        ("secondary_hopf", "8 phases", 128),
    ] {
        let rows = faulty_at(Fault::LostHalfStep, scenario, variant, configuration_of(scenario), &[steps]);
        assert!(rows.iter().any(|row| row.verdict == Verdict::Failed), "{scenario}: {rows:#?}");
    }
}

#[test]
fn friction_that_is_not_averaged_is_noticed_where_it_should_be() {
    for (scenario, variant) in
        [("limit_cycle", BESIDE), ("friction_decay", ""), ("energy_ledger", ""), ("secondary_hopf", "8 phases")]
    {
        let rows = faulty_at(Fault::SampledFriction, scenario, variant, AVERAGED, &[128, 256]);
        assert!(rows.iter().any(|row| row.verdict == Verdict::Failed), "{scenario}: {rows:#?}");
        for fault in [Fault::WrongFriction, Fault::LostHalfStep] {
            let rows = faulty_at(fault, scenario, variant, AVERAGED, &[128]);
            assert!(rows.iter().any(|row| row.verdict == Verdict::Failed), "{scenario}: {rows:#?}");
        }
    }
}

#[test]
fn the_finest_hopf_points_are_right_at_every_phase_only_with_averaged_friction() {
    let every_phase = |configuration| {
        let rows = rows("secondary_hopf", "8 phases", configuration, &[2048]);
        rows.into_iter().find(|row| row.quantity == "secondary_hopf_every_phase").unwrap()
    };
    let sampled = every_phase(Configuration::SAMPLED_FRICTION);
    assert_eq!((sampled.verdict, sampled.physics), (Verdict::Passed, Physics::Wrong), "{sampled:?}");
    assert!(sampled.reason.contains("7 of 8 phases"), "{sampled:?}");
    let averaged = every_phase(AVERAGED);
    assert_eq!((averaged.verdict, averaged.physics), (Verdict::Passed, Physics::Right), "{averaged:?}");
    // Measured 1.5e-8 with the difference equation and exact derivatives.
    assert!(averaged.found.unwrap() < 3e-8);
}

#[test]
fn averaged_friction_is_of_second_order() {
    let mut all = rows("limit_cycle", BESIDE, AVERAGED, &[64, 128, 256, 512, 1024]);
    all.extend(rows("limit_cycle", SETTLED, AVERAGED, &[64, 128, 256, 512]));
    all.extend(rows("energy_ledger", "", AVERAGED, &[64, 128, 256, 512]));
    all_green(&all);
    for quantity in ["state_error", "switching_time", "amplitude", "angular_frequency"] {
        let row = all.iter().find(|row| row.quantity == quantity && row.steps_per_period.is_none()).unwrap();
        // Amplitudes are held against the difference equation's order; here against second order.
        assert!((row.order.unwrap() - 2.0).abs() < 0.1, "{row:?}");
    }
}

#[test]
fn without_a_fault_chaos_is_chaos() {
    let rows = rows("chaos", "", Configuration::SAMPLED_FRICTION, &[128]);
    all_green(&rows);
    let chaotic = rows.iter().find(|row| row.quantity == "is_chaotic").unwrap();
    assert_eq!((chaotic.found, chaotic.exact), (Some(1.0), Some(1.0)), "{chaotic:?}");
    assert!(rows.iter().filter(|row| row.verdict == Verdict::Passed).count() >= 5, "{rows:#?}");
}

#[test]
fn without_a_fault_the_same_rows_are_green() {
    all_green(&rows("friction_decay", "", Configuration::SAMPLED_FRICTION, &STEPS));
    all_green(&rows("limit_cycle", BESIDE, Configuration::SAMPLED_FRICTION, &STEPS));
    all_green(&rows("coupled_oscillators", "", Configuration::SAMPLED_FRICTION, &STEPS));
}
