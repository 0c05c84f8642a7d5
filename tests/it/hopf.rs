//! Secondary Hopf (Neimark-Sacker) points of the limit cycle, and where stability is regained.
//!
//! Woiwode, Vakakis & Krack, Nonlinear Dynamics 106 (2021) 1659-1673; the numbers to nine digits were computed outside this project.

use super::orbits::{exact_at, from_the_sticking_limit, nominal};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::dynamics::{HalfPeriodMap, ReversalPoint, State};
use stickslip::exact::TwoMassFlow;
use stickslip::model::{RigParameters, TwoMassRig};
use stickslip::orbit::{
    Bifurcation, Branch, BranchEnd, Criticality, FloquetMultipliers, Mode, NormalForm, OrbitError, Passage,
    SpecialPoint, limit_cycle, limit_cycle_of,
};

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

/// Computed outside this project in 40 digits: Taylor series, shooting, secants on the modulus of the pair. It crosses the circle at so low
/// an angle that 1e-10 in a modulus would be 1e-8 in xi1.
#[test]
fn pairs_of_points_close_together_are_found() {
    for (p, expected) in [
        (RigParameters { gamma: 0.7995, ..nominal() }, Some([-0.06470079205335, -0.06727256185683])),
        (RigParameters { gamma: 0.79941, ..nominal() }, Some([-0.06435207594376, -0.06764638664195])),
        // The multipliers reach 1 + 6e-6 and 1 + 8e-6.
        (RigParameters { kappa: 0.0708722, ..nominal() }, None),
        (RigParameters { kappa: 0.2161527, ..nominal() }, None),
    ] {
        let points = hopf_points(p);
        let [start, end] = &points[..] else { panic!("{} points at {p:?}", points.len()) };
        assert_eq!([start.passage, end.passage], [Passage::Upwards, Passage::Downwards], "{p:?}");
        for (point, expected) in points.iter().zip(expected.iter().flatten()) {
            // Roundings of a modulus, 1e-15, over that angle.
            assert!((point.parameters.xi1 - expected).abs() < 1e-11, "{p:?}: {}", point.parameters.xi1);
        }
        let modulus = |xi1| {
            let flow_at = RigParameters { xi1, ..p };
            limit_cycle(flow_at, exact_at).unwrap().section_multipliers()[0].norm()
        };
        let middle = 0.5 * (start.parameters.xi1 + end.parameters.xi1);
        let width = start.parameters.xi1 - end.parameters.xi1;
        assert!(modulus(middle) > 1.0 && modulus(middle + width) < 1.0 && modulus(middle - width) < 1.0, "{p:?}");
    }
}

/// Around the value of gamma at which a pair merges: a pair is found where a scan of the multipliers a hundred times as dense sees one outside
/// the circle. `STICKSLIP_SETS` sets the number of parameter sets.
#[test]
fn merging_pairs_are_found_or_excluded_as_a_dense_scan_says() {
    let count = std::env::var("STICKSLIP_SETS").map_or(16, |text| text.parse().unwrap());
    let mut random = ChaCha8Rng::seed_from_u64(200);
    let (mut with, mut without) = (0, 0);
    for _ in 0..count {
        // Equation (32) puts the merging at pi kappa^2/(gamma xi2) = 3; the exact one lies within a third of that.
        let (kappa, about): (f64, f64) = (random.random_range(0.05..0.2), random.random_range(0.4..0.85));
        let p = RigParameters { kappa, xi2: std::f64::consts::PI * kappa * kappa / (3.5 * about), ..nominal() };
        let pair = |gamma: f64| !hopf_points(RigParameters { gamma, ..p }).is_empty();
        let (mut low, mut high) = (0.75 * about, (1.3 * about).min(0.99));
        if !pair(low) || pair(high) {
            continue;
        }
        for _ in 0..14 {
            let middle = 0.5 * (low + high);
            if pair(middle) { low = middle } else { high = middle }
        }
        let gamma = low + (high - low) * random.random_range(-20.0..20.0);
        let p = RigParameters { gamma, ..p };
        let found = hopf_points(p);
        let dense = from_the_sticking_limit(p).with_largest_step(5e-4).up_to_amplitude(20.0);
        let dense = dense.map(Result::unwrap).take_while(|point| point.parameter_rate < 0.0);
        let largest = dense.map(|point| {
            let [a, b, _] = point.orbit.section_multipliers();
            if a.im != 0.0 { a.norm() } else { b.norm() * f64::from(u8::from(b.im != 0.0)) }
        });
        let moduli: Vec<f64> = largest.collect();
        let outside = moduli.iter().any(|modulus| *modulus > 1.0);
        assert_eq!(!found.is_empty(), outside, "{p:?}");
        // Starts and ends alternate; the last one is a start where the pair is still outside at the fold.
        let expected = [Passage::Upwards, Passage::Downwards].into_iter().cycle();
        assert!(found.iter().map(|point| point.passage).eq(expected.take(found.len())), "{p:?}");
        assert_eq!(found.len() % 2 == 1, moduli.last().is_some_and(|modulus| *modulus > 1.0), "{p:?}");
        assert!(found.windows(2).all(|pair| pair[0].parameters.xi1 > pair[1].parameters.xi1), "{p:?}");
        if outside { with += 1 } else { without += 1 }
    }
    println!("{count} sets, {with} with a pair, {without} without");
    // Half of the sets have no merging in the range of gamma looked at.
    assert!(with > 0 && without > 0 && with + without > count / 4, "{with} {without}");
}

