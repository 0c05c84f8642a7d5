//! Which frame is where in what the program writes: each picture, and each of the film, is the one drawn here of the same instant.

use super::{document_on, scene_file};
use crate::film::mp4;
use crate::film::video::bt709;
use crate::golden::on_cpu;
use image::RgbaImage;
use serde_json::Value;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
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

/// Films of the scene, and what their frames have to be.
struct Films {
    folder: tempfile::TempDir,
    frames: Vec<RgbaImage>,
    /// The film made at once.
    whole: PathBuf,
}

impl Films {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let whole = folder.path().join("whole");
        let mut films = Self { folder, frames: Vec::new(), whole };
        let json = films.render("whole", 1, &[]);
        films.frames = drawn(serde_json::from_value(json["parameters"]["case"].clone()).unwrap());
        assert_eq!(films.frames.len(), COUNT);
        films
    }

    fn place(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn render(&self, name: &str, threads: usize, options: &[&str]) -> Value {
        let (scene, output) = (scene_file(self.folder.path(), SCENE), self.place(name));
        let args = ["render", &scene, "--with", "exact", "--renderer", "cpu", "--json", "-q", "-o"];
        document_on(threads, &[&args[..], &[output.to_str().unwrap()], options].concat())
    }

    fn numbers(&self, pictures: &[RgbaImage]) -> Vec<usize> {
        pictures.iter().map(|picture| nearest(picture, &self.frames)).collect()
    }

    /// The frames of `range` are there and in order.
    fn check_pictures(&self, name: &str, range: Range<usize>) {
        assert_eq!(self.numbers(&stored(&self.place(name), range.clone())), range.collect::<Vec<_>>(), "{name}");
    }

    /// So is the whole film, which has the bytes of the one made at once.
    fn check(&self, name: &str) {
        self.check_pictures(name, 0..COUNT);
        let bytes = fs::read(self.place(name).join("film.mp4")).unwrap();
        let filmed: Vec<RgbaImage> = mp4::read(&bytes).decode().iter().map(bt709).collect();
        assert_eq!(self.numbers(&filmed), (0..COUNT).collect::<Vec<_>>(), "{name}");
        assert!(bytes == fs::read(self.whole.join("film.mp4")).unwrap(), "{name}");
    }
}

/// Pictures of a film by their numbers.
fn stored(directory: &Path, range: Range<usize>) -> Vec<RgbaImage> {
    let path = |index| directory.join(format!("frames/{index:06}.png"));
    range.map(|index| image::open(path(index)).unwrap().to_rgba8()).collect()
}

#[test]
fn every_picture_is_the_one_of_its_number_on_any_number_of_threads_and_after_a_loss() {
    let films = Films::new();
    films.check("whole");
    // Negative control: pictures that come one too late, the first of them twice.
    let late = [stored(&films.whole, 0..1), stored(&films.whole, 0..COUNT - 1)].concat();
    assert_eq!(films.numbers(&late)[..3], [0, 0, 1]);
    films.render("threads", 4, &[]);
    films.check("threads");
    for missing in ["frames/000000.png", "frames/000009.png", "frames/000010.png", "frames/000020.png", "film.mp4"] {
        fs::remove_file(films.place("threads").join(missing)).unwrap();
    }
    assert_eq!(films.render("threads", 3, &[])["frames"]["drawn"], 4);
    films.check("threads");
}

#[test]
fn ranges_and_shards_are_the_frames_of_their_numbers_and_make_the_film() {
    let films = Films::new();
    films.render("parts", 3, &["--frames", "7:21"]);
    films.check_pictures("parts", 7..COUNT);
    assert!(!films.place("parts/frames/000006.png").exists() && !films.place("parts/film.mp4").exists());
    films.render("parts", 3, &["--frames", "0:7"]);
    assert_eq!(films.render("parts", 2, &[])["frames"]["drawn"], 0);
    films.check("parts");
    // Each third in a place of its own; put together, their journals one after the other, they are the film.
    let together = films.place("2");
    for (shard, range) in [("2", 7..14), ("3", 14..21), ("1", 0..7)] {
        assert_eq!(films.render(shard, 2, &["--shard", &format!("{shard}/3")])["frames"]["drawn"], 7);
        films.check_pictures(shard, range.clone());
        let place = films.place(shard);
        if place == together {
            continue;
        }
        for name in range.map(|index| format!("frames/{index:06}.png")) {
            fs::copy(place.join(&name), together.join(&name)).unwrap();
        }
        let mut journal = fs::read(together.join("outputs.jsonl")).unwrap();
        journal.extend(fs::read(place.join("outputs.jsonl")).unwrap());
        fs::write(together.join("outputs.jsonl"), journal).unwrap();
    }
    assert_eq!(films.render("2", 1, &[])["frames"]["drawn"], 0);
    films.check("2");
}
