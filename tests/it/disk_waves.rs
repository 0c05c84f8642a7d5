//! Travelling-wave limit cycles: one sector against the whole ring, describing function, stability against simulation.

use crate::disk_exact::scattered;
use nalgebra::{DMatrix, DVector};
use stickslip::disk::{
    DESCRIBING_FUNCTION, DiskError, MANY_HARMONICS, TravellingWave, largest_by_wave, ring_wave, settled_cycle,
    strongest, wave_amplitudes, wave_multipliers,
};
use stickslip::dynamics::{Sampling, State, TangentFlow};
use stickslip::exact::SparseFlow;
use stickslip::model::{
    Aerodynamics, BladedDisk, ContactPlace, DiskSegments, FrictionContacts, InfluenceCoefficient, Mistuning,
    NodalDiameter, RigParameters, Topology,
};
use stickslip::orbit::{SpatialClosure, shoot_flow};

const N: usize = 12;

/// damping(sigma) = mean - swing sin(sigma): forward waves are fed.
fn ring(mean: f64, swing: f64) -> BladedDisk {
    let l = |offset, real, imaginary| InfluenceCoefficient { offset, real, imaginary };
    BladedDisk {
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        aerodynamics: Some(Aerodynamics::Coefficients {
            coefficients: vec![l(0, 0.0, mean), l(1, 0.5 * swing, 0.0), l(-1, -0.5 * swing, 0.0)],
            reference_frequency: 1.0,
        }),
        ..BladedDisk::ring(N, 0.1)
    }
}

fn wave(n: i64) -> NodalDiameter {
    NodalDiameter::new(n, N)
}

#[test]
fn the_wave_of_the_whole_ring_is_that_of_one_sector_and_near_the_describing_function() {
    let disk = ring(0.01, 0.06);
    let flow = SparseFlow::new(&disk.chain().unwrap());
    for n in [1, 2, 3, 5] {
        let one = TravellingWave::of(&disk, wave(n), MANY_HARMONICS).unwrap();
        let whole = ring_wave(&flow, &one).unwrap();
        assert!(one.amplitude > 1.02 && whole.asymmetry < 1e-11, "{n}: {} {:e}", one.amplitude, whole.asymmetry);
        // What 256 harmonics leave out: at most 0.3/(6 * 512^3) = 4e-10, measured below 1e-11 (128 against 512).
        assert!((one.amplitude - whole.amplitude).abs() < 1e-9, "{n}: {:e}", one.amplitude - whole.amplitude);
        let frequency = whole.orbit.angular_frequency();
        assert!((one.angular_frequency - frequency).abs() < 1e-9, "{n}: {:e}", one.angular_frequency - frequency);
        let estimate = TravellingWave::of(&disk, wave(n), DESCRIBING_FUNCTION).unwrap();
        let off = (estimate.amplitude / whole.amplitude - 1.0).abs();
        assert!(off < 0.03 && off > 1e-7, "{n}: {off}");
    }
}

#[test]
fn fewer_harmonics_are_worse_at_least_with_their_third_power() {
    // Negative control of the agreement above, and the stated order of the error.
    let disk = ring(0.01, 0.06);
    let amplitude = |count| TravellingWave::of(&disk, wave(3), count).unwrap().amplitude;
    let reference = amplitude(MANY_HARMONICS);
    let [coarse, fine] = [4, 16].map(|count| (amplitude(count) - reference).abs());
    assert!(coarse > 1e-7 && fine < coarse / 64.0, "{coarse:e} {fine:e}");
}

#[test]
fn shrouded_blades_on_segments_agree_as_well() {
    let disk = BladedDisk {
        segments: Some(DiskSegments { mass: 5.0, stiffness: 10.0 }),
        friction: vec![FrictionContacts::everywhere(ContactPlace::NextBlade, 0.1)],
        coupling: 0.5,
        ..ring(0.005, 0.03)
    };
    let flow = SparseFlow::new(&disk.chain().unwrap());
    let one = TravellingWave::of(&disk, wave(3), 256).unwrap();
    let whole = ring_wave(&flow, &one).unwrap();
    // Weaker contacts: R = 0.1 in place of 0.5, half the harmonics.
    assert!((one.amplitude - whole.amplitude).abs() < 1e-9, "{:e}", one.amplitude - whole.amplitude);
}

#[test]
fn waves_that_the_air_damps_have_no_limit_cycle_and_rings_only_have_waves() {
    let disk = ring(0.01, 0.06);
    assert!(matches!(TravellingWave::of(&disk, wave(-3), 1), Err(DiskError::NoWave { wave: -3, .. })));
    assert!(matches!(TravellingWave::of(&ring(-0.9, 0.0), wave(0), 1), Err(DiskError::NoWave { .. })));
    let open = BladedDisk { topology: Topology::Chain, ..disk };
    assert!(matches!(TravellingWave::of(&open, wave(1), 1), Err(DiskError::NotOneGroup)));
}

