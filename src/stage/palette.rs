//! Colours and materials. Data colours are from the Okabe-Ito palette, which colour-blind readers can tell apart; contact states
//! are named in words beside their colour.

use crate::render::{Colour, Material};

pub const BACKDROP_TOP: Colour = Colour::rgb(0x1b2430);
pub const BACKDROP_BOTTOM: Colour = Colour::rgb(0x55626f);
pub const PANEL: Colour = Colour::rgb(0x10161d);
pub const PANEL_EDGE: Colour = Colour::rgb(0x3a4653);
pub const GRID: Colour = Colour::rgb(0x2a343f);
pub const ZERO_LINE: Colour = Colour::rgb(0x4d5a68);
pub const TEXT: Colour = Colour::rgb(0xe8edf2);
pub const FAINT_TEXT: Colour = Colour::rgb(0xa9b4bf);
/// Mass 1.
pub const FIRST: Colour = Colour::rgb(0x56b4e9);
/// Mass 2.
pub const SECOND: Colour = Colour::rgb(0xf0e442);
pub const STICK: Colour = Colour::rgb(0x00a37a);
pub const SLIP: Colour = Colour::rgb(0xff7a1a);
/// Self-excitation.
pub const EXCITATION: Colour = Colour::rgb(0xcc79a7);

const fn material(hex: u32, roughness: f32, metallic: f32) -> Material {
    Material { colour: Colour::rgb(hex), roughness, metallic, glow: 0.0 }
}

pub const FLOOR: Material = material(0x39434d, 1.0, 0.0);
pub const RAIL: Material = material(0xb9c0c6, 0.35, 0.8);
pub const POST: Material = material(0x59626b, 0.6, 0.2);
pub const SPRING: Material = material(0xd7dbdf, 0.3, 0.85);
pub const DAMPER: Material = material(0x3a424b, 0.45, 0.4);
pub const ROD: Material = material(0xe2e6e9, 0.22, 0.9);
pub const PAD: Material = material(0x4a3f38, 0.9, 0.0);

/// Painted body in a data colour.
pub fn painted(colour: Colour) -> Material {
    Material { colour, roughness: 0.45, metallic: 0.1, glow: 0.0 }
}

/// A body that glows in its colour, so that it can be told even in shadow.
pub fn glowing(colour: Colour) -> Material {
    Material { colour, roughness: 0.5, metallic: 0.0, glow: 0.2 }
}