/// Where the branch runs to infinity or damping is strong the search ends with what it found. Fold and amplitude were computed outside
/// this project by shooting.
#[test]
fn weak_coupling_and_strong_damping_are_followed() {
    let p = RigParameters { kappa: 0.01, ..nominal() };
    let branch = Branch::follow(from_the_sticking_limit(p).up_to_amplitude(50.0), |_| false).unwrap();
    assert_eq!(branch.end, BranchEnd::Unbounded);
    assert_eq!(branch.special_of(Bifurcation::NeimarkSacker).count(), 0);
    let fold = branch.special_of(Bifurcation::Fold).next().unwrap();
    assert!((fold.parameters.xi1 + 0.012751689256).abs() < 1e-11, "{}", fold.parameters.xi1);
    // At a fold the amplitude is off by the square root of what xi1 is off by, 1e-12.
    assert!((fold.orbit.amplitude() - 1.15709247).abs() < 1e-6, "{}", fold.orbit.amplitude());
    let damped = limit_cycle(RigParameters { xi2: 20.0, ..nominal() }, exact_at).unwrap();
    assert!((damped.amplitude() - 1.32404823).abs() < 1e-8, "{}", damped.amplitude());
    let p = RigParameters { kappa: 0.0524, xi2: 0.0966, gamma: 0.862, xi1: -0.125 };
    let error = limit_cycle(p, exact_at).unwrap_err();
    let OrbitError::Unbounded { reached, .. } = error else { panic!("{error}") };
    assert!((reached + 0.124).abs() < 5e-4, "{reached}");
}

/// Computed outside this project by shooting.
#[test]
fn both_modes_have_a_cycle_where_both_are_excited() {
    let p = RigParameters { xi1: -0.001, xi2: -0.01, ..nominal() };
    let cycle = |mode| limit_cycle_of(mode, p, exact_at).unwrap();
    let (in_phase, out_of_phase) = (cycle(Mode::InPhase), cycle(Mode::OutOfPhase));
    assert!((in_phase.amplitude() - 1.0031585).abs() < 1e-7 && in_phase.stable());
    assert!((out_of_phase.amplitude() - 1.0383632).abs() < 1e-7 && out_of_phase.stable());
    assert!((out_of_phase.angular_frequency() - 1.0938073).abs() < 1e-7);
    // x2 is its largest displacement there, not that at the reversal of mass 1.
    assert!((out_of_phase.section[1] + 1.07).abs() < 1e-2, "{}", out_of_phase.section);
    let driven = RigParameters { xi1: 0.01, xi2: -0.01, ..nominal() };
    assert!(limit_cycle_of(Mode::OutOfPhase, driven, exact_at).is_ok());
    assert!(matches!(limit_cycle(driven, exact_at), Err(OrbitError::NoGuess { .. })));
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
