//! Set-ups for other engines, and how their trajectories are judged: shown with an integrator of 30 lines in plain Python.

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use std::process;

fn stickslip() -> Command {
    Command::cargo_bin("stickslip").unwrap()
}

const NAMES: [&str; 12] = [
    "free_flight",
    "constant_force",
    "linear_oscillator_0",
    "linear_oscillator_0.1",
    "linear_oscillator_1.5",
    "negative_damping",
    "coupled_oscillators",
    "friction_decay",
    "limit_cycle",
    "hysteresis",
    "torus",
    "chaos",
];

fn exported(folder: &Path) {
    stickslip().args(["conformance", "export", "-q", "-o"]).arg(folder).assert().success();
}

/// Scores of one file as JSON, and the exit status.
fn judged(file: &Path) -> (serde_json::Value, i32) {
    let output = stickslip().args(["conformance", "judge", "--json"]).arg(file).output().unwrap();
    let code = output.status.code().unwrap();
    (serde_json::from_slice(&output.stdout).unwrap_or_default(), code)
}

#[test]
fn every_motion_is_exported_with_its_reference_which_is_right_itself() {
    let folder = tempfile::tempdir().unwrap();
    exported(folder.path());
    let mut names: Vec<String> =
        fs::read_dir(folder.path()).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    for name in NAMES {
        assert!(names.contains(&format!("{name}.csv")) && names.contains(&format!("{name}.json")), "{names:?}");
        let (scores, code) = judged(&folder.path().join(format!("{name}.csv")));
        assert_eq!(code, 0, "{name}: {scores}");
        let checks = scores["scores"][0]["checks"].as_array().unwrap();
        assert!(!checks.is_empty() && checks.iter().all(|check| check["error"] == 0.0), "{name}: {scores}");
    }
    assert_eq!(names.len(), 2 * NAMES.len(), "every file is judged here: {names:?}");
    stickslip().args(["conformance", "export", "-o"]).arg(folder.path()).assert().failure();
}

#[test]
fn a_motion_that_is_not_the_reference_is_wrong_and_a_bad_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    exported(folder.path());
    let file = folder.path().join("limit_cycle.csv");
    let text = fs::read_to_string(&file).unwrap();
    let (heading, numbers) = text.split_once('\n').unwrap();
    // Two percent too large.
    let scaled: Vec<String> = numbers
        .lines()
        .map(|line| {
            let (time, values) = line.split_once(',').unwrap();
            let values: Vec<String> =
                values.split(',').map(|v| (1.02 * v.parse::<f64>().unwrap()).to_string()).collect();
            format!("{time},{}", values.join(","))
        })
        .collect();
    fs::write(&file, format!("{heading}\n{}\n", scaled.join("\n"))).unwrap();
    let (scores, code) = judged(&file);
    assert_eq!((code, &scores["scores"][0]["right"]), (1, &serde_json::json!(false)), "{scores}");
    for (content, word) in [
        ("x1,x2\n", "no column"),
        ("t,x1,x2\n0,1,nan\n", "finite"),
        ("t,x1,x2\n0,1,1\n", "samples"),
        ("t,x1,x2,v2\n0,1,1,1\n", "v1 missing: give all of them or none"),
    ] {
        fs::write(&file, content).unwrap();
        let output = stickslip().args(["conformance", "judge"]).arg(&file).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && message.contains(word), "{message}");
    }
    let foreign = folder.path().join("unknown.csv");
    fs::write(&foreign, "t,x1\n0,1\n").unwrap();
    assert_eq!(judged(&foreign).1, 2);
}

#[test]
fn what_can_be_scored_is_though_other_files_are_missing() {
    let folder = tempfile::tempdir().unwrap();
    exported(folder.path());
    let file = |name: &str| folder.path().join(format!("{name}.csv"));
    let output = stickslip()
        .args(["conformance", "judge", "--json"])
        .args([folder.path().join("gone/limit_cycle.csv"), file("friction_decay")])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["scores"][0]["right"], true, "{document}");
    assert!(document["not_scored"][0].as_str().unwrap().contains("gone/limit_cycle.csv"), "{document}");
    assert!(String::from_utf8(output.stderr).unwrap().contains("1 of 2 files could not be scored"));
}

