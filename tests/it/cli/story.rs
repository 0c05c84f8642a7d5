//! `run --story`, and what is made of a film that is there.

use super::{document, refused, stickslip};
use serde_json::Value;
use std::fs;

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

/// 13 frames of a motion that lasts and at most 61 (40 time units at 8 a second, 12 a second, and the one at time 0) of one that escapes.
#[test]
fn frames_beyond_a_story_whose_motion_ends_early_are_refused_with_the_number_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |title: &str, duration: f64, rest: &str| {
        format!(
            "[[scene]]\ntitle = \"{title}\"\n[scene.initial]\nstart = \"state\"\n{rest}\n[scene.film]\nwidth = 64\nheight = 64\n\
             fps = 12\n[scene.check]\nhorizon = 8.0\n[scene.simulation]\nduration = {duration}\namplitude_bound = 12.0\n"
        )
    };
    let text = scene("lasts", 8.0, "state = [0.2, 0.2, 0.0, 0.0, 0.2]")
        + &scene("escapes", 40.0, "state = [3.0, 3.0, 0.0, 0.0, 0.0]\n[scene.rig]\nxi1 = -0.4");
    let (story, output) = (folder.path().join("story.toml"), folder.path().join("film"));
    fs::write(&story, text).unwrap();
    let run = |frames: &str| {
        let output = ["run", "--story", story.to_str().unwrap(), "--renderer", "cpu", "-o", output.to_str().unwrap()];
        let result = stickslip(&[&output[..], &["--frames", frames]].concat());
        (result.status.code(), String::from_utf8_lossy(&result.stderr).into_owned())
    };
    let (code, told) = run("0:75");
    assert!(code == Some(2) && told.contains("--frames 0:75 is beyond the film: it has at most 74 frames"), "{told}");
    assert!(!output.exists());
    let (code, told) = run("0:74");
    let left = told.split("its motion ended early and left it ").nth(1).and_then(|rest| rest.split(' ').next());
    let count: u64 = left.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{code:?}: {told}"));
    assert!(code == Some(2) && (14..74).contains(&count), "{told}");
    // The same number where the frames are drawn.
    let (code, told) = run(&format!("{}:{count}", count - 2));
    let summary = format!("film: 2 frames ({}:{count} of {count}), 2 drawn, 0 reused", count - 2);
    assert!(code == Some(0) && told.contains("film: 2 of 2 frames") && told.contains(&summary), "{told}");
    let (code, told) = run(&format!("{}:{}", count - 2, count + 1));
    assert!(code == Some(2) && told.contains(&format!("left it {count} frames")), "{told}");
}

/// Which parameter of which scene, not the whole story.
#[test]
fn a_story_of_other_parameters_is_refused_with_the_field_that_differs() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |title: &str| {
        format!(
            "[[scene]]\ntitle = \"{title}\"\n[scene.simulation]\nduration = 2.0\n[scene.film]\nwidth = 64\nheight = 64\nfps = 4\n"
        )
    };
    let (story, output) = (folder.path().join("story.toml"), folder.path().join("film"));
    fs::write(&story, scene("one") + &scene("two")).unwrap();
    let args = ["run", "--story", story.to_str().unwrap(), "--renderer", "cpu", "-o", output.to_str().unwrap()];
    document(&[&args[..], &["--frames", "0:1", "--json"]].concat());
    let light = stickslip(&[&args[..], &["--theme", "light"]].concat());
    let told = String::from_utf8_lossy(&light.stderr).into_owned();
    assert_eq!(light.status.code(), Some(2), "{told}");
    for number in [0, 1] {
        let differs = format!("parameters.story[{number}].case.film.theme: \"dark\" there, \"light\" now");
        assert!(told.contains(&differs), "{told}");
    }
    // Two differences of some 70 characters, the directory and the advice.
    assert!(told.len() < 600, "{} bytes: {told}", told.len());
}
