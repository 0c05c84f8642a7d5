//! Films of a fake renderer whose frames say which one they are.

mod browser;
mod fake;
mod ffmpeg;
mod mp4;
mod resume;
mod sequence;
mod video;
