//! `gallery`: pictures and short loops of the built-in scenes of the rig and of one disk, as pages about the program show them.

use super::Verdict;
use super::common::print;
use super::draw_args::PictureArgs;
use super::film;
use super::motions;
use super::progress::Progress;
use super::shown::Shown;
use crate::film::{encode_small_png, gif, scaled};
use crate::render::Renderer;
use crate::scene::{BUILT_IN, BUILT_IN_DISKS, CameraMove, Case, Scene, Scheme};
use crate::stage::{Take, data_colours};
use crate::store::write_atomically;
use anyhow::{Context, ensure};
use clap::Args;
use std::path::{Path, PathBuf};

/// Width of pictures and loops in pixels, frames of a loop, and its frames per second.
const PICTURE: u32 = 960;
const LOOP: u32 = 400;
const LOOP_FRAMES: u64 = 40;
const LOOP_RATE: u32 = 12;
/// Part of the motion after which a picture is taken and a loop begins: the panels are full by then.
const PICTURE_AT: f64 = 0.62;
const LOOP_AT: f64 = 0.45;
/// A loop shows the motion slower than the film, for its few frames a second.
const LOOP_SPEED: f64 = 0.5;
/// Name of the picture of a coarse engine, and its steps per period.
const COARSE: &str = "coarse_engine";
const COARSE_STEPS: f64 = 256.0;
/// The disk of the gallery, width of its loop and its frames, which show one period of a wave: the loop has no seam.
const DISK: &str = "disk_forward_wave";
const DISK_LOOP: u32 = 360;
const DISK_LOOP_FRAMES: u32 = 18;

/// Pictures and short loops for pages about the program: of the built-in scenes of the two-mass rig and of one bladed disk, and the picture
/// of a coarse engine.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip gallery -o renders/gallery")]
pub struct GalleryArgs {
    /// Directory for NAME.png and NAME.gif (coarse_engine has no loop); files of these names are replaced.
    #[arg(short, long, value_name = "DIRECTORY", default_value = "renders/gallery")]
    output: PathBuf,
    /// What has this name alone.
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// No progress and no logs.
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    draw: PictureArgs,
}

pub fn run(args: &GalleryArgs) -> anyhow::Result<Verdict> {
    let progress = Progress::new(args.quiet);
    let wanted = |name: &str| args.only.as_deref().is_none_or(|only| only == name);
    let names: Vec<&str> = BUILT_IN.iter().map(|(name, _)| *name).chain([COARSE, DISK]).collect();
    ensure!(
        names.iter().copied().any(wanted),
        "--only {:?} is not in the gallery, which has {}",
        args.only.as_deref().unwrap_or_default(),
        names.join(", ")
    );
    let mut renderer = film::renderer(&args.draw, &progress)?;
    std::fs::create_dir_all(&args.output).with_context(|| format!("{} cannot be made", args.output.display()))?;
    for (name, text) in BUILT_IN.into_iter().filter(|(name, _)| wanted(name)) {
        let (_, case) = Scene::parse(text, name)?;
        let path = |extension: &str| args.output.join(format!("{name}.{extension}"));
        write(&path("png"), &picture(&case, args.draw.supersample, renderer.as_mut(), &progress)?)?;
        write(&path("gif"), &short_loop(&case, args.draw.supersample, renderer.as_mut(), &progress)?)?;
    }
    if wanted(COARSE) {
        let picture = picture(&coarse()?, args.draw.supersample, renderer.as_mut(), &progress)?;
        write(&args.output.join(format!("{COARSE}.png")), &picture)?;
    }
    for (name, text) in BUILT_IN_DISKS.into_iter().filter(|(name, _)| *name == DISK && wanted(name)) {
        let (_, case) = Scene::parse(text, name)?;
        let path = |extension: &str| args.output.join(format!("{name}.{extension}"));
        write(&path("png"), &picture(&case, args.draw.supersample, renderer.as_mut(), &progress)?)?;
        write(&path("gif"), &one_period(&case, args.draw.supersample, renderer.as_mut(), &progress)?)?;
    }
    Ok(Verdict::Done)
}

fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    write_atomically(path, |writer| writer.write_all(bytes))?;
    print(&path.display().to_string())
}

/// The case in the engine beside the exact solution, ready to be drawn.
fn stage(case: &Case, supersample: u32, progress: &Progress) -> anyhow::Result<Take> {
    let (start, sampling) = (motions::start(case)?, motions::film_sampling(case));
    let recording = motions::in_engine(case, &start, sampling)?;
    let exact = motions::exactly(case, &start, sampling)?;
    Shown::of_engine(case, &recording)?.beside(case, &exact)?.stage(case, supersample, progress)
}

/// The built-in scene in an engine that takes its velocities at face value, with coarse steps: what a fault of the engine looks like.
fn coarse() -> anyhow::Result<Case> {
    let (mut scene, _) = Scene::built_in()?;
    scene.title = "A coarse engine".to_owned();
    scene.caption =
        format!("Velocities at face value, {COARSE_STEPS} steps a period: white outlines are the exact solution.");
    scene.engine.scheme = Scheme::Plain;
    scene.engine.steps_per_period = COARSE_STEPS;
    Ok(scene.checked(COARSE)?)
}

fn picture(case: &Case, supersample: u32, renderer: &mut dyn Renderer, progress: &Progress) -> anyhow::Result<Vec<u8>> {
    let stage = stage(case, supersample, progress)?;
    let (image, _) = renderer.draw(&stage.frame((PICTURE_AT * stage.frame_count() as f64) as u64))?;
    encode_small_png(&scaled(&image, PICTURE)).context("the picture could not be encoded")
}

/// The rig alone: panels could not be read at this size.
fn short_loop(
    case: &Case,
    supersample: u32,
    renderer: &mut dyn Renderer,
    progress: &Progress,
) -> anyhow::Result<Vec<u8>> {
    let mut case = case.clone();
    case.direction.panels = Some(Vec::new());
    case.film.fps = LOOP_RATE;
    case.film.speed *= LOOP_SPEED;
    let stage = stage(&case, supersample, progress)?;
    let first = (LOOP_AT * stage.frame_count() as f64) as u64;
    let frames = (first..stage.frame_count().min(first + LOOP_FRAMES))
        .map(|index| Ok(scaled(&renderer.draw(&stage.frame(index))?.0, LOOP)))
        .collect::<anyhow::Result<Vec<_>>>()?;
    gif(&frames, (1, LOOP_RATE as u16), &data_colours()).context("the loop could not be encoded")
}

/// A disk alone for one period of its motion.
fn one_period(
    case: &Case,
    supersample: u32,
    renderer: &mut dyn Renderer,
    progress: &Progress,
) -> anyhow::Result<Vec<u8>> {
    let mut case = case.clone();
    case.direction.panels = Some(Vec::new());
    case.direction.camera = CameraMove::default();
    let Take::Disk(stage) = stage(&case, supersample, progress)? else {
        anyhow::bail!("{} is no disk", case.title);
    };
    let start = PICTURE_AT * stage.end();
    let time = |n: u32| start + stage.period() * f64::from(n) / f64::from(DISK_LOOP_FRAMES);
    let frames = (0..DISK_LOOP_FRAMES)
        .map(|n| Ok(scaled(&renderer.draw(&stage.frame_at(time(n)))?.0, DISK_LOOP)))
        .collect::<anyhow::Result<Vec<_>>>()?;
    gif(&frames, (1, LOOP_RATE as u16), &data_colours()).context("the loop could not be encoded")
}
