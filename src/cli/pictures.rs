//! `contact-sheet` and `animate`: pictures of a film that is there already, and short loops of it.

use super::Verdict;
use super::common::{print, refuse_existing};
use super::draw_args::parse_frames;
use crate::film::{animated_png, contact_sheet, encode_png, gif, scaled};
use crate::render::has_transparency;
use crate::stage::data_colours;
use crate::store::{read_whole, write_atomically};
use anyhow::{Context, bail, ensure};
use clap::Args;
use image::RgbaImage;
use serde_json::Value;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// One picture of several frames of a film, evenly from its first to its last.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip contact-sheet renders/limit_torus -o torus.png")]
pub struct ContactSheetArgs {
    /// Directory that `run` or `render` wrote.
    directory: PathBuf,
    /// Number of frames.
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=400))]
    count: u32,
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=20))]
    columns: u32,
    /// Width of each frame in pixels.
    #[arg(long, default_value_t = 480, value_parser = clap::value_parser!(u32).range(16..=3840))]
    width: u32,
    /// PNG file; without it contact-sheet.png in the directory, made anew each time.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file of -o.
    #[arg(long)]
    force: bool,
}

/// A short loop of a film as GIF or animated PNG.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  stickslip animate renders/limit_torus --frames 0:120 --every 2 --width 480 -o torus.gif"
)]
pub struct AnimateArgs {
    /// Directory that `run` or `render` wrote.
    directory: PathBuf,
    /// The frames from A up to, not including, B; all without it.
    #[arg(long, value_name = "A:B", value_parser = parse_frames)]
    frames: Option<Range<u64>>,
    /// Every so many frames only.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u16).range(1..=100))]
    every: u16,
    /// Width in pixels.
    #[arg(long, default_value_t = 480, value_parser = clap::value_parser!(u32).range(16..=3840))]
    width: u32,
    /// File, .gif or .png.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Replace the file of -o.
    #[arg(long)]
    force: bool,
}

/// A film on disk, as its manifest says.
struct Finished {
    directory: PathBuf,
    frames: Vec<String>,
    frames_per_second: u16,
}

impl Finished {
    fn open(directory: &Path) -> anyhow::Result<Self> {
        let path = directory.join("frames.json");
        let fault =
            || format!("{} is no manifest of a film: name a directory that `run` or `render` wrote", path.display());
        let manifest: Value = serde_json::from_slice(&read_whole(&path).with_context(fault)?).with_context(fault)?;
        let list = manifest["frames"].as_array().with_context(fault)?;
        let frames: Option<Vec<String>> = list.iter().map(|frame| Some(frame["file"].as_str()?.to_owned())).collect();
        let rate = manifest["frames_per_second"].as_u64().and_then(|rate| u16::try_from(rate).ok());
        let (frames, frames_per_second) = frames.zip(rate).with_context(fault)?;
        ensure!(!frames.is_empty(), "the film in {} has no frames yet", directory.display());
        Ok(Self { directory: directory.to_owned(), frames, frames_per_second })
    }

    fn picture(&self, number: usize, width: u32) -> anyhow::Result<RgbaImage> {
        let path = self.directory.join(&self.frames[number]);
        let picture = image::open(&path).with_context(|| format!("{} cannot be read", path.display()))?;
        Ok(scaled(&picture.into_rgba8(), width))
    }
}

fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<Verdict> {
    write_atomically(path, |writer| writer.write_all(bytes))?;
    print(&path.display().to_string())?;
    Ok(Verdict::Done)
}

pub fn sheet(args: &ContactSheetArgs) -> anyhow::Result<Verdict> {
    let film = Finished::open(&args.directory)?;
    args.output.iter().try_for_each(|path| refuse_existing(path, args.force))?;
    let (last, count) = (film.frames.len() - 1, (args.count as usize).min(film.frames.len()));
    let number = |n: usize| if count == 1 { 0 } else { n * last / (count - 1) };
    let pictures: Vec<_> = (0..count).map(|n| film.picture(number(n), args.width)).collect::<anyhow::Result<_>>()?;
    let bytes = encode_png(&contact_sheet(&pictures, args.columns)).context("the picture could not be encoded")?;
    write(&args.output.clone().unwrap_or_else(|| args.directory.join("contact-sheet.png")), &bytes)
}

pub fn animate(args: &AnimateArgs) -> anyhow::Result<Verdict> {
    let film = Finished::open(&args.directory)?;
    let count = film.frames.len();
    let Range { start, end } = args.frames.clone().unwrap_or(0..count as u64);
    ensure!(end <= count as u64, "--frames {start}:{end} is beyond the film: {count} frames are there");
    refuse_existing(&args.output, args.force)?;
    let numbers = (start as usize..end as usize).step_by(usize::from(args.every));
    let frames: Vec<_> = numbers.map(|n| film.picture(n, args.width)).collect::<anyhow::Result<_>>()?;
    let delay = (args.every, film.frames_per_second);
    let extension = args.output.extension().map(|extension| extension.to_ascii_lowercase());
    let bytes = match extension.as_ref().and_then(|extension| extension.to_str()) {
        Some("gif") if frames.iter().any(has_transparency) => {
            bail!("the frames are translucent, which GIF cannot show: end the name of the loop in .png")
        }
        Some("gif") => gif(&frames, delay, &data_colours()).context("the loop could not be encoded as GIF")?,
        Some("png" | "apng") => animated_png(&frames, delay).context("the loop could not be encoded as PNG")?,
        _ => bail!("{} says no format: end its name in .gif or .png", args.output.display()),
    };
    write(&args.output, &bytes)
}
