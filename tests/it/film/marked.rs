//! Which frame is where, on the real path: the rig drawn by the built-in rasteriser, with a mark whose place is the frame's number, stored,
//! filmed and read back from the files.

use super::fake::{origin, settings};
use super::mp4;
use super::video::bt709;
use crate::golden::on_cpu;
use glam::Vec2;
use image::{Rgba, RgbaImage};
use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::Path;
use stickslip::dynamics::{Flow, Sampling, State};
use stickslip::exact::TwoMassFlow;
use stickslip::film::{FilmReport, FilmSettings, FrameSource, SourceError, produce};
use stickslip::model::TwoMassRig;
use stickslip::render::{
    AdapterInfo, Colour, DrawList, DrawTimes, OverlayItem, Rectangle, RenderError, Renderer, RendererChoice, open,
};
use stickslip::scene::{Initial, Panel, Scene};
use stickslip::stage::{Beside, Motion, Stage};
use stickslip::store::{Existing, OutputDir};

const SIZE: [u32; 2] = [192, 108];
const COUNT: u64 = 20;
/// Side of the mark, which moves its own width per frame along a black strip at the top.
const MARK: u32 = 8;
/// A square of even colour, on whole blocks of the video, that no frame is without.
pub const PATCH: [u32; 4] = [0, 48, 32, 80];
pub const PATCH_COLOUR: u32 = 0xd0_40_20;

/// The built-in scene in its exact motion, every frame marked.
pub struct Marked {
    stage: Stage,
    count: u64,
}

impl Marked {
    pub fn new([width, height]: [u32; 2], count: u64) -> Self {
        let (mut scene, _) = Scene::built_in().unwrap();
        (scene.film.width, scene.film.height, scene.film.fps) = (width, height, 25);
        scene.direction.panels = Some(vec![Panel::Series, Panel::Phase]);
        let case = scene.checked("marked").unwrap();
        let Initial::State { state } = case.initial else { panic!("the built-in scene gives its state") };
        let sampling = Sampling { interval: 0.04, t_end: case.motion_time(count) };
        let flow = TwoMassFlow::new(&TwoMassRig::new(case.parameters).unwrap());
        let motion = Motion::new(&flow.trajectory(&State::two_mass(state), sampling).unwrap()).unwrap();
        Self { stage: Stage::new(case, motion, Beside::default()), count }
    }
}

impl FrameSource for Marked {
    fn count(&self) -> u64 {
        self.count
    }

    fn frame(&self, index: u64) -> Result<DrawList, SourceError> {
        let mut list = self.stage.frame(index);
        let at = index as u32 * MARK;
        let marks = [([0, 0, list.size[0], MARK], 0), ([at, 0, at + MARK, MARK], 0xff_ff_ff), (PATCH, PATCH_COLOUR)];
        list.overlay.extend(marks.map(|([left, top, right, bottom], colour)| OverlayItem::Box {
            area: Rectangle { min: Vec2::new(left as f32, top as f32), max: Vec2::new(right as f32, bottom as f32) },
            corner_radius: 0.0,
            fill: Colour::rgb(colour),
            stroke: None,
        }));
        Ok(list)
    }
}

/// The number a picture says it has; `None` where there is no mark, or more than one.
fn number(picture: &RgbaImage) -> Option<u64> {
    let is_lit = |place: &u32| picture.get_pixel(place * MARK + MARK / 2, MARK / 2).0[1] > 127;
    let lit: Vec<u32> = (0..picture.width() / MARK).filter(is_lit).collect();
    match lit[..] {
        [place] => Some(place.into()),
        _ => None,
    }
}

fn film(
    directory: &Path,
    frames: Option<Range<u64>>,
    renderer: &mut dyn Renderer,
    source: &dyn FrameSource,
) -> FilmReport {
    let output = OutputDir::open(directory, &origin(), Existing::Resume).unwrap();
    let settings = FilmSettings { size: SIZE, frames, ..settings() };
    produce(&settings, &output, renderer, source, &mut |_| ()).unwrap()
}

/// Films on the calling thread's pool with the built-in rasteriser.
fn really(directory: &Path, frames: Option<Range<u64>>) -> FilmReport {
    film(directory, frames, open(RendererChoice::Cpu).unwrap().as_mut(), &Marked::new(SIZE, COUNT))
}

fn picture(directory: &Path, index: u64) -> RgbaImage {
    image::open(directory.join(format!("frames/{index:06}.png"))).unwrap().to_rgba8()
}

/// The numbers on the pictures of the first `count` frames, and on those of the film.
fn numbers(directory: &Path, count: u64) -> [Vec<Option<u64>>; 2] {
    let bytes = fs::read(directory.join("film.mp4")).unwrap();
    let pictures = (0..count).map(|index| number(&picture(directory, index))).collect();
    [pictures, mp4::read(&bytes).decode().iter().map(|planes| number(&bt709(planes))).collect()]
}

