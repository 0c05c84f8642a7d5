//! What Rapier does to a linear oscillator, `x'' + x = 0` with the spring as a force law: numerical damping xi_num, defined by
//! `x'' + xi_num x' + x = 0` and fitted to the decay of the peaks. With a force held constant over n substeps,
//!
//! ```text
//! xi_num = -omega^2 h (1 - (n + 1)/(2 n)).
//! ```
//!
//! The step map of Rapier for `a = -omega^2 x` has the determinant `1 + omega^2 h^2 (1 - (n + 1)/(2 n))`, which is `exp(-xi_num h)`.

use stickslip::compare::Cycles;
use stickslip::dynamics::{Flow, Sampling, State};
use stickslip::engine::{EngineFlow, EngineSettings, Joints, Precision, Scheme};
use stickslip::model::ChainBuilder;

/// Least-squares slope of the logarithm of the peaks, times -2.
fn numerical_damping(settings: EngineSettings) -> f64 {
    let chain = ChainBuilder::new(vec![1.0]).ground_spring(0, 1.0).build().unwrap();
    let start = State { positions: vec![1.0], velocities: vec![0.0], slider_forces: vec![] };
    let sampling = Sampling { interval: settings.step, t_end: 200.0 };
    let motion = EngineFlow::new(&chain, settings).unwrap().trajectory(&start, sampling).unwrap();
    let peaks: Vec<(f64, f64)> = Cycles::of(&motion, 0).maxima.iter().map(|m| (m.time, m.value.ln())).collect();
    assert_eq!(peaks.len(), 31, "200 time units hold 31 peaks");
    let n = peaks.len() as f64;
    let mean = peaks.iter().fold((0.0, 0.0), |sum, peak| (sum.0 + peak.0 / n, sum.1 + peak.1 / n));
    let covariance: f64 = peaks.iter().map(|peak| (peak.0 - mean.0) * (peak.1 - mean.1)).sum();
    let variance: f64 = peaks.iter().map(|peak| (peak.0 - mean.0).powi(2)).sum();
    -2.0 * covariance / variance
}

#[test]
fn rapiers_defaults_feed_energy_in_as_more_than_half_of_the_rigs_damping() {
    for precision in [Precision::Double, Precision::Single] {
        for joints in [Joints::Impulse, Joints::Multibody] {
            let found = numerical_damping(EngineSettings { precision, joints, ..EngineSettings::rapier_defaults() });
            println!("{precision:?} {joints:?}: {found}");
            // The law gives -0.00625 exactly; the determinant against its exponential is 0.1 % of it, f32 peaks another 0.1 %.
            assert!((found / -0.00625 - 1.0).abs() < 0.02, "{precision:?} {joints:?}: {found}");
            assert!(-found > 0.5 * 0.011);
        }
    }
}

#[test]
fn the_law_holds_for_every_number_of_substeps() {
    for step in [1.0 / 60.0, 1.0 / 240.0] {
        for substeps in [2, 4, 8] {
            let n = substeps as f64;
            let law = -step * (1.0 - (n + 1.0) / (2.0 * n));
            let found = numerical_damping(EngineSettings { step, substeps, ..EngineSettings::rapier_defaults() });
            // ln(1 + e) against e with e = xi h below 1.3e-4, and the fit.
            assert!((found / law - 1.0).abs() < 0.01, "h = {step}, n = {substeps}: {found} for {law}");
        }
    }
}

#[test]
fn one_substep_damps_nothing() {
    for scheme in [Scheme::Plain, Scheme::SecondOrder] {
        let settings = EngineSettings { substeps: 1, scheme, ..EngineSettings::rapier_defaults() };
        let found = numerical_damping(settings);
        println!("{scheme:?}: {found:e}");
        // The map is area preserving, so the law gives 0. Peaks between samples are interpolated with an error of up to
        // h^2 (the plain velocities are off by h/2), at random over 31 peaks in 200 time units: 1e-6.
        assert!(found.abs() < 2e-6, "{scheme:?}: {found:e}");
    }
}
