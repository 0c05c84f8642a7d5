//! NOTICE names what Cargo.lock says is in the program, and the program prints it.

#[path = "../../examples/notice/lock.rs"]
mod lock;

use assert_cmd::Command;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const NOTICE: &str = include_str!("../../NOTICE");

fn table(name: &str) -> toml::Table {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap().parse().unwrap()
}

/// Of the list at the top: `  name version: licence`.
fn listed(notice: &str) -> BTreeSet<lock::Package> {
    let entry = |line: &str| {
        let (package, _) = line.strip_prefix("  ")?.split_once(": ")?;
        package.split_once(' ').map(|(name, version)| (name.to_owned(), version.to_owned()))
    };
    notice.split("\n====").next().unwrap().lines().filter_map(entry).collect()
}

#[test]
fn the_notice_is_that_of_the_lock_file() {
    let packages = lock::packages(&table("Cargo.toml"), &table("Cargo.lock")).unwrap();
    assert!(packages.len() > 300, "the lock file was not understood: {} packages", packages.len());
    let listed = listed(NOTICE);
    let missing: Vec<_> = packages.difference(&listed).collect();
    let superfluous: Vec<_> = listed.difference(&packages).collect();
    assert!(
        missing.is_empty() && superfluous.is_empty(),
        "run `cargo run --example notice`: missing {missing:?}, superfluous {superfluous:?}"
    );
}

#[test]
fn a_package_that_is_new_in_the_lock_file_is_missed() {
    let mut lock = table("Cargo.lock");
    let packages = lock["package"].as_array_mut().unwrap();
    let snap = packages.iter_mut().find(|package| package["name"].as_str() == Some("snap")).unwrap();
    snap["version"] = "99.0.0".into();
    let packages = lock::packages(&table("Cargo.toml"), &lock).unwrap();
    assert!(packages.contains(&("snap".to_owned(), "99.0.0".to_owned())));
    assert!(!listed(NOTICE).contains(&("snap".to_owned(), "99.0.0".to_owned())));
    // What only tests the program is no part of it.
    assert!(packages.iter().all(|(name, _)| name != "criterion" && name != "diffsol"));
}

#[test]
fn the_program_prints_the_notices_that_its_licences_demand() {
    let output = Command::cargo_bin("stickslip").unwrap().arg("--licences").output().unwrap();
    assert!(output.status.success());
    let printed = String::from_utf8(output.stdout).unwrap();
    assert_eq!(printed.trim_end(), NOTICE.trim_end());
    for words in [
        // openh264's C source, BSD-2-Clause; the fonts; snap, BSD-3-Clause; the licence of most packages.
        "Copyright (c) 2013, Cisco Systems",
        "Copyright (c) 2003 by Bitstream, Inc.",
        "Copyright 2011, The Snappy-Rust Authors",
        "Apache License",
    ] {
        assert!(printed.contains(words), "{words:?} is not there");
    }
    let output = Command::cargo_bin("stickslip").unwrap().args(["--licences", "modes"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "an option without effect is an error");
}
