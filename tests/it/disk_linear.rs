//! Bladed disks, linear: the eigenvalues of a ring against closed forms, forward and backward waves apart; mistuned modes.

use nalgebra::Complex;
use std::f64::consts::{PI, TAU};
use stickslip::dynamics::State;
use stickslip::model::{
    Aerodynamics, BladedDisk, ContactPlace, DiskSegments, FrictionContacts, InfluenceCoefficient, Mistuning,
    NodalDiameter, OscillatorChain, Topology, TravelDirection,
};

const N: usize = 12;
const KAPPA: f64 = 0.1;
const GAMMA: f64 = 0.5;

/// `L_-1, L_0, L_1`.
const L: [(i64, f64, f64); 3] = [(-1, 0.011, -0.004), (0, 0.003, 0.012), (1, -0.009, 0.002)];

fn ring(aerodynamics: bool) -> BladedDisk {
    let coefficient = |(offset, real, imaginary)| InfluenceCoefficient { offset, real, imaginary };
    BladedDisk {
        damping: if aerodynamics { 0.001 } else { 0.0 },
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, GAMMA)],
        aerodynamics: aerodynamics.then(|| Aerodynamics::Coefficients {
            coefficients: L.map(coefficient).to_vec(),
            reference_frequency: 0.9,
        }),
        ..BladedDisk::ring(N, KAPPA)
    }
}

fn stuck(chain: &OscillatorChain) -> Vec<bool> {
    vec![true; chain.sliders()]
}

#[test]
fn a_stuck_ring_without_air_has_the_sticking_frequencies() {
    let chain = ring(false).chain().unwrap();
    let modes = chain.linear_modes(&stuck(&chain)).unwrap();
    let mut expected: Vec<f64> =
        (0..N).map(|n| (1.0 + 4.0 * KAPPA * (PI * n as f64 / N as f64).sin().powi(2)).sqrt()).collect();
    expected.sort_by(f64::total_cmp);
    for (mode, expected) in modes.iter().zip(&expected) {
        // Backward error of the QR iteration on a 24 x 24 matrix.
        assert!((mode.angular_frequency - expected).abs() < 1e-12 && mode.damping.abs() < 1e-12, "{mode:?} {expected}");
    }
    assert_eq!(modes.len(), N);
    // Negative control: one third of the coupling missing is seen.
    let other = BladedDisk { coupling: KAPPA * 0.999, ..ring(false) }.chain().unwrap();
    let largest = other.linear_modes(&stuck(&other)).unwrap()[N - 1].angular_frequency;
    assert!((largest - expected[N - 1]).abs() > 1e-5);
}

/// The closed form, written down a second time: `s^2 + (c + i-parts/w) s + k = 0` for the wave n.
fn closed_form(n: i64) -> Complex<f64> {
    let sigma = TAU * n as f64 / N as f64;
    let turned = |part: fn((i64, f64, f64)) -> f64| -> Complex<f64> {
        L.iter().map(|&l| Complex::from_polar(1.0, -(l.0 as f64) * sigma) * part(l)).sum::<Complex<f64>>()
    };
    let k: Complex<f64> = turned(|l| l.1) + 1.0 + 2.0 * KAPPA * (1.0 - sigma.cos());
    let d: Complex<f64> = turned(|l| l.2) / 0.9 + 0.001;
    // For small d the root with positive imaginary part takes the principal square root.
    let s: Complex<f64> = 0.5 * (Complex::<f64>::i() * (4.0 * k - d * d).sqrt() - d);
    assert!((s * s + d * s + k).norm() < 1e-15 && s.im > 0.0);
    s
}

#[test]
fn forward_and_backward_waves_of_a_stuck_ring_have_the_eigenvalues_of_the_closed_form() {
    let disk = ring(true);
    let chain = disk.chain().unwrap();
    let numeric = chain.linear_modes(&stuck(&chain)).unwrap();
    let waves = disk.tuned_modes(true).unwrap();
    assert_eq!((numeric.len(), waves.len()), (N, N));
    for found in waves {
        let s = closed_form(found.wave.signed());
        let off = |mode: &stickslip::model::LinearMode| {
            (mode.angular_frequency - s.im).abs().max((mode.damping + 2.0 * s.re).abs())
        };
        assert!(off(&found.mode) < 1e-14, "{found:?} {s}");
        let nearest = numeric.iter().map(off).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-12, "wave {}: {nearest:e}", found.wave.signed());
    }
    // Forward and backward differ, and exchange if the sign convention is reversed.
    let damping = |n: i64| -2.0 * closed_form(n).re;
    assert!((damping(3) - damping(-3)).abs() > 0.03);
}

#[test]
fn the_s_curve_is_the_damping_that_the_ring_was_given() {
    let given: Vec<f64> = (0..N).map(|n| 0.006 - 0.01 * (TAU * n as f64 / N as f64 + 0.4).sin()).collect();
    let disk = BladedDisk {
        aerodynamics: Some(Aerodynamics::Waves { damping: given.clone(), stiffness: None, reference_frequency: 1.0 }),
        ..BladedDisk::ring(N, 0.0)
    };
    for (wave, damping) in disk.aerodynamic_damping().unwrap() {
        assert!((damping - given[wave.index()]).abs() < 1e-16);
    }
    for found in disk.tuned_modes(true).unwrap() {
        // Uncoupled blades oscillate at w = 1 to O(damping), where the damping is the given one to O(damping^2).
        assert!((found.mode.damping - given[found.wave.index()]).abs() < 3e-4, "{found:?}");
        assert_eq!(found.wave.direction() == TravelDirection::Forward, (1..6).contains(&found.wave.signed()));
    }
}

