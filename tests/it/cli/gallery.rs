//! `gallery` has the options that it uses, and says what it makes.

use super::{refused, stickslip};

#[test]
fn options_of_films_are_refused_and_so_is_a_name_it_does_not_know() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("gallery");
    let place = output.to_str().unwrap();
    for option in ["--frames=0:1", "--shard=1/2", "--encoder=ffmpeg"] {
        refused(&["gallery", option, "-o", place], &["unexpected argument", option.split('=').next().unwrap()]);
    }
    refused(&["gallery", "--only", "nothere", "-o", place], &["nothere", "limit_torus", "coarse_engine"]);
    // Before anything is looked for: an adapter that may be missing is no reason to leave the name unsaid.
    let unknown = stickslip(&["gallery", "--only", "nothere", "--renderer", "vulkan", "-o", place]);
    let told = String::from_utf8_lossy(&unknown.stderr).into_owned();
    assert!(told.contains("nothere") && !told.contains("renderer:") && !told.contains("adapter"), "{told}");
    assert!(!output.exists());
}

#[test]
fn its_help_names_what_it_shows() {
    let help = String::from_utf8(stickslip(&["gallery", "--help"]).stdout).unwrap();
    for words in ["two-mass rig", "one bladed disk", "coarse engine", "--supersample", "--renderer"] {
        assert!(help.split_whitespace().collect::<Vec<_>>().join(" ").contains(words), "{words}: {help}");
    }
    assert!(!help.contains("every built-in scene") && !help.contains("--shard"), "{help}");
}
