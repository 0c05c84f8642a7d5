//! Limit cycles of mistuned disks: the tuned limit, small mistuning as a perturbation, following a wave as mistuning grows.

use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;
use stickslip::disk::{
    DiskCycle, DiskError, MANY_HARMONICS, TravellingWave, blade_amplitudes, mistuned_wave, participation, ring_wave,
    settled_cycle,
};
use stickslip::dynamics::{Sampling, State};
use stickslip::exact::SparseFlow;
use stickslip::model::{
    Aerodynamics, BladedDisk, ContactPlace, FrictionContacts, InfluenceCoefficient, Mistuning, NodalDiameter,
};
use stickslip::orbit::{FlowOrbit, SpatialClosure};

const N: usize = 8;

/// Forward waves are fed, 2 most; the deviations are `size` times a pattern.
fn ring(size: f64, pattern: impl Fn(usize) -> f64) -> BladedDisk {
    let l = |offset, real, imaginary| InfluenceCoefficient { offset, real, imaginary };
    BladedDisk {
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        aerodynamics: Some(Aerodynamics::Coefficients {
            coefficients: vec![l(0, 0.0, 0.01), l(1, 0.03, 0.0), l(-1, -0.03, 0.0)],
            reference_frequency: 1.0,
        }),
        mistuning: Some(Mistuning::Pattern { deviations: (0..N).map(|j| size * pattern(j)).collect() }),
        ..BladedDisk::ring(N, 0.1)
    }
}

fn wave(n: i64) -> NodalDiameter {
    NodalDiameter::new(n, N)
}

/// `cos(2 pi 3 j/N)`: no mean, so that it moves no frequency at first order.
fn third(j: usize) -> f64 {
    (TAU * 3.0 * j as f64 / N as f64).cos()
}

/// Of the wave 3: on the wave 2 = N/4 the two waves that a harmonic mixes in lie as far above as below, and cancel.
fn cycle(size: f64, pattern: impl Fn(usize) -> f64) -> DiskCycle {
    mistuned_wave(&ring(size, pattern), wave(3), 2).unwrap()
}

#[test]
fn without_mistuning_the_cycle_is_the_travelling_wave() {
    let disk = ring(0.0, third);
    let found = mistuned_wave(&disk, wave(2), 1).unwrap();
    let one = TravellingWave::of(&disk, wave(2), MANY_HARMONICS).unwrap();
    let whole = ring_wave(&SparseFlow::new(&disk.chain().unwrap()), &one).unwrap();
    for amplitude in &found.amplitudes {
        // The residual of Newton's method, 2e-12, and what 256 harmonics leave out.
        assert!((amplitude - one.amplitude).abs() < 1e-9 && (amplitude - whole.amplitude).abs() < 1e-10);
    }
    assert!((found.orbit.angular_frequency() - one.angular_frequency).abs() < 1e-9);
    assert!(found.orbit.residual < 1e-11 && found.stuck_contacts == 0);
    assert!((found.participation() - 1.0).abs() < 1e-9);
}

/// The part of harmonic r round the ring, `|1/N sum_j d_j exp(-2 pi i r j/N)|`.
fn share(values: &[f64], r: usize) -> f64 {
    let part = |of: fn(f64) -> f64| {
        values.iter().enumerate().map(|(j, d)| d * of(TAU * (r * j) as f64 / N as f64)).sum::<f64>() / N as f64
    };
    part(f64::cos).hypot(part(f64::sin))
}

#[test]
fn small_mistuning_moves_amplitudes_linearly_in_its_own_harmonic_and_the_frequency_quadratically() {
    let tuned = cycle(0.0, third);
    let change = |size: f64| {
        let moved = cycle(size, third);
        let amplitudes: Vec<f64> = moved.amplitudes.iter().zip(&tuned.amplitudes).map(|(a, b)| a - b).collect();
        (amplitudes, moved.orbit.angular_frequency() - tuned.orbit.angular_frequency())
    };
    let ((coarse, by_coarse), (fine, by_fine)) = (change(2e-4), change(1e-4));
    let largest = coarse.iter().fold(0.0_f64, |l, a| l.max(a.abs()));
    assert!(largest > 1e-5, "the mistuning should be felt: {largest:e}");
    for (a, b) in coarse.iter().zip(&fine) {
        // Second order: the size, relative, with a factor of a hundred for the nearness of other waves.
        assert!((a - 2.0 * b).abs() < 0.02 * largest, "{a:e} {b:e}");
    }
    // By symmetry, a pattern of harmonic 3 on a wave can modulate amplitudes in harmonic 3 alone at first order.
    for r in [0, 1, 2, 4] {
        assert!(share(&coarse, r) < 0.02 * share(&coarse, 3), "{r}: {:e} {:e}", share(&coarse, r), share(&coarse, 3));
    }
    // A pattern without mean moves the frequency at second order: four times as far for twice the mistuning.
    assert!((by_coarse / by_fine - 4.0).abs() < 0.2, "{by_coarse:e} {by_fine:e}");
    // Negative control: one with a mean moves it at first order, by delta/(2 w) at most (the part of the blade's own stiffness).
    let shifted = |size: f64| cycle(size, |_| 1.0).orbit.angular_frequency() - tuned.orbit.angular_frequency();
    let (coarse, fine) = (shifted(2e-4), shifted(1e-4));
    assert!((coarse / fine - 2.0).abs() < 0.01, "{coarse:e} {fine:e}");
    let expected = 2e-4 / (2.0 * tuned.orbit.angular_frequency());
    // One harmonic, amplitude and slip following: measured within 2 %.
    assert!((coarse / expected - 1.0).abs() < 0.05, "{coarse:e} {expected:e}");
}