/// Growth of every wave per period on the limit cycle n, and the flow.
fn growth(disk: &BladedDisk, n: i64) -> (SparseFlow, DVector<f64>, f64, Vec<(NodalDiameter, f64)>) {
    let flow = SparseFlow::new(&disk.chain().unwrap());
    let whole = ring_wave(&flow, &TravellingWave::of(disk, wave(n), 128).unwrap()).unwrap();
    let multipliers = wave_multipliers(&flow, disk, wave(n), &whole.orbit).unwrap();
    (flow, whole.orbit.state.clone(), whole.orbit.period, largest_by_wave(&multipliers, N))
}

#[test]
fn grouped_multipliers_are_those_of_the_full_monodromy() {
    let disk = ring(0.01, 0.06);
    let flow = SparseFlow::new(&disk.chain().unwrap());
    for n in [0_i64, 2, 3, 5] {
        let feeding = ring(-0.03, 0.0);
        let disk = if n == 0 { &feeding } else { &disk };
        let flow = if n == 0 { SparseFlow::new(&disk.chain().unwrap()) } else { flow.clone() };
        let whole = ring_wave(&flow, &TravellingWave::of(disk, wave(n), 128).unwrap()).unwrap();
        let grouped = wave_multipliers(&flow, disk, wave(n), &whole.orbit).unwrap();
        let full = whole.orbit.multipliers().unwrap();
        assert_eq!(grouped.len(), full.len());
        for m in grouped.iter().filter(|m| m.multiplier.norm() > 1e-3) {
            let nearest = full.iter().map(|f| (f - m.multiplier).norm()).fold(f64::INFINITY, f64::min);
            // Eigenvalues of a matrix that is not normal: its rounding times their condition.
            assert!(nearest < 1e-8, "{n}: {m:?} {nearest:e}");
        }
        let trivial = grouped.iter().filter(|m| m.relative.signed() == 0);
        let error = trivial.map(|m| (m.multiplier - 1.0).norm()).fold(f64::INFINITY, f64::min);
        assert!(error < 1e-8, "{n}: {error:e}");
    }
}

#[test]
fn a_perturbation_by_one_wave_grows_by_its_own_multiplier() {
    // The label of a multiplier, checked by a perturbation that is a pure wave in the moving frame: it stays in its group.
    let disk = ring(0.01, 0.06);
    let (flow, state, period, growth) = growth(&disk, 2);
    let n = flow.dimension();
    for r in [1_i64, -1, 3] {
        let shape = |j: usize, part: f64| (std::f64::consts::TAU * ((2 + r) * j as i64) as f64 / N as f64 + part).cos();
        let mut tangent = DVector::zeros(n);
        for j in 0..N {
            tangent[j] = shape(j, 0.0);
            // x = cos(w t - j sigma') at t = 0 has v = + sin(j sigma').
            tangent[N + j] = shape(j, -std::f64::consts::FRAC_PI_2);
        }
        let (mut y, mut tangents) = (state.clone(), DMatrix::from_columns(&[tangent]));
        let mut sizes = Vec::new();
        for _ in 0..60 {
            flow.carry(&mut y, &mut tangents, period).unwrap();
            sizes.push(tangents.norm());
        }
        // A real perturbation of relative number r carries -r as well, with the conjugate multiplier.
        let of = |r: i64| growth.iter().find(|(w, _)| *w == wave(r)).unwrap().1;
        let expected = of(r).max(of(-r));
        let found = (sizes[59] / sizes[29]).powf(1.0 / 30.0);
        // Beating between the two leaves the mean growth over 30 periods known to a per cent.
        assert!((found - expected).abs() < 0.01, "{r}: {found} {expected}");
    }
}

/// Whether a motion started near a wave is that wave 20 000 time units later, seen at the frequency `w`; and the amplitudes then.
fn stays(flow: &SparseFlow, n: NodalDiameter, start: &State, w: f64) -> (bool, Vec<f64>) {
    let mut start = start.clone();
    let noise = scattered(flow.chain(), 0.01);
    start.positions.iter_mut().zip(&noise.positions).for_each(|(x, d)| *x += d);
    let mut last = Vec::new();
    let sampling = Sampling { interval: 20_000.0, t_end: 20_000.0 };
    flow.observe(&start, sampling, |_, state, _| last = wave_amplitudes(state, N, w)).unwrap();
    let others = last.iter().enumerate().all(|(i, a)| i == n.index() || *a < 0.05 * last[n.index()]);
    (strongest(&last) == n && others, last)
}

