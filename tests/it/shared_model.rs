//! What the engine side and its references share: the description of the model. Each of its functions against numbers found by hand.

use stickslip::conformance::Configuration;
use stickslip::conformance::DifferenceEquation;
use stickslip::dynamics::State;
use stickslip::model::{Attachment, JenkinsElement, RigParameters, TwoMassRig};

fn rig() -> TwoMassRig {
    TwoMassRig::new(RigParameters { xi1: -0.05, xi2: 0.01, kappa: 0.25, gamma: 0.5 }).unwrap()
}

#[test]
fn matrices_of_the_rig_are_those_of_equation_1() {
    let rig = rig();
    let chain = rig.chain();
    // d1 = (-0.05 + 0.01)/2, d2 = (-0.05 - 0.01)/2; 1 - gamma + kappa, 1 + kappa.
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-16, "{found} {expected}");
    let damping = chain.total_damping();
    close(damping[(0, 0)], -0.02);
    close(damping[(1, 1)], -0.02);
    close(damping[(0, 1)], -0.03);
    close(damping[(1, 0)], -0.03);
    let stiffness = chain.stiffness();
    close(stiffness[(0, 0)], 0.75);
    close(stiffness[(1, 1)], 1.25);
    close(stiffness[(0, 1)], -0.25);
    close(stiffness[(1, 0)], -0.25);
    let element = chain.jenkins()[0];
    assert_eq!((element.attachment, element.slip_force), (Attachment::Ground(0), 0.5));
    close(element.normalised_stiffness(), 1.0);
}

#[test]
fn accelerations_and_energies_are_those_found_by_hand() {
    let rig = rig();
    let chain = rig.chain();
    let (x, v, f) = ([2.0, 1.0], [1.0, -1.0], [0.5]);
    // -(0.75 * 2 - 0.25 * 1) - (-0.02 * 1 + 0.03 * 1) - 0.5 * 0.5, and -(1.25 * 1 - 0.25 * 2) - (-0.03 * 1 + 0.02 * 1).
    let a = chain.acceleration(&x, &v, &f);
    assert!((a[0] + 1.51).abs() < 1e-15 && (a[1] + 0.74).abs() < 1e-15, "{a:?}");
    // 1 + (0.75 * 4 - 2 * 0.25 * 2 + 1.25)/2 + 0.25 * 0.25/(2 * 0.5).
    assert!((chain.stored_energy(&x, &v, &f) - (1.0 + 1.625 + 0.0625)).abs() < 1e-15);
}

#[test]
fn an_element_between_two_masses_stretches_and_pulls_as_drawn() {
    let between = Attachment::Between(0, 1);
    let stretch = between.elongation(&[3.0, 1.0]);
    let mut forces = [0.0; 2];
    between.scatter(1.5, &mut forces);
    // Work of the force on a displacement is that on the elongation.
    assert_eq!(stretch.abs(), 2.0);
    assert_eq!(forces[0] * 3.0 + forces[1] * 1.0, 1.5 * stretch);
    let element = JenkinsElement { attachment: between, stiffness: 3.0, slip_force: 1.5 };
    assert_eq!(element.normalised_stiffness(), 2.0);
    // Force 0.75 on a spring of 3.
    assert_eq!(element.stored_energy(0.5), 0.75 * 0.75 / 6.0);
}

#[test]
fn one_step_of_the_difference_equation_is_the_one_found_by_hand() {
    let rig = rig();
    let start = State::two_mass([0.0, 0.0, 1.0, 0.0, 0.0]);
    // a = (0.02, 0.03). Face value, one substep, h = 0.5: w = (1.01, 0.015), x = h w, f = x1.
    let plain = Configuration { scheme: stickslip::engine::Scheme::Plain, ..Configuration::SAMPLED_FRICTION };
    let motion = DifferenceEquation::new(rig.chain(), plain, 0.5).motion(&start, 1, 1);
    let found: Vec<f64> = motion.samples[1].state.components().collect();
    for (found, expected) in found.iter().zip([0.505, 0.0075, 1.01, 0.015, 0.505]) {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
    // Half a step back, w_0 = v_0 - 0.25 a: x = 0.5 (w_0 + 0.5 a) = 0.5 v_0 + 0.125 a.
    let motion = DifferenceEquation::new(rig.chain(), Configuration::SAMPLED_FRICTION, 0.5).motion(&start, 1, 1);
    let x = &motion.samples[1].state.positions;
    assert!((x[0] - 0.5025).abs() < 1e-15 && (x[1] - 0.00375).abs() < 1e-15, "{x:?}");
}