fn in_order() -> Vec<Option<u64>> {
    (0..COUNT).map(Some).collect()
}

/// Pictures, list of frames and film.
fn files(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let names = (0..COUNT).map(|index| format!("frames/{index:06}.png"));
    let names = names.chain(["frames.json", "film.mp4"].map(str::to_owned));
    names.map(|name| (name.clone(), fs::read(directory.join(name)).unwrap())).collect()
}

#[test]
fn every_frame_is_drawn_stored_and_filmed_once_in_order_on_any_number_of_threads() {
    let source = Marked::new(SIZE, COUNT);
    let places = [1, 2, 5].map(|threads| {
        let place = tempfile::tempdir().unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| really(place.path(), None));
        assert_eq!(numbers(place.path(), COUNT), [in_order(), in_order()], "{threads} threads");
        place
    });
    for index in 0..COUNT {
        assert_eq!(picture(places[0].path(), index), on_cpu(&source.frame(index).unwrap()), "frame {index}");
    }
    let all = places.map(|place| files(place.path()));
    assert!(all[1] == all[0] && all[2] == all[0]);
}

#[test]
fn frames_that_were_deleted_come_back_to_their_places() {
    let place = tempfile::tempdir().unwrap();
    really(place.path(), None);
    let whole = files(place.path());
    for missing in ["frames/000000.png", "frames/000007.png", "frames/000008.png", "frames/000019.png", "film.mp4"] {
        fs::remove_file(place.path().join(missing)).unwrap();
    }
    let report = really(place.path(), None);
    assert_eq!((report.drawn, report.reused), (4, COUNT - 4));
    assert_eq!(numbers(place.path(), COUNT), [in_order(), in_order()]);
    assert!(files(place.path()) == whole);
}

#[test]
fn ranges_and_parts_drawn_in_any_sequence_make_the_film_in_order() {
    let whole = tempfile::tempdir().unwrap();
    really(whole.path(), None);
    let third = |k: u64| (k - 1) * COUNT / 3..k * COUNT / 3;
    for parts in [[5..12, 12..COUNT, 0..5], [third(2), third(3), third(1)]] {
        let place = tempfile::tempdir().unwrap();
        for (done, part) in parts.into_iter().enumerate() {
            let report = really(place.path(), Some(part.clone()));
            assert_eq!((report.drawn, report.reused), (part.end - part.start, 0));
            for index in part {
                assert_eq!(number(&picture(place.path(), index)), Some(index));
            }
            assert_eq!(report.film.is_some(), done == 2, "a film needs all its frames");
        }
        assert_eq!(numbers(place.path(), COUNT), [in_order(), in_order()]);
        assert!(files(place.path()) == files(whole.path()));
    }
}

/// Hands out the picture before the one it was asked for: one read too early from the device. The first is black.
struct Late {
    inner: Box<dyn Renderer>,
    before: RgbaImage,
}

impl Renderer for Late {
    fn info(&self) -> &AdapterInfo {
        self.inner.info()
    }

    fn draw(&mut self, list: &DrawList) -> Result<(RgbaImage, DrawTimes), RenderError> {
        let (image, times) = self.inner.draw(list)?;
        Ok((std::mem::replace(&mut self.before, image), times))
    }
}

/// Another frame in the place of some.
struct Wrong {
    frames: Marked,
    shown: fn(u64) -> u64,
}

impl FrameSource for Wrong {
    fn count(&self) -> u64 {
        self.frames.count()
    }

    fn frame(&self, index: u64) -> Result<DrawList, SourceError> {
        self.frames.frame((self.shown)(index))
    }
}

/// Negative controls: what goes wrong where pictures are read back too early, a frame is shown twice, or counting begins at 1.
#[test]
fn frames_that_are_late_repeated_or_shifted_are_found() {
    let cpu = || open(RendererChoice::Cpu).unwrap();
    let place = tempfile::tempdir().unwrap();
    let [width, height] = SIZE;
    let mut late = Late { inner: cpu(), before: RgbaImage::from_pixel(width, height, Rgba([0, 0, 0, 255])) };
    film(place.path(), None, &mut late, &Marked::new(SIZE, 5));
    let found = [None, Some(0), Some(1), Some(2), Some(3)].to_vec();
    assert_eq!(numbers(place.path(), 5), [found.clone(), found]);
    for (shown, found) in
        [((|index| index - index / 3) as fn(u64) -> u64, [0, 1, 2, 2, 3]), (|index| index + 1, [1, 2, 3, 4, 5])]
    {
        let place = tempfile::tempdir().unwrap();
        film(place.path(), None, cpu().as_mut(), &Wrong { frames: Marked::new(SIZE, 5), shown });
        let found = found.map(Some).to_vec();
        assert_eq!(numbers(place.path(), 5), [found.clone(), found]);
    }
}