/// Every nodal diameter of the ring: where there is a limit cycle, it is stable exactly if a motion started beside it stays; where there is none,
/// a motion started as that wave does not stay.
#[test]
fn stable_waves_stay_and_unstable_and_absent_ones_give_way() {
    let disk = ring(0.01, 0.04);
    let flow = SparseFlow::new(&disk.chain().unwrap());
    let mut seen = [0, 0, 0];
    for n in NodalDiameter::all(N) {
        match TravellingWave::of(&disk, n, 64) {
            Ok(estimate) => {
                let whole = ring_wave(&flow, &estimate).unwrap();
                let multipliers = wave_multipliers(&flow, &disk, n, &whole.orbit).unwrap();
                let worst = largest_by_wave(&multipliers, N).into_iter().map(|(_, size)| size).fold(0.0, f64::max);
                let on_orbit = State::from_components(whole.orbit.state.as_slice(), flow.chain()).unwrap();
                let (stays, last) = stays(&flow, n, &on_orbit, whole.orbit.angular_frequency());
                assert_eq!(stays, worst < 1.0, "{}: multiplier {worst}, amplitudes {last:?}", n.signed());
                seen[usize::from(stays)] += 1;
            }
            Err(error) => {
                assert!(matches!(error, DiskError::NoWave { .. }), "{}: {error}", n.signed());
                let angle = |j: usize| -n.multiple(j as i64);
                let start = State {
                    positions: (0..N).map(|j| 1.2 * angle(j).cos()).collect(),
                    velocities: (0..N).map(|j| -1.2 * angle(j).sin()).collect(),
                    ..State::rest(flow.chain())
                };
                let (stays, last) = stays(&flow, n, &start, 1.0);
                assert!(!stays, "{}: {last:?}", n.signed());
                seen[2] += 1;
            }
        }
    }
    assert!(seen.iter().all(|count| *count >= 1), "all three kinds should occur: {seen:?}");
}

#[test]
fn a_mistuned_disk_settles_on_a_stable_cycle_with_unequal_blades() {
    let mistuning = Some(Mistuning::Normal { standard_deviation: 0.02, seed: 3 });
    let disk = BladedDisk { mistuning, ..ring(0.01, 0.06) };
    let flow = SparseFlow::new(&disk.chain().unwrap());
    let start = scattered(flow.chain(), 1.0);
    let cycle = settled_cycle(&disk, &flow, &start, 3000.0, |_, _| {}).unwrap().cycle;
    assert!(cycle.stable() && cycle.leading_multiplier > 0.5, "{}", cycle.leading_multiplier);
    let (low, high) = cycle.amplitudes.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), a| (l.min(*a), h.max(*a)));
    // Tuned blades are equal to 1e-11.
    assert!(high > 1.005 * low, "{low} {high}");
    // The motion itself stays there: largest displacements over ten more periods.
    let at = State::from_components(cycle.orbit.state.as_slice(), flow.chain()).unwrap();
    let mut largest = vec![0.0_f64; N];
    let sampling = Sampling { interval: cycle.orbit.period / 256.0, t_end: 10.0 * cycle.orbit.period };
    flow.observe(&at, sampling, |_, state, _| {
        largest.iter_mut().zip(&state.positions).for_each(|(l, x)| *l = l.max(x.abs()));
    })
    .unwrap();
    for (a, l) in cycle.amplitudes.iter().zip(&largest) {
        // Peaks fall between samples: (pi/256)^2/2 of the amplitude at most.
        assert!((0.0..1e-4).contains(&(a - l)), "{a} {l}");
    }
}

/// The two-mass rig as two blades in an open chain.
fn two(xi1: f64) -> BladedDisk {
    let p = RigParameters { xi1, ..RigParameters::default() };
    let l = |offset, imaginary| InfluenceCoefficient { offset, real: 0.0, imaginary };
    let [d1, d2] = [0.5 * (p.xi1 + p.xi2), 0.5 * (p.xi1 - p.xi2)];
    BladedDisk {
        topology: Topology::Chain,
        friction: vec![FrictionContacts {
            sectors: Some(vec![0]),
            ..FrictionContacts::everywhere(ContactPlace::Foot, p.gamma)
        }],
        aerodynamics: Some(Aerodynamics::Coefficients {
            coefficients: vec![l(0, d1), l(1, d2), l(-1, d2)],
            reference_frequency: 1.0,
        }),
        ..BladedDisk::ring(2, p.kappa)
    }
}

#[test]
fn two_blades_lose_stability_where_the_two_mass_rig_does() {
    // The multiplier of the half-period map through this flow and this shooting reaches 1 at the published point.
    let mut guess = DVector::from_vec(vec![1.2, 0.95, 0.0, -0.3, 1.0]);
    let mut period = 6.3;
    let mut excess = |xi1: f64| {
        let flow = SparseFlow::new(&two(xi1).chain().unwrap());
        let admit = |y: &mut DVector<f64>| y[4] = y[4].clamp(-1.0, 1.0);
        let orbit = shoot_flow(&flow, &guess, period, &SpatialClosure::half_period(5), admit).unwrap();
        (guess, period) = (orbit.state.clone(), orbit.period);
        let multipliers = orbit.multipliers().unwrap();
        // The half-period map has the trivial multiplier 1; the critical pair is complex.
        multipliers.iter().filter(|m| m.im.abs() > 0.05).map(|m| m.norm()).fold(0.0, f64::max) - 1.0
    };
    let (mut a, mut b) = (-0.034, -0.035);
    let (mut fa, mut fb) = (excess(a), excess(b));
    assert!(fa < 0.0 && fb > 0.0, "{fa} {fb}");
    for _ in 0..8 {
        let next = b - fb * (b - a) / (fb - fa);
        (a, fa) = (b, fb);
        (b, fb) = (next, excess(next));
        if fb.abs() < 1e-14 {
            break;
        }
    }
    assert!((b + 0.0345753708).abs() < 1e-8, "{b}");
}
