//! Amplitude diagrams of the exact flow.

use crate::lyapunov::{beside_the_limit_cycle, flow_at};
use std::convert::Infallible;
use std::sync::Mutex;
use stickslip::chaos::{DiagramPlan, DiagramRow, MotionClass, Window, amplitude_diagram, divergence_edge};
use stickslip::dynamics::{Sampled, State};
use stickslip::exact::TwoMassFlow;

/// Beside the limit cycle where there is one, otherwise a state that slips at first.
fn prepare(xi1: f64) -> Result<(TwoMassFlow, State), Infallible> {
    let start = if xi1 < 0.0 { beside_the_limit_cycle(xi1, 1e-3) } else { State::two_mass([1.2, 0.9, 0.0, -0.5, 1.0]) };
    Ok((flow_at(xi1), start))
}

fn diagram(values: &[f64]) -> Vec<DiagramRow> {
    amplitude_diagram(values, &DiagramPlan::default(), &[], prepare, |_, _, _| {}).unwrap()
}

#[test]
fn known_motions_are_classified() {
    use MotionClass::{Chaos, Diverged, Equilibrium, LimitCycle, Torus};
    let rows = diagram(&[0.01, -0.03, -0.06, -0.09, -0.155, -0.2]);
    let classes: Vec<_> = rows.iter().map(|row| row.outcome).collect();
    assert_eq!(classes, [Equilibrium, LimitCycle, Torus, Torus, Chaos, Diverged], "{rows:#?}");
    let [_, cycle, torus, _, _, diverged] = rows.try_into().unwrap();
    // On the limit cycle both ends are its amplitude; the motion still settles on it, from 1e-3 away.
    let amplitude = crate::lyapunov::orbit_at(-0.03).section[0];
    assert!((cycle.a1_max.unwrap() - amplitude).abs() < 1e-3 && (cycle.a1_min.unwrap() - amplitude).abs() < 1e-3);
    // The torus surrounds the unstable cycle (x1 = 1.2226) and dips below the slip limit.
    assert!(torus.a1_max.unwrap() > 1.3 && torus.a1_min.unwrap() < 1.0);
    assert_eq!((diverged.a1_max, diverged.a1_min), (None, None));
    assert!(diverged.evidence.life_time.unwrap() < 5000.0);
}

#[test]
fn a_settled_limit_cycle_repeats_after_one_return() {
    let plan = DiagramPlan { window: Window { transient: 40_000.0, length: 500.0 }, ..Default::default() };
    let rows = amplitude_diagram(&[-0.03], &plan, &[], prepare, |_, _, _| {}).unwrap();
    assert_eq!((rows[0].outcome, rows[0].evidence.cycle), (MotionClass::LimitCycle, Some(1)), "{rows:#?}");
    let amplitude = crate::lyapunov::orbit_at(-0.03).section[0];
    // e^(-0.00061 * 40000) = 3e-11 of a start 1e-3 away.
    assert!((rows[0].a1_max.unwrap() - amplitude).abs() < 1e-9);
}

#[test]
fn rows_are_the_same_on_one_thread_and_on_two() {
    let values: Vec<f64> = (0..12).map(|n| 0.01 - 0.015 * f64::from(n)).collect();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| diagram(&values))
    };
    assert_eq!(on(1), on(2));
}

#[test]
fn finished_rows_are_taken_over_and_new_ones_reported() {
    let values = [-0.03, -0.04, -0.05];
    let all = diagram(&values);
    // A recognisable row shows that it is not computed again.
    let finished = DiagramRow { a1_max: Some(7.0), ..all[1] };
    let heard = Mutex::new(Vec::new());
    let progress = |row: &DiagramRow, done, total| heard.lock().unwrap().push((row.value, done, total));
    let rows = amplitude_diagram(&values, &DiagramPlan::default(), &[finished], prepare, progress).unwrap();
    assert_eq!(rows, [all[0], finished, all[2]]);
    let mut heard = heard.into_inner().unwrap();
    heard.sort_by_key(|(_, done, _)| *done);
    assert_eq!(heard.iter().map(|(_, done, total)| (*done, *total)).collect::<Vec<_>>(), [(2, 3), (3, 3)]);
}

#[test]
fn a_failing_row_is_named() {
    let refuse = |xi1: f64| match prepare(xi1) {
        Ok((flow, _)) if xi1 == -0.04 => flow.with_amplitude_bound(-1.0).map(|flow| (flow, State::two_mass([0.0; 5]))),
        Ok(start) => Ok(start),
        Err(never) => match never {},
    };
    let error = amplitude_diagram(&[-0.03, -0.04], &DiagramPlan::default(), &[], refuse, |_, _, _| {}).unwrap_err();
    assert!(error.to_string().contains("parameter -0.04"), "{error}");
}

#[test]
fn the_edge_of_divergence_lies_where_it_was_measured() {
    // About -0.165 for the exact system started beside its limit cycle; the edge is not sharp.
    let values: Vec<f64> = (0..16).map(|n| -0.15 - 0.002 * f64::from(n)).collect();
    let edge = divergence_edge(&diagram(&values)).unwrap();
    assert!(edge.first_diverged < -0.155 && edge.first_diverged > -0.175, "{edge:?}");
    assert!(edge.life_times.0 > 50.0 && edge.life_times.1 <= 5000.0, "{edge:?}");
    assert_eq!(divergence_edge(&diagram(&[-0.03])), None);
}

/// The engine's motions reach the diagram through samples: the way there must not change what they are.
#[test]
fn samples_in_place_of_the_dense_output_leave_the_diagram_as_it_is() {
    let values = [-0.03, -0.06, -0.155, -0.2];
    let exact = diagram(&values);
    let interval = std::f64::consts::TAU / 256.0;
    let through_samples = |interval| {
        let prepare = |xi1| prepare(xi1).map(|(flow, start)| (Sampled::new(flow, interval).unwrap(), start));
        amplitude_diagram(&values, &DiagramPlan::default(), &[], prepare, |_, _, _| {}).unwrap()
    };
    for (a, b) in exact.iter().zip(&through_samples(interval)) {
        assert_eq!(a.outcome, b.outcome, "{a:?} {b:?}");
        for (a, b) in [(a.a1_max, b.a1_max), (a.a1_min, b.a1_min)] {
            assert_eq!(a.is_some(), b.is_some());
            // A cubic through a jump of the third derivative by gamma |v| < 1 is off by less than h^3/6 of it: 2.5e-6.
            assert!((a.unwrap_or(0.0) - b.unwrap_or(0.0)).abs() < 2.5e-6, "{a:?} {b:?}");
        }
    }
    // Samples too far apart are seen: with eight to a period the limit cycle no longer closes.
    let coarse = through_samples(32.0 * interval);
    assert_ne!(coarse[0].outcome, MotionClass::LimitCycle, "{coarse:?}");
}
