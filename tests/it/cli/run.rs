//! `run`, the main job: verdict, film, and what is left of a run that was broken off.

use super::{document, refused, stickslip};
use assert_cmd::Command;
use serde_json::Value;
use std::fs;

#[test]
fn run_checks_films_and_resumes() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("run");
    let args = [
        "run",
        "--t-end",
        "8",
        "--size",
        "128x72",
        "--fps",
        "5",
        "--renderer",
        "cpu",
        "-o",
        output.to_str().unwrap(),
        "--json",
        "-q",
    ];
    let json = document(&args);
    assert_eq!(json["agreement"]["passed"], true);
    // 8 time units at 8 a second and 5 frames a second, the one at time 0 included.
    assert_eq!(json["frames"]["count"], 6);
    assert_eq!(json["frames"]["drawn"], 6);
    assert_eq!(json["frames"]["backend"], "cpu");
    assert_eq!(json["engine"]["name"], "rapier3d-f64");
    let film = fs::read(output.join("film.mp4")).unwrap();
    let frame = fs::read(output.join("frames/000003.png")).unwrap();
    fs::remove_file(output.join("frames/000003.png")).unwrap();
    let again = document(&args);
    assert_eq!(again["frames"]["drawn"], 1);
    assert_eq!(fs::read(output.join("frames/000003.png")).unwrap(), frame);
    assert_eq!(fs::read(output.join("film.mp4")).unwrap(), film);
    assert_eq!(document(&args)["frames"]["drawn"], 0);
    let other = ["run", "--t-end", "9", "-o", output.to_str().unwrap(), "--renderer", "cpu"];
    refused(&other, &["--force"]);
}

#[test]
fn a_run_that_disagrees_with_the_exact_solution_exits_with_one() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("coarse");
    // The engine's own defaults: the numerical damping they cause is no small error.
    let result = stickslip(&[
        "run",
        "--scheme",
        "plain",
        "--dt",
        "0.016666666666666666",
        "--substeps",
        "4",
        "--t-end",
        "40",
        "--fps",
        "1",
        "--size",
        "64x64",
        "--renderer",
        "cpu",
        "-o",
        output.to_str().unwrap(),
        "--json",
        "-q",
    ]);
    assert_eq!(result.status.code(), Some(1));
    let json: Value = serde_json::from_slice(&result.stdout).unwrap();
    assert_eq!(json["agreement"]["passed"], false);
}

#[test]
fn the_built_in_scene_agrees_over_its_whole_length_and_films_twenty_seconds() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("run");
    // The engine's steps depend on the time between frames a little; the motion and the length of the film do not.
    let json = document(&[
        "run",
        "--size",
        "64x64",
        "--fps",
        "4",
        "--renderer",
        "cpu",
        "-o",
        output.to_str().unwrap(),
        "--json",
        "-q",
    ]);
    assert_eq!(json["agreement"]["passed"], true);
    assert_eq!(json["agreement"]["horizon"], 160.0);
    // 160 time units at 8 a second, and the frame at time 0.
    assert_eq!(json["frames"]["count"], 4 * 20 + 1);
    // The motion is the torus: maxima of x1 from 0.88 to 1.53.
    let table = stickslip::store::read_table(&output.join("engine.csv")).unwrap();
    let stickslip::store::ColumnData::F64(x1) = &table.column("x1").unwrap().values else { panic!("x1 is numbers") };
    let maxima = x1.windows(3).filter(|w| w[1] > w[0] && w[1] > w[2]).map(|w| w[1]);
    let (low, high) = maxima.fold((f64::MAX, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    assert!((0.85..0.95).contains(&low) && (1.5..1.56).contains(&high), "{low} {high}");
}

#[test]
fn a_run_killed_at_any_moment_ends_with_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_stickslip"));
        command.args(["run", "--t-end", "24", "--size", "256x144", "--fps", "20", "--renderer", "cpu", "-q", "-o"]);
        command.arg(folder.path().join(name)).stdout(std::process::Stdio::null());
        command
    };
    assert!(run("whole").status().unwrap().success());
    let mut interrupted = 0;
    for milliseconds in [20, 60, 120, 200, 300] {
        let mut child = run("killed").spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(milliseconds));
        interrupted += u32::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(interrupted > 0, "every run had ended before it was killed: nothing was tested");
    assert!(run("killed").status().unwrap().success());
    let bytes = |name: &str, file: &str| fs::read(folder.path().join(name).join(file)).unwrap();
    let frames: Vec<String> = (0..=60).map(|n| format!("frames/{n:06}.png")).collect();
    let files = ["film.mp4", "frames.json", "engine.csv", "exact.csv"].into_iter().map(str::to_owned).chain(frames);
    for file in files {
        assert_eq!(bytes("whole", &file), bytes("killed", &file), "{file}");
    }
}

#[test]
fn a_full_disk_is_an_error_that_keeps_what_is_finished() {
    let Some(disk) = crate::small_disk::SmallDisk::mount(400) else { return };
    let output = disk.path().join("run");
    let args = ["run", "--t-end", "16", "--size", "320x180", "--renderer", "cpu", "-q", "-o", output.to_str().unwrap()];
    refused(&args, &["No space left on device", "finished files are kept"]);
    let table = disk.path().join("t.csv");
    refused(&["simulate", "--t-end", "2000", "-o", table.to_str().unwrap()], &["No space left on device"]);
    assert!(!table.exists());
    disk.grow(40_000);
    document(&[
        "run",
        "--t-end",
        "16",
        "--size",
        "320x180",
        "--renderer",
        "cpu",
        "-q",
        "--json",
        "-o",
        output.to_str().unwrap(),
    ]);
}

#[test]
fn without_ffmpeg_its_film_is_refused_before_anything_is_computed() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("film");
    let run = Command::cargo_bin("stickslip")
        .unwrap()
        .args(["run", "--encoder", "ffmpeg", "-o"])
        .arg(&output)
        .env("PATH", folder.path())
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(2), "{message}");
    for word in ["no ffmpeg", "install", "--encoder openh264"] {
        assert!(message.contains(word), "{message}");
    }
    assert!(!output.exists());
}