#[test]
fn an_unstable_forward_wave_runs_to_higher_blade_numbers() {
    // The exact motion itself decides the direction: crests reach blade j+1 a time sigma/w after blade j.
    let disk = ring(true);
    let chain = BladedDisk { friction: vec![], ..disk }.chain().unwrap();
    let wave = NodalDiameter::new(2, N);
    let s = closed_form(2);
    let at = |j: usize| Complex::from_polar(1e-3, -wave.multiple(j as i64));
    let start = State {
        positions: (0..N).map(|j| at(j).re).collect(),
        velocities: (0..N).map(|j| (s * at(j)).re).collect(),
        slider_forces: vec![],
    };
    let motion = stickslip::exact::ChainFlow::new(&chain).solve(&start, 20.0).unwrap();
    for j in 0..N - 1 {
        let t = 15.0;
        let here = motion.state_at(t).unwrap().state.positions[j];
        let there = motion.state_at(t + wave.phase_angle() / s.im).unwrap().state.positions[j + 1];
        let growth = (s.re * wave.phase_angle() / s.im).exp();
        // A single eigenmode: the relation holds to rounding.
        assert!((there - growth * here).abs() < 1e-15, "blade {j}: {here} {there}");
    }
}

#[test]
fn waves_of_a_disk_with_segments_are_eigenvalues_of_the_whole_matrix() {
    let disk = BladedDisk { segments: Some(DiskSegments { mass: 4.0, stiffness: 3.0 }), ..ring(true) };
    let chain = disk.chain().unwrap();
    let numeric = chain.linear_modes(&stuck(&chain)).unwrap();
    let waves = disk.tuned_modes(true).unwrap();
    assert_eq!((numeric.len(), waves.len()), (2 * N, 2 * N));
    for found in waves {
        let off = |mode: &&stickslip::model::LinearMode| {
            (mode.angular_frequency - found.mode.angular_frequency).abs().max((mode.damping - found.mode.damping).abs())
        };
        let nearest = numeric.iter().map(|mode| off(&mode)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-12, "{found:?}: {nearest:e}");
    }
}

#[test]
fn mode_shapes_of_a_ring_are_waves_and_mistuning_mixes_them() {
    let chain = ring(true).chain().unwrap();
    for shape in chain.mode_shapes(&stuck(&chain)).unwrap() {
        let wave = shape.dominant_wave(N);
        assert!((closed_form(wave.signed()).im - shape.mode.angular_frequency).abs() < 1e-11, "{wave:?}");
        // All eigenvalues differ, so shapes are pure; the iteration stops some roundings over the smallest gap away.
        assert!((shape.participation(N) - 1.0).abs() < 1e-9 && shape.wave_shares(N)[wave.index()] > 1.0 - 1e-9);
    }
    let mistuned = BladedDisk { mistuning: Some(Mistuning::Normal { standard_deviation: 0.2, seed: 1 }), ..ring(true) };
    let chain = mistuned.chain().unwrap();
    let shapes = chain.mode_shapes(&stuck(&chain)).unwrap();
    let mean = shapes.iter().map(|shape| shape.participation(N)).sum::<f64>() / N as f64;
    assert!(mean < 0.6, "strong mistuning localises: {mean}");
    let (m, k, d) = (chain.mass(), chain.stiffness_with(&stuck(&chain)), chain.total_damping());
    for shape in shapes {
        let s = Complex::new(-0.5 * shape.mode.damping, shape.mode.angular_frequency);
        for i in 0..N {
            let row: Complex<f64> = (0..N).map(|j| (s * d[(i, j)] + k[(i, j)]) * shape.shape[j]).sum();
            // Residual of the pencil: roundings of a row sum of about 2.
            assert!((s * s * m[i] * shape.shape[i] + row).norm() < 1e-11);
        }
    }
}

#[test]
fn mean_damping_is_untouched_by_mistuning() {
    // The trace of the damping matrix: the mean of all dampings is L_0's whatever the pattern; mistuning can only average.
    let mean = |disk: &BladedDisk| {
        let chain = disk.chain().unwrap();
        let modes = chain.linear_modes(&stuck(&chain)).unwrap();
        modes.iter().map(|mode| mode.damping).sum::<f64>() / N as f64
    };
    let least = |disk: &BladedDisk| {
        let chain = disk.chain().unwrap();
        chain.linear_modes(&stuck(&chain)).unwrap().iter().map(|mode| mode.damping).fold(f64::INFINITY, f64::min)
    };
    let mistuned = BladedDisk { mistuning: Some(Mistuning::Uniform { half_width: 0.1, seed: 7 }), ..ring(true) };
    assert!((mean(&ring(true)) - mean(&mistuned)).abs() < 1e-12);
    // The open chain has another matrix with the same diagonal.
    let open = BladedDisk { topology: Topology::Chain, ..ring(true) };
    assert!((mean(&ring(true)) - mean(&open)).abs() < 1e-12);
    // Ten per cent of scatter against a coupling of ten: the least damping moves a good part of the way to the mean.
    let (tuned, mean) = (least(&ring(true)), mean(&ring(true)));
    assert!(least(&mistuned) > tuned + 0.1 * (mean - tuned), "{} {tuned} {mean}", least(&mistuned));
}
