//! Random mistuning: the same rows on any number of threads and after any interruption; fates against the linear analysis.

use std::fs;
use stickslip::disk::{Fate, MonteCarlo, Sample, SampleRow, Summary};
use stickslip::model::{
    Aerodynamics, BladedDisk, ContactPlace, FrictionContacts, InfluenceCoefficient, Mistuning, Stability,
};
use stickslip::store::{Existing, Origin, OutputDir};

/// Small disks near the edge of flutter: tuned they flutter, mistuned some do not.
fn plan(samples: usize) -> MonteCarlo {
    let l = |offset, real, imaginary| InfluenceCoefficient { offset, real, imaginary };
    let disk = BladedDisk {
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        aerodynamics: Some(Aerodynamics::Coefficients {
            coefficients: vec![l(0, 0.0, 0.02), l(1, 0.016, 0.0), l(-1, -0.016, 0.0)],
            reference_frequency: 1.0,
        }),
        mistuning: Some(Mistuning::Normal { standard_deviation: 0.03, seed: 0 }),
        ..BladedDisk::ring(8, 0.02)
    };
    MonteCarlo { disk, samples, first_seed: 100, periods: 60.0, longest: 240.0, start: 1.5 }
}

fn on_threads(plan: &MonteCarlo, threads: usize, record: Option<&OutputDir>) -> Vec<SampleRow> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let samples = pool.install(|| plan.run(record, |_, _| {})).unwrap();
    samples.iter().map(|sample| *sample.row().expect("every sample can be followed")).collect()
}

fn summary_of(rows: &[SampleRow]) -> Summary {
    Summary::of(&rows.iter().map(|row| Sample::Followed(*row)).collect::<Vec<_>>())
}

#[test]
fn rows_do_not_depend_on_threads_and_an_interrupted_record_is_completed() {
    let plan = plan(25);
    let expected = on_threads(&plan, 1, None);
    assert_eq!(on_threads(&plan, 3, None), expected);
    let folder = tempfile::tempdir().unwrap();
    let open = || {
        let origin = Origin::new("flutter", serde_json::to_value(&plan).unwrap());
        OutputDir::open(folder.path(), &origin, Existing::Resume).unwrap()
    };
    assert_eq!(on_threads(&plan, 2, Some(&open())), expected);
    let block = |n: usize| folder.path().join(format!("samples/block-{n:06}.json"));
    // What a killed run can leave: one block missing, one torn, one that nobody recorded would be refused.
    let whole = fs::read(block(1)).unwrap();
    fs::remove_file(block(0)).unwrap();
    fs::write(block(1), &whole[..whole.len() / 2]).unwrap();
    assert_eq!(on_threads(&plan, 2, Some(&open())), expected);
    assert_eq!(fs::read(block(1)).unwrap(), whole);
    // A block is read, not computed, where it is whole: a forged one with its sum would show. Another plan is refused.
    let other = Origin::new("flutter", serde_json::to_value(MonteCarlo { samples: 26, ..plan.clone() }).unwrap());
    assert!(OutputDir::open(folder.path(), &other, Existing::Resume).is_err());
}

#[test]
fn fates_agree_with_the_linear_margin_and_seeds_differ() {
    let rows = on_threads(&plan(40), 2, None);
    let summary = summary_of(&rows);
    assert!(summary.fates.stable > 3 && summary.fates.flutter > 3 && summary.fates.diverged == 0, "{summary:?}");
    for row in &rows {
        // Linear flutter is flutter; a stable disk may also be caught slipping still.
        assert!(row.fate == Fate::Flutter || row.least_damping >= 0.0, "{row:?}");
        assert!((1.0 / 8.0..=1.0 + 1e-12).contains(&row.participation) && row.mean_amplitude <= row.amplitude);
    }
    assert!(rows.windows(2).all(|pair| pair[0].least_damping != pair[1].least_damping));
    let negative = rows.iter().filter(|row| row.least_damping < 0.0).count() as f64 / 40.0;
    assert_eq!(summary.probability_of_linear_flutter, negative);
}

#[test]
fn a_mistuning_that_is_not_random_is_refused() {
    let plan = MonteCarlo { disk: plan(1).disk.tuned(), ..plan(1) };
    assert!(plan.run(None, |_, _| {}).unwrap_err().to_string().contains("normal"));
}

