//! A run that was broken off, in whatever way, ends with the bytes of one that was not.

use super::fake::{FakeRenderer, FakeSource, SIZE, Stop, finish, origin, run, settings};
use crate::small_disk::{SmallDisk, names_in};
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use stickslip::film::{FilmError, FilmSettings, Video, produce};
use stickslip::store::{Existing, Origin, OutputDir, StoreError};

const COUNT: u64 = 20;
/// Directory the killed process works in.
const WORKER: &str = "STICKSLIP_TEST_FILM_DIRECTORY";

/// Everything a film leaves, by name, except the journal, which tells the order of events.
fn results(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for folder in ["", "frames/"] {
        for name in names_in(&directory.join(folder)) {
            let path = directory.join(folder).join(&name);
            if path.is_file() && name != "outputs.jsonl" {
                files.insert(format!("{folder}{name}"), fs::read(path).unwrap());
            }
        }
    }
    files
}

/// What an uninterrupted run leaves.
fn reference() -> BTreeMap<String, Vec<u8>> {
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &settings(), COUNT);
    let files = results(place.path());
    // 20 frames, frames.json, film.mp4, manifest.json.
    assert_eq!(files.len(), 23);
    files
}

fn frame_path(directory: &Path, index: u64) -> PathBuf {
    directory.join(format!("frames/{index:06}.png"))
}

#[test]
fn nothing_is_done_twice() {
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &settings(), COUNT);
    let changed = |name: &str| fs::metadata(place.path().join(name)).unwrap().modified().unwrap();
    let names = ["film.mp4", "frames.json", "frames/000007.png"];
    let before = names.map(changed);
    let (report, drawn) = finish(place.path(), &settings(), COUNT);
    assert!(drawn.is_empty());
    assert_eq!((report.drawn, report.reused), (0, COUNT));
    assert_eq!(report.film, Some(place.path().join("film.mp4")));
    assert_eq!(names.map(changed), before);
    assert_eq!(results(place.path()), reference());
}

#[test]
fn after_an_error_the_rest_is_drawn_and_the_bytes_are_the_same() {
    let expected = reference();
    for stop in [Stop::RenderErrorAt(0), Stop::RenderErrorAt(7), Stop::SourceErrorAt(7), Stop::RenderErrorAt(19)] {
        let place = tempfile::tempdir().unwrap();
        let error = run(place.path(), &settings(), COUNT, stop).0.unwrap_err();
        let kept = match (stop, &error) {
            (Stop::RenderErrorAt(at), FilmError::Render { index, .. }) if at == *index => at,
            (Stop::SourceErrorAt(at), FilmError::Source { index, .. }) if at == *index => at,
            _ => panic!("{stop:?} gave {error}"),
        };
        assert!(!place.path().join("film.mp4").exists());
        let (report, drawn) = finish(place.path(), &settings(), COUNT);
        assert_eq!(drawn, (kept..COUNT).collect::<Vec<_>>());
        assert_eq!(report.reused, kept);
        assert_eq!(results(place.path()), expected);
    }
}

#[test]
fn a_panic_of_the_renderer_ends_the_run_and_keeps_finished_frames() {
    let place = tempfile::tempdir().unwrap();
    let panicked = catch_unwind(AssertUnwindSafe(|| run(place.path(), &settings(), COUNT, Stop::PanicAt(11))));
    assert!(panicked.is_err());
    let (report, _) = finish(place.path(), &settings(), COUNT);
    assert_eq!((report.drawn, report.reused), (9, 11));
    assert_eq!(results(place.path()), reference());
}

#[test]
fn damaged_frames_are_drawn_again_and_only_those() {
    let expected = reference();
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &settings(), COUNT);
    let at = |index| frame_path(place.path(), index);
    let whole = fs::read(at(3)).unwrap();
    fs::write(at(3), &whole[..whole.len() / 2]).unwrap();
    fs::write(at(5), "").unwrap();
    // A good picture, but of another frame.
    fs::copy(at(9), at(8)).unwrap();
    fs::remove_file(at(12)).unwrap();
    let (report, drawn) = finish(place.path(), &settings(), COUNT);
    assert_eq!(drawn, [3, 5, 8, 12]);
    assert_eq!((report.drawn, report.reused), (4, COUNT - 4));
    assert_eq!(results(place.path()), expected);
}

#[test]
fn a_missing_or_damaged_film_is_made_from_the_frames_on_disk() {
    let expected = reference();
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &settings(), COUNT);
    let film = place.path().join("film.mp4");
    let whole = fs::read(&film).unwrap();
    for damage in [None, Some(&whole[..whole.len() - 1])] {
        fs::remove_file(&film).unwrap();
        if let Some(bytes) = damage {
            fs::write(&film, bytes).unwrap();
        }
        let (report, drawn) = finish(place.path(), &settings(), COUNT);
        assert!(drawn.is_empty() && report.drawn == 0);
        assert_eq!(results(place.path()), expected);
    }
}

