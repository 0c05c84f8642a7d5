//! The slow flow of N oscillators against the two-mass slow flow, harmonic balance of waves, and the exact motion.

use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::TAU;
use std::sync::Arc;
use stickslip::averaging::{
    AveragingError, Carrier, ChainSlowFlow, EnergyDefinition, EnergyFrequency, Interpolation, SlowFlow,
};
use stickslip::disk::{
    DESCRIBING_FUNCTION, TravellingWave, ring_wave, slow_wave_amplitudes, strongest, wave_amplitudes,
};
use stickslip::dynamics::{Outcome, Sampling, State};
use stickslip::exact::SparseFlow;
use stickslip::model::{
    Aerodynamics, BladedDisk, ContactPlace, DiskSegments, FrictionContacts, InfluenceCoefficient, NodalDiameter,
    OscillatorChain, RigParameters, TwoMassRig,
};

type C = Complex<f64>;
const N: usize = 12;

fn rig(p: RigParameters) -> OscillatorChain {
    TwoMassRig::new(p).unwrap().chain().clone()
}

fn two_mass(p: RigParameters) -> SlowFlow {
    let w = EnergyFrequency::new(p, EnergyDefinition::MeanPotential, Interpolation::Converged).unwrap();
    SlowFlow::new(p, Arc::new(w)).unwrap()
}

fn rates(flow: &ChainSlowFlow, z: &[C]) -> (Vec<C>, f64) {
    let mut rates = vec![C::ZERO; z.len()];
    let w = flow.rates(z, &mut rates).unwrap();
    (rates, w)
}

/// Rates of `(a1, Re B, Im B)` from those of `z1 = a1`, `z2 = B`.
fn reduced(a: f64, b: C, rate: &[C]) -> Vector3<f64> {
    let turned = rate[1] - C::i() * (rate[0].im / a) * b;
    Vector3::new(rate[0].re, turned.re, turned.im)
}

#[test]
fn two_oscillators_on_the_same_carrier_have_the_rates_of_the_two_mass_slow_flow() {
    let p = RigParameters { xi1: -0.09, ..RigParameters::default() };
    let known = two_mass(p);
    for (a, b) in [(0.6, C::new(0.4, 0.1)), (1.3, C::new(0.9, -0.4)), (2.4, C::new(-1.0, 1.5))] {
        let expected = known.slow_rate(&Vector3::new(a, b.re, b.im));
        let rate_of = |p| {
            let flow = ChainSlowFlow::new(&rig(p)).with_carrier(Carrier::Given(expected.angular_frequency)).unwrap();
            let (rate, _) = rates(&flow, &[C::from(a), b]);
            (reduced(a, b, &rate), rate[0].im / a)
        };
        let (found, turn) = rate_of(p);
        // Rounding of a few terms of order 1.
        assert!((found - expected.rate).amax() < 1e-15 && (turn - expected.phase_rate).abs() < 1e-15, "{found}");
        let (other, _) = rate_of(RigParameters { kappa: 0.10001, ..p });
        assert!((other - expected.rate).amax() > 1e-7, "negative control: another coupling shows");
        let (other, _) = rate_of(RigParameters { gamma: 0.50001, ..p });
        assert!(a < 1.0 || (other - expected.rate).amax() > 1e-7, "negative control: another friction law shows");
    }
}

/// Limit cycles of the two-mass slow flow are motions of one frequency: the mean frequency is theirs, and they are fixed points.
#[test]
fn limit_cycles_of_the_two_mass_slow_flow_are_fixed_points_on_the_mean_carrier() {
    let known = two_mass(RigParameters::default());
    let cycles: Vec<_> = known.frequency().branch().map(|(_, cycle)| *cycle).step_by(400).skip(1).collect();
    assert!(cycles.len() > 5 && cycles.iter().any(|cycle| cycle.amplitude > 3.0));
    for cycle in cycles {
        let flow = ChainSlowFlow::new(&rig(RigParameters { xi1: cycle.xi1, ..RigParameters::default() }));
        let z = [C::from(cycle.amplitude), cycle.ratio * cycle.amplitude];
        let (rate, w) = rates(&flow, &z);
        let size = cycle.amplitude;
        // The residual of the branch, 1e-14, per amplitude, and rounding.
        assert!((w - cycle.angular_frequency).abs() < 1e-12, "{cycle:?} {w}");
        assert!(rate.iter().all(|r| r.norm() < 1e-12 * size), "{cycle:?} {rate:?}");
    }
}

