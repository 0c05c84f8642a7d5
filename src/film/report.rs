use std::path::PathBuf;
use std::time::Duration;

/// How far a film is, told after each frame that was handed on to the encoders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    pub done: u64,
    pub total: u64,
    pub drawn: u64,
    pub reused: u64,
}

/// Where the time went, summed over all frames. Encoding runs beside drawing, so the sum may exceed the wall time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StageTimes {
    /// Building the drawing lists.
    pub scene: Duration,
    pub draw: Duration,
    pub read_back: Duration,
    pub overlay: Duration,
    /// Encoding and writing PNG files, and reading reused ones for the film.
    pub encode_png: Duration,
    pub encode_video: Duration,
}

/// What was made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FilmReport {
    /// Frames asked for: `drawn + reused`.
    pub frames: u64,
    pub drawn: u64,
    pub reused: u64,
    /// Size of the frames in pixels; the film's sides are made even.
    pub width: u32,
    pub height: u32,
    pub frames_per_second: u32,
    /// The film, if one was asked for and all its frames are there.
    pub film: Option<PathBuf>,
    /// All files, the frames asked for included.
    pub files: Vec<PathBuf>,
    pub times: StageTimes,
    pub wall: Duration,
}
