//! Options that name or change a scene.

use crate::scene::{Backdrop, Case, Initial, Joints, Precision, Scene, Scheme, Theme};
use anyhow::{Context, ensure};
use clap::Args;
use std::path::{Path, PathBuf};

/// Parameters of the two-mass rig; those of the scene, or nominal ones, where not given.
#[derive(Debug, Args)]
#[command(next_help_heading = "Rig")]
pub struct RigArgs {
    /// Damping of the in-phase mode, negative: self-excitation.
    #[arg(long, allow_hyphen_values = true)]
    pub xi1: Option<f64>,
    /// Damping of the out-of-phase mode.
    #[arg(long, allow_hyphen_values = true)]
    pub xi2: Option<f64>,
    /// Coupling stiffness.
    #[arg(long, allow_hyphen_values = true)]
    pub kappa: Option<f64>,
    /// Friction intensity, greater than 0 and at most 1.
    #[arg(long, allow_hyphen_values = true)]
    pub gamma: Option<f64>,
}

/// How Rapier is run.
#[derive(Debug, Args)]
#[command(next_help_heading = "Engine")]
pub struct EngineArgs {
    /// f64 or f32; as the scene says, f64 where it does not.
    #[arg(long, value_parser = parse_serde::<Precision>)]
    pub precision: Option<Precision>,
    /// impulse or multibody; as the scene says, impulse where it does not.
    #[arg(long, value_parser = parse_serde::<Joints>)]
    pub joints: Option<Joints>,
    /// averaged_friction, second_order or plain; as the scene says, averaged_friction where it does not.
    #[arg(long, value_parser = parse_serde::<Scheme>)]
    pub scheme: Option<Scheme>,
    /// Solver iterations per step; as the scene says, 1 where it does not.
    #[arg(long)]
    pub substeps: Option<usize>,
    /// Steps per period of the sticking in-phase mode; as the scene says, 4096 where it does not.
    #[arg(long, allow_hyphen_values = true)]
    pub steps_per_period: Option<f64>,
    /// Length of a step, in place of --steps-per-period.
    #[arg(long, allow_hyphen_values = true, conflicts_with = "steps_per_period")]
    pub dt: Option<f64>,
}

/// Reads a word as serde does, so that options and scene files know the same words.
fn parse_serde<T: serde::de::DeserializeOwned>(word: &str) -> Result<T, String> {
    serde_json::from_value(word.into()).map_err(|error| error.to_string())
}

impl RigArgs {
    pub fn apply(&self, scene: &mut Scene) -> anyhow::Result<()> {
        if [self.xi1, self.xi2, self.kappa, self.gamma].iter().all(Option::is_none) {
            return Ok(());
        }
        ensure!(
            scene.disk.is_none(),
            "--xi1, --xi2, --kappa and --gamma are about the two-mass rig, but the scene is about a bladed disk: change [disk] in the scene"
        );
        ensure!(
            scene.rig_si.is_none(),
            "--xi1, --xi2, --kappa and --gamma are non-dimensional, but the scene gives its rig in SI units ([rig_si]): change them in the scene"
        );
        let mut rig = scene.rig.unwrap_or_default();
        rig.xi1 = self.xi1.unwrap_or(rig.xi1);
        rig.xi2 = self.xi2.unwrap_or(rig.xi2);
        rig.kappa = self.kappa.unwrap_or(rig.kappa);
        rig.gamma = self.gamma.unwrap_or(rig.gamma);
        scene.rig = Some(rig);
        // What the scene says of its motion need not hold for another rig.
        scene.title = "Self-excited rig with dry friction".to_owned();
        scene.caption.clear();
        Ok(())
    }
}

impl EngineArgs {
    pub fn is_given(&self) -> bool {
        self.precision.is_some()
            || self.joints.is_some()
            || self.scheme.is_some()
            || self.substeps.is_some()
            || self.steps_per_period.is_some()
            || self.dt.is_some()
    }

