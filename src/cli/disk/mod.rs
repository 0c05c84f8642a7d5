//! `disk`: nonlinear analysis of the bladed disk of a scene.

mod conventions;
mod cycle;
pub mod filmed;
mod flutter;
mod motion;
mod solver;
mod waves;

use super::Verdict;
use super::case_args::EngineArgs;
use crate::scene::{Case, DiskCase, Scene};
use anyhow::Context;
use clap::{Args, Subcommand};
use std::path::Path;

/// Bladed disks: travelling-wave limit cycles, wave competition, flutter under random mistuning. `run` and `render` film them.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip disk waves scenes/disk_forward_wave.toml")]
pub struct DiskArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    Waves(waves::WavesArgs),
    Cycle(cycle::CycleArgs),
    Simulate(motion::MotionArgs),
    Flutter(flutter::FlutterArgs),
    Conventions(conventions::ConventionsArgs),
}

pub fn run(args: &DiskArgs) -> anyhow::Result<Verdict> {
    match &args.what {
        What::Waves(args) => waves::run(args),
        What::Cycle(args) => cycle::run(args),
        What::Simulate(args) => motion::run(args),
        What::Flutter(args) => flutter::run(args),
        What::Conventions(args) => conventions::run(args),
    }
}

/// The disk of a scene.
fn load(path: &Path) -> anyhow::Result<DiskCase> {
    Ok(load_case(path, None)?.1)
}

/// The same with the whole case; `engine` is applied to its settings.
fn load_case(path: &Path, engine: Option<&EngineArgs>) -> anyhow::Result<(Case, DiskCase)> {
    let (mut scene, mut case) = Scene::load(path)?;
    if let Some(engine) = engine.filter(|engine| engine.is_given()) {
        engine.apply(&mut scene);
        case = scene.checked(&path.display().to_string()).context("scene with the options given")?;
    }
    let disk = case
        .disk
        .clone()
        .with_context(|| format!("scene {} is about the two-mass rig: give one with a [disk] table", path.display()))?;
    Ok((case, disk))
}
