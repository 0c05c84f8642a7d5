//! Which back end draws.

use super::cpu::CpuRenderer;
use super::gpu::GpuRenderer;
use super::retry::Persistent;
use super::{RenderError, Renderer};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// What to draw with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum RendererChoice {
    /// A graphics card if there is one, otherwise the built-in rasteriser.
    #[default]
    Auto,
    /// The built-in rasteriser: runs anywhere, the same bytes on every machine.
    Cpu,
    /// A graphics card, whatever its interface: Vulkan or OpenGL (Metal, Direct3D).
    Gpu,
    /// A graphics card through Vulkan.
    Vulkan,
    /// A graphics card through OpenGL.
    Gl,
    /// A software implementation of Vulkan or OpenGL, to test the graphics path without a card.
    Software,
    /// A software implementation of Vulkan, such as lavapipe.
    SoftwareVulkan,
    /// A software implementation of OpenGL, such as llvmpipe.
    SoftwareGl,
}

impl RendererChoice {
    pub(super) fn is_software(self) -> bool {
        matches!(self, Self::Software | Self::SoftwareVulkan | Self::SoftwareGl)
    }
}

/// A driver that has not opened a device by then hangs.
const PATIENCE: Duration = Duration::from_secs(30);

/// Opens a back end; [`Renderer::info`] tells which and why. A device that is lost while it draws is opened again.
///
/// # Errors
/// If a graphics adapter was asked for and there is none, or it does not answer. `Auto` and `Cpu` never fail.
pub fn open(choice: RendererChoice) -> Result<Box<dyn Renderer>, RenderError> {
    Ok(Box::new(Persistent::new(choice, open_once)?))
}

fn open_once(choice: RendererChoice) -> Result<Box<dyn Renderer>, RenderError> {
    match choice {
        RendererChoice::Cpu => Ok(Box::new(CpuRenderer::new("asked for"))),
        RendererChoice::Auto => open_gpu(choice).or_else(|error| Ok(Box::new(CpuRenderer::new(why_not(&error))))),
        _ => open_gpu(choice),
    }
}

/// Why the built-in rasteriser stands in for a graphics card.
fn why_not(error: &RenderError) -> String {
    match error {
        RenderError::NoAdapter { wanted, reason } => format!("no {wanted} adapter: {reason}"),
        other => other.to_string(),
    }
}

/// Opens the device on a thread of its own, which is left behind if the driver hangs.
fn open_gpu(choice: RendererChoice) -> Result<Box<dyn Renderer>, RenderError> {
    let (sender, receiver) = mpsc::channel();
    let fail = |reason: String| RenderError::Device { doing: "opening the device", reason };
    let opening = thread::Builder::new().name("graphics device".into());
    let work = move || {
        // Nobody listens any more only after a timeout, which has been reported.
        let _ = sender.send(GpuRenderer::open(choice));
    };
    opening.spawn(work).map_err(|error| fail(error.to_string()))?;
    match receiver.recv_timeout(PATIENCE) {
        Ok(opened) => Ok(Box::new(opened?)),
        Err(RecvTimeoutError::Timeout) => Err(fail(format!("no answer within {} s", PATIENCE.as_secs()))),
        Err(RecvTimeoutError::Disconnected) => Err(fail("the driver broke down".into())),
    }
}