    pub fn apply(&self, scene: &mut Scene) {
        let engine = &mut scene.engine;
        engine.precision = self.precision.unwrap_or(engine.precision);
        engine.joints = self.joints.unwrap_or(engine.joints);
        engine.scheme = self.scheme.unwrap_or(engine.scheme);
        engine.substeps = self.substeps.unwrap_or(engine.substeps);
        if let Some(steps) = self.steps_per_period {
            engine.steps_per_period = steps;
            engine.dt = None;
        }
        engine.dt = self.dt.or(engine.dt);
    }
}

/// Picture and length of a film.
#[derive(Debug, Args)]
#[command(next_help_heading = "Film")]
pub struct FilmArgs {
    /// Length of the motion, in the units of the scene.
    #[arg(long, allow_hyphen_values = true)]
    pub t_end: Option<f64>,
    /// Picture size in pixels. H.264 needs even sides: where one is odd, film.mp4 repeats the last column or row.
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Frames per second of film.
    #[arg(long)]
    pub fps: Option<u32>,
    /// Time of the motion in one second of film, in the units of the scene.
    #[arg(long, allow_hyphen_values = true)]
    pub speed: Option<f64>,
    /// dark or light.
    #[arg(long, value_parser = parse_serde::<Theme>)]
    pub theme: Option<Theme>,
    /// theme, or transparent: frames with alpha and no film.
    #[arg(long, value_parser = parse_serde::<Backdrop>)]
    pub background: Option<Backdrop>,
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').map(|(w, h)| [w.parse(), h.parse()]);
    match sides {
        Some([Ok(width), Ok(height)]) => Ok([width, height]),
        _ => Err("give width and height in pixels, such as 1280x720".to_owned()),
    }
}

impl FilmArgs {
    pub fn apply(&self, scene: &mut Scene) {
        scene.simulation.duration = self.t_end.unwrap_or(scene.simulation.duration);
        let film = &mut scene.film;
        [film.width, film.height] = self.size.unwrap_or([film.width, film.height]);
        film.fps = self.fps.unwrap_or(film.fps);
        film.speed = self.speed.unwrap_or(film.speed);
        film.theme = self.theme.unwrap_or(film.theme);
        film.background = self.background.unwrap_or(film.background);
    }
}

/// A scene to film, with its changes.
#[derive(Debug, Args)]
pub struct SceneArgs {
    /// Scene file; the built-in limit torus without it.
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    rig: RigArgs,
    #[command(flatten)]
    engine: EngineArgs,
    #[command(flatten)]
    pub film: FilmArgs,
}

impl SceneArgs {
    pub fn case(&self) -> anyhow::Result<Case> {
        let mut scene = load(self.scene.as_deref())?;
        self.rig.apply(&mut scene)?;
        self.engine.apply(&mut scene);
        self.film.apply(&mut scene);
        checked(&scene, self.scene.as_deref())
    }
}

/// `x1,x2,v1,v2,f`
pub fn parse_initial(text: &str) -> Result<Initial, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse::<f64>()).collect();
    let state = numbers.ok().and_then(|numbers| <[f64; 5]>::try_from(numbers).ok());
    state.map(|state| Initial::State { state }).ok_or_else(|| "give five numbers x1,x2,v1,v2,f".to_owned())
}

/// The scene at `path`, or the built-in one.
pub fn load(path: Option<&Path>) -> anyhow::Result<Scene> {
    let (scene, _) = match path {
        Some(path) => Scene::load(path)?,
        None => Scene::built_in()?,
    };
    Ok(scene)
}

fn origin(path: Option<&Path>) -> String {
    path.map_or_else(|| "built in".to_owned(), |path| path.display().to_string())
}

/// Checks the changed scene; `path` names it in errors.
fn checked(scene: &Scene, path: Option<&Path>) -> anyhow::Result<Case> {
    scene.checked(&origin(path)).context("scene with the options given")
}

/// Checks a changed scene of the two-mass rig.
pub fn check(scene: &Scene, path: Option<&Path>) -> anyhow::Result<Case> {
    let case = checked(scene, path)?;
    ensure!(
        case.disk.is_none(),
        "scene {} is about a bladed disk, this command about the two-mass rig: take `modes`, `disk`, `run` or `render`",
        origin(path)
    );
    Ok(case)
}
