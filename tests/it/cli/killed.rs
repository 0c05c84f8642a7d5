//! A run that is killed, and goes on: the directory is that of a run nobody disturbed, byte by byte.

use super::scene_file;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const SCENE: &str = include_str!("../../inputs/short.toml");

/// Names and bytes of all files.
fn contents(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut open = vec![root.to_owned()];
    while let Some(folder) = open.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                open.push(path);
            } else {
                files.insert(path.strip_prefix(root).unwrap().display().to_string(), fs::read(&path).unwrap());
            }
        }
    }
    files
}

fn command(line: &[&str], place: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
    command.args(line).arg("-o").arg(place).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn lines(place: &Path) -> usize {
    fs::read_to_string(place.join("outputs.jsonl")).map_or(0, |journal| journal.lines().count())
}

/// Kills the run when its journal has grown by so many lines. Whether it was still running.
fn kill_after(line: &[&str], place: &Path, more: usize) -> bool {
    let target = lines(place) + more;
    let mut child = command(line, place).spawn().unwrap();
    let begun = Instant::now();
    while lines(place) < target && child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < Duration::from_secs(120), "nothing is written");
        std::thread::sleep(Duration::from_millis(1));
    }
    // SIGKILL on Unix.
    child.kill().unwrap();
    child.wait().unwrap().code().is_none()
}

fn same_after_kills(line: &[&str], kills: &[usize]) {
    let folder = tempfile::tempdir().unwrap();
    let (whole, killed) = (folder.path().join("whole"), folder.path().join("killed"));
    assert!(command(line, &whole).status().unwrap().success());
    let hit = kills.iter().filter(|more| kill_after(line, &killed, **more)).count();
    assert!(hit > 0, "no kill hit a running run: nothing was tested");
    assert!(command(line, &killed).status().unwrap().success());
    let (whole, killed) = (contents(&whole), contents(&killed));
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&whole), names(&killed));
    for (name, bytes) in &whole {
        assert!(killed[name] == *bytes, "{name} differs after a kill:\n{}", String::from_utf8_lossy(&killed[name]));
    }
    // Each file stands in the journal once, as finished.
    let journal = String::from_utf8(whole["outputs.jsonl"].clone()).unwrap();
    assert!(journal.lines().all(|line| line.starts_with("{\"finished\"")), "{journal}");
    assert!(journal.lines().count() >= whole.len() - 2, "{journal}");
}

#[test]
fn a_film_after_kills_is_the_same_directory() {
    let folder = tempfile::tempdir().unwrap();
    // 51 frames, of a size that takes some milliseconds each.
    let long = SCENE.replace("duration = 4.0", "duration = 40.0").replace("width = 64", "width = 160");
    let scene = scene_file(folder.path(), &long);
    same_after_kills(&["render", &scene, "--with", "exact", "--renderer", "cpu"], &[1, 8, 17]);
}

#[test]
fn the_figures_of_the_paper_after_kills_are_the_same_directory() {
    same_after_kills(&["paper", "--quick", "--only", "fig1,fig6"], &[1, 3]);
}

#[test]
fn a_monte_carlo_after_kills_is_the_same_directory() {
    let scene = "scenes/disk_mistuned.toml";
    same_after_kills(&["disk", "flutter", scene, "--samples", "12", "--periods", "20"], &[2, 5]);
}