#[test]
fn the_wave_followed_as_mistuning_grows_is_the_cycle_on_which_motions_settle() {
    let disk = ring(0.02, |j| (2.4 * (j * j) as f64).sin());
    let followed = mistuned_wave(&disk, wave(2), 8).unwrap();
    assert!(followed.stable(), "{}", followed.leading_multiplier);
    let flow = SparseFlow::new(&disk.chain().unwrap());
    let start = TravellingWave::of(&disk, wave(2), 16).unwrap().state();
    let settled = settled_cycle(&disk, &flow, &start, 3000.0, |_, _| {}).unwrap().cycle;
    for (a, b) in followed.amplitudes.iter().zip(&settled.amplitudes) {
        // Two orbits closed to 2e-12, of a cycle whose perturbations halve in some periods.
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    let (low, high) = followed.amplitudes.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), a| (l.min(*a), h.max(*a)));
    assert!(high > 1.001 * low && followed.participation() < 1.0 - 1e-7, "{low} {high}");
    assert!((followed.participation() - participation(&settled.amplitudes)).abs() < 1e-8);
}

/// The multiplier of an unstable cycle, against how fast motions beside it part from it.
#[test]
fn an_unstable_cycle_is_left_at_the_rate_of_its_multiplier() {
    // Wave 1 of this ring exists and is not stable.
    let disk = ring(0.005, |j| (2.4 * (j * j) as f64).sin());
    let cycle = mistuned_wave(&disk, wave(1), 8).unwrap();
    assert!(!cycle.stable(), "{}", cycle.leading_multiplier);
    let flow = SparseFlow::new(&disk.chain().unwrap());
    let on_orbit = State::from_components(cycle.orbit.state.as_slice(), flow.chain()).unwrap();
    let mut beside = on_orbit.clone();
    beside.positions.iter_mut().enumerate().for_each(|(j, x)| *x += 1e-7 * (2.4 * (j * j) as f64 + 1.0).cos());
    let period = cycle.orbit.period;
    let mut distances = Vec::new();
    let sampling = Sampling { interval: period, t_end: 400.0 * period };
    flow.observe(&beside, sampling, |_, state, _| distances.push(state.max_difference(&on_orbit))).unwrap();
    let grown: Vec<(usize, f64)> =
        distances.iter().copied().enumerate().filter(|(_, d)| (1e-5..1e-3).contains(d)).collect();
    let ((from, d), (to, e)) = (grown[0], grown[grown.len() - 1]);
    assert!(to > from + 5, "{from} {to}");
    let rate = (e / d).powf(1.0 / (to - from) as f64);
    // A pair that turns makes the distance swing about its growth: a tenth of the growth is left for it.
    assert!(
        (rate - cycle.leading_multiplier).abs() < 0.1 * (cycle.leading_multiplier - 1.0),
        "{rate} {}",
        cycle.leading_multiplier
    );
}

#[test]
fn waves_that_do_not_exist_cannot_be_followed() {
    assert!(matches!(mistuned_wave(&ring(0.01, third), wave(-2), 4), Err(DiskError::NoWave { wave: -2, .. })));
}

#[test]
fn the_amplitude_of_a_blade_leaves_out_the_displacement_that_a_stuck_contact_holds() {
    // An uncoupled blade let go at x_0 with a contact of zero force there swings, without slip, about x_0/2 with amplitude x_0/2 and frequency 1, as
    // the contact has half of its stiffness.
    let disk = BladedDisk {
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        ..BladedDisk::ring(3, 0.0)
    };
    let chain = disk.chain().unwrap();
    let mut start = State::rest(&chain);
    start.positions[..2].copy_from_slice(&[0.4, -0.1]);
    let state = DVector::from_iterator(9, start.components());
    let closing = DMatrix::zeros(9, 9);
    let orbit = FlowOrbit { state, period: TAU, closure: SpatialClosure::full_period(9), closing, residual: 0.0 };
    let found = blade_amplitudes(&SparseFlow::new(&chain), &orbit, 3).unwrap();
    for (found, expected) in found.iter().zip([0.2, 0.05, 0.0]) {
        // Rounding of the closed-form motion over two periods.
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
}
