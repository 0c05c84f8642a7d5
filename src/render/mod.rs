//! Drawing without a window: knows shapes, lines and text, and no physics.

mod draw_list;
mod error;
mod renderer;

pub use draw_list::{
    Anchor, Background, Camera, Colour, DrawList, Light, Material, Mesh, Object, OverlayItem, Rectangle, Stroke,
};
pub use error::RenderError;
pub use renderer::{AdapterInfo, DrawTimes, Renderer};
