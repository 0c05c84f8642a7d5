//! `disk`: nonlinear analysis of the bladed disk of a scene.

pub mod filmed;
mod flutter;
mod motion;
mod waves;

use super::Verdict;
use crate::scene::{DiskCase, Scene};
use anyhow::Context;
use clap::{Args, Subcommand};
use std::path::Path;

/// Bladed disks: travelling-wave limit cycles, wave competition, flutter under random mistuning.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip disk waves scenes/disk_forward_wave.toml")]
pub struct DiskArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    Waves(waves::WavesArgs),
    Simulate(motion::MotionArgs),
    Flutter(flutter::FlutterArgs),
}

pub fn run(args: &DiskArgs) -> anyhow::Result<Verdict> {
    match &args.what {
        What::Waves(args) => waves::run(args),
        What::Simulate(args) => motion::run(args),
        What::Flutter(args) => flutter::run(args),
    }
}

/// The disk of a scene, and the length of its motion.
fn load(path: &Path) -> anyhow::Result<(DiskCase, f64)> {
    let (_, case) = Scene::load(path)?;
    let disk = case
        .disk
        .with_context(|| format!("scene {} is about the two-mass rig: give one with a [disk] table", path.display()))?;
    Ok((disk, case.duration))
}
