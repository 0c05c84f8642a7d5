//! What is refused before anything is computed, with exit status 2 and words that say what to change.

use super::{document, refused, scene_file};
use std::fs;
use stickslip::store::{ColumnData, read_table, write_table};

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
fn what_fuzzing_found_is_refused_with_what_it_is_about() {
    // Messages that named no option, no field and no file.
    refused(&["lyapunov", "--t-end=40", "--transient=10"], &["--t-end 40", "--transient 10", "at least"]);
    refused(&["slow-flow", "doublings", "--gamma", "0.0001"], &["gamma = 0.0001", "no secondary Hopf point"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.csv");
    let name = path.to_str().unwrap();
    document(&["simulate", "--t-end", "1", "--json", "-o", name]);
    let mut table = read_table(&path).unwrap();
    for column in &mut table.columns {
        match &mut column.values {
            ColumnData::F64(values) => values.clear(),
            ColumnData::OptionalF64(values) => values.clear(),
            ColumnData::Text(values) => values.clear(),
        }
    }
    write_table(&path, &table).unwrap();
    let picture = folder.path().join("p.png");
    refused(&["render", "--trajectory", name, "--at", "0", "-o", picture.to_str().unwrap()], &[name, "no rows"]);
    // An abort: rates of 4e9 cut the motion into more pieces than fit into memory.
    let fast = include_str!("../../inputs/disk.toml").replace("imaginary = 0.01", "imaginary = 4294967296");
    let scene = scene_file(folder.path(), &fast);
    let film = ["--with", "exact", "--renderer", "cpu", "--t-end", "2", "--at", "1", "--size", "64x64", "-o"];
    refused(&[&["render", &scene][..], &film, &[picture.to_str().unwrap()]].concat(), &["pieces", "memory"]);
}