#[test]
fn motions_are_followed_until_they_settle_and_the_rest_counts_apart() {
    let (short, long) = (plan(40), MonteCarlo { longest: 3840.0, ..plan(40) });
    let given_up = MonteCarlo { longest: 60.0, ..plan(40) };
    let [first, short, long] = [&given_up, &short, &long].map(|plan| on_threads(plan, 2, None));
    let unsettled = |rows: &[SampleRow]| summary_of(rows).fates.unsettled;
    // After 60 periods some still grow or beat; longer motions leave fewer of them.
    assert!(
        unsettled(&first) >= 3 && unsettled(&long) < unsettled(&first),
        "{} {}",
        unsettled(&first),
        unsettled(&long)
    );
    assert!(unsettled(&short) <= unsettled(&first));
    for (a, b) in first.iter().zip(&long) {
        // What had settled is left alone; what had not is longer, by fours.
        assert!(if a.settled { a == b } else { [240.0, 960.0, 3840.0].contains(&b.periods) }, "{a:?} {b:?}");
        assert!(b.settled || b.periods == 3840.0);
    }
    // Quantiles are of settled flutter alone.
    let mut settled: Vec<f64> =
        long.iter().filter(|row| row.fate == Fate::Flutter && row.settled).map(|row| row.amplitude).collect();
    settled.sort_by(f64::total_cmp);
    let summary = summary_of(&long);
    assert_eq!(summary.fates.flutter, settled.len());
    assert_eq!(summary.amplitude_quantiles[2], settled[((settled.len() - 1) as f64 * 0.5).round() as usize]);
    assert_eq!(summary.lengths.iter().map(|(_, count)| count).sum::<usize>(), 40);
}

#[test]
fn a_settled_amplitude_is_that_of_a_motion_twice_as_long() {
    // The criterion means something: disks called settled keep their amplitude, seen over the same motion followed for longer.
    let rows = on_threads(&MonteCarlo { longest: 3840.0, ..plan(20) }, 2, None);
    let mut checked = 0;
    for row in rows.iter().filter(|row| row.fate == Fate::Flutter && row.settled) {
        let twice = MonteCarlo { periods: 2.0 * row.periods, longest: 2.0 * row.periods, ..plan(20) };
        let later = twice.sample(row.seed).unwrap();
        // The 1 % of the criterion, over ten times the span of its windows: slow drifts may add up.
        assert!((later.amplitude / row.amplitude - 1.0).abs() < 0.05, "{row:?} {later:?}");
        checked += 1;
    }
    assert!(checked >= 3, "{checked}");
}

#[test]
fn a_longest_time_below_the_first_is_refused() {
    let plan = MonteCarlo { longest: 10.0, ..plan(1) };
    assert!(plan.run(None, |_, _| {}).unwrap_err().to_string().contains("longest = 10"));
}

/// Three blades that the air feeds so weakly, 2e-5, that they grow by a factor of e in 16 000 periods: from a start below slip nothing slips in 1000.
fn slow() -> MonteCarlo {
    let disk = BladedDisk {
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        aerodynamics: Some(Aerodynamics::Coefficients {
            coefficients: vec![InfluenceCoefficient { offset: 0, real: 0.0, imaginary: -2e-5 }],
            reference_frequency: 1.0,
        }),
        mistuning: Some(Mistuning::Normal { standard_deviation: 0.001, seed: 1 }),
        ..BladedDisk::ring(3, 0.05)
    };
    MonteCarlo { disk, samples: 6, first_seed: 0, periods: 60.0, longest: 960.0, start: 0.3 }
}

#[test]
fn a_motion_that_still_grows_and_never_slips_has_not_settled() {
    // From one of the last tenths to the other it grows by 0.6 %, and yet no friction holds it.
    let rows = on_threads(&slow(), 2, None);
    for row in &rows {
        assert!(row.fate == Fate::Flutter && !row.slips && !row.settled && row.periods == 960.0, "{row:?}");
        assert!((row.least_damping + 2e-5).abs() < 1e-9, "{row:?}");
    }
    let summary = summary_of(&rows);
    assert_eq!((summary.fates.flutter, summary.fates.unsettled), (0, 6));
    assert!(summary.amplitude_quantiles.is_empty());
    // Where it counts as settled, contacts slip.
    for row in on_threads(&MonteCarlo { longest: 3840.0, ..plan(40) }, 2, None) {
        assert!(row.fate != Fate::Flutter || !row.settled || row.slips, "{row:?}");
    }
}

