//! Making a film of a motion: shared by `run` and `render`.

use super::draw_args::{DrawArgs, PictureArgs};
use super::progress::Progress;
use crate::film::{self, FilmReport, FilmSettings, FrameSource, FrameState, SourceError, Video};
use crate::render::{AdapterInfo, Colour, DrawList, OverlayItem, Rectangle, Renderer};
use crate::scene::{Backdrop, Film};
use crate::stage::Take;
use crate::store::{OutputDir, sha256_hex};
use glam::Vec2;
use serde_json::{Value, json};
use std::ops::Range;

/// Time in which one scene of a story fades out, and the next one in: seconds of film.
const FADE: f64 = 0.3;

/// The stages of a film, one after the other.
struct Source {
    stages: Vec<Take>,
    size: [u32; 2],
    /// Frames of a fade.
    fade: u64,
}

impl Source {
    /// The stage of a frame of the film, and the frame's number in it.
    fn locate(&self, index: u64) -> Option<(&Take, u64)> {
        let mut first = 0;
        self.stages.iter().find_map(|stage| {
            let number = index.checked_sub(first)?;
            first += stage.frame_count();
            (index < first).then_some((stage, number))
        })
    }

    /// How dark a frame is beside a cut, 0 to 1, and at the end of a story, whose last frame is black. No frame beside a cut is: two
    /// black ones would stand still. A film of one stage has no cut.
    fn darkness(&self, stage: &Take, number: u64, index: u64) -> f32 {
        let (whole, to_end) = (self.fade + 1, stage.frame_count() - 1 - number);
        let is_last = index + to_end + 1 == self.count();
        let before = if index == number { whole } else { number + 1 };
        let after = match (is_last, self.stages.len()) {
            (true, 1) => whole,
            (true, _) => to_end,
            (false, _) => to_end + 1,
        };
        1.0 - before.min(after).min(whole) as f32 / whole as f32
    }
}

impl FrameSource for Source {
    fn count(&self) -> u64 {
        self.stages.iter().map(Take::frame_count).sum()
    }

    fn frame(&self, index: u64) -> Result<DrawList, SourceError> {
        let (stage, number) = self.locate(index).ok_or("the film has fewer frames")?;
        let mut list = stage.frame(number);
        let darkness = self.darkness(stage, number, index);
        // Before nothing there is nothing to fade to: scenes are cut.
        if darkness > 0.0 && !list.background.is_transparent() {
            let [width, height] = self.size.map(|side| side as f32);
            list.overlay.push(OverlayItem::Box {
                area: Rectangle { min: Vec2::ZERO, max: Vec2::new(width, height) },
                corner_radius: 0.0,
                fill: Colour::rgb(0).with_alpha(darkness),
                stroke: None,
            });
        }
        Ok(list)
    }

    fn state(&self, index: u64) -> Option<FrameState> {
        let (stage, number) = self.locate(index)?;
        let numbers = stage.numbers(number);
        let bytes: Vec<u8> = numbers.iter().copied().flat_map(f64::to_le_bytes).collect();
        Some(FrameState { time: *numbers.first()?, sha256: sha256_hex(&bytes) })
    }
}

/// A film and who drew it.
pub struct Made {
    pub report: FilmReport,
    pub adapter: AdapterInfo,
}

/// Opens what draws, and says which it is.
pub fn renderer(args: &PictureArgs, progress: &Progress) -> anyhow::Result<Box<dyn Renderer>> {
    let renderer = crate::render::open(args.renderer)?;
    let adapter = renderer.info();
    progress.say(&format!("renderer: {} ({}): {}", adapter.adapter, adapter.backend, adapter.reason));
    Ok(renderer)
}

/// Names of the files of a film of `count` frames, or of the part of it that is asked for.
pub fn file_names(film: &Film, args: &DrawArgs, count: u64) -> Vec<String> {
    let selected = args.selected(count);
    let with_film = video(film, selected.as_ref()) == Video::Whole;
    film::file_names(selected.unwrap_or(0..count), with_film)
}

/// A film of all frames that are not clear.
fn video(film: &Film, selected: Option<&Range<u64>>) -> Video {
    if selected.is_some() || film.background == Backdrop::Transparent { Video::None } else { Video::Whole }
}

/// Draws the frames of the stages that are missing, one stage after the other, and makes the film.
pub fn make(
    stages: Vec<Take>,
    film: &Film,
    args: &DrawArgs,
    output: &OutputDir,
    renderer: &mut dyn Renderer,
    progress: &mut Progress,
) -> anyhow::Result<Made> {
    let fade = (FADE * f64::from(film.fps)).ceil() as u64;
    let source = Source { stages, size: [film.width, film.height].map(|side| side * args.picture.supersample), fade };
    args.check_of(source.count())?;
    let selected = args.selected(source.count());
    let adapter = renderer.info().clone();
    if film.background == Backdrop::Transparent {
        progress.say("transparent background: frames with alpha and no film, for H.264 has no alpha");
    }
    let video = video(film, selected.as_ref());
    if video == Video::Whole && (film.width % 2 == 1 || film.height % 2 == 1) {
        progress.say("film: H.264 needs even sides, so film.mp4 repeats the last column or row of the frames");
    }
    let settings = FilmSettings {
        size: [film.width, film.height],
        frames_per_second: film.fps,
        supersampling: args.picture.supersample,
        frames: selected.clone(),
        video,
        encoder: args.encoder()?,
        ..FilmSettings::default()
    };
    let report = film::produce(&settings, output, renderer, &source, &mut |at| progress.frame(at))?;
    progress.say(&summary(&report, selected.map(|part| (part, source.count()))));
    Ok(Made { report, adapter })
}

/// How long what took, for people; `part` are the frames drawn of how many, where they were not all.
fn summary(report: &FilmReport, part: Option<(Range<u64>, u64)>) -> String {
    let t = &report.times;
    let of = part.map_or_else(String::new, |(part, all)| format!(" ({}:{} of {all})", part.start, part.end));
    let per_frame = |time: std::time::Duration| time.as_secs_f64() * 1e3 / report.drawn.max(1) as f64;
    format!(
        "film: {} frames{of}, {} drawn, {} reused, {:.1} s; ms per drawn frame: list {:.1}, draw {:.1}, read back {:.1}, overlay {:.1}, \
         png {:.1}, video {:.1}",
        report.frames,
        report.drawn,
        report.reused,
        report.wall.as_secs_f64(),
        per_frame(t.scene),
        per_frame(t.draw),
        per_frame(t.read_back),
        per_frame(t.overlay),
        per_frame(t.encode_png),
        per_frame(t.encode_video),
    )
}

impl Made {
    /// The field `frames` of the JSON documents.
    pub fn frames_json(&self) -> Value {
        let report = &self.report;
        json!({
            "count": report.frames, "drawn": report.drawn, "reused": report.reused,
            "width": report.width, "height": report.height, "fps": report.frames_per_second,
            "adapter": self.adapter.adapter, "backend": self.adapter.backend, "reason": self.adapter.reason,
        })
    }
}
