//! Frames as PNG files and a film of them, made so that a run can be killed at any moment and taken up again.
//!
//! A frame is a pure function of its index, and its time is `index / frames_per_second`. Drawing happens on the calling thread; PNG
//! files and the video are encoded on one further thread each, behind queues of two pictures: at most seven pictures are in memory,
//! however long the film is. Besides them only the compressed film (a few kB per frame) and a sum per frame are held; an ffmpeg is sent
//! its pictures through a pipe and writes the film to a temporary file.
//!
//! A frame on disk is trusted if the journal of the output directory lists it as finished, for the same parameters, size and drawing
//! device, and its bytes still have the SHA-256 recorded there. Anything else is drawn again. The bytes of frames and film depend on the
//! parameters, the device and this program's version only: neither on threads nor on interruptions.

mod animation;
mod colours;
mod error;
mod ffmpeg;
mod h264;
mod manifest;
mod picture;
mod pipeline;
mod plan;
mod report;
mod settings;
mod video;
mod yuv;

pub use animation::{animated_png, contact_sheet, gif, scaled};
pub use error::{FilmError, SourceError};
pub use ffmpeg::Ffmpeg;
pub use picture::{encode as encode_png, encode_small as encode_small_png};
pub use pipeline::produce;
pub use plan::file_names;
pub use report::{FilmReport, Progress, StageTimes};
pub use settings::{Encoder, FilmSettings, Video};

use crate::render::DrawList;
use serde::Serialize;

/// Frames as drawing lists.
pub trait FrameSource: Sync {
    /// Number of frames of the whole sequence.
    fn count(&self) -> u64;

    /// The frame at `index < count()`: the same list for the same index, whatever was asked before.
    ///
    /// # Errors
    /// Whatever keeps the frame from being built; reported as [`FilmError::Source`].
    fn frame(&self, index: u64) -> Result<DrawList, SourceError>;

    /// What the frame at `index < count()` shows, for the manifest.
    fn state(&self, _index: u64) -> Option<FrameState> {
        None
    }
}

/// See [`FrameSource::state`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrameState {
    /// Time of the motion, in its own units.
    #[serde(rename = "motion_time")]
    pub time: f64,
    /// SHA-256 of the state that is drawn.
    #[serde(rename = "state_sha256")]
    pub sha256: String,
}
