//! `run` and `render` of bladed disks as a user meets them.

use crate::cli::{document, refused};
use std::fs;

fn scene(name: &str) -> String {
    format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn a_disk_is_simulated_checked_filmed_and_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("run");
    let path = scene("disk_shroud");
    let size = ["--t-end", "9", "--size", "128x72", "--fps", "5", "--renderer", "cpu", "-q", "--json"];
    let args = [&["run", &path, "-o", output.to_str().unwrap()], &size[..]].concat();
    let json = document(&args);
    assert_eq!(json["agreement"]["passed"], true, "{}", json["agreement"]);
    assert_eq!(json["engine"]["name"], "rapier3d-f64");
    // 9 time units at 18 a second, half as fast in slow motion, and 5 frames a second, the one at time 0 included.
    assert_eq!((&json["frames"]["count"], &json["frames"]["drawn"]), (&6.into(), &6.into()));
    let table = fs::read_to_string(output.join("engine.csv")).unwrap();
    assert!(["x11", "v_segment3", "contact7", "work_circulatory"].iter().all(|name| table.contains(name)));
    fs::remove_file(output.join("frames/000002.png")).unwrap();
    assert_eq!(document(&args)["frames"]["drawn"], 1);
    // A stored motion is one of the rig.
    let stored = output.join("engine.csv");
    refused(&["render", "--trajectory", stored.to_str().unwrap(), "-o", "never"], &["disk", "scene"]);
}

#[test]
fn an_engine_with_coarse_steps_does_not_pass() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene("disk_forward_wave");
    let args = ["run", &path, "--t-end", "30", "--scheme", "plain", "--steps-per-period", "256", "--frames", "0:1"];
    let rest =
        ["--size", "64x64", "--renderer", "cpu", "-q", "--json", "-o", folder.path().to_str().unwrap(), "--force"];
    let output = std::process::Command::new(assert_cmd::cargo::cargo_bin("stickslip"))
        .args([&args[..], &rest[..]].concat())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn parameters_of_the_rig_and_its_panels_are_refused_for_a_disk() {
    refused(&["run", &scene("disk_mistuned"), "--xi1", "-0.1", "-o", "never"], &["two-mass rig", "[disk]"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("disk.toml");
    let text = fs::read_to_string(scene("chain_100")).unwrap();
    fs::write(&path, text.replace("[direction.camera]", "[direction]\npanels = [\"map\"]\n\n[direction.camera]"))
        .unwrap();
    refused(&["render", path.to_str().unwrap(), "-o", "never"], &["direction.panels", "carpet"]);
}
