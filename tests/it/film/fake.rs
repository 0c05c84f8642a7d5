//! Frames that carry their index as a row of black and white blocks, and a renderer that fills boxes.

use glam::{Vec2, Vec3};
use image::{Rgba, RgbaImage};
use serde_json::json;
use std::path::Path;
use std::time::Duration;
use stickslip::film::{FilmError, FilmReport, FilmSettings, FrameSource, Progress, SourceError, produce};
use stickslip::render::{
    AdapterInfo, Background, Camera, Colour, DrawList, DrawTimes, Light, OverlayItem, Rectangle, RenderError, Renderer,
};
use stickslip::store::{Existing, Origin, OutputDir};

pub const SIZE: [u32; 2] = [64, 48];
/// Side of a block of the marker and of the moving square.
const BLOCK: u32 = 8;
/// Bits of the marker; fewer where the picture is narrow.
const BITS: u32 = 16;
/// Pictures from this width on are full of noise, another in each frame, which costs the video encoder many bits.
const NOISY_WIDTH: u32 = 320;

/// Where the film is broken off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    Never,
    SourceErrorAt(u64),
    RenderErrorAt(u64),
    PanicAt(u64),
}

pub struct FakeSource {
    pub count: u64,
    pub size: [u32; 2],
    pub stop: Stop,
}

impl FrameSource for FakeSource {
    fn count(&self) -> u64 {
        self.count
    }

    fn frame(&self, index: u64) -> Result<DrawList, SourceError> {
        if self.stop == Stop::SourceErrorAt(index) {
            return Err("no such state".into());
        }
        Ok(frame(self.size, index))
    }
}

/// The index in the top row, lowest bit left; below it a coloured square that moves two pixels a frame.
fn frame(size: [u32; 2], index: u64) -> DrawList {
    let block = |x: u32, y: u32, fill| OverlayItem::Box {
        area: Rectangle { min: Vec2::new(x as f32, y as f32), max: Vec2::new((x + BLOCK) as f32, (y + BLOCK) as f32) },
        corner_radius: 0.0,
        fill,
        stroke: None,
    };
    let bits = (0..BITS.min(size[0] / BLOCK)).map(|bit| {
        let is_set = index >> bit & 1 == 1;
        block(bit * BLOCK, 0, Colour::rgb(if is_set { 0xff_ff_ff } else { 0 }))
    });
    let left = 2 * (index as u32) % (size[0] - BLOCK);
    let square = block(left, 24, Colour::rgb(0xd0_40_20));
    let light = Light {
        direction: Vec3::Y,
        colour: Colour::rgb(0),
        intensity: 0.0,
        sky: Colour::rgb(0),
        ground: Colour::rgb(0),
        shadow_centre: Vec3::ZERO,
        shadow_radius: 1.0,
    };
    let camera = Camera {
        eye: Vec3::new(index as f32, 0.0, 1.0),
        target: Vec3::ZERO,
        up: Vec3::Y,
        vertical_field_of_view: 1.0,
        viewport: [0.0, 0.0, 1.0, 1.0],
    };
    DrawList {
        size,
        background: Background { top: Colour::rgb(0x30_60_a0), bottom: Colour::rgb(0x90_a0_80) },
        camera,
        light,
        objects: Vec::new(),
        overlay: bits.chain([square]).collect(),
    }
}

/// The index a picture says it has.
pub fn index_of(picture: &RgbaImage) -> u64 {
    let bits = (0..BITS.min(picture.width() / BLOCK)).map(|bit| {
        let pixel = picture.get_pixel(bit * BLOCK + BLOCK / 2, BLOCK / 2).0;
        u64::from(pixel[1] > 127) << bit
    });
    bits.sum()
}

/// What the fake renderer makes of a frame.
pub fn picture(size: [u32; 2], index: u64) -> RgbaImage {
    paint(&frame(size, index))
}

fn paint(list: &DrawList) -> RgbaImage {
    let [width, height] = list.size;
    let mut noise = list.camera.eye.x as u32;
    let mut image = RgbaImage::from_fn(width, height, |_, y| {
        // The generator of Numerical Recipes; its high bits are random enough here.
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let grain = if width >= NOISY_WIDTH { (noise >> 27) as u8 } else { 0 };
        let mix = |from: u8, to: u8| (u32::from(from) * (height - y) + u32::from(to) * y) / height;
        let (top, bottom) = (list.background.top.0, list.background.bottom.0);
        let [r, g, b] = [0, 1, 2].map(|i| mix(top[i], bottom[i]) as u8 + grain);
        Rgba([r, g, b, 255])
    });
    for item in &list.overlay {
        let OverlayItem::Box { area, fill, .. } = item else { continue };
        for y in area.min.y as u32..(area.max.y as u32).min(height) {
            for x in area.min.x as u32..(area.max.x as u32).min(width) {
                image.put_pixel(x, y, Rgba(fill.0));
            }
        }
    }
    image
}

pub struct FakeRenderer {
    info: AdapterInfo,
    stop: Stop,
    pub delay: Duration,
    /// Indices drawn, in order.
    pub drawn: Vec<u64>,
}

impl FakeRenderer {
    pub fn new(stop: Stop) -> Self {
        let info = AdapterInfo { adapter: "fake".to_owned(), backend: "cpu".to_owned(), reason: "test".to_owned() };
        Self { info, stop, delay: Duration::ZERO, drawn: Vec::new() }
    }

    pub fn called(mut self, adapter: &str) -> Self {
        self.info.adapter = adapter.to_owned();
        self
    }
}

impl Renderer for FakeRenderer {
    fn info(&self) -> &AdapterInfo {
        &self.info
    }

    fn draw(&mut self, list: &DrawList) -> Result<(RgbaImage, DrawTimes), RenderError> {
        std::thread::sleep(self.delay);
        let image = paint(list);
        let index = index_of(&image);
        assert!(self.stop != Stop::PanicAt(index), "the renderer was told to panic");
        if self.stop == Stop::RenderErrorAt(index) {
            return Err(RenderError::Device { doing: "drawing", reason: "it was told to fail".to_owned() });
        }
        self.drawn.push(index);
        let times = DrawTimes { draw: Duration::from_micros(1), ..DrawTimes::default() };
        Ok((image, times))
    }
}

pub fn settings() -> FilmSettings {
    FilmSettings { size: SIZE, frames_per_second: 25, ..FilmSettings::default() }
}

pub fn origin() -> Origin {
    Origin::new("render", json!({"xi1": -0.02}))
}

/// A run into `directory`: the report and the indices drawn.
pub fn run(
    directory: &Path,
    settings: &FilmSettings,
    count: u64,
    stop: Stop,
) -> (Result<FilmReport, FilmError>, Vec<u64>) {
    let output = OutputDir::open(directory, &origin(), Existing::Resume).unwrap();
    let source = FakeSource { count, size: settings.size, stop };
    let mut renderer = FakeRenderer::new(stop);
    let report = produce(settings, &output, &mut renderer, &source, &mut |_: Progress| ());
    (report, renderer.drawn)
}

/// A run that must succeed.
pub fn finish(directory: &Path, settings: &FilmSettings, count: u64) -> (FilmReport, Vec<u64>) {
    let (report, drawn) = run(directory, settings, count, Stop::Never);
    (report.unwrap(), drawn)
}
