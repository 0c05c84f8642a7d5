//! Checks that a folder of frames shows something: every frame has many colours, and frames differ from one another.
//!
//! `cargo run --example inspect_frames -- renders/limit_torus/frames`

use anyhow::{Context, bail, ensure};
use std::collections::HashSet;
use std::path::PathBuf;

/// An empty picture has one colour, a background alone one per line; a lit scene with text has thousands.
const FEWEST_COLOURS: usize = 1500;
/// Part of the pixels that must change from one frame to the next: the carriages and the plots move.
const LEAST_CHANGE: f64 = 0.001;

fn main() -> anyhow::Result<()> {
    let folder = std::env::args().nth(1).context("name a folder of frames")?;
    let mut frames: Vec<PathBuf> = std::fs::read_dir(&folder)
        .with_context(|| folder.clone())?
        .map(|entry| Ok(entry?.path()))
        .collect::<std::io::Result<_>>()?;
    frames.retain(|path| path.extension().is_some_and(|extension| extension == "png"));
    frames.sort();
    ensure!(frames.len() > 1, "{folder} has {} frames, expected at least 2", frames.len());
    let mut before: Option<image::RgbaImage> = None;
    for path in &frames {
        let picture = image::open(path).with_context(|| path.display().to_string())?.into_rgba8();
        let colours: HashSet<_> = picture.pixels().collect();
        ensure!(colours.len() >= FEWEST_COLOURS, "{}: only {} colours", path.display(), colours.len());
        if let Some(before) = before {
            let changed = picture.pixels().zip(before.pixels()).filter(|(a, b)| a != b).count();
            let part = changed as f64 / f64::from(picture.width() * picture.height());
            if part < LEAST_CHANGE {
                bail!("{}: only {:.3} % of the pixels differ from the frame before", path.display(), 100.0 * part);
            }
        }
        before = Some(picture);
    }
    println!("{} frames show something", frames.len());
    Ok(())
}
