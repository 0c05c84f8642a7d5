//! Negative controls: engines with a deliberate fault, which the report must show in red, in the rows it affects and in no others.

use super::conformance::{case, rows};
use std::sync::Arc;
use stickslip::conformance::{Bench, Configuration, ConformanceError, Row, Verdict};
use stickslip::engine::{Dampers, EngineFlow, ForceLaw, JenkinsElements, Known, Scheme, SelfExcitation, Springs};
use stickslip::model::{JenkinsElement, OscillatorChain};

const STEPS: [u32; 4] = [128, 256, 512, 1024];
const BESIDE: &str = "ten periods beside the cycle at xi1 = -0.06";

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
}

fn faulty(fault: Fault, scenario: &str, variant: &str) -> Vec<Row> {
    let (scenario, case) = case(scenario, variant, Configuration::RECIPE, &STEPS);
    scenario.run(&case, &Faulty(fault)).unwrap()
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
fn without_a_fault_the_same_rows_are_green() {
    all_green(&rows("friction_decay", "", Configuration::RECIPE, &STEPS));
    all_green(&rows("limit_cycle", BESIDE, Configuration::RECIPE, &STEPS));
    all_green(&rows("coupled_oscillators", "", Configuration::RECIPE, &STEPS));
}
