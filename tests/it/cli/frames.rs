//! Which frame is where in what the program writes: each picture, and each of the film, is the one drawn here of the same instant.

use super::{document_on, scene_file};
use crate::film::mp4;
use crate::film::video::bt709;
use crate::golden::on_cpu;
use image::RgbaImage;
use std::fs;
use std::path::Path;
use stickslip::dynamics::{Flow, Sampling, State};
use stickslip::exact::TwoMassFlow;
use stickslip::model::TwoMassRig;
use stickslip::scene::{Case, Initial};
use stickslip::stage::{Beside, Motion, Stage};

/// 16 time units at 8 a second and 10 frames a second, and the one at time 0.
const COUNT: usize = 21;
const SCENE: &str = "title = \"x\"\n[rig]\nxi1 = -0.1\n[initial]\nstart = \"state\"\nstate = [1.5, -0.8, 0.0, 0.5, 0.5]\n\
    [simulation]\nduration = 16.0\n[film]\nwidth = 192\nheight = 108\nfps = 10\n[direction]\npanels = [\"series\", \"phase\"]\n";

/// The frames of a case in its exact motion.
fn drawn(case: Case) -> Vec<RgbaImage> {
    let Initial::State { state } = case.initial else { panic!("the scene gives its state") };
    let flow = TwoMassFlow::new(&TwoMassRig::new(case.parameters).unwrap());
    let sampling = Sampling { interval: 0.04, t_end: case.duration };
    let motion = Motion::new(&flow.trajectory(&State::two_mass(state), sampling).unwrap()).unwrap();
    let stage = Stage::new(case, motion, Beside::default());
    (0..stage.frame_count()).map(|index| on_cpu(&stage.frame(index))).collect()
}

/// The number of the frame that is most like a picture: least squares over all channels.
fn nearest(picture: &RgbaImage, frames: &[RgbaImage]) -> usize {
    let apart = |frame: &RgbaImage| -> u64 {
        let pairs = picture.as_raw().iter().zip(frame.as_raw());
        pairs.map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2)).sum()
    };
    (0..frames.len()).min_by_key(|&index| apart(&frames[index])).unwrap()
}

/// Pictures `A:B` of a film.
fn stored(directory: &Path, frames: std::ops::Range<usize>) -> Vec<RgbaImage> {
    let path = |index| directory.join(format!("frames/{index:06}.png"));
    frames.map(|index| image::open(path(index)).unwrap().to_rgba8()).collect()
}

fn filmed(directory: &Path) -> Vec<RgbaImage> {
    mp4::read(&fs::read(directory.join("film.mp4")).unwrap()).decode().iter().map(bt709).collect()
}

#[test]
fn every_picture_is_the_one_of_its_number_however_the_film_was_made() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_file(folder.path(), SCENE);
    let render = |name: &str, threads: usize, options: &[&str]| {
        let output = folder.path().join(name);
        let args = ["render", &scene, "--with", "exact", "--renderer", "cpu", "--json", "-q", "-o"];
        (document_on(threads, &[&args[..], &[output.to_str().unwrap()], options].concat()), output)
    };
    let (json, whole) = render("whole", 1, &[]);
    let frames = drawn(serde_json::from_value(json["parameters"]["case"].clone()).unwrap());
    assert_eq!(frames.len(), COUNT);
    let numbers = |pictures: &[RgbaImage]| pictures.iter().map(|p| nearest(p, &frames)).collect::<Vec<_>>();
    let in_order: Vec<usize> = (0..COUNT).collect();
    let check = |directory: &Path| {
        assert_eq!(numbers(&stored(directory, 0..COUNT)), in_order);
        assert_eq!(numbers(&filmed(directory)), in_order);
        assert!(fs::read(directory.join("film.mp4")).unwrap() == fs::read(whole.join("film.mp4")).unwrap());
    };
    check(&whole);
    // Negative control: pictures that are one too late, the first of them twice.
    let late: Vec<RgbaImage> = stored(&whole, 0..1).into_iter().chain(stored(&whole, 0..COUNT - 1)).collect();
    assert_eq!(numbers(&late)[..3], [0, 0, 1]);

    for missing in ["frames/000000.png", "frames/000009.png", "frames/000010.png", "frames/000020.png", "film.mp4"] {
        fs::remove_file(whole.join(missing)).unwrap();
    }
    let bytes = render("again", 4, &[]).1;
    assert_eq!(render("whole", 4, &[]).0["frames"]["drawn"], 4);
    assert!(fs::read(bytes.join("film.mp4")).unwrap() == fs::read(whole.join("film.mp4")).unwrap());
    check(&whole);

    let parts = render("parts", 3, &["--frames", "7:21"]).1;
    assert_eq!(numbers(&stored(&parts, 7..COUNT)), in_order[7..]);
    assert!(!parts.join("frames/000006.png").exists() && !parts.join("film.mp4").exists());
    render("parts", 3, &["--frames", "0:7"]);
    assert_eq!(render("parts", 2, &[]).0["frames"]["drawn"], 0);
    check(&parts);

    for (part, begin, end) in [("2/3", 7, 14), ("3/3", 14, 21), ("1/3", 0, 7)] {
        let (json, shards) = render("shards", 2, &["--shard", part]);
        assert_eq!(json["frames"]["drawn"], 7);
        assert_eq!(numbers(&stored(&shards, begin..end)), in_order[begin..end]);
    }
    check(&render("shards", 1, &[]).1);
}