#[test]
fn a_set_up_of_ones_own_is_judged_by_its_own_reference() {
    let folder = tempfile::tempdir().unwrap();
    exported(folder.path());
    // The reference of a stronger push under a name of its own: x = t + 0.1 t^2, v = 1 + 0.2 t.
    let setup = fs::read_to_string(folder.path().join("constant_force.json")).unwrap();
    fs::write(folder.path().join("mine.json"), setup.replace("\"constant_force\"", "\"mine\"")).unwrap();
    let rows: String = (0..=128)
        .map(|n| 4.0 * std::f64::consts::PI / 128.0 * f64::from(n))
        .map(|t| format!("{t},{},{}\n", t + 0.1 * t * t, 1.0 + 0.2 * t))
        .collect();
    let moved = folder.path().join("moved");
    fs::create_dir(&moved).unwrap();
    fs::write(folder.path().join("mine.csv"), format!("t,x1,v1\n{rows}")).unwrap();
    fs::write(moved.join("mine.csv"), format!("t,x1,v1\n{rows}")).unwrap();
    fs::copy(folder.path().join("constant_force.csv"), moved.join("constant_force.csv")).unwrap();
    let code = |file: &str| {
        let mut command = stickslip();
        command.args(["conformance", "judge", "--setups"]).arg(folder.path()).arg(moved.join(file));
        command.output().unwrap().status.code()
    };
    assert_eq!((code("mine.csv"), code("constant_force.csv")), (Some(0), Some(0)));
    // The weaker push under the name of the stronger one.
    fs::copy(folder.path().join("constant_force.csv"), moved.join("mine.csv")).unwrap();
    assert_eq!((code("mine.csv"), code("nothing.csv")), (Some(1), Some(2)));
}

#[test]
fn without_velocities_the_positions_are_judged_and_the_rest_is_said() {
    let folder = tempfile::tempdir().unwrap();
    exported(folder.path());
    let file = folder.path().join("linear_oscillator_0.csv");
    let text = fs::read_to_string(&file).unwrap();
    let positions: String = text.lines().map(|line| line.rsplit_once(',').unwrap().0.to_owned() + "\n").collect();
    fs::write(&file, positions).unwrap();
    let (scores, code) = judged(&file);
    assert_eq!(code, 0, "{scores}");
    assert_eq!(scores["scores"][0]["checks"].as_array().unwrap().len(), 1);
    assert!(scores["scores"][0]["not_judged"].to_string().contains("maxima: needs velocities"), "{scores}");
}

#[test]
fn a_thirty_line_integrator_in_python_is_right_at_small_steps_and_wrong_at_large_ones() {
    if process::Command::new("python3").arg("--version").output().is_err() {
        println!("skipped: there is no python3 here");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    exported(folder.path());
    let mine = folder.path().join("mine");
    fs::create_dir(&mine).unwrap();
    let run = |name: &str, steps: &str| {
        let out = mine.join(format!("{name}.csv"));
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/other_engine.py");
        let setup = folder.path().join(format!("{name}.json"));
        let status = process::Command::new("python3").arg(script).args([&setup, &out]).arg(steps).status().unwrap();
        assert!(status.success());
        judged(&out)
    };
    for name in NAMES {
        // 8 steps per sample, 256 or 512 a period.
        let (scores, code) = run(name, "8");
        assert_eq!(code, 0, "{name}: {scores}");
        let check = &scores["scores"][0]["checks"][0];
        let (error, limit) = (check["error"].as_f64().unwrap(), check["limit"].as_f64().unwrap());
        // Of second order: at 64 steps twice the limit on the limit cycle, at 256 an eighth of it. Parabolas and prescribed motions are met to rounding.
        let exact = ["free_flight", "constant_force", "hysteresis"].contains(&name);
        assert!(error < 0.125 * limit && (error > 1e-9) != exact, "{name}: {error} {limit}");
    }
    // One step per sample, 64 a period: off by 2.4e-2 there.
    assert_eq!(run("limit_cycle", "1").1, 1);
}
