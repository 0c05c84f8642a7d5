//! The command line as a user meets it: exit statuses, messages, JSON documents.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn stickslip(args: &[&str]) -> std::process::Output {
    Command::cargo_bin("stickslip").unwrap().args(args).output().unwrap()
}

/// Runs and expects exit status 2 and every one of `words` in the message.
pub fn refused(args: &[&str], words: &[&str]) {
    let output = stickslip(args);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {message}");
    assert!(output.stdout.is_empty(), "{args:?} printed a result");
    for word in words {
        assert!(message.contains(word), "{args:?}: {word:?} is not in: {message}");
    }
}

pub fn document(args: &[&str]) -> Value {
    let output = stickslip(args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn scene_file(folder: &Path, text: &str) -> String {
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn bad_input_is_refused_with_file_line_and_field() {
    let folder = tempfile::tempdir().unwrap();
    for (text, words) in [
        ("title = \"x\"\n[rig\n", ["scene.toml", "line 2"]),
        ("title = \"x\"\n[rig]\nxi3 = 1.0\n", ["line 3", "unknown field `xi3`"]),
        ("title = \"x\"\n[rig]\nxi1 = nan\n", ["line 3, field rig.xi1", "xi1 = NaN"]),
        ("title = \"x\"\n[rig]\ngamma = 1.5\n", ["line 3, field rig.gamma", "greater than 0 and at most 1"]),
        ("title = \"x\"\n[engine]\ndt = 0.0\n", ["line 3, field engine.dt", "greater than 0"]),
        ("title = \"x\"\n[film]\nfps = 0\n", ["line 3, field film.fps", "1 to 240"]),
    ] {
        refused(&["run", &scene_file(folder.path(), text)], &words);
    }
    refused(&["run", "no/such/scene.toml"], &["no/such/scene.toml", "cannot be read"]);
}

#[test]
fn bad_options_are_refused() {
    refused(&["simulate", "--gamma", "1.5"], &["gamma = 1.5"]);
    refused(&["simulate", "--xi1", "nan"], &["xi1 = NaN"]);
    refused(&["simulate", "--with", "rapier", "--dt", "0"], &["dt = 0"]);
    refused(&["simulate", "--t-end=-5"], &["duration = -5"]);
    refused(&["simulate", "--sample", "0"], &["--sample = 0"]);
    refused(&["simulate", "--initial", "0,0,0,0,1.5"], &["1.5", "slip force"]);
    refused(&["simulate", "--initial", "0,0,0"], &["five numbers"]);
    refused(&["simulate", "--units", "si"], &["rig_si"]);
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("never");
    for frames in [
        ["run", "--frames=-3:5", "--frames"],
        ["run", "--frames=5:3", "A smaller than B"],
        ["render", "--frames=0:1000000", "beyond the film"],
    ] {
        refused(&[frames[0], frames[1], "-o", output.to_str().unwrap()], &[frames[2]]);
        assert!(!output.exists(), "bad input left something behind");
    }
    refused(&["simulate", "-o", "out.xyz"], &["out.xyz"]);
}

#[test]
fn an_output_that_cannot_be_written_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "in the way").unwrap();
    let below = file.join("renders");
    refused(&["run", "-o", below.to_str().unwrap()], &[below.to_str().unwrap()]);
    let table = file.join("t.csv");
    refused(&["simulate", "--t-end", "1", "-o", table.to_str().unwrap()], &[file.to_str().unwrap()]);
}

#[test]
fn simulate_meets_the_reference_trajectory() {
    let json = document(&[
        "simulate",
        "--xi1",
        "-0.06",
        "--initial",
        "1.2226496266,0.9053979113,0,-0.5377904062,1",
        "--t-end=2000",
        "--json",
    ]);
    // Computed with 50 digits outside this project; 5e-11 is the accuracy promised for this trajectory.
    for (name, expected) in [
        ("x1", 1.17683461371815),
        ("x2", 1.142441921330231),
        ("v1", -0.00277934897911),
        ("v2", -0.307457641547716),
        ("f", 0.99999649751427),
    ] {
        let found = json["final"][name].as_f64().unwrap();
        assert!((found - expected).abs() < 5e-11, "{name}: {found}");
    }
    assert_eq!(json["final"]["contact"], "stick");
    assert_eq!(json["events"], 1260);
    assert_eq!(json["diverged"], false);
    assert!(json["energy_residual"].as_f64().unwrap() < 2e-10);
    assert_eq!(json["command"], "simulate");
    assert_eq!(json["stickslip"], env!("CARGO_PKG_VERSION"));
}

#[test]
fn divergence_is_a_result_and_not_an_error() {
    let json = document(&["simulate", "--xi1=-0.4", "--initial", "3,3,0,0,0", "--t-end=500", "--json"]);
    assert_eq!(json["diverged"], true);
}

#[test]
fn a_table_is_not_overwritten_by_other_parameters_and_not_believed_when_truncated() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["t.csv", "t.parquet"] {
        let path: PathBuf = folder.path().join(name);
        let table = path.to_str().unwrap();
        let simulate = ["simulate", "--t-end", "20", "--sample", "0.04", "-o", table, "--json"];
        document(&simulate);
        let first = fs::read(&path).unwrap();
        document(&simulate);
        assert_eq!(fs::read(&path).unwrap(), first, "same input, same bytes");
        refused(&["simulate", "--t-end", "30", "-o", table], &["other parameters", "--force"]);
        document(&["simulate", "--t-end", "30", "-o", table, "--force", "--json"]);
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() * 2 / 3]).unwrap();
        refused(&["render", "--trajectory", table], &[name]);
    }
}

