//! Making a film of a motion: shared by `run` and `render`.

use super::progress::Progress;
use crate::dynamics::Trajectory;
use crate::engine::{BodyPose, BodyRole, Recording, RigGeometry};
use crate::film::{self, FilmReport, FilmSettings, FrameSource, SourceError, Video};
use crate::render::{AdapterInfo, DrawList, RendererChoice};
use crate::scene::Case;
use crate::stage::{Beside, Body, Motion, Stage};
use crate::store::OutputDir;
use anyhow::{Context, ensure};
use clap::{Args, ValueEnum};
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
}

fn parse_frames(text: &str) -> Result<Range<u64>, String> {
    match text.split_once(':').map(|(a, b)| (a.parse(), b.parse())) {
        Some((Ok(a), Ok(b))) if a < b => Ok(a..b),
        _ => Err("give two whole numbers A:B from 0, A smaller than B".to_owned()),
    }
}

impl DrawArgs {
    /// Refuses frames beyond a film of `count`. Asked once before anything is written, and again of the motion, which may have ended
    /// early.
    pub fn check(&self, count: u64) -> anyhow::Result<()> {
        let Some(Range { start, end }) = self.frames else { return Ok(()) };
        ensure!(end <= count, "--frames {start}:{end} is beyond the film: it has {count} frames");
        Ok(())
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
        }
    }
}

struct Source(Stage);

impl FrameSource for Source {
    fn count(&self) -> u64 {
        self.0.frame_count()
    }

    fn frame(&self, index: u64) -> Result<DrawList, SourceError> {
        Ok(self.0.frame(index))
    }
}

/// A film and who drew it.
pub struct Made {
    pub report: FilmReport,
    pub adapter: AdapterInfo,
}

/// The motion to film, and the exact one beside it.
pub struct Shown {
    motion: Motion,
    reference: Option<Motion>,
}

const NOT_THE_RIG: &str = "the motion is not one of two masses and one slider";

impl Shown {
    /// A motion without bodies.
    pub fn of(trajectory: &Trajectory) -> anyhow::Result<Self> {
        Ok(Self { motion: Motion::new(trajectory).context(NOT_THE_RIG)?, reference: None })
    }

    /// The engine's motion with its own bodies.
    pub fn of_engine(recording: &Recording) -> anyhow::Result<Self> {
        let bodies: Option<Vec<_>> = recording.poses.iter().map(|poses| carriages(poses)).collect();
        let motion = Motion::new(&recording.trajectory).zip(bodies).and_then(|(motion, b)| motion.with_bodies(&b));
        Ok(Self { motion: motion.context(NOT_THE_RIG)?, reference: None })
    }

    pub fn beside(self, exact: &Trajectory) -> Self {
        Self { reference: Motion::new(exact), ..self }
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

/// Draws the frames that are missing and makes the film.
pub fn make(
    case: &Case,
    shown: Shown,
    args: &DrawArgs,
    output: &OutputDir,
    progress: &mut Progress,
) -> anyhow::Result<Made> {
    let map = super::damping_map::of(case, progress)?;
    let source = Source(Stage::new(case.clone(), shown.motion, Beside { exact: shown.reference, map }));
    args.check(source.count())?;
    let mut renderer = crate::render::open(args.renderer.choice())?;
    let adapter = renderer.info().clone();
    progress.say(&format!("renderer: {} ({}): {}", adapter.adapter, adapter.backend, adapter.reason));
    let settings = FilmSettings {
        size: [case.film.width, case.film.height],
        frames_per_second: case.film.fps,
        frames: args.frames.clone(),
        video: if args.frames.is_some() { Video::None } else { Video::Whole },
        ..FilmSettings::default()
    };
    let report = film::produce(&settings, output, renderer.as_mut(), &source, &mut |at| progress.frame(at))?;
    progress.say(&summary(&report));
    Ok(Made { report, adapter })
}

/// How long what took, for people.
fn summary(report: &FilmReport) -> String {
    let t = &report.times;
    let per_frame = |time: std::time::Duration| time.as_secs_f64() * 1e3 / report.drawn.max(1) as f64;
    format!(
        "film: {} frames, {} drawn, {} reused, {:.1} s; ms per drawn frame: list {:.1}, draw {:.1}, read back {:.1}, overlay {:.1}, \
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
