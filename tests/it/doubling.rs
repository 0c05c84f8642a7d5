//! Period doublings on a map whose doublings are known: the logistic map, with two coordinates that follow it and decay.

use nalgebra::{Matrix3, Vector3};
use std::convert::Infallible;
use stickslip::dynamics::{Closure, ReversalPoint, SectionMap, SectionReturn};
use stickslip::model::{RigParameter, RigParameters};
use stickslip::orbit::{Bifurcation, Branch, Heading, OrbitError, PseudoArclength, SpecialPoint, shoot_section};

/// `x1 -> r x1 (1 - x1)`, `x2 -> x1 + x2/2`, `v2 -> x2 - v2/4`, with `r = -xi1`. Its multipliers beside those of the first line are 1/2 and -1/4
/// to the power of the cycle.
struct Logistic {
    r: f64,
}

impl SectionMap for Logistic {
    type Error = Infallible;

    fn section_return(
        &self,
        start: ReversalPoint,
        closure: Closure,
        parameters: &[RigParameter],
    ) -> Result<SectionReturn, Infallible> {
        let Closure::FullPeriod { cycles } = closure else { panic!("the logistic map has no symmetry") };
        let r = self.r;
        let (mut z, mut jacobian, mut by_r) = (start, Matrix3::identity(), Vector3::zeros());
        for _ in 0..cycles {
            let step = Matrix3::new(r * (1.0 - 2.0 * z[0]), 0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 1.0, -0.25);
            by_r = step * by_r + Vector3::new(z[0] * (1.0 - z[0]), 0.0, 0.0);
            jacobian = step * jacobian;
            z = Vector3::new(r * z[0] * (1.0 - z[0]), z[0] + 0.5 * z[1], z[1] - 0.25 * z[2]);
        }
        let sensitivities =
            parameters.iter().map(|p| if *p == RigParameter::Xi1 { -by_r } else { Vector3::zeros() }).collect();
        Ok(SectionReturn { image: z, duration: cycles as f64, jacobian, sensitivities })
    }
}

fn at(p: RigParameters) -> Result<Logistic, OrbitError> {
    Ok(Logistic { r: -p.xi1 })
}

type At = fn(RigParameters) -> Result<Logistic, OrbitError>;

fn first_doubling(branch: PseudoArclength<At>) -> SpecialPoint {
    let kinds = |so_far: &Branch| so_far.special.iter().any(|point| point.kind == Bifurcation::PeriodDoubling);
    let branch = Branch::follow(branch, |so_far| kinds(so_far) || so_far.points.len() > 1000).unwrap();
    *branch.special_of(Bifurcation::PeriodDoubling).next().expect("the branch doubles")
}

#[test]
fn the_cascade_of_the_logistic_map_is_followed_through_three_doublings() {
    let p = RigParameters { xi1: -2.8, ..RigParameters::default() };
    let closure = Closure::FullPeriod { cycles: 1 };
    let orbit = shoot_section(&at(p).unwrap(), Vector3::new(0.6, 1.3, 1.0), closure).unwrap();
    let branch = PseudoArclength::new(at as At, p, &orbit, RigParameter::Xi1, Heading::Decreasing).unwrap();
    let mut special = first_doubling(branch);
    // The first two in closed form; the third is the one published for this map (OEIS A086181).
    for (r, cycles, tolerance) in [(3.0, 1, 1e-10), (1.0 + 6.0_f64.sqrt(), 2, 1e-10), (3.544_090_359_551_9, 4, 1e-10)] {
        assert_eq!(special.orbit.closure, Closure::FullPeriod { cycles });
        assert!((-special.parameters.xi1 - r).abs() < tolerance, "{} is not {r}", -special.parameters.xi1);
        let multipliers = special.orbit.section_multipliers();
        // Of order 1, from a determinant of order 1 that is zero to rounding.
        assert!((multipliers[0] + 1.0).norm() < 1e-9, "{multipliers:?}");
        let doubled = PseudoArclength::switched(at as At, &special, RigParameter::Xi1).unwrap();
        special = first_doubling(doubled);
    }
}

#[test]
fn the_doubled_orbit_is_the_two_cycle_in_closed_form() {
    let p = RigParameters { xi1: -2.9, ..RigParameters::default() };
    let closure = Closure::FullPeriod { cycles: 1 };
    let orbit = shoot_section(&at(p).unwrap(), Vector3::new(0.6, 1.3, 1.0), closure).unwrap();
    let branch = PseudoArclength::new(at as At, p, &orbit, RigParameter::Xi1, Heading::Decreasing).unwrap();
    let doubled = PseudoArclength::switched(at as At, &first_doubling(branch), RigParameter::Xi1).unwrap();
    for point in doubled.map(Result::unwrap).take(20).skip(1) {
        let (r, x) = (-point.parameters.xi1, point.orbit.section[0]);
        // x = (r + 1 -+ sqrt((r - 3)(r + 1)))/(2 r); its multiplier is 4 + 2 r - r^2.
        let root = ((r - 3.0) * (r + 1.0)).sqrt();
        let cycle = [(r + 1.0 - root) / (2.0 * r), (r + 1.0 + root) / (2.0 * r)];
        let distance = cycle.map(|c| (c - x).abs()).into_iter().fold(f64::INFINITY, f64::min);
        // The residual is below 1e-12; next to the doubling the cycle answers to it by one over its distance, r - 3 > 1e-4.
        assert!(r > 3.0 && distance < 1e-8, "r = {r}: {x} is not of {cycle:?}");
        assert!((point.orbit.jacobian[(0, 0)] - (4.0 + 2.0 * r - r * r)).abs() < 1e-7);
    }
}
