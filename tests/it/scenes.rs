//! Scene files: every one in `scenes/` parses, the schema is fresh and accepts them.

use std::fs;
use std::path::PathBuf;
use stickslip::scene::{BUILT_IN, BUILT_IN_DISKS, Scene};

fn scene_files() -> Vec<PathBuf> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

#[test]
fn every_scene_file_is_valid_and_says_what_to_look_at() {
    let files = scene_files();
    assert!(files.len() >= BUILT_IN.len() + BUILT_IN_DISKS.len());
    for file in files {
        Scene::load(&file).unwrap();
        let text = fs::read_to_string(&file).unwrap();
        assert!(text.starts_with("# ") && text.contains("# Look at: "), "{} lacks its comment", file.display());
    }
}

#[test]
fn every_built_in_scene_is_the_file_of_its_name() {
    for (name, text) in BUILT_IN.into_iter().chain(BUILT_IN_DISKS) {
        let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        assert_eq!(fs::read_to_string(path).unwrap(), text);
    }
    Scene::built_in().unwrap();
}

#[test]
fn the_committed_schema_is_fresh() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scene.schema.json");
    let committed: serde_json::Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    assert!(committed == Scene::json_schema(), "renew it: stickslip schema scene > assets/scene.schema.json");
}

#[test]
fn the_schema_accepts_every_scene_and_refuses_unknown_fields() {
    let validator = jsonschema::validator_for(&Scene::json_schema()).unwrap();
    let as_json = |text: &str| serde_json::to_value(toml::from_str::<toml::Table>(text).unwrap()).unwrap();
    for file in scene_files() {
        let scene = as_json(&fs::read_to_string(&file).unwrap());
        assert!(validator.is_valid(&scene), "{}: {:?}", file.display(), validator.iter_errors(&scene).next());
    }
    assert!(!validator.is_valid(&as_json("title = \"x\"\ncolour = \"red\"\n")));
    assert!(!validator.is_valid(&as_json("title = \"x\"\n[rig]\nxi9 = 1.0\n")));
    assert!(!validator.is_valid(&as_json("title = \"x\"\n[film]\nfps = -3\n")));
}
