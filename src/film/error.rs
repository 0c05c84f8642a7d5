use crate::render::RenderError;
use crate::store::StoreError;
use std::error::Error;
use std::path::PathBuf;
use thiserror::Error;

/// Why a frame source could not build a frame.
pub type SourceError = Box<dyn Error + Send + Sync>;

/// Why a film could not be made. Finished frames are kept in every case.
#[derive(Debug, Error)]
pub enum FilmError {
    #[error("the film has no frames: choose a longer time span or more frames per second")]
    NoFrames,
    #[error("frames {start}..{end} are not all among the {count} frames of the film: choose a range within 0..{count}")]
    Range { start: u64, end: u64, count: u64 },
    #[error("{frames_per_second} frames per second cannot be filmed: choose 1 to {limit}")]
    FrameRate { frames_per_second: u32, limit: u32 },
    #[error("frames cannot be drawn {found} times as large: choose 1 to {limit}")]
    Supersampling { found: u32, limit: u32 },
    #[error("the film cannot be encoded with quantiser {quantiser}: choose {best} (best) to {worst} (worst)")]
    Quantiser { quantiser: u8, best: u8, worst: u8 },
    #[error(
        "a video of {width} x {height} pixels cannot be encoded: each side must be at least {least}, the longer at most {long} and the \
         shorter at most {short} pixels. Choose another size, or frames without a film"
    )]
    VideoSize { width: u32, height: u32, least: u32, long: u32, short: u32 },
    #[error("frame {index} could not be built: {source}")]
    Source { index: u64, source: SourceError },
    #[error("frame {index} could not be drawn: {source}")]
    Render { index: u64, source: RenderError },
    #[error(
        "frame {index} has {found_width} x {found_height} pixels where the film has {width} x {height}: all frames need the size set"
    )]
    FrameSize { index: u64, width: u32, height: u32, found_width: u32, found_height: u32 },
    #[error("the finished frame {path} changed while the film was made ({reason}): run again, it will be drawn anew", path = .path.display())]
    FrameChanged { path: PathBuf, reason: String },
    #[error("frame {index} could not be encoded as {format}: {reason}")]
    Encode { index: u64, format: &'static str, reason: String },
    #[error(
        "no ffmpeg can be used ({reason}): install it so that `ffmpeg` is on the search path, or leave the film to the built-in encoder \
         with --encoder openh264"
    )]
    NoFfmpeg { reason: String },
    #[error("ffmpeg could not make the film ({reason}): the frames are kept; run again, or with --encoder openh264")]
    Ffmpeg { reason: String },
    #[error(transparent)]
    Store(#[from] StoreError),
}