#[test]
fn amplitudes_leave_out_what_stuck_contacts_hold() {
    // Uncoupled blades that do not slip: a force of zero at x_0 makes each swing about x_0/2 with amplitude x_0/2, its contact having half of its
    // stiffness. With |x_0| up to 0.3 the largest of three lies below 0.15; with the offset it would be twice as much.
    let still = slow();
    let without_air = MonteCarlo {
        disk: BladedDisk { coupling: 0.0, aerodynamics: None, ..still.disk.clone() },
        periods: 60.0,
        longest: 60.0,
        ..still
    };
    for row in on_threads(&without_air, 2, None) {
        let drawn = Mistuning::Uniform { half_width: 0.3, seed: row.seed ^ 0x5354_4152_5400_0000 };
        let largest = drawn.deviations(3).unwrap().iter().fold(0.0_f64, |l, x| l.max(x.abs()));
        // Stiffness deviations, some 0.1 %, and peaks missed by half of 2 pi/64: 0.12 %.
        assert!((row.amplitude / (0.5 * largest) - 1.0).abs() < 5e-3, "{row:?} {largest}");
        assert!(row.fate == Fate::Stable && row.settled && !row.slips);
    }
}

#[test]
fn motions_too_short_to_measure_and_seeds_beyond_the_last_are_refused() {
    let refused = |plan: MonteCarlo| plan.run(None, |_, _| {}).unwrap_err().to_string();
    assert!(refused(MonteCarlo { periods: 5.0, ..plan(1) }).contains("at least 20"));
    let message = refused(MonteCarlo { first_seed: u64::MAX, ..plan(2) });
    assert!(message.contains("seed") && message.contains("18446744073709551615"), "{message}");
}

#[test]
fn a_draw_that_is_no_disk_is_named_by_its_seed() {
    // Contacts take half of a blade's stiffness: a deviation below -1/2 leaves none, with this scatter in two of three draws.
    let mistuning = Mistuning::Normal { standard_deviation: 1.0, seed: 1 };
    let fails = |seed: &u64| mistuning.with_seed(*seed).deviations(3).unwrap().iter().any(|d| *d < -0.5);
    let seed = (77..).find(fails).unwrap();
    let disk = BladedDisk { mistuning: Some(mistuning.clone()), ..slow().disk };
    // The samples beside it are followed.
    let samples = MonteCarlo { disk, samples: 6, first_seed: seed, ..slow() }.run(None, |_, _| {}).unwrap();
    assert_eq!(samples.len(), 6);
    let Sample::Failed { seed: named, reason } = &samples[0] else { panic!("{:?}", samples[0]) };
    assert!(*named == seed && reason.contains("stiffness of blade"), "{reason}");
    assert_eq!(samples.iter().filter(|sample| sample.row().is_none()).count(), (seed..seed + 6).filter(fails).count());
}

#[test]
fn intervals_are_those_of_wilson() {
    // Wilson (1927) at 95 %: 10 of 10 gives [0.7225, 1], 0 of 10 [0, 0.2775] (4 digits); 1/2 of 10 [0.2366, 0.7634].
    let row = on_threads(&MonteCarlo { samples: 1, ..slow() }, 1, None)[0];
    let rows =
        |fluttering: usize| -> Vec<SampleRow> {
            (0..10)
                .map(|i| {
                    if i < fluttering {
                        row
                    } else {
                        SampleRow { linear: Stability::Stable, least_damping: 0.1, ..row }
                    }
                })
                .collect()
        };
    for (fluttering, expected) in [(10, [0.7225, 1.0]), (0, [0.0, 0.2775]), (5, [0.2366, 0.7634])] {
        let found = summary_of(&rows(fluttering)).linear_flutter_interval;
        // Rounding of the published digits.
        assert!((0..2).all(|i| (found[i] - expected[i]).abs() < 6e-5), "{fluttering}: {found:?}");
    }
    let held: Vec<SampleRow> = rows(10).into_iter().map(|row| SampleRow { settled: true, ..row }).collect();
    let summary = summary_of(&held);
    assert!((summary.held_flutter_interval[0] - 0.7225).abs() < 6e-5 && summary.probability_of_held_flutter == 1.0);
    assert_eq!(summary_of(&rows(10)).probability_of_held_flutter, 0.0);
}

#[test]
fn a_margin_of_rounding_size_is_no_flutter() {
    let mut plan = slow();
    plan.disk.aerodynamics = None;
    for row in on_threads(&plan, 2, None) {
        assert!(row.linear == Stability::Neutral && row.least_damping.abs() < 1e-12, "{row:?}");
        assert!(row.fate == Fate::Stable, "{row:?}");
    }
    // Negative control: ten times the tolerance is told.
    plan.disk.aerodynamics = Some(Aerodynamics::Coefficients {
        coefficients: vec![InfluenceCoefficient { offset: 0, real: 0.0, imaginary: -1e-11 }],
        reference_frequency: 1.0,
    });
    assert!(on_threads(&plan, 2, None).iter().all(|row| row.linear == Stability::Flutter));
}
