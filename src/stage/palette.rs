//! Colours and materials of the dark and the light theme. Data colours are from the Okabe-Ito palette, which colour-blind readers can tell
//! apart (darkened where they stand on white); contact states are named in words beside their colour.

use crate::model::ContactState;
use crate::render::{Background, Colour, Light, Material};
use crate::scene::{self, Theme};
use glam::Vec3;

/// Everything a theme decides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Palette {
    pub backdrop: Background,
    pub panel: Colour,
    pub panel_edge: Colour,
    pub grid: Colour,
    pub zero_line: Colour,
    pub text: Colour,
    pub faint_text: Colour,
    /// Text on a filled chip.
    pub chip_text: Colour,
    /// Masses 1 and 2.
    pub masses: [Colour; 2],
    pub stick: Colour,
    pub slip: Colour,
    pub excitation: Colour,
    pub damping: Colour,
    /// The exact solution beside the engine's.
    pub ghost: Colour,
    pub floor: Material,
    /// Arrow of the normal force.
    pub normal_force: Material,
    sun: f32,
    sky: Colour,
    ground: Colour,
}

const DARK: Palette = Palette {
    backdrop: Background { top: Colour::rgb(0x10161d), bottom: Colour::rgb(0x2c3640) },
    panel: Colour::rgb(0x10161d),
    panel_edge: Colour::rgb(0x3a4653),
    grid: Colour::rgb(0x27313b),
    zero_line: Colour::rgb(0x4d5a68),
    text: Colour::rgb(0xe8edf2),
    faint_text: Colour::rgb(0xa9b4bf),
    chip_text: Colour::rgb(0x0c1116),
    masses: [Colour::rgb(0x56b4e9), Colour::rgb(0xf0e442)],
    stick: Colour::rgb(0x00b386),
    slip: Colour::rgb(0xff7a1a),
    excitation: Colour::rgb(0xe07fb4),
    damping: Colour::rgb(0x8f9ba8),
    ghost: Colour::rgb(0xffffff),
    floor: material(0x262e36, 0.8, 0.0),
    normal_force: Material { glow: 0.12, ..material(0xd4dae0, 0.6, 0.0) },
    sun: 2.5,
    sky: Colour::rgb(0x9db4cc),
    ground: Colour::rgb(0x4a4640),
};

const LIGHT: Palette = Palette {
    backdrop: Background { top: Colour::rgb(0xd3dae2), bottom: Colour::rgb(0xf2f4f6) },
    panel: Colour::rgb(0xffffff),
    panel_edge: Colour::rgb(0xb9c3cd),
    grid: Colour::rgb(0xe4e9ee),
    zero_line: Colour::rgb(0xb4bfca),
    text: Colour::rgb(0x18202a),
    faint_text: Colour::rgb(0x4c5967),
    chip_text: Colour::rgb(0xffffff),
    masses: [Colour::rgb(0x0072b2), Colour::rgb(0xb88a00)],
    stick: Colour::rgb(0x00805f),
    slip: Colour::rgb(0xc94a00),
    excitation: Colour::rgb(0xb0437f),
    damping: Colour::rgb(0x6c7885),
    ghost: Colour::rgb(0x18202a),
    floor: material(0xc9d0d7, 0.9, 0.0),
    normal_force: material(0x2c3640, 0.5, 0.0),
    sun: 1.5,
    sky: Colour::rgb(0xc3cedb),
    ground: Colour::rgb(0x8f8a84),
};

impl Palette {
    #[must_use]
    pub fn of(theme: Theme) -> Self {
        match theme {
            Theme::Dark => DARK,
            Theme::Light => LIGHT,
        }
    }

    /// The same before a background of the scene's choice.
    #[must_use]
    pub fn before(mut self, background: scene::Backdrop) -> Self {
        if background == scene::Backdrop::Transparent {
            let Background { top, bottom } = self.backdrop;
            self.backdrop = Background { top: top.with_alpha(0.0), bottom: bottom.with_alpha(0.0) };
            self.floor.colour = self.floor.colour.with_alpha(0.0);
        }
        self
    }

    /// Colour of a contact state, the same wherever it is shown.
    #[must_use]
    pub fn contact(&self, contact: ContactState) -> Colour {
        match contact {
            ContactState::Stick => self.stick,
            ContactState::Slip(_) => self.slip,
        }
    }

    /// From the left, above and in front.
    #[must_use]
    pub fn light(&self) -> Light {
        Light {
            direction: Vec3::new(-0.75, 1.0, 0.42),
            colour: Colour::rgb(0xfff1de),
            intensity: self.sun,
            sky: self.sky,
            ground: self.ground,
            shadow_centre: Vec3::new(-0.1, 0.4, 0.1),
            shadow_radius: 3.9,
        }
    }
}

/// Colours that stand for a quantity or a state, in both themes.
#[must_use]
pub fn data_colours() -> Vec<Colour> {
    let of = |p: Palette| [p.masses[0], p.masses[1], p.stick, p.slip, p.excitation];
    [DARK, LIGHT].into_iter().flat_map(of).collect()
}

const fn material(hex: u32, roughness: f32, metallic: f32) -> Material {
    Material { colour: Colour::rgb(hex), roughness, metallic, glow: 0.0 }
}

/// Anodised base plate and end plates.
pub const PLATE: Material = material(0x87919b, 0.42, 0.65);
pub const GROOVE: Material = material(0x1d2329, 0.8, 0.1);
pub const RAIL: Material = material(0xc9ced3, 0.28, 0.95);
pub const SHOE: Material = material(0x3b434b, 0.4, 0.7);
pub const SCREW: Material = material(0x23282e, 0.35, 0.8);
pub const SPRING: Material = material(0xd7dbdf, 0.25, 0.95);
pub const SEAT: Material = material(0x7b858f, 0.4, 0.85);
pub const BARREL: Material = material(0x4a545e, 0.4, 0.6);
pub const ROD: Material = material(0xe6eaee, 0.18, 0.95);
pub const BRASS: Material = material(0xd9b15f, 0.3, 0.95);
pub const PAD: Material = material(0x4a3d35, 0.95, 0.0);

/// Painted body in a data colour.
pub fn painted(colour: Colour) -> Material {
    Material { colour, roughness: 0.42, metallic: 0.05, glow: 0.03 }
}

/// A body that glows in its colour, so that it can be told even in shadow.
pub fn glowing(colour: Colour, glow: f32) -> Material {
    Material { colour, roughness: 0.5, metallic: 0.0, glow }
}

/// Words on painted carriages and on dark metal, the same in both themes.
pub const CARRIAGE_TEXT: Colour = Colour::rgb(0x10161d);
pub const LABEL_ON_METAL: Colour = Colour::rgb(0xe8edf2);
