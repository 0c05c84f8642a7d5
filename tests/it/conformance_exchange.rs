//! Set-ups for other engines, and how their trajectories are judged: shown with an integrator of 30 lines in plain Python.

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use std::process;

fn stickslip() -> Command {
    Command::cargo_bin("stickslip").unwrap()
}

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
    for name in ["linear_oscillator_0", "negative_damping", "coupled_oscillators", "friction_decay", "limit_cycle"] {
        assert!(names.contains(&format!("{name}.csv")) && names.contains(&format!("{name}.json")), "{names:?}");
        let (scores, code) = judged(&folder.path().join(format!("{name}.csv")));
        assert_eq!(code, 0, "{name}: {scores}");
        assert_eq!(scores["scores"][0]["checks"][0]["found"], 0.0, "{name}");
    }
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
    for (content, word) in [("x1,x2\n", "no column"), ("t,x1,x2\n0,1,nan\n", "finite"), ("t,x1,x2\n0,1,1\n", "samples")]
    {
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
    for name in ["limit_cycle", "friction_decay", "linear_oscillator_1.5"] {
        let (scores, code) = run(name, "8");
        // 512 steps per period: 4e-4 by second order on the limit cycle, against 1 % of 1.2.
        assert_eq!(code, 0, "{name}: {scores}");
        let error = scores["scores"][0]["checks"][0]["found"].as_f64().unwrap();
        assert!(error > 1e-9 && error < 1e-3, "{name}: {error}");
    }
    // One step per sample, 64 a period: off by 2.4e-2 there.
    assert_eq!(run("limit_cycle", "1").1, 1);
}