#[test]
fn an_si_scene_gives_tables_in_si_units() {
    let folder = tempfile::tempdir().unwrap();
    // w0 = 20 rad/s, unit of length 0.02 m, of velocity 0.4 m/s.
    let text = "title = \"si\"\n[rig_si]\nmass = 2.0\nground_stiffness = 300.0\njenkins_stiffness = 500.0\nslip_force = 10.0\n\
                coupling_stiffness = 80.0\nground_damping = -2.4\ncoupling_damping = 1.42\n\
                [initial]\nstart = \"state\"\nstate = [0.02, 0.01, 0.4, 0.0, 5.0]\n[simulation]\nduration = 1.0\n";
    let scene = scene_file(folder.path(), text);
    let table = folder.path().join("t.csv");
    let table = table.to_str().unwrap();
    let json = document(&["simulate", "--scene", &scene, "--sample", "0.01", "--units", "si", "-o", table, "--json"]);
    let written = stickslip::store::read_table(Path::new(table)).unwrap();
    let column = |name: &str| match &written.column(name).unwrap().values {
        stickslip::store::ColumnData::F64(values) => values.clone(),
        _ => panic!("{name} is not a number"),
    };
    assert_eq!(written.column("x1").unwrap().unit, "m");
    assert!((column("x1")[0] - 0.02).abs() < 1e-15 && (column("f")[0] - 5.0).abs() < 1e-14);
    assert!((column("t").last().unwrap() - 1.0).abs() < 1e-14);
    // One second is 20 time units; the document is non-dimensional.
    assert!((json["final"]["t"].as_f64().unwrap() - 20.0).abs() < 1e-12);
    let x1 = json["final"]["x1"].as_f64().unwrap();
    assert!((column("x1").last().unwrap() / 0.02 - x1).abs() < 1e-13);
}

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
fn a_film_of_a_trajectory_that_has_changed_is_not_taken_for_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let (table, output) = (folder.path().join("t.csv"), folder.path().join("film"));
    let (table, output) = (table.to_str().unwrap(), output.to_str().unwrap());
    let render =
        ["render", "--trajectory", table, "--size", "64x64", "--fps", "2", "--renderer", "cpu", "-o", output, "--json"];
    document(&["simulate", "--t-end", "8", "-o", table, "--json"]);
    document(&render);
    document(&["simulate", "--t-end", "8", "--with", "rapier", "-o", table, "--force", "--json"]);
    refused(&render, &["other parameters", "--force"]);
    refused(&["render", "--trajectory", table, "--xi1", "-0.1"], &["--xi1"]);
    document(&["simulate", "--t-end", "8", "--sample", "2", "-o", table, "--force", "--json"]);
    refused(&render, &["too coarse"]);
}

#[test]
fn steps_that_no_engine_could_take_are_refused() {
    refused(&["simulate", "--with", "rapier", "--dt", "1e9"], &["engine.dt = 1e9", "no step"]);
    refused(&["simulate", "--with", "rapier", "--dt", "3"], &["engine.dt = 3e0", "unstable"]);
    refused(&["simulate", "--with", "rapier", "--t-end", "1e12", "--sample", "1e6"], &["steps"]);
    refused(&["simulate", "--with", "exact", "--dt", "0.01"], &["--with rapier"]);
    refused(&["simulate", "--xi1", "1e4"], &["from -100 to 100"]);
    // Exponents are numbers too.
    assert_eq!(document(&["simulate", "--xi1", "-6e-2", "--t-end", "1", "--json"])["parameters"]["xi1"], -0.06);
}

