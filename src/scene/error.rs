use crate::model::ParameterError;
use std::path::PathBuf;
use thiserror::Error;

/// Why a scene cannot be used.
#[derive(Debug, Error)]
pub enum SceneError {
    #[error("scene {path} cannot be read: {source}. Check the path, or leave it out for the built-in scene")]
    Unreadable { path: PathBuf, source: std::io::Error },
    /// Malformed TOML, unknown fields, values of the wrong kind. The message of the parser shows the line and the field.
    #[error("scene {origin}, line {line}: {message}")]
    Syntax { origin: String, line: usize, message: String },
    #[error("scene {origin}{place}: {fault}")]
    Parameter { origin: String, place: Place, fault: Fault },
}

/// Where in a file a field stands: `, line 12, field rig.gamma`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    pub line: Option<usize>,
    pub field: String,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.line {
            Some(line) => write!(f, ", line {line}, field {}", self.field),
            None => write!(f, ", field {}", self.field),
        }
    }
}

/// What is wrong with a field.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Fault {
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error("{field} = {found} is not allowed: it must be {allowed}")]
    Whole { field: &'static str, found: u64, allowed: &'static str },
    #[error("{field} is not allowed as it is: it must be {allowed}")]
    Direction { field: &'static str, allowed: &'static str },
    #[error("a ramp of xi1 goes with [rig] and a free motion only: leave out [rig_si] and [prescribed], or the ramp")]
    RampOfWhat,
    #[error("a story has at least one scene: add [[scene]]")]
    EmptyStory,
    #[error("all scenes of a story need the same width, height and fps: this one has others than the first")]
    OtherFormat,
    #[error("a scene has either [rig] or [rig_si], this one has both: remove one")]
    TwoRigs,
    #[error("a scene is about a [disk] or a two-mass rig, this one has [disk] and [{other}]: remove [{other}]")]
    DiskWith { other: &'static str },
    #[error("[disk_start] says how a disk starts, but there is none: add [disk]")]
    StartWithoutDisk,
    #[error("slider force {found} is beyond the slip force {allowed}: give at most that")]
    BeyondSlipForce { found: f64, allowed: f64 },
    #[error(
        "the film would have {found} frames: it must have 1 to {allowed}. Change simulation.duration, film.fps or film.speed"
    )]
    FrameCount { found: f64, allowed: u64 },
}
