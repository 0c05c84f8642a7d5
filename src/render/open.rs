//! Which back end draws.

use super::cpu::CpuRenderer;
use super::{RenderError, Renderer};

/// What to draw with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum RendererChoice {
    /// A graphics card if there is one, otherwise the built-in rasteriser.
    #[default]
    Auto,
    /// The built-in rasteriser: runs anywhere, the same bytes on every machine.
    Cpu,
    /// A graphics card, whatever its interface.
    Gpu,
    /// A graphics card through Vulkan.
    Vulkan,
    /// A graphics card through OpenGL.
    Gl,
    /// A software implementation of Vulkan or OpenGL, to test the graphics path without a card.
    Software,
}

/// Opens a back end; [`Renderer::info`] tells which and why.
///
/// # Errors
/// If a graphics adapter was asked for and there is none, or it does not answer. `Auto` and `Cpu` never fail.
pub fn open(choice: RendererChoice) -> Result<Box<dyn Renderer>, RenderError> {
    match choice {
        RendererChoice::Cpu => Ok(Box::new(CpuRenderer::new("asked for"))),
        RendererChoice::Auto => Ok(Box::new(CpuRenderer::new("no graphics adapter"))),
        _ => Err(RenderError::NoAdapter { wanted: format!("{choice:?}"), reason: "not built in".into() }),
    }
}