/// How the carrier follows from a state near the limit cycle: of the two-mass slow flow, the cycle's frequency, and `(a1, B)`.
type CarrierLaw = fn(&SlowFlow, f64, f64, C) -> Carrier;

/// Where a complex pair of the two-mass limit cycle crosses the axis through the rates of the chain, by bisection in xi1.
fn hopf(law: CarrierLaw) -> f64 {
    let known = two_mass(RigParameters::default());
    let branch: Vec<_> = known.frequency().branch().map(|(_, cycle)| *cycle).collect();
    let growth = |index: usize| {
        let cycle = branch[index];
        let chain = rig(RigParameters { xi1: cycle.xi1, ..RigParameters::default() });
        let two = known.with_xi1(cycle.xi1).unwrap();
        let at = [cycle.amplitude, cycle.slow_state()[1], cycle.slow_state()[2]];
        let h = 1e-6;
        let field = |y: [f64; 3]| {
            let b = C::new(y[1], y[2]);
            let carrier = law(&two, cycle.angular_frequency, y[0], b);
            let flow = ChainSlowFlow::new(&chain).with_carrier(carrier).unwrap();
            reduced(y[0], b, &rates(&flow, &[C::from(y[0]), b]).0)
        };
        let column = |i: usize| {
            let moved = |by: f64| {
                let mut y = at;
                y[i] += by;
                field(y)
            };
            (moved(h) - moved(-h)) / (2.0 * h)
        };
        let jacobian = Matrix3::from_columns(&[column(0), column(1), column(2)]);
        let values = jacobian.complex_eigenvalues();
        values.iter().filter(|v| v.im.abs() > 1e-3).map(|v| v.re).fold(f64::NEG_INFINITY, f64::max)
    };
    let past = |xi1: f64| branch.iter().position(|cycle| cycle.xi1 < xi1).unwrap();
    let (mut low, mut high) = (past(-0.02), past(-0.06));
    assert!(growth(low) < 0.0 && growth(high) > 0.0, "{} {}", growth(low), growth(high));
    while high - low > 1 {
        let middle = (low + high) / 2;
        if growth(middle) < 0.0 { low = middle } else { high = middle }
    }
    let (a, b) = (growth(low), growth(high));
    branch[low].xi1 + (branch[high].xi1 - branch[low].xi1) * a / (a - b)
}

#[test]
fn two_oscillators_lose_stability_where_the_two_mass_slow_flow_does_on_its_carrier() {
    let by_energy = hopf(|two, _, a, b| Carrier::Given(two.energy_and_frequency(&Vector3::new(a, b.re, b.im)).1));
    // The point of the two-mass slow flow, from its own derivatives; here finite differences, and a chord of the branch.
    assert!((by_energy + 0.0350021436).abs() < 1e-7, "{by_energy}");
    // The choice of the carrier off the limit cycle is worth some per cent of the damping at which the cycle loses stability.
    let mean = hopf(|_, _, _, _| Carrier::Mean);
    let held = hopf(|_, w, _, _| Carrier::Given(w));
    println!(
        "secondary Hopf point: w(E) {by_energy:.7}, mean frequency {mean:.7}, frequency of the cycle {held:.7}; exact -0.0345754"
    );
    for found in [mean, held] {
        assert!((found / -0.0345753708 - 1.0).abs() < 0.1, "{mean} {held}");
    }
}

