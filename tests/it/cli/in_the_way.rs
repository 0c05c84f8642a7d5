//! What stands in the way of a film: found before anything is computed or made, and kept.

use super::{document, refused, scene_file, stickslip};
use crate::small_disk::names_in;
use assert_cmd::Command;
use std::fs;
use std::path::Path;

/// 8 time units at 8 a second and 5 frames a second, and the one at time 0: 6 frames.
const SCENE: &str =
    "title = \"x\"\n[simulation]\nduration = 8.0\n[film]\nwidth = 64\nheight = 64\nfps = 5\n[direction]\npanels = []\n";

fn put(directory: &Path, name: &str) {
    let path = directory.join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, "mine").unwrap();
}

fn is_kept(directory: &Path, name: &str) -> bool {
    fs::read(directory.join(name)).unwrap() == b"mine"
}

#[test]
fn a_file_of_someone_else_is_found_before_anything_is_computed_or_written() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_file(folder.path(), SCENE);
    let story = folder.path().join("story.toml");
    let part = SCENE.replace("\n[", "\n[scene.");
    fs::write(&story, format!("[[scene]]\n{part}[[scene]]\n{part}")).unwrap();
    let (run, render) = (["run", &scene], ["render", &scene]);
    let story = ["run", "--story", story.to_str().unwrap()];
    let of_film = ["film.mp4", "frames.json", "frames/000002.png", "frames/000005.png"];
    let of_run = ["engine.csv", "exact.csv", "run.json"];
    let cases = of_film.map(|name| (&run[..], name)).into_iter().chain(of_run.map(|name| (&run[..], name)));
    let cases = cases.chain(of_film.map(|name| (&render[..], name)));
    let cases = cases.chain(["2-exact.csv", "frames/000011.png"].map(|name| (&story[..], name)));
    for (number, (command, name)) in cases.enumerate() {
        let place = folder.path().join(number.to_string());
        put(&place, name);
        let output = stickslip(&[command, &["--renderer", "cpu", "-o", place.to_str().unwrap()]].concat());
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{command:?}, {name}: {told}");
        let path = place.join(name);
        assert!(told.contains(&format!("{} exists", path.display())) && told.contains("--force"), "{told}");
        // What is said of a simulation and of a film.
        assert!(!told.contains("agreement") && !told.contains("film:"), "{command:?}, {name}: {told}");
        let first = name.split('/').next().unwrap();
        assert_eq!(names_in(&place), [first], "{command:?}, {name}");
        assert_eq!(names_in(path.parent().unwrap()).len(), 1, "{command:?}, {name}");
        assert!(is_kept(&place, name));
    }
}

#[test]
fn what_is_not_written_is_not_in_the_way_and_force_takes_the_rest() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, place) = (scene_file(folder.path(), SCENE), folder.path().join("film"));
    let names = ["film.mp4", "run.json", "frames/000002.png", "frames/000006.png", "thesis.txt"];
    names.iter().for_each(|name| put(&place, name));
    let render = ["render", &scene, "--with", "exact", "--renderer", "cpu", "--json", "-o", place.to_str().unwrap()];
    let part = document(&[&render[..], &["--frames", "3:6"]].concat());
    assert_eq!(part["frames"]["drawn"], 3);
    assert!(names.iter().all(|name| is_kept(&place, name)));
    refused(&render, &["000002.png exists"]);
    document(&[&render[..], &["--force"]].concat());
    let kept: Vec<_> = names.iter().filter(|name| is_kept(&place, name)).collect();
    assert_eq!(kept, [&"run.json", &"frames/000006.png", &"thesis.txt"]);
}

#[test]
fn a_renderer_that_is_not_there_leaves_no_directory() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, place) = (scene_file(folder.path(), SCENE), folder.path().join("film"));
    for command in [&["run", &scene][..], &["render", &scene], &["run", "--story"]] {
        let mut program = Command::cargo_bin("stickslip").unwrap();
        // Drivers that may be there are hidden from the loader.
        program.envs(["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].map(|name| (name, "/nonexistent.json")));
        let output = program.args(command).args(["--renderer", "vulkan", "-o"]).arg(&place).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains("adapter") && !told.contains("agreement"), "{told}");
        assert!(!place.exists(), "{command:?}");
    }
}
