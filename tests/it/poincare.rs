//! Sections, rotation numbers and the 0-1 test on motions of the exact flow.

use crate::lyapunov::{beside_the_limit_cycle, flow_at, orbit_at};
use stickslip::chaos::{
    ChaosError, PoincareMap, PoincareSection, Rotation, Window, poincare_map, torus_rotation, zero_one_test,
};
use stickslip::dynamics::State;

fn map(xi1: f64, window: Window, section: PoincareSection) -> PoincareMap {
    poincare_map(&flow_at(xi1), &beside_the_limit_cycle(xi1, 1e-2), window, section).unwrap()
}

const LONG: Window = Window { transient: 3000.0, length: 20_000.0 };

/// Correlation dimension of a point set (Grassberger and Procaccia, 1983): the share of pairs closer than r grows as
/// `r^dimension`. Between r = 0.02 and 0.08, on sets of extent 1 to 3.
fn dimension(map: &PoincareMap) -> f64 {
    let points: Vec<_> = map.points.iter().map(|point| &point[1..]).collect();
    let squared = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    let pairs = || points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| squared(a, b)));
    let closer = |radius: f64| pairs().filter(|distance| *distance < radius * radius).count() as f64;
    (closer(0.08) / closer(0.02)).ln() / 4.0_f64.ln()
}

#[test]
fn a_torus_leaves_a_closed_curve_and_chaos_a_cloud_on_the_fast_section() {
    let [torus, chaos] = [-0.06, -0.155].map(|xi1| map(xi1, LONG, PoincareSection::Fast));
    for map in [&torus, &chaos] {
        assert!(map.points.len() > 3000);
        // A crossing is found to rounding of the time, 1e-11 at most, at velocities of order 1.
        assert!(map.column("x2").unwrap().iter().all(|x2| x2.abs() < 1e-10));
        assert!(map.column("v2").unwrap().iter().all(|v2| *v2 > 0.0));
    }
    let (torus, chaos) = (dimension(&torus), dimension(&chaos));
    // Measured 1.003 and 1.93. A curve has dimension 1. The chaotic attractor has exponents (+, 0, 0, -), so dimension above 3, and its section one above 2.
    assert!((torus - 1.0).abs() < 0.1, "{torus}");
    assert!((chaos - 2.0).abs() < 0.3, "{chaos}");
}

#[test]
fn a_limit_cycle_is_one_point_of_every_section() {
    let orbit = orbit_at(-0.03);
    let window = Window { transient: 0.0, length: 300.0 };
    for section in [PoincareSection::Fast, PoincareSection::Stroboscopic { period: orbit.period }] {
        let map = poincare_map(&flow_at(-0.03), &orbit.reversal(), window, section).unwrap();
        assert!(map.points.len() >= 47);
        for (point, column) in map.points.iter().flat_map(|point| point[1..].iter().zip(&map.points[0][1..])) {
            // 95 switches from an orbit closed to 2e-13.
            assert!((point - column).abs() < 1e-11, "{point} {column}");
        }
    }
}

#[test]
fn a_torus_is_one_point_on_the_slow_section() {
    // As in Fig. 8 a: the slow flow has a limit cycle where the motion has a torus.
    let extent = |xi1| {
        let map = map(xi1, LONG, PoincareSection::Slow);
        assert!(map.column("a2_deviation_rate").unwrap().iter().all(|rate| *rate > 0.0));
        let deviations = map.column("a1_deviation").unwrap();
        let (low, high) = deviations.iter().fold((f64::MAX, f64::MIN), |(l, h), d| (l.min(*d), h.max(*d)));
        (deviations.len(), high - low)
    };
    let ((torus_count, torus), (_, chaos)) = (extent(-0.06), extent(-0.155));
    // One point per slow period of about 87 time units.
    assert!((torus_count as f64 - 20_000.0 / 87.0).abs() < 10.0, "{torus_count}");
    // Measured 0.007 and 0.26; what is left on the torus is the ripple that averaging takes out.
    assert!(torus < 0.05 * chaos, "{torus} {chaos}");
}

fn rotation(xi1: f64, settling: f64) -> Rotation {
    let flow = flow_at(xi1);
    let settled: State = flow.advance(&beside_the_limit_cycle(xi1, 3e-2), settling).unwrap().state;
    torus_rotation(&flow, &settled, Window { transient: 0.0, length: 10_000.0 }).unwrap()
}

#[test]
fn the_torus_turns_like_its_multiplier_near_the_secondary_hopf_point() {
    let argument = |xi1: f64| orbit_at(xi1).section_multipliers()[0].arg().abs();
    // 4.3e-4 and 8.5e-4 beyond the secondary Hopf point at -0.034575.
    let deviations = [-0.035, -0.035425].map(|xi1| {
        let found = rotation(xi1, 300_000.0);
        assert!(found.rotation_error < 1e-8, "{found:?}");
        (found.rotation_number - argument(xi1)).abs()
    });
    // Measured 4.9e-4 and 9.7e-4. The deviation grows with the square of the torus amplitude, so with the distance from the Hopf point.
    assert!(deviations[0] < 2e-3);
    assert!((deviations[1] / deviations[0] - 2.0).abs() < 0.2);
}

#[test]
fn a_limit_cycle_and_a_diverging_motion_have_no_rotation_number() {
    let window = Window { transient: 0.0, length: 2000.0 };
    let cycle = torus_rotation(&flow_at(-0.03), &orbit_at(-0.03).reversal(), window);
    assert!(matches!(cycle, Err(ChaosError::NotWinding { .. })), "{cycle:?}");
    let diverged = torus_rotation(&flow_at(-0.2), &beside_the_limit_cycle(-0.2, 1e-2), window);
    assert!(matches!(diverged, Err(ChaosError::Diverged { time, .. }) if time < 2000.0), "{diverged:?}");
}

#[test]
fn the_zero_one_test_agrees_on_torus_and_chaos() {
    let indicator = |xi1| {
        let window = Window { transient: 3000.0, length: 80_000.0 };
        let series = map(xi1, window, PoincareSection::Slow).column("a1_deviation").unwrap();
        zero_one_test(&series).unwrap()
    };
    let (torus, chaos) = (indicator(-0.06), indicator(-0.155));
    // Measured 0.011 and 0.998 with 900 returns each.
    assert!(torus.abs() < 0.2 && chaos > 0.8, "{torus} {chaos}");
}
