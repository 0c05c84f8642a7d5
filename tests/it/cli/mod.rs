//! The command line as a user meets it: exit statuses, messages, JSON documents.

mod analysis;
mod frames;
mod gallery;
mod generated;
mod in_the_way;
mod input;
mod killed;
mod pictures;
mod render;
mod run;
mod simulate;
mod slow_flow;
mod story;

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;

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

/// The same on so many threads.
fn document_on(threads: usize, args: &[&str]) -> Value {
    let mut command = Command::cargo_bin("stickslip").unwrap();
    let output = command.env("RAYON_NUM_THREADS", threads.to_string()).args(args).output().unwrap();
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn scene_file(folder: &Path, text: &str) -> String {
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}
