//! A small scene to put objects into, and its picture on the built-in rasteriser.

use glam::{Affine3A, Vec3};
use image::{Rgba, RgbaImage};
use std::sync::Arc;
use stickslip::render::{Background, Camera, Colour, CpuRenderer, DrawList, Light, Material, Mesh, Object, Renderer};

pub const SKY: Colour = Colour::rgb(0x20_30_40);
pub const RED: Colour = Colour::rgb(0xff_00_00);

/// Glows red and reflects nothing worth mentioning: its colour does not depend on the light.
pub const GLOWING: Material = Material { colour: RED, roughness: 1.0, metallic: 0.0, glow: 1.0 };

/// Camera on +z looking at the origin: at z = 0 the picture is 2 units high, so a 100 pixel picture shows 50 pixels a unit.
pub fn empty() -> DrawList {
    DrawList {
        size: [100, 100],
        background: Background { top: SKY, bottom: SKY },
        camera: Camera {
            eye: Vec3::Z * 2.0,
            target: Vec3::ZERO,
            up: Vec3::Y,
            vertical_field_of_view: 2.0 * 0.5_f32.atan(),
            viewport: [0.0, 0.0, 1.0, 1.0],
        },
        light: Light {
            direction: Vec3::Y,
            colour: Colour::rgb(0xff_ff_ff),
            intensity: 0.6,
            sky: Colour::rgb(0x60_60_60),
            ground: Colour::rgb(0x20_20_20),
            shadow_centre: Vec3::ZERO,
            shadow_radius: 3.0,
        },
        objects: Vec::new(),
        overlay: Vec::new(),
    }
}

pub fn object(mesh: Mesh, place: Vec3, material: Material) -> Object {
    Object { mesh: Arc::new(mesh), transform: Affine3A::from_translation(place), material, casts_shadow: true }
}

/// A triangle in the plane z = 0, seen from its front.
pub fn triangle(corners: [[f32; 2]; 3]) -> Mesh {
    Mesh {
        positions: corners.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 3],
        triangles: vec![[0, 1, 2]],
    }
}

pub fn draw(list: &DrawList) -> RgbaImage {
    CpuRenderer::new("test").draw(list).unwrap().0
}

pub fn brightness(pixel: &Rgba<u8>) -> u32 {
    pixel.0[..3].iter().map(|&channel| u32::from(channel)).sum()
}

pub const BACKDROP: Rgba<u8> = Rgba([0x20, 0x30, 0x40, 255]);
