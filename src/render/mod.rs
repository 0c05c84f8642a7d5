//! Drawing without a window: knows shapes, lines and text, and no physics.

mod alpha;
mod cpu;
mod draw_list;
mod error;
mod geometry;
mod gpu;
mod look;
mod open;
mod overlay;
mod portable;
mod renderer;
mod retry;
pub mod shapes;
mod shrink;
mod view;

pub use alpha::{has_transparency, premultiply, straighten};
pub use cpu::CpuRenderer;
pub use draw_list::{
    Anchor, Background, Camera, Colour, DrawList, Light, Material, Mesh, Object, OverlayItem, Rectangle, Stroke,
};
pub use error::RenderError;
pub use open::{RendererChoice, open};
pub use overlay::text_width;
pub use renderer::{AdapterInfo, DrawTimes, Renderer};
pub use shrink::shrunk;
