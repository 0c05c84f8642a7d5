use thiserror::Error;

/// Why a frame could not be drawn.
#[derive(Debug, Error)]
pub enum RenderError {
    #[error("picture size {width} x {height} cannot be drawn: each side must be 1 to {limit} pixels")]
    Size { width: u32, height: u32, limit: u32 },
    #[error("object {object} of the scene cannot be drawn: {problem}")]
    Mesh { object: usize, problem: &'static str },
    #[error("the scene cannot be seen: {problem}")]
    View { problem: &'static str },
    #[error("item {item} of the overlay cannot be drawn: {problem}")]
    Overlay { item: usize, problem: String },
    #[error("no {wanted} adapter found ({reason}): install its driver, or draw with the CPU")]
    NoAdapter { wanted: String, reason: String },
    #[error("the graphics device failed while {doing}: {reason}. Run again: finished frames are kept")]
    Device { doing: &'static str, reason: String },
}
