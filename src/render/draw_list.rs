//! One frame described as data: a lit 3D scene and flat vector graphics over it.
//!
//! World coordinates are right-handed, metres of the drawing, y up. Overlay coordinates are pixels from the top left corner.
//! Colours are sRGB, alpha not premultiplied.

use glam::{Affine3A, Vec2, Vec3};
use std::sync::Arc;

/// sRGB colour with straight alpha, each component in 0..=255.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Colour(pub [u8; 4]);

impl Colour {
    /// Opaque colour from `0xRRGGBB`.
    #[must_use]
    pub const fn rgb(hex: u32) -> Self {
        let [_, r, g, b] = hex.to_be_bytes();
        Self([r, g, b, 255])
    }

    /// The same colour with alpha from 0 (clear) to 1 (opaque).
    #[must_use]
    pub fn with_alpha(self, alpha: f32) -> Self {
        let [r, g, b, _] = self.0;
        Self([r, g, b, (alpha.clamp(0.0, 1.0) * 255.0).round() as u8])
    }
}

/// Everything a back end needs to draw one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawList {
    /// Width and height in pixels.
    pub size: [u32; 2],
    pub background: Background,
    pub camera: Camera,
    pub light: Light,
    pub objects: Vec<Object>,
    /// Drawn in order, after the scene.
    pub overlay: Vec<OverlayItem>,
}

/// Vertical gradient behind the scene; where both colours have alpha 0 the picture is clear there, and surfaces fade into nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Background {
    pub top: Colour,
    pub bottom: Colour,
}

impl Background {
    #[must_use]
    pub fn is_transparent(&self) -> bool {
        self.top.0[3] == 0 && self.bottom.0[3] == 0
    }
}

/// Perspective camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    pub eye: Vec3,
    pub target: Vec3,
    pub up: Vec3,
    /// Full vertical angle, rad.
    pub vertical_field_of_view: f32,
    /// Part of the picture the scene is centred in, as fractions `[left, top, right, bottom]` of the whole: `[0, 0, 1, 1]` for all of
    /// it. The field of view spans its height. The scene is still drawn everywhere; panels may cover the rest.
    pub viewport: [f32; 4],
}

/// One directional light that casts shadows, and a sky that does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// From the scene towards the light, any length.
    pub direction: Vec3,
    pub colour: Colour,
    /// What a white matt surface that faces the light sends back of it: about 1.
    pub intensity: f32,
    pub sky: Colour,
    pub ground: Colour,
    /// Sphere that must receive shadows. Surfaces farther from its centre than its radius fade into the backdrop, and are gone at 2.6 radii.
    pub shadow_centre: Vec3,
    pub shadow_radius: f32,
}

/// A mesh at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    pub mesh: Arc<Mesh>,
    pub transform: Affine3A,
    pub material: Material,
    pub casts_shadow: bool,
}

/// Simple physically motivated material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Objects are opaque, but for one thing: with alpha 0 before a transparent background only the shadows on the surface show, as
    /// translucent black.
    pub colour: Colour,
    /// 0 mirror-like to 1 dull.
    pub roughness: f32,
    /// 0 paint or plastic to 1 metal.
    pub metallic: f32,
    /// Light given off, as a multiple of `colour`.
    pub glow: f32,
}

/// Triangles with smooth normals, counter-clockwise seen from outside; they do not show from behind.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// Where the given position lies on a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    Left,
    Centre,
    Right,
}

/// Axis-aligned rectangle in overlay pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    pub min: Vec2,
    pub max: Vec2,
}

/// A stroke around a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    pub width: f32,
    pub colour: Colour,
}

/// Flat vector graphics. Pixel centres lie at half coordinates: a vertical line one pixel wide is crisp at x = n + 0.5, a box at whole
/// coordinates.
#[derive(Debug, Clone, PartialEq)]
pub enum OverlayItem {
    Box {
        area: Rectangle,
        corner_radius: f32,
        fill: Colour,
        stroke: Option<Stroke>,
    },
    /// Open line through `points`, cut off at `clip`.
    Line {
        points: Vec<Vec2>,
        stroke: Stroke,
        clip: Option<Rectangle>,
    },
    /// Filled polygon, cut off at `clip`.
    Polygon {
        points: Vec<Vec2>,
        fill: Colour,
        clip: Option<Rectangle>,
    },
    Disc {
        centre: Vec2,
        radius: f32,
        fill: Colour,
        stroke: Option<Stroke>,
    },
    /// Opaque cells of even colour that fill `area`, row by row from the top left one, `columns` in a row.
    Raster {
        area: Rectangle,
        columns: usize,
        cells: Arc<[Colour]>,
    },
    /// One line of text; `position` is on the baseline. `size` is the font size in pixels.
    Text {
        position: Vec2,
        anchor: Anchor,
        size: f32,
        colour: Colour,
        bold: bool,
        text: String,
    },
}