/// Foot contacts; damping(sigma) = mean - swing sin(sigma).
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

/// Complex amplitudes of all oscillators in a travelling wave.
fn amplitudes(wave: &TravellingWave) -> Vec<C> {
    let first = &wave.harmonics[0];
    let at = |part: usize, j: usize| first[part] * C::from_polar(1.0, -wave.wave.multiple(j as i64));
    (0..first.len()).flat_map(|part| (0..N).map(move |j| (part, j))).map(|(part, j)| at(part, j)).collect()
}

#[test]
fn travelling_waves_by_the_describing_function_are_fixed_points() {
    let shrouded = BladedDisk {
        segments: Some(DiskSegments { mass: 5.0, stiffness: 10.0 }),
        friction: vec![FrictionContacts::everywhere(ContactPlace::NextBlade, 0.1)],
        coupling: 0.5,
        ..ring(0.005, 0.03)
    };
    for (disk, numbers) in [(ring(0.01, 0.06), &[1, 2, 3, 5][..]), (shrouded, &[3][..])] {
        let flow = ChainSlowFlow::new(&disk.chain().unwrap());
        for n in numbers {
            let wave = TravellingWave::of(&disk, NodalDiameter::new(*n, N), DESCRIBING_FUNCTION).unwrap();
            let z = amplitudes(&wave);
            let (rate, w) = rates(&flow, &z);
            // The residual of harmonic balance, 1e-13, and rounding.
            assert!((w - wave.angular_frequency).abs() < 1e-12, "{n}: {w} {}", wave.angular_frequency);
            let largest = rate.iter().map(|r| r.norm()).fold(0.0, f64::max);
            assert!(largest < 1e-12, "{n}: {largest:e}");
            // Negative control: two per cent more amplitude is no fixed point.
            let grown: Vec<C> = z.iter().map(|z| z * 1.02).collect();
            assert!(rates(&flow, &grown).0.iter().any(|r| r.norm() > 1e-5));
        }
    }
}

#[test]
fn a_small_wave_grows_to_the_fixed_point_which_is_near_the_exact_wave() {
    let disk = ring(0.01, 0.06);
    let chain = disk.chain().unwrap();
    let number = NodalDiameter::new(3, N);
    let estimate = TravellingWave::of(&disk, number, DESCRIBING_FUNCTION).unwrap();
    let exact = ring_wave(&SparseFlow::new(&chain), &estimate).unwrap();
    let flow = ChainSlowFlow::new(&chain);
    let start = State {
        positions: (0..N).map(|j| 0.3 * number.multiple(j as i64).cos()).collect(),
        velocities: (0..N).map(|j| 0.3 * number.multiple(j as i64).sin()).collect(),
        ..State::rest(&chain)
    };
    let start = flow.slow_state(&start).unwrap();
    let mut last = Vec::new();
    let mut times = Vec::new();
    let sampling = Sampling { interval: 7.0, t_end: 2000.0 };
    let arrival = flow
        .follow(&start, sampling, |t, state| {
            times.push(t);
            last = slow_wave_amplitudes(&state.amplitudes);
        })
        .unwrap();
    assert_eq!(arrival.outcome, Outcome::Completed);
    assert!(times.iter().copied().eq(sampling.times()));
    let first: f64 = estimate.harmonics[0][0].norm();
    // The tolerance of the integration, at a stable fixed point.
    assert!((last[number.index()] - first).abs() < 1e-6, "{} {first}", last[number.index()]);
    // The describing function itself, as in the test of harmonic balance.
    assert!((last[number.index()] / exact.amplitude - 1.0).abs() < 0.03);
    let frequency = flow.frequency(&arrival.state.amplitudes).unwrap();
    assert!((frequency / exact.orbit.angular_frequency() - 1.0).abs() < 1e-3);
}

