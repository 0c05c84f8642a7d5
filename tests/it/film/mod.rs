//! Films whose frames say which one they are, of a fake renderer and of the built-in one.

mod browser;
mod fake;
mod ffmpeg;
mod marked;
pub mod mp4;
mod resume;
mod sequence;
pub mod video;
