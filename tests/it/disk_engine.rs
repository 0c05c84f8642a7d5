//! Bladed disks in Rapier: a ring of twelve against the exact flow over 20 periods, bodies and poses, errors.

use std::f64::consts::TAU;
use stickslip::disk::TravellingWave;
use stickslip::dynamics::{Flow, Outcome, Sampling, State};
use stickslip::engine::{BladeMotion, BodyRole, DiskFlow, DiskGeometry, EngineFlow, EngineSettings, Joints, Precision};
use stickslip::exact::SparseFlow;
use stickslip::model::{
    Aerodynamics, BladedDisk, ContactPlace, FrictionContacts, InfluenceCoefficient, NodalDiameter, Topology,
};

const PERIODS: f64 = 20.0;

/// Twelve blades with friction at every foot, forward waves fed by the antisymmetric stiffness.
fn ring() -> BladedDisk {
    let l = |offset, real, imaginary| InfluenceCoefficient { offset, real, imaginary };
    BladedDisk {
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        aerodynamics: Some(Aerodynamics::Coefficients {
            coefficients: vec![l(0, 0.0, 0.01), l(1, 0.03, 0.0), l(-1, -0.03, 0.0)],
            reference_frequency: 1.0,
        }),
        ..BladedDisk::ring(12, 0.1)
    }
}

/// Near the travelling wave of nodal diameter 3, every blade doing something of its own.
fn off_the_wave() -> State {
    let mut start = TravellingWave::of(&ring(), NodalDiameter::new(3, 12), 32).unwrap().state();
    start.positions.iter_mut().enumerate().for_each(|(j, x)| *x += 0.02 * (2.4 * (j * j) as f64).sin());
    start
}

/// Largest difference of any component at 32 times per period.
fn error(disk: &BladedDisk, start: &State, steps_per_period: f64) -> f64 {
    let chain = &disk.chain().unwrap();
    let sampling = Sampling { interval: TAU / 32.0, t_end: PERIODS * TAU };
    let exact = SparseFlow::new(chain).trajectory(start, sampling).unwrap();
    let settings = EngineSettings::default_for(TAU / steps_per_period);
    let engine = DiskFlow::new(disk, settings).unwrap().trajectory(start, sampling).unwrap();
    assert_eq!(exact.samples.len(), engine.samples.len());
    assert!(exact.switches() > 12 * 4 * 15, "the contacts should slip: {}", exact.switches());
    let pairs = exact.samples.iter().zip(&engine.samples);
    pairs.map(|(a, b)| a.state.max_difference(&b.state)).fold(0.0, f64::max)
}

#[test]
fn twelve_blades_in_rapier_follow_the_exact_ring_with_second_order() {
    let disk = ring();
    let chain = disk.chain().unwrap();
    let start = off_the_wave();
    let [coarse, fine] = [1024.0, 4096.0].map(|steps| error(&disk, &start, steps));
    println!("engine against exact, N = 12: {coarse:.2e} at 1024, {fine:.2e} at 4096 steps per period");
    assert!(coarse <= 5e-4, "{coarse:e}");
    assert!(fine <= 3e-5, "{fine:e}");
    let order = (coarse / fine).log2() / 2.0;
    // Events fall at random within a step, which scatters the constant of the error by some ten per cent.
    assert!((order - 2.0).abs() < 0.25, "{order}");
    // Negative control: without the antisymmetric stiffness the motion is another one.
    let other = BladedDisk { aerodynamics: None, ..ring() }.chain().unwrap();
    let sampling = Sampling { interval: TAU, t_end: PERIODS * TAU };
    let [a, b] = [&chain, &other].map(|chain| SparseFlow::new(chain).trajectory(&start, sampling).unwrap());
    assert!(a.samples[20].state.max_difference(&b.samples[20].state) > 0.1);
}

/// Everything at once: segments, foot and shroud contacts, a tuned or an open disk.
fn everything(topology: Topology) -> (BladedDisk, State) {
    let disk = BladedDisk { topology, ..super::disk_exact::everything(6, 0.3) };
    let chain = disk.chain().unwrap();
    let start = super::disk_exact::scattered(&chain, 1.5);
    (disk, start)
}

#[test]
fn rings_and_chains_with_segments_and_shrouds_follow_the_exact_flow_in_every_direction_of_motion() {
    let sampling = Sampling { interval: 1.0, t_end: 40.0 };
    for topology in [Topology::Ring, Topology::Chain] {
        let (disk, start) = everything(topology);
        let exact = SparseFlow::new(&disk.chain().unwrap()).trajectory(&start, sampling).unwrap();
        assert!(exact.switches() > 100, "{}", exact.switches());
        for motion in [BladeMotion::Tangential, BladeMotion::Axial] {
            for joints in [Joints::Impulse, Joints::Multibody] {
                let settings = EngineSettings { joints, ..EngineSettings::default_for(1.0 / 512.0) };
                let geometry = DiskGeometry { motion, ..DiskGeometry::default() };
                let flow = DiskFlow::new(&disk, settings).unwrap().with_geometry(geometry).unwrap();
                let recording = flow.record(&start, sampling).unwrap();
                let pairs = exact.samples.iter().zip(&recording.trajectory.samples);
                let error = pairs.map(|(a, b)| a.state.max_difference(&b.state)).fold(0.0, f64::max);
                // Second order, some 40 h^2; frequencies up to sqrt(1 + 4 (0.3 + 0.1)) and twice the contacts.
                assert!(error < 2e-4, "{topology:?} {motion:?} {joints:?}: {error:e}");
                assert!(recording.drift.lateral < 1e-9 && recording.drift.rotation < 1e-9, "{:?}", recording.drift);
                // Second order in the step, of an energy near 10.
                assert!(recording.trajectory.energy_residual() < 1e-3, "{}", recording.trajectory.energy_residual());
            }
        }
    }
}