/// From the same irregular start: the wave that is left, by the slow flow and by the exact flow; and the work of both.
fn winners(disk: &BladedDisk, seed: usize, t_end: f64) -> ([NodalDiameter; 2], [usize; 2]) {
    let chain = disk.chain().unwrap();
    let positions = (0..N).map(|j| 1.2 * (2.4 * (j * j + seed * j) as f64 + seed as f64).sin()).collect();
    let velocities = (0..N).map(|j| 0.9 * (1.7 * (j * j + seed * j) as f64 - seed as f64).cos()).collect();
    let start = State { positions, velocities, ..State::rest(&chain) };
    let sampling = Sampling { interval: t_end, t_end };
    let (mut exact, mut slow) = (Vec::new(), Vec::new());
    let arrival = SparseFlow::new(&chain)
        .observe(&start, sampling, |_, state, _| exact = wave_amplitudes(state, N, 1.1))
        .unwrap();
    let flow = ChainSlowFlow::new(&chain);
    let work = flow
        .follow(&flow.slow_state(&start).unwrap(), sampling, |_, state| slow = slow_wave_amplitudes(&state.amplitudes))
        .unwrap();
    ([strongest(&exact), strongest(&slow)], [arrival.switches, work.steps])
}

#[test]
fn competing_waves_have_the_winner_of_the_exact_motion() {
    let disk = ring(0.01, 0.04);
    let mut won = Vec::new();
    for seed in 0..8 {
        let ([exact, slow], [events, steps]) = winners(&disk, seed, 6000.0);
        println!("start {seed}: exact {}, slow flow {}; {events} events, {steps} steps", exact.signed(), slow.signed());
        assert_eq!(exact, slow, "start {seed}");
        won.push(exact);
        // What averaging is for.
        assert!(steps * 3 < events, "{steps} {events}");
    }
    won.sort_unstable();
    won.dedup();
    assert!(won.len() >= 2, "starts should lead to more than one wave: {won:?}");
}

#[test]
fn states_without_a_frequency_and_samplings_out_of_range_are_refused() {
    let chain = ring(0.01, 0.04).chain().unwrap();
    let flow = ChainSlowFlow::new(&chain);
    assert!(matches!(flow.slow_state(&State::rest(&chain)), Err(AveragingError::NoCarrier { .. })));
    assert!(flow.clone().with_carrier(Carrier::Given(-1.0)).is_err());
    let start = flow.slow_state(&State { positions: vec![1.0; N], ..State::rest(&chain) }).unwrap();
    assert!(flow.follow(&start, Sampling { interval: 0.0, t_end: 1.0 }, |_, _| {}).is_err());
    // At rest in position only: z = x, whose frequency is that of the uniform motion of stuck blades, 1 to the square of the damping.
    let w = flow.frequency(&start.amplitudes).unwrap();
    assert!((w - 1.0).abs() < 1e-12, "{w}");
    // A motion that grows without friction leaves the bound at the time of its exponential.
    let fed = InfluenceCoefficient { offset: 0, real: 0.0, imaginary: -0.2 };
    let air = Aerodynamics::Coefficients { coefficients: vec![fed], reference_frequency: 1.0 };
    let chain = BladedDisk { aerodynamics: Some(air), ..BladedDisk::ring(3, 0.0) }.chain().unwrap();
    let flow = ChainSlowFlow::new(&chain).with_amplitude_bound(20.0).unwrap();
    let start = flow.slow_state(&State { positions: vec![1.0; 3], ..State::rest(&chain) }).unwrap();
    let arrival = flow.follow(&start, Sampling { interval: 1.0, t_end: 100.0 }, |_, _| {}).unwrap();
    let Outcome::Diverged { time, .. } = arrival.outcome else { panic!("{:?}", arrival.outcome) };
    // exp(0.1 t) = 20; found at the end of a step of a few cycles.
    assert!((0.0..3.0 * TAU).contains(&(time - 20.0_f64.ln() / 0.1)), "{time}");
}
