//! `simulate`: one trajectory, and the tables of it.

use super::{document, refused, scene_file};
use std::fs;
use std::path::{Path, PathBuf};

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
fn a_prescribed_motion_needs_no_initial_state() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_file(folder.path(), "title = \"x\"\n[prescribed]\namplitude = 2.0\nangular_frequency = 1.0\n");
    let json = document(&["simulate", "--scene", &scene, "--t-end", "3", "--json"]);
    assert_eq!(json["final"]["x2"], 0.0);
    assert!((json["final"]["x1"].as_f64().unwrap() - 2.0 * 3.0_f64.sin()).abs() < 1e-14);
}

/// A slip length of half a micrometre: bounds and perturbations in metres would start the motion 1000 slip lengths off its cycle.
#[test]
fn defaults_of_an_si_scene_are_in_slip_lengths() {
    let given =
        fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cases/si_micrometre_contact.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for slip_force in [5.0, 11.0] {
        let text = given.replace("slip_force = 5.0", &format!("slip_force = {slip_force:?}"));
        let scene = scene_file(folder.path(), &text);
        let out = folder.path().join(format!("{slip_force}.csv"));
        let json = document(&["simulate", "--scene", &scene, "-o", out.to_str().unwrap(), "--json"]);
        assert_eq!(json["diverged"], false);
        // The limit cycle and the torus of this rig stay below some slip lengths.
        let slip_length = if json["units"] == "si" { slip_force / 1e7 } else { 1.0 };
        let x1 = json["final"]["x1"].as_f64().unwrap() / slip_length;
        assert!(x1.abs() < 5.0, "{slip_force}: {x1} slip lengths");
    }
}
