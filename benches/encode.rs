//! Frames per second of everything but drawing: PNG files, video, resuming.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use image::{Rgba, RgbaImage};
use serde_json::json;
use std::hint::black_box;
use stickslip::film::{FilmSettings, FrameSource, SourceError, Video, produce};
use stickslip::render::{AdapterInfo, Background, Camera, Colour, DrawList, DrawTimes, Light, RenderError, Renderer};
use stickslip::store::{Existing, Origin, OutputDir};
use tempfile::TempDir;

const FRAMES: u64 = 30;

struct Source([u32; 2]);

impl FrameSource for Source {
    fn count(&self) -> u64 {
        FRAMES
    }

    /// An empty scene; the eye says which frame it is.
    fn frame(&self, index: u64) -> Result<DrawList, SourceError> {
        let black = Colour::rgb(0);
        Ok(DrawList {
            size: self.0,
            background: Background { top: black, bottom: black },
            camera: Camera {
                eye: glam::Vec3::X * index as f32,
                target: glam::Vec3::ZERO,
                up: glam::Vec3::Y,
                vertical_field_of_view: 1.0,
                viewport: [0.0, 0.0, 1.0, 1.0],
            },
            light: Light {
                direction: glam::Vec3::Y,
                colour: black,
                intensity: 0.0,
                sky: black,
                ground: black,
                shadow_centre: glam::Vec3::ZERO,
                shadow_radius: 1.0,
            },
            objects: Vec::new(),
            overlay: Vec::new(),
        })
    }
}

/// Hands out pictures made beforehand: shaded balls that move over a gradient.
struct Prepared {
    info: AdapterInfo,
    pictures: Vec<RgbaImage>,
}

impl Prepared {
    fn new([width, height]: [u32; 2]) -> Self {
        let info = AdapterInfo { adapter: "prepared".into(), backend: "cpu".into(), reason: "benchmark".into() };
        let picture = |index: u64| {
            RgbaImage::from_fn(width, height, |x, y| {
                let (x, y) = (f64::from(x) / f64::from(height), f64::from(y) / f64::from(height));
                let shade = [0.0, 0.9].iter().find_map(|phase| {
                    let (dx, dy) = (x - 0.6 - phase - 0.2 * (0.2 * index as f64 + phase).sin(), y - 0.5);
                    let squared = (dx * dx + dy * dy) / 0.04;
                    (squared < 1.0).then(|| ((1.0 - squared).sqrt() - 0.5 * (dx + dy) / 0.2).clamp(0.05, 1.0))
                });
                let grey = shade.map_or(60.0 + 100.0 * y, |shade| 220.0 * shade);
                Rgba([grey as u8, (0.9 * grey) as u8, (0.7 * grey) as u8, 255])
            })
        };
        Self { info, pictures: (0..FRAMES).map(picture).collect() }
    }
}

impl Renderer for Prepared {
    fn info(&self) -> &AdapterInfo {
        &self.info
    }

    fn draw(&mut self, list: &DrawList) -> Result<(RgbaImage, DrawTimes), RenderError> {
        Ok((self.pictures[list.camera.eye.x as usize].clone(), DrawTimes::default()))
    }
}

fn open() -> (TempDir, OutputDir) {
    let place = tempfile::tempdir().expect("a temporary directory");
    let output = OutputDir::open(place.path(), &Origin::new("bench", json!({})), Existing::Resume).expect("a new one");
    (place, output)
}

fn films(criterion: &mut Criterion) {
    for size in [[1280, 720], [1920, 1080]] {
        let (mut renderer, source) = (Prepared::new(size), Source(size));
        let mut group = criterion.benchmark_group(format!("film {}x{}", size[0], size[1]));
        group.throughput(Throughput::Elements(FRAMES)).sample_size(10);
        for (name, video) in [("frames", Video::None), ("frames and film", Video::Whole)] {
            let settings = FilmSettings { size, video, ..FilmSettings::default() };
            let mut make = |(place, output): (TempDir, OutputDir)| {
                black_box(produce(&settings, &output, &mut renderer, &source, &mut |_| ()).expect("a film"));
                (place, output)
            };
            group.bench_function(name, |bencher| bencher.iter_batched(open, &mut make, BatchSize::PerIteration));
        }
        let settings = FilmSettings { size, ..FilmSettings::default() };
        let (_place, output) = open();
        let report = produce(&settings, &output, &mut renderer, &source, &mut |_| ()).expect("a film");
        eprintln!("{:?}", report.times);
        group.bench_function("nothing to do", |bencher| {
            bencher.iter(|| produce(&settings, &output, &mut renderer, &source, &mut |_| ()).expect("a film"));
        });
        group.finish();
    }
}

criterion_group!(benches, films);
criterion_main!(benches);
