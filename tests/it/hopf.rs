//! Secondary Hopf (Neimark-Sacker) points of the limit cycle, and where stability is regained.
//!
//! Woiwode, Vakakis & Krack, Nonlinear Dynamics 106 (2021) 1659-1673; the numbers to nine digits were computed outside this project.

use super::orbits::{exact_at, from_the_sticking_limit, nominal};
use stickslip::dynamics::{HalfPeriodMap, ReversalPoint, State};
use stickslip::exact::TwoMassFlow;
use stickslip::model::{RigParameters, TwoMassRig};
use stickslip::orbit::{Bifurcation, Branch, Criticality, FloquetMultipliers, NormalForm, SpecialPoint, limit_cycle};

/// Secondary Hopf points between the sticking limit and the first fold, or amplitude 20 where there is no fold before.
fn hopf_points(p: RigParameters) -> Vec<SpecialPoint> {
    let branch = from_the_sticking_limit(p).up_to_amplitude(20.0);
    let branch = Branch::follow(branch, |so_far| so_far.special_of(Bifurcation::Fold).next().is_some()).unwrap();
    let before_fold = branch.special.iter().take_while(|point| point.kind != Bifurcation::Fold);
    before_fold.filter(|point| point.kind == Bifurcation::NeimarkSacker).copied().collect()
}

#[test]
fn the_secondary_hopf_point_is_where_it_was_computed_elsewhere() {
    let [hopf] = hopf_points(nominal())[..] else { panic!("one secondary Hopf point expected") };
    // Given to nine digits after the point.
    assert!((hopf.parameters.xi1 + 0.034575371).abs() < 1e-9, "{}", hopf.parameters.xi1);
    let [pair, _, real] = hopf.orbit.section_multipliers();
    assert!((pair.norm() - 1.0).abs() < 1e-12 && real.norm() < 1.0 && real.im == 0.0);
    assert_eq!(hopf.rotation_angle(), Some(pair.arg()));
}

#[test]
fn stability_is_lost_there() {
    let stable = |xi1| {
        let p = RigParameters { xi1, ..nominal() };
        let flow = TwoMassFlow::new(&TwoMassRig::new(p).unwrap());
        FloquetMultipliers::of(&flow, &limit_cycle(p, exact_at).unwrap()).unwrap().stable()
    };
    assert!(stable(-0.034575371 + 1e-6));
    assert!(!stable(-0.034575371 - 1e-6));
}

#[test]
fn stability_is_regained_for_some_parameters() {
    for p in [
        RigParameters { kappa: 0.074, ..nominal() },
        RigParameters { kappa: 0.21, ..nominal() },
        RigParameters { gamma: 0.7, ..nominal() },
    ] {
        let points = hopf_points(p);
        assert_eq!(points.len(), 2, "start and end at {p:?}");
    }
}

#[test]
fn others_keep_their_stability_up_to_the_first_fold() {
    for p in [
        RigParameters { kappa: 0.06, ..nominal() },
        RigParameters { kappa: 0.3, ..nominal() },
        RigParameters { gamma: 0.2, ..nominal() },
        RigParameters { gamma: 0.8, ..nominal() },
        RigParameters { gamma: 0.9, ..nominal() },
    ] {
        assert!(hopf_points(p).is_empty(), "{p:?}");
        // A start and an end between two points of the branch would escape the signs: steps a tenth as long find none either.
        let branch = from_the_sticking_limit(p).with_largest_step(0.005).up_to_amplitude(20.0);
        let points = branch.map(Result::unwrap).take_while(|point| point.parameter_rate < 0.0);
        assert!(points.map(|point| assert!(point.orbit.stable(), "{:?}", point.parameters)).count() > 100);
    }
}

#[test]
fn the_multipliers_are_those_of_long_simulations() {
    // A perturbation across the leading pair: after n periods, the difference of two simulations is M^n times it.
    let p = nominal();
    let flow = TwoMassFlow::new(&TwoMassRig::new(p).unwrap());
    let orbit = limit_cycle(p, exact_at).unwrap();
    let distance = |periods: f64, by: f64| {
        let [x1, x2, v2]: [f64; 3] = orbit.section.into();
        let end = |x2| flow.advance(&State::two_mass([x1, x2, 0.0, v2, 1.0]), periods * orbit.period).unwrap().state;
        let (plus, minus) = (end(x2 + by), end(x2 - by));
        (plus.positions[0] - minus.positions[0]) / (2.0 * by)
    };
    // With the other multipliers gone (0.07^20), d_n = Re(c m^n): d_(n+1) - 2 Re(m) d_n + |m|^2 d_(n-1) = 0, plus the constant
    // along the orbit, removed by differences. Two such equations give m.
    let d: Vec<f64> = (20..26).map(|n| distance(f64::from(n), 1e-7)).collect();
    let e: Vec<f64> = d.windows(2).map(|w| w[1] - w[0]).collect();
    let determinant = e[1] * e[1] - e[0] * e[2];
    let trace = (e[1] * e[2] - e[0] * e[3]) / determinant;
    let squared_norm = (e[2] * e[2] - e[1] * e[3]) / determinant;
    let pair = FloquetMultipliers::of(&flow, &orbit).unwrap().others[0];
    // Rounding 1e-14/1e-7 in the differences, amplified some ten times by the elimination.
    assert!((trace - 2.0 * pair.re).abs() < 1e-5, "{trace} {}", 2.0 * pair.re);
    assert!((squared_norm - pair.norm_sqr()).abs() < 1e-5, "{squared_norm} {}", pair.norm_sqr());
}

#[test]
fn the_torus_is_born_as_the_normal_form_says() {
    let [hopf] = hopf_points(nominal())[..] else { panic!("one secondary Hopf point expected") };
    let normal_form = NormalForm::of(&exact_at(hopf.parameters).unwrap(), &hopf).unwrap();
    // Supercritical: simulations beyond the point settle on a torus, whose radius (root mean square of x1 - x1* over returns)
    // grows from nothing with the square root of the distance.
    assert_eq!(normal_form.criticality(), Criticality::Supercritical);
    let radius = |distance: f64| {
        let p = RigParameters { xi1: hopf.parameters.xi1 - distance, ..nominal() };
        let (flow, orbit) = (exact_at(p).unwrap(), limit_cycle(p, exact_at).unwrap());
        let mut section = orbit.section + ReversalPoint::new(0.05, 0.0, 0.0);
        let mut squares = 0.0;
        for n in 0..40_000 {
            section = flow.half_return(section).unwrap().image;
            squares += if n < 30_000 { 0.0 } else { (section[0] - orbit.section[0]).powi(2) };
        }
        (squares / 1e4).sqrt()
    };
    // Multipliers grow by about 0.35 per unit of xi1: at 5e-4 the torus is reached like e^(-2 * 1.7e-4 n), to e^-10 here. The next
    // order is relative 2e-3/0.035, the distance over xi1 itself.
    let (near, far) = (radius(5e-4), radius(2e-3));
    assert!((far / near - 2.0).abs() < 0.12, "{near} {far}");
}
