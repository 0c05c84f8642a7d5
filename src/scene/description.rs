//! What a scene file says, as data. Where the rig is given in SI units (`[rig_si]`), every other length, velocity, force and
//! time of the file is in SI too; where it is given non-dimensionally (`[rig]`), all are non-dimensional.

use super::direction::Direction;
use super::disk::DiskStart;
use super::ramp::Ramp;
use crate::model::{BladedDisk, DimensionalRig, PrescribedMotion, RigParameters};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A scene: the rig, how it starts, how long it moves, how it is simulated, checked and filmed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Headline of the film.
    pub title: String,
    /// What to look at, one sentence; shown under the headline.
    #[serde(default)]
    pub caption: String,
    /// Non-dimensional parameters; the nominal set without it. Exclusive with `rig_si`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rig: Option<RigParameters>,
    /// The rig in SI units. Exclusive with `rig`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rig_si: Option<DimensionalRig>,
    /// A bladed disk in place of the two-mass rig, non-dimensional. Exclusive with `rig`, `rig_si`, `initial` and `prescribed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disk: Option<BladedDisk>,
    /// How the blades of the disk start; at rest without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disk_start: Option<DiskStart>,
    /// Sweeps the self-excitation; only with a non-dimensional rig and a free motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ramp: Option<Ramp>,
    #[serde(default)]
    pub initial: Initial,
    /// Moves mass 1 as `amplitude sin(angular_frequency t)` and holds mass 2. Of `initial` only the slider force of a state counts then; it is 0 without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prescribed: Option<PrescribedMotion>,
    #[serde(default)]
    pub simulation: Simulation,
    #[serde(default)]
    pub engine: Engine,
    #[serde(default)]
    pub check: Check,
    #[serde(default)]
    pub film: Film,
    #[serde(default)]
    pub direction: Direction,
}

/// How the motion starts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "start", rename_all = "snake_case", deny_unknown_fields)]
pub enum Initial {
    /// On the limit cycle, at a reversal of mass 1, with `perturbation` added to the position of mass 2: 0.001 slip lengths where not given.
    LimitCycle {
        #[serde(default)]
        perturbation: Option<f64>,
    },
    /// At `[x1, x2, v1, v2, f]`; in SI m, m/s and the slider force in N.
    State { state: [f64; 5] },
}

/// Perturbation of the limit cycle where none is given, in slip lengths.
pub const DEFAULT_PERTURBATION: f64 = 0.001;
/// Displacement beyond which a motion has diverged where no bound is given, in slip lengths.
pub(super) const DEFAULT_AMPLITUDE_BOUND: f64 = 1000.0;

impl Default for Initial {
    fn default() -> Self {
        Self::LimitCycle { perturbation: None }
    }
}

/// How long the motion is followed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Simulation {
    /// Length of the motion.
    pub duration: f64,
    /// The motion has diverged once |x1| or |x2| exceeds this: 1000 slip lengths where not given.
    pub amplitude_bound: Option<f64>,
}

impl Default for Simulation {
    fn default() -> Self {
        Self { duration: 160.0, amplitude_bound: None }
    }
}

/// Number format of the engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    F32,
    #[default]
    F64,
}

/// How the engine holds the carriages on the rail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Joints {
    #[default]
    Impulse,
    Multibody,
}

/// What the engine's forces see of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// As `second_order`, with the friction force averaged over the step: Floquet multipliers are of second order too.
    #[default]
    AveragedFriction,
    /// Leapfrog start, velocity predicted to the instant of the positions: second order with one substep.
    SecondOrder,
    /// The engine's velocity as it is: first order.
    Plain,
}

/// How the engine simulates the rig.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Engine {
    pub precision: Precision,
    pub joints: Joints,
    pub scheme: Scheme,
    /// Solver iterations per step.
    pub substeps: usize,
    /// Steps per period of the sticking in-phase mode (2 pi non-dimensional time units). Ignored where `dt` is given.
    pub steps_per_period: f64,
    /// Length of a step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dt: Option<f64>,
}

impl Default for Engine {
    fn default() -> Self {
        Self {
            precision: Precision::default(),
            joints: Joints::default(),
            scheme: Scheme::default(),
            substeps: 1,
            steps_per_period: 4096.0,
            dt: None,
        }
    }
}

/// What kind of motion a scene shows, which decides what engine and exact solution can agree on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MotionKind {
    /// Amplitude and frequency agree as well as the states do.
    #[default]
    Regular,
    /// Beyond the horizon only averages agree, within their statistical error.
    Chaotic,
}

/// How engine and exact solution are compared.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Check {
    /// States are compared up to this time; the whole motion without it. Chaos calls for a short one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub horizon: Option<f64>,
    pub motion: MotionKind,
}

/// Colours of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Theme {
    /// For screens.
    #[default]
    Dark,
    /// For paper and bright rooms.
    Light,
}

/// What is behind the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Backdrop {
    /// The backdrop and floor of the theme.
    #[default]
    Theme,
    /// Nothing: frames with alpha, shadows as translucent black. They make no video, which has no alpha.
    Transparent,
}

/// How the motion is filmed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Film {
    /// Picture width, pixels. Where it is odd, the last column of the video is there twice: H.264 needs even sides.
    pub width: u32,
    /// Picture height, pixels; as for the width.
    pub height: u32,
    /// Frames per second of film.
    pub fps: u32,
    /// Time of the motion that passes in one second of film.
    pub speed: f64,
    pub theme: Theme,
    pub background: Backdrop,
}

impl Default for Film {
    fn default() -> Self {
        Self { width: 1280, height: 720, fps: 30, speed: 8.0, theme: Theme::default(), background: Backdrop::default() }
    }
}
