//! `contact-sheet` and `animate` leave the files of others alone.

use super::{refused, stickslip};
use std::fs;

#[test]
fn a_file_in_the_way_of_a_picture_is_replaced_by_force_only() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let film = at("film");
    let made = |args: &[&str]| {
        let output = stickslip(args);
        assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    };
    let small = ["--t-end", "4", "--fps", "4", "--size", "64x64", "--renderer", "cpu"];
    made(&[&["render", "--with", "exact", "-o", &film][..], &small].concat());
    for (command, name) in [("contact-sheet", "sheet.png"), ("animate", "loop.gif")] {
        let file = at(name);
        fs::write(&file, "mine").unwrap();
        let args = [command, &film, "--width", "32", "-o", &file];
        refused(&args, &[&format!("{file} exists: replace it with --force")]);
        assert_eq!(fs::read(&file).unwrap(), b"mine");
        made(&[&args[..], &["--force"]].concat());
        assert!(image::open(&file).is_ok(), "{name}");
        refused(&args, &["--force"]);
    }
    // Without -o the sheet belongs to the film, and follows it.
    let own = folder.path().join("film/contact-sheet.png");
    made(&["contact-sheet", &film, "--width", "32"]);
    let first = fs::read(&own).unwrap();
    made(&["contact-sheet", &film, "--width", "32", "--count", "1"]);
    assert_ne!(fs::read(&own).unwrap(), first);
}