#[test]
fn a_prescribed_motion_needs_no_initial_state() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_file(folder.path(), "title = \"x\"\n[prescribed]\namplitude = 2.0\nangular_frequency = 1.0\n");
    let json = document(&["simulate", "--scene", &scene, "--t-end", "3", "--json"]);
    assert_eq!(json["final"]["x2"], 0.0);
    assert!((json["final"]["x1"].as_f64().unwrap() - 2.0 * 3.0_f64.sin()).abs() < 1e-14);
}

#[test]
fn generated_texts_are_there() {
    let schema = document(&["schema", "scene"]);
    assert_eq!(schema["title"], "Scene");
    for shell in ["bash", "zsh", "fish"] {
        let text = stickslip(&["completions", shell]).stdout;
        assert!(String::from_utf8(text).unwrap().contains("stickslip"));
    }
    let man = String::from_utf8(stickslip(&["man"]).stdout).unwrap();
    assert!(man.contains(".TH") && man.contains("simulate"));
}

#[test]
fn a_single_picture_is_drawn_at_any_time_of_the_motion() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("still.png");
    let path = path.to_str().unwrap();
    let still = [
        "render",
        "--with",
        "exact",
        "--at",
        "10.123",
        "--t-end",
        "12",
        "--size",
        "320x180",
        "--renderer",
        "cpu",
        "-o",
        path,
    ];
    document(&[&still[..], &["--json"]].concat());
    assert_eq!(image::open(path).unwrap().to_rgba8().dimensions(), (320, 180));
    refused(&still, &["exists", "--force"]);
    refused(&["render", "--at", "10", "-o", "still.jpg"], &[".png"]);
    let late = folder.path().join("late.png");
    refused(&["render", "--with", "exact", "--at", "13", "--t-end", "12", "-o", late.to_str().unwrap()], &["0 to 12"]);
    assert!(!late.exists());
}