#[test]
fn blades_stand_round_the_hub_and_move_by_their_displacements() {
    let (disk, start) = everything(Topology::Ring);
    let geometry = DiskGeometry::default();
    let flow = DiskFlow::new(&disk, EngineSettings::default_for(0.01)).unwrap();
    let recording = flow.record(&start, Sampling { interval: 0.375, t_end: 3.0 }).unwrap();
    let radius = geometry.hub_radius(6);
    for (bodies, sample) in recording.poses.iter().zip(&recording.trajectory.samples) {
        assert_eq!(bodies.len(), 1 + 2 * 6);
        assert_eq!((bodies[0].role, bodies[0].half_extents), (BodyRole::Hub, [radius, geometry.hub, radius]));
        for j in 0..6 {
            let (s, c) = (TAU * j as f64 / 6.0).sin_cos();
            let expected = |rise: f64, x: f64| [(radius + rise) * c - x * s, (radius + rise) * s + x * c, 0.0];
            let x = &sample.state.positions;
            let blade = (BodyRole::Blade(j), geometry.blade, expected(1.2 + 3.0, x[j]));
            let segment = (BodyRole::Segment(j), geometry.segment, expected(0.6, x[6 + j]));
            for ((role, half, place), body) in [(blade, bodies[1 + j]), (segment, bodies[7 + j])] {
                assert_eq!((body.role, body.half_extents), (role, half));
                // Joint drift and rounding of places near 8.
                let off = body.translation.iter().zip(place).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(off < 1e-9, "{role}: {off:e}");
            }
        }
    }
}

#[test]
fn what_is_observed_is_what_is_recorded() {
    let (disk, start) = everything(Topology::Ring);
    let flow = DiskFlow::new(&disk, EngineSettings::default_for(0.01)).unwrap();
    let sampling = Sampling { interval: 0.377, t_end: 12.0 };
    let kept = flow.trajectory(&start, sampling).unwrap();
    let mut seen = Vec::new();
    let arrival = flow.observe(&start, sampling, |t, state, contacts| seen.push((t, state.clone(), contacts.to_vec())));
    let expected: Vec<_> = kept.samples.iter().map(|s| (s.time, s.state.clone(), s.contacts.clone())).collect();
    assert!(seen == expected, "{} and {} samples", seen.len(), expected.len());
    let arrival = arrival.unwrap();
    assert_eq!((arrival.switches, arrival.steps), (kept.switches(), 1200));
    // The general flow of a chain in Rapier adds the same forces in another order, on another kind of rail.
    let general = EngineFlow::new(&disk.chain().unwrap(), flow.settings()).unwrap();
    let general = general.trajectory(&start, sampling).unwrap();
    let difference = general.last().unwrap().state.max_difference(&arrival.state);
    assert!(difference < 1e-11, "{difference:e}");
}

#[test]
fn disks_that_diverge_or_cannot_be_are_told_from_motions() {
    let air = Aerodynamics::Coefficients {
        coefficients: vec![InfluenceCoefficient { offset: 0, real: 0.0, imaginary: -0.5 }],
        reference_frequency: 1.0,
    };
    let disk = BladedDisk { aerodynamics: Some(air), ..BladedDisk::ring(3, 0.0) };
    let start = State { positions: vec![1.0; 3], ..State::rest(&disk.chain().unwrap()) };
    for precision in [Precision::Double, Precision::Single] {
        let settings = EngineSettings { precision, ..EngineSettings::default_for(0.01) };
        let flow = DiskFlow::new(&disk, settings).unwrap().with_amplitude_bound(20.0).unwrap();
        let sampling = Sampling { interval: 0.5, t_end: 100.0 };
        let mut last = 0.0;
        let arrival = flow.observe(&start, sampling, |t, _, _| last = t).unwrap();
        let Outcome::Diverged { time, bound } = arrival.outcome else { panic!("{:?}", arrival.outcome) };
        // exp(0.25 t) = 20 at t = 12.
        assert!(bound == 20.0 && (time - 12.0).abs() < 2.0 && last < time, "{time} {last}");
    }
    let settings = EngineSettings::default_for(0.01);
    assert!(DiskFlow::new(&BladedDisk::ring(2, 0.1), settings).unwrap_err().to_string().contains("sectors = 2"));
    let flow = DiskFlow::new(&disk, settings).unwrap();
    let flat = DiskGeometry { blade: [0.3, 0.0, 1.0], ..DiskGeometry::default() };
    assert!(flow.clone().with_geometry(flat).unwrap_err().to_string().contains("blade[1] = 0"));
    let short = State { positions: vec![1.0; 2], ..start };
    assert!(flow.observe(&short, Sampling { interval: 1.0, t_end: 1.0 }, |_, _, _| {}).is_err());
}
