//! The commands about bladed disks as a user meets them.

use crate::cli::{document, refused};
use assert_cmd::cargo::cargo_bin;
use std::f64::consts::PI;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

fn scene(name: &str) -> String {
    format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn modes_of_a_ring_are_its_waves_and_of_the_rig_its_two() {
    let json = document(&["modes", &scene("disk_forward_wave"), "--json"]);
    let modes = json["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 12);
    let of = |n: i64| modes.iter().find(|mode| mode["nodal_diameter"] == n).unwrap();
    for n in -5..=6_i64 {
        let w = of(n)["angular_frequency"].as_f64().unwrap();
        // The air moves frequencies by the square of its damping, 0.05^2/8 at most.
        let sticking = (1.0 + 4.0 * 0.1 * (PI * n as f64 / 12.0).sin().powi(2)).sqrt();
        assert!((w - sticking).abs() < 4e-4, "{n}: {w} {sticking}");
    }
    assert_eq!((&of(3)["direction"], &of(-3)["direction"]), (&"forward".into(), &"backward".into()));
    assert_eq!(of(6)["direction"], "standing");
    assert_eq!(json["flutter_margin"], of(3)["damping"]);
    let rig = document(&["modes", &scene("limit_cycle"), "--json"]);
    assert!(rig["modes"][0]["nodal_diameter"].is_null());
    assert!((rig["modes"][0]["damping"].as_f64().unwrap() + 0.01).abs() < 1e-12);
}

#[test]
fn disk_scenes_are_for_disk_commands_and_the_others_for_the_rig() {
    refused(&["simulate", "--scene", &scene("disk_mistuned")], &["bladed disk", "modes"]);
    refused(&["disk", "waves", &scene("limit_cycle")], &["two-mass rig", "[disk]"]);
    refused(&["disk", "flutter", &scene("disk_forward_wave")], &["mistuning", "normal"]);
    refused(&["disk", "waves", &scene("chain_100")], &["ring"]);
}

#[test]
fn waves_and_motions_are_printed_and_written() {
    let json = document(&["disk", "waves", &scene("disk_forward_wave"), "--json"]);
    let waves = json["waves"].as_array().unwrap();
    let stable: Vec<i64> = waves
        .iter()
        .filter(|wave| wave["limit_cycle"]["stable"] == true)
        .map(|wave| wave["nodal_diameter"].as_i64().unwrap())
        .collect();
    // The wave with the strongest excitation is stable, backward waves have no cycle.
    assert!(stable.contains(&3), "{stable:?}");
    assert!(waves.iter().all(|wave| wave["nodal_diameter"].as_i64() >= Some(0) || wave["limit_cycle"].is_null()));
    // Multipliers of real orbits are conjugate: with the wave m, its mirror image 2 n - m grows as well.
    let mut pairs = 0;
    for wave in waves.iter().filter(|wave| wave["limit_cycle"]["stability"] == "unstable") {
        let n = wave["nodal_diameter"].as_i64().unwrap();
        let fastest = wave["limit_cycle"]["fastest"]["nodal_diameters"].as_array().unwrap();
        for m in fastest.iter().map(|m| m.as_i64().unwrap()) {
            assert!(fastest.iter().any(|other| (other.as_i64().unwrap() - (2 * n - m)).rem_euclid(12) == 0), "{wave}");
        }
        pairs += usize::from(fastest.len() == 2);
    }
    assert!(pairs > 0);
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let args = ["disk", "simulate", &scene("disk_competition"), "--t-end", "300", "--json", "-o", &path("w.csv")];
    let json = document(&[&args[..], &["--plot", &path("w.svg")]].concat());
    assert_eq!(json["final"]["amplitudes"].as_array().unwrap().len(), 12);
    assert!(folder.path().join("w.csv").exists() && folder.path().join("w.svg").exists());
}

#[test]
fn engine_and_slow_flow_write_the_columns_of_the_exact_motion_and_agree_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let run = |solver: &str| {
        let path = folder.path().join(format!("{solver}.csv"));
        let args =
            ["disk", "simulate", &scene("disk_forward_wave"), "--with", solver, "--t-end", "400", "--json", "-o"];
        let json = document(&[&args[..], &[path.to_str().unwrap()]].concat());
        let text = std::fs::read_to_string(path).unwrap();
        let header = text.lines().find(|line| line.starts_with("t [1],")).unwrap().to_owned();
        (json, header)
    };
    let [exact, engine, slow] = ["exact", "rapier", "slow-flow"].map(run);
    assert!(exact.1 == engine.1 && exact.1 == slow.1, "{} {} {}", exact.1, engine.1, slow.1);
    let amplitude = |json: &serde_json::Value| json["final"]["amplitudes"][3].as_f64().unwrap();
    let [a, b, c] = [&exact.0, &engine.0, &slow.0].map(amplitude);
    // The engine at 1024 steps a period, second order; averaging: the describing function and the frequency at which waves are seen.
    assert!((a - b).abs() < 1e-3 && (a - c).abs() < 0.03 * a, "{a} {b} {c}");
    for json in [&exact.0, &engine.0, &slow.0] {
        assert_eq!(json["final"]["strongest_nodal_diameter"], 3);
    }
    assert!(exact.0["events"].as_u64().unwrap() > 100 && slow.0["events"].is_null());
    assert!(engine.0["work"]["steps"].as_u64().unwrap() > 10_000 && slow.0["work"]["steps"].as_u64().unwrap() < 1000);
    assert_eq!(engine.0["parameters"]["engine"]["substeps"], 1);
    refused(&["disk", "simulate", &scene("disk_forward_wave"), "--dt", "0.01"], &["--with rapier"]);
}

#[test]
fn a_cycle_of_a_mistuned_disk_is_printed() {
    let json = document(&["disk", "cycle", &scene("disk_mistuned"), "--wave", "6", "--json"]);
    assert_eq!(json["amplitudes"].as_array().unwrap().len(), 24);
    assert!(json["residual"].as_f64().unwrap() < 1e-11 && json["participation"].as_f64().unwrap() < 1.0);
    // 24 displacements, velocities and forces.
    assert_eq!(json["floquet_multipliers"].as_array().unwrap().len(), 72);
    refused(&["disk", "cycle", &scene("disk_mistuned"), "--wave", "-6"], &["no limit cycle", "-6"]);
    refused(&["disk", "cycle", &scene("disk_mistuned"), "--wave", "99"], &["--wave = 99", "from -11 to 12"]);
    refused(&["disk", "cycle", &scene("chain_100"), "--wave", "1"], &["ring"]);
}

fn flutter(folder: &Path) -> Command {
    let mut command = Command::new(cargo_bin("stickslip"));
    command.args(["disk", "flutter", &scene("disk_mistuned"), "--samples", "60", "--periods", "60", "-q", "-o"]);
    command.arg(folder).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

#[test]
fn a_killed_monte_carlo_goes_on_to_the_same_result() {
    let folder = tempfile::tempdir().unwrap();
    let [killed, whole] = ["killed", "whole"].map(|name| folder.path().join(name));
    let mut child = flutter(&killed).spawn().unwrap();
    // Killed as soon as a block is there; with SIGKILL nothing can be put in order.
    let blocks = || std::fs::read_dir(killed.join("samples")).map_or(0, Iterator::count);
    while blocks() < 1 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!killed.join("samples.json").exists(), "it was to be killed before its end");
    assert!(flutter(&killed).status().unwrap().success());
    assert!(flutter(&whole).status().unwrap().success());
    let bytes = |folder: &Path| std::fs::read(folder.join("samples.json")).unwrap();
    assert_eq!(bytes(&killed), bytes(&whole));
}

fn written(folder: &Path, text: &str) -> String {
    let path = folder.join("scene.toml");
    std::fs::write(&path, format!("title = \"x\"\n[disk]\n{text}")).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn a_ring_of_two_is_sent_to_chains() {
    let folder = tempfile::tempdir().unwrap();
    refused(&["modes", &written(folder.path(), "sectors = 2\ncoupling = 0.1\n")], &["topology = \"chain\""]);
}

#[test]
fn uncoupled_blades_have_equal_cycles_and_their_waves_are_listed_without_wrong_advice() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(
        folder.path(),
        "sectors = 6\ncoupling = 0.0\n[[disk.friction]]\nplace = \"foot\"\nstiffness = 0.5\n[disk.aerodynamics]\n\
         given = \"coefficients\"\ncoefficients = [{ offset = 0, imaginary = -0.02 }]\n",
    );
    // Waves that could not be solved for are rows that say why, exit status 1.
    let output = Command::new(cargo_bin("stickslip")).args(["disk", "waves", &path, "--json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let waves = json["waves"].as_array().unwrap();
    assert_eq!(waves.len(), 6);
    for wave in waves {
        // Blades that do not know of each other may shift in phase at no cost: no wave is stable, none of the small ones unstable.
        let failed = wave["failed"].as_array().unwrap();
        let told = failed.iter().any(|f| f["reason"].as_str().unwrap().contains("without coupling"));
        assert!(wave["limit_cycle"]["stability"] == "neutral" || told, "{wave}");
    }
}

#[test]
fn without_air_modes_stand_and_their_margin_is_neutral() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(
        folder.path(),
        "sectors = 9\ncoupling = 0.1\n[disk.mistuning]\nkind = \"normal\"\nstandard_deviation = 0.02\nseed = 3\n",
    );
    let json = document(&["modes", &path, "--json"]);
    assert_eq!((&json["stability"], &json["flutter"]), (&"neutral".into(), &false.into()));
    for mode in json["modes"].as_array().unwrap() {
        assert!(mode["direction"] == "standing" && mode["nodal_diameter"].as_i64() >= Some(0), "{mode}");
    }
}
