//! Making a film of a motion: shared by `run` and `render`.

use super::motions;
use super::progress::Progress;
use crate::dynamics::Trajectory;
use crate::engine::{BodyPose, BodyRole, EngineInfo, Recording, RigGeometry};
use crate::film::{self, Encoder, Ffmpeg, FilmReport, FilmSettings, FrameSource, FrameState, SourceError, Video};
use crate::render::{AdapterInfo, Colour, DrawList, OverlayItem, Rectangle, Renderer, RendererChoice};
use crate::scene::{Backdrop, Case, Film};
use crate::stage::{Beside, Body, DiskMotion, DiskStage, Motion, Solution, Stage, Take};
use crate::store::{OutputDir, sha256_hex};
use anyhow::{Context, ensure};
use clap::{Args, ValueEnum};
use glam::Vec2;
use serde_json::{Value, json};
use std::ops::Range;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum RendererName {
    /// A hardware adapter if there is one, otherwise the CPU rasteriser.
    Auto,
    /// The built-in CPU rasteriser.
    Cpu,
    /// A hardware adapter, Vulkan or GL (Metal, Direct3D).
    Gpu,
    /// A hardware adapter through Vulkan.
    Vulkan,
    /// A hardware adapter through OpenGL.
    Gl,
    /// A graphics driver that draws in software, such as lavapipe or llvmpipe.
    Software,
    /// The same, through Vulkan.
    SoftwareVulkan,
    /// The same, through OpenGL.
    SoftwareGl,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum EncoderName {
    /// The built-in one.
    Openh264,
    /// An installed ffmpeg with libx264: slower, and smaller files.
    Ffmpeg,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Drawing")]
pub struct DrawArgs {
    /// What draws the frames.
    #[arg(long, value_enum, default_value_t = RendererName::Auto)]
    pub renderer: RendererName,
    /// Draw the frames from A up to, not including, B only, and no film.
    #[arg(long, value_name = "A:B", value_parser = parse_frames)]
    pub frames: Option<Range<u64>>,
    /// Draw the Kth of N equal parts of the frames only, and no film; for many machines that share a directory, or whose directories are
    /// put together: all frames in one, and its outputs.jsonl followed by the others'.
    #[arg(long, value_name = "K/N", value_parser = parse_shard, conflicts_with = "frames")]
    pub shard: Option<[u64; 2]>,
    /// Draw frames this many times as wide and high and make them smaller: smoother edges for as much more time, squared.
    #[arg(long, value_name = "FACTOR", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub supersample: u32,
    /// What makes film.mp4 of the frames.
    #[arg(long, value_enum, default_value_t = EncoderName::Openh264)]
    pub encoder: EncoderName,
}

/// `A:B`
pub fn parse_frames(text: &str) -> Result<Range<u64>, String> {
    match text.split_once(':').map(|(a, b)| (a.parse(), b.parse())) {
        Some((Ok(a), Ok(b))) if a < b => Ok(a..b),
        _ => Err("give two whole numbers A:B from 0, A smaller than B".to_owned()),
    }
}

/// `K/N`
fn parse_shard(text: &str) -> Result<[u64; 2], String> {
    match text.split_once('/').map(|(k, n)| (k.parse(), n.parse())) {
        Some((Ok(k), Ok(n))) if 1 <= k && k <= n => Ok([k, n]),
        _ => Err("give two whole numbers K/N, K from 1 to N".to_owned()),
    }
}

impl DrawArgs {
    /// The frames to draw of a film of `count`; `None` for all.
    fn selected(&self, count: u64) -> Option<Range<u64>> {
        let part = |[k, n]: [u64; 2]| (k - 1) * count / n..k * count / n;
        self.frames.clone().or(self.shard.map(part))
    }

    /// Refuses frames beyond a film that has at most `most`, before anything is computed; the motion may end early. Refuses an encoder
    /// that is not there.
    pub fn check(&self, most: u64) -> anyhow::Result<()> {
        self.encoder()?;
        self.check_frames(most, &format!("it has at most {most} frames"))
    }

    /// The same of the film, its motion known. What was within the most frames it might have is beyond them only where it ended early.
    fn check_of(&self, count: u64) -> anyhow::Result<()> {
        self.check_frames(count, &format!("its motion ended early and left it {count} frames"))
    }

    fn check_frames(&self, count: u64, film: &str) -> anyhow::Result<()> {
        if let Some([k, n]) = self.shard {
            ensure!(n <= count, "--shard {k}/{n} is too small a part of the film: {film}");
        }
        if let Some(Range { start, end }) = self.frames {
            ensure!(end <= count, "--frames {start}:{end} is beyond the film: {film}");
        }
        Ok(())
    }
}

impl DrawArgs {
    fn encoder(&self) -> anyhow::Result<Encoder> {
        Ok(match self.encoder {
            EncoderName::Openh264 => Encoder::OpenH264,
            EncoderName::Ffmpeg => Encoder::Ffmpeg(Ffmpeg::find()?),
        })
    }
}

impl RendererName {
    fn choice(self) -> RendererChoice {
        match self {
            Self::Auto => RendererChoice::Auto,
            Self::Cpu => RendererChoice::Cpu,
            Self::Gpu => RendererChoice::Gpu,
            Self::Vulkan => RendererChoice::Vulkan,
            Self::Gl => RendererChoice::Gl,
            Self::Software => RendererChoice::Software,
            Self::SoftwareVulkan => RendererChoice::SoftwareVulkan,
            Self::SoftwareGl => RendererChoice::SoftwareGl,
        }
    }
}

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

/// The motion to film, what computed it, and the exact one beside it.
pub struct Shown {
    motion: ShownMotion,
    solution: Solution,
}

enum ShownMotion {
    Rig { motion: Motion, reference: Option<Motion> },
    Disk { motion: DiskMotion, reference: Option<DiskMotion> },
}

const NOT_THE_RIG: &str = "the motion is not one of two masses and one slider";
const NOT_THE_DISK: &str = "the motion is not one of the scene's disk";

impl ShownMotion {
    fn of(case: &Case, trajectory: &Trajectory) -> anyhow::Result<Self> {
        if let Some(disk) = &case.disk {
            let motion = DiskMotion::new(&disk.disk, trajectory)?.context(NOT_THE_DISK)?;
            return Ok(Self::Disk { motion, reference: None });
        }
        Ok(Self::Rig { motion: Motion::new(trajectory).context(NOT_THE_RIG)?, reference: None })
    }

    /// With the rig's own bodies.
    fn of_engine(case: &Case, recording: &Recording) -> anyhow::Result<Self> {
        if case.disk.is_some() {
            return Self::of(case, &recording.trajectory);
        }
        let bodies: Option<Vec<_>> = recording.poses.iter().map(|poses| carriages(poses)).collect();
        let motion = Motion::new(&recording.trajectory).zip(bodies).and_then(|(motion, b)| motion.with_bodies(&b));
        Ok(Self::Rig { motion: motion.context(NOT_THE_RIG)?, reference: None })
    }

    fn beside(self, exact: Self) -> Self {
        match (self, exact) {
            (Self::Rig { motion, .. }, Self::Rig { motion: exact, .. }) => Self::Rig { motion, reference: Some(exact) },
            (Self::Disk { motion, .. }, Self::Disk { motion: exact, .. }) => {
                Self::Disk { motion, reference: Some(exact) }
            }
            (shown, _) => shown,
        }
    }
}

impl Shown {
    /// A motion without bodies.
    pub fn of(case: &Case, trajectory: &Trajectory, solution: Solution) -> anyhow::Result<Self> {
        Ok(Self { motion: ShownMotion::of(case, trajectory)?, solution })
    }

    /// The engine's motion, that of the rig with its own bodies.
    pub fn of_engine(case: &Case, recording: &Recording) -> anyhow::Result<Self> {
        let solution = Solution::Engine(EngineInfo::of(motions::precision(case)).to_string());
        Ok(Self { motion: ShownMotion::of_engine(case, recording)?, solution })
    }

    pub fn beside(self, case: &Case, exact: &Trajectory) -> anyhow::Result<Self> {
        Ok(Self { motion: self.motion.beside(ShownMotion::of(case, exact)?), ..self })
    }
}

/// The two carriages of the engine's world, seen from their rest poses.
fn carriages(poses: &[BodyPose]) -> Option<[Body; 2]> {
    let geometry = RigGeometry::default();
    let carriage = |index: usize| {
        let pose = poses.iter().find(|pose| pose.role == BodyRole::Carriage(index))?;
        let rest = geometry.rest_position(index);
        Some(Body {
            displacement: std::array::from_fn(|axis| pose.translation[axis] - rest[axis]),
            rotation: pose.rotation,
            half_extents: pose.half_extents,
        })
    };
    Some([carriage(0)?, carriage(1)?])
}

/// A case with its motion, ready to be drawn `supersample` times as large as its film.
pub fn stage(case: &Case, shown: Shown, supersample: u32, progress: &Progress) -> anyhow::Result<Take> {
    let mut case = case.clone();
    case.film.width *= supersample;
    case.film.height *= supersample;
    let solution = shown.solution;
    match shown.motion {
        ShownMotion::Rig { motion, reference } => {
            let map = super::damping_map::of(&case, progress)?;
            let beside = Beside { exact: reference, map, solution: Some(solution) };
            Ok(Take::Rig(Box::new(Stage::new(case, motion, beside))))
        }
        ShownMotion::Disk { motion, reference } => {
            let stage = DiskStage::new(case, motion, reference).context("the scene has no disk")?;
            Ok(Take::Disk(Box::new(stage.computed_by(solution))))
        }
    }
}

/// Opens what draws, and says which it is.
pub fn renderer(args: &DrawArgs, progress: &Progress) -> anyhow::Result<Box<dyn Renderer>> {
    let renderer = crate::render::open(args.renderer.choice())?;
    let adapter = renderer.info();
    progress.say(&format!("renderer: {} ({}): {}", adapter.adapter, adapter.backend, adapter.reason));
    Ok(renderer)
}

/// Draws the frames of the stages that are missing, one stage after the other, and makes the film.
pub fn make(
    stages: Vec<Take>,
    film: &Film,
    args: &DrawArgs,
    output: &OutputDir,
    progress: &mut Progress,
) -> anyhow::Result<Made> {
    let fade = (FADE * f64::from(film.fps)).ceil() as u64;
    let source = Source { stages, size: [film.width, film.height].map(|side| side * args.supersample), fade };
    args.check_of(source.count())?;
    let selected = args.selected(source.count());
    let mut renderer = renderer(args, progress)?;
    let adapter = renderer.info().clone();
    let is_clear = film.background == Backdrop::Transparent;
    if is_clear {
        progress.say("transparent background: frames with alpha and no film, for H.264 has no alpha");
    }
    let video = if selected.is_some() || is_clear { Video::None } else { Video::Whole };
    if video == Video::Whole && (film.width % 2 == 1 || film.height % 2 == 1) {
        progress.say("film: H.264 needs even sides, so film.mp4 repeats the last column or row of the frames");
    }
    let settings = FilmSettings {
        size: [film.width, film.height],
        frames_per_second: film.fps,
        supersampling: args.supersample,
        frames: selected.clone(),
        video,
        encoder: args.encoder()?,
        ..FilmSettings::default()
    };
    let report = film::produce(&settings, output, renderer.as_mut(), &source, &mut |at| progress.frame(at))?;
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