/// A story of two scenes: 13 frames (8 time units at 8 a second, 12 a second, and the one at time 0) and 7.
#[test]
fn a_story_is_filmed_scene_by_scene_and_its_manifest_says_what_each_frame_shows() {
    let folder = tempfile::tempdir().unwrap();
    let (story, output) = (folder.path().join("story.toml"), folder.path().join("story"));
    let scene = |title: &str, duration: f64, state: &str| {
        format!(
            "[[scene]]\ntitle = \"{title}\"\n[scene.initial]\nstart = \"state\"\nstate = {state}\n[scene.simulation]\n\
             duration = {duration}\n[scene.film]\nwidth = 256\nheight = 144\nfps = 12\n"
        )
    };
    let text = scene("one", 8.0, "[0.2, 0.2, 0.0, 0.0, 0.2]") + &scene("two", 4.0, "[0.5, -0.2, 0.0, 0.0, 0.5]");
    fs::write(&story, text).unwrap();
    let (story, directory) = (story.to_str().unwrap(), output.to_str().unwrap());
    let json = document(&["run", "--story", story, "--renderer", "cpu", "-o", directory, "--json", "-q"]);
    assert_eq!(json["frames"]["count"], 13 + 7);
    assert_eq!(json["scenes"].as_array().unwrap().len(), 2);
    assert!(json["scenes"].as_array().unwrap().iter().all(|scene| scene["agreement"]["passed"] == true));
    let manifest: Value = serde_json::from_slice(&fs::read(output.join("frames.json")).unwrap()).unwrap();
    let frames = manifest["frames"].as_array().unwrap();
    let time = |index: usize| frames[index]["motion_time"].as_f64().unwrap();
    assert!((time(12) - 8.0).abs() < 1e-12 && time(13) == 0.0 && (time(14) - 8.0 / 12.0).abs() < 1e-12);
    let hashes: std::collections::BTreeSet<_> =
        frames.iter().map(|frame| frame["state_sha256"].as_str().unwrap()).collect();
    assert_eq!(hashes.len(), 20, "every frame shows another state");
    // The frames at a cut are dark but not black, for two black ones would stand still: a fade takes 4 frames at 12 a second, so that a
    // fifth is left of white letters (242 of 255) at the cut and two fifths before it. The last frame of the story is black.
    let brightest = |index: u64| {
        let frame = image::open(output.join(format!("frames/{index:06}.png"))).unwrap().to_rgb8();
        frame.pixels().flat_map(|pixel| pixel.0).max().unwrap()
    };
    let cut = [11, 12, 13, 14].map(brightest);
    assert!(cut[0] > cut[1] && cut[3] > cut[2] && cut[1..3].iter().all(|level| (40..=52).contains(level)), "{cut:?}");
    assert_eq!(brightest(19), 0);
    assert!(brightest(6) > 100 && brightest(0) > 200);
    refused(&["run", "--story", story, "--xi1", "-0.1"], &["--xi1"]);
    // Three parts drawn apart are the whole.
    let parts = folder.path().join("parts");
    for part in ["1/3", "3/3", "2/3"] {
        let drawn = document(&[
            "run",
            "--story",
            story,
            "--renderer",
            "cpu",
            "-o",
            parts.to_str().unwrap(),
            "--shard",
            part,
            "--json",
            "-q",
        ]);
        assert_eq!(drawn["frames"]["drawn"].as_u64().unwrap(), if part == "1/3" { 6 } else { 7 });
    }
    assert_eq!(fs::read(parts.join("frames.json")).unwrap(), fs::read(output.join("frames.json")).unwrap());
    refused(&["run", "--shard", "4/3"], &["K from 1 to N"]);
    let (sheet, film) = (folder.path().join("sheet.png"), folder.path().join("loop.gif"));
    let (sheet, film) = (sheet.to_str().unwrap(), film.to_str().unwrap());
    let made = |args: &[&str]| assert!(stickslip(args).status.success(), "{args:?}");
    made(&["contact-sheet", directory, "--count", "6", "--columns", "3", "--width", "128", "-o", sheet]);
    assert_eq!(image::open(sheet).unwrap().to_rgb8().dimensions(), (3 * 136 + 8, 2 * 80 + 8));
    made(&["animate", directory, "--frames", "2:10", "--every", "2", "--width", "64", "-o", film]);
    assert_eq!(image::open(film).unwrap().to_rgb8().dimensions(), (64, 36));
    refused(&["animate", directory, "--frames", "2:99", "-o", film], &["20 frames"]);
    refused(&["animate", directory, "-o", "film.avi"], &[".gif"]);
    refused(&["contact-sheet", folder.path().to_str().unwrap()], &["manifest"]);
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

/// Frames with alpha, no film, and a loop of them as animated PNG; GIF cannot show them.
#[test]
fn a_transparent_background_gives_frames_with_alpha_and_no_film() {
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("film");
    let film = film.to_str().unwrap();
    let scene = scene_file(
        folder.path(),
        "title = \"x\"\n[simulation]\nduration = 1.0\n[film]\nwidth = 320\nheight = 180\nfps = 4\nbackground = \"transparent\"\n",
    );
    let with = ["render", &scene, "--with", "exact", "--renderer", "cpu", "-o", film];
    let output = stickslip(&with);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && told.contains("H.264 has no alpha"), "{told}");
    assert!(!Path::new(film).join("film.mp4").exists());
    let frame = image::open(Path::new(film).join("frames/000000.png")).unwrap();
    let image::DynamicImage::ImageRgba8(frame) = frame else { panic!("no alpha") };
    assert_eq!(frame.get_pixel(100, 2).0[3], 0);
    assert!(frame.pixels().any(|pixel| pixel.0[3] == 255));
    let gif = folder.path().join("loop.gif");
    refused(&["animate", film, "-o", gif.to_str().unwrap()], &["translucent", ".png"]);
    let loop_ = folder.path().join("loop.png");
    assert!(stickslip(&["animate", film, "--width", "160", "-o", loop_.to_str().unwrap()]).status.success());
    let image::DynamicImage::ImageRgba8(first) = image::open(loop_).unwrap() else { panic!("no alpha") };
    assert!(first.get_pixel(50, 1).0[3] == 0);
    // The same by an option; the opaque frames of the scene are another film.
    let still = folder.path().join("still.png");
    let args = ["render", "--with", "exact", "--at", "3", "--size", "320x180", "--background", "transparent", "-o"];
    assert!(stickslip(&[&args[..], &[still.to_str().unwrap()]].concat()).status.success());
    assert!(matches!(image::open(still).unwrap(), image::DynamicImage::ImageRgba8(_)));
    refused(&[&with[..], &["--background", "theme"]].concat(), &["background", "--force"]);
}