#[test]
fn a_film_can_be_added_to_frames_and_made_anew_with_another_rate() {
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &FilmSettings { video: Video::None, ..settings() }, COUNT);
    assert!(!place.path().join("film.mp4").exists());
    assert!(finish(place.path(), &settings(), COUNT).1.is_empty());
    assert_eq!(results(place.path()), reference());
    let slow = FilmSettings { frames_per_second: 5, ..settings() };
    assert!(finish(place.path(), &slow, COUNT).1.is_empty());
    assert_ne!(results(place.path())["film.mp4"], reference()["film.mp4"]);
}

#[test]
fn frames_of_another_device_or_size_are_not_mixed_in() {
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &settings(), 3);
    let other_size = FilmSettings { size: [32, 32], ..settings() };
    assert_eq!(finish(place.path(), &other_size, 3).1, [0, 1, 2]);
    let output = OutputDir::open(place.path(), &origin(), Existing::Resume).unwrap();
    let source = FakeSource { count: 3, size: [32, 32], stop: Stop::Never };
    let mut renderer = FakeRenderer::new(Stop::Never).called("another");
    produce(&other_size, &output, &mut renderer, &source, &mut |_| ()).unwrap();
    assert_eq!(renderer.drawn, [0, 1, 2]);
}

#[test]
fn frames_of_other_parameters_are_refused_without_force_and_removed_with_it() {
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &settings(), 5);
    let other = Origin::new("render", json!({"xi1": -0.03}));
    let refused = OutputDir::open(place.path(), &other, Existing::Resume).unwrap_err();
    assert!(matches!(refused, StoreError::OtherParameters { .. }), "{refused}");
    assert_eq!(results(place.path()).len(), 8);
    let output = OutputDir::open(place.path(), &other, Existing::Replace).unwrap();
    assert!(names_in(&place.path().join("frames")).is_empty());
    let source = FakeSource { count: 2, size: SIZE, stop: Stop::Never };
    produce(&settings(), &output, &mut FakeRenderer::new(Stop::Never), &source, &mut |_| ()).unwrap();
    assert_eq!(names_in(&place.path().join("frames")), ["000000.png", "000001.png"]);
}

#[test]
fn a_full_disk_midway_is_an_error_and_finished_frames_are_kept() {
    // 60 frames of 4 kB pages fill 160 kB after some 30.
    let Some(disk) = SmallDisk::mount(160) else { return };
    let error = run(disk.path(), &settings(), 60, Stop::Never).0.unwrap_err();
    assert!(matches!(error, FilmError::Store(StoreError::Write { .. })), "{error}");
    assert!(error.to_string().contains("Free some space"), "{error}");
    let leftovers = names_in(&disk.path().join("frames")).iter().filter(|name| name.starts_with('.')).count();
    assert_eq!(leftovers, 0);
    disk.grow(2000);
    let (report, drawn) = finish(disk.path(), &settings(), 60);
    assert!(report.reused > 10, "{}", report.reused);
    assert_eq!(drawn, (report.reused..60).collect::<Vec<_>>());
    let elsewhere = tempfile::tempdir().unwrap();
    finish(elsewhere.path(), &settings(), 60);
    assert_eq!(results(disk.path()), results(elsewhere.path()));
}

/// The process that is killed: this test binary, running only this.
#[test]
#[ignore = "started and killed by the next test"]
fn worker() {
    let Some(directory) = std::env::var_os(WORKER) else { return };
    let output = OutputDir::open(directory.as_ref(), &origin(), Existing::Resume).unwrap();
    let source = FakeSource { count: COUNT, size: SIZE, stop: Stop::Never };
    let mut renderer = FakeRenderer::new(Stop::Never);
    // Slow enough to be killed midway.
    renderer.delay = Duration::from_millis(4);
    produce(&settings(), &output, &mut renderer, &source, &mut |_| ()).unwrap();
}

#[test]
fn a_run_killed_at_any_moment_ends_with_the_same_bytes() {
    let expected = reference();
    let place = tempfile::tempdir().unwrap();
    // Finished ones: a temporary left by the kill before is removed by the next worker.
    let finished = |name: &std::ffi::OsString| !name.to_string_lossy().starts_with('.');
    let frames = || {
        let entries = fs::read_dir(place.path().join("frames")).into_iter().flatten();
        entries.filter_map(|entry| Some(entry.ok()?.file_name())).filter(finished).count()
    };
    // Killed again and again, each time a few frames further and after another fraction of a frame.
    for (kill, wanted) in [1, 2, 5, 9, 14, 18, 20].into_iter().enumerate() {
        let mut worker = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "film::resume::worker", "--ignored", "--test-threads=1"])
            .env(WORKER, place.path())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let patience = Instant::now() + Duration::from_secs(60);
        while frames() < wanted && worker.try_wait().unwrap().is_none() && Instant::now() < patience {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_micros(700 * kill as u64));
        worker.kill().unwrap();
        worker.wait().unwrap();
        assert!(frames() >= wanted, "{wanted}");
    }
    let (report, _) = finish(place.path(), &settings(), COUNT);
    // The last worker was killed after its last frame; the one being recorded at a kill may be lost.
    assert!(report.reused >= COUNT - 2, "{}", report.reused);
    assert_eq!(results(place.path()), expected);
}
