//! What a back end is.

use super::draw_list::DrawList;
use image::RgbaImage;
use std::time::Duration;

/// Which back end drew a frame, for reports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AdapterInfo {
    /// Name of the device, such as `llvmpipe (LLVM 15.0.6, 256 bits)`.
    pub adapter: String,
    /// `vulkan`, `gl`, `metal`, `dx12` or `cpu`.
    pub backend: String,
    /// Why this one was taken: one sentence.
    pub reason: String,
}

/// Where the time of one frame went.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DrawTimes {
    pub draw: Duration,
    pub read_back: Duration,
    pub overlay: Duration,
}

/// Turns a [`DrawList`] into pixels: always the same ones for the same list on the same machine.
pub trait Renderer: Send {
    fn info(&self) -> &AdapterInfo;

    /// Draws one frame, sRGB, `list.size` pixels; opaque, or with straight alpha where the background is transparent.
    ///
    /// # Errors
    /// If the size is zero or beyond what the back end can do, or the device fails.
    fn draw(&mut self, list: &DrawList) -> Result<(RgbaImage, DrawTimes), super::RenderError>;
}
