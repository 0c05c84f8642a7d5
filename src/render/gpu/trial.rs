//! Whether a device draws what it should: some drivers give black, stale or single-sampled pictures without a word.

use super::GpuRenderer;
use crate::render::cpu::CpuRenderer;
use crate::render::shapes::{block, floor};
use crate::render::{Background, Camera, Colour, DrawList, Light, Material, Object, RenderError, Renderer};
use glam::{Affine3A, Vec3};
use image::RgbaImage;
use std::sync::Arc;

/// Level by which a pixel may differ: drivers place the centroid of a partly covered pixel as they like.
const VISIBLE: u8 = 16;
/// Part of the pixels that may differ by more; measured: 0.7 % on software drivers.
const ALLOWED: f64 = 0.03;

/// Draws two small pictures and compares them with those of the built-in rasteriser.
pub(super) fn prove(renderer: &mut GpuRenderer) -> Result<(), RenderError> {
    let mut reference = CpuRenderer::new("reference");
    for height in [0.0, 0.3] {
        let list = picture(height);
        let (drawn, expected) = (renderer.draw(&list)?.0, reference.draw(&list)?.0);
        let wrong = difference(&drawn, &expected);
        tracing::debug!(wrong, "part of a trial picture's pixels that differ");
        if wrong > ALLOWED {
            let reason = format!("{:.0} % of a trial picture's pixels are wrong", wrong * 100.0);
            return Err(RenderError::Device { doing: "drawing a trial picture", reason });
        }
    }
    Ok(())
}

/// Part of the pixels that differ visibly.
fn difference(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let differs =
        |(p, q): (&image::Rgba<u8>, &image::Rgba<u8>)| p.0.iter().zip(q.0).any(|(x, y)| x.abs_diff(y) > VISIBLE);
    a.pixels().zip(b.pixels()).filter(|&pair| differs(pair)).count() as f64 / f64::from(a.width() * a.height())
}

/// A block above a floor, with its shadow. The odd width makes rows that need padding.
fn picture(height: f32) -> DrawList {
    let material = |colour| Material { colour: Colour::rgb(colour), roughness: 0.5, metallic: 0.3, glow: 0.0 };
    let object = |mesh, height, colour| Object {
        mesh: Arc::new(mesh),
        transform: Affine3A::from_translation(Vec3::Y * height),
        material: material(colour),
        casts_shadow: true,
    };
    DrawList {
        size: [97, 64],
        background: Background { top: Colour::rgb(0xe0_e8_f0), bottom: Colour::rgb(0x40_50_60) },
        camera: Camera {
            eye: Vec3::new(1.0, 1.5, 2.5),
            target: Vec3::Y * 0.2,
            up: Vec3::Y,
            vertical_field_of_view: 0.8,
            viewport: [0.0, 0.0, 1.0, 1.0],
        },
        light: Light {
            direction: Vec3::new(0.5, 1.0, 0.3),
            colour: Colour::rgb(0xff_f0_e0),
            intensity: 0.9,
            sky: Colour::rgb(0x90_a0_b0),
            ground: Colour::rgb(0x60_58_50),
            shadow_centre: Vec3::ZERO,
            shadow_radius: 1.5,
        },
        objects: vec![
            object(floor(1.5, 1.5), 0.0, 0xb0_b0_b0),
            object(block(Vec3::new(0.4, 0.25, 0.3), 0.05), height + 0.25, 0xc0_50_30),
        ],
        overlay: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Negative control: a stale picture and a black one are refused, the right one is not.
    #[test]
    fn the_trial_tells_pictures_apart() {
        let mut renderer = CpuRenderer::new("test");
        let mut drawn = |height| renderer.draw(&picture(height)).unwrap().0;
        let (first, second) = (drawn(0.0), drawn(0.3));
        assert!(difference(&first, &second) > ALLOWED);
        assert!(difference(&first, &RgbaImage::new(97, 64)) > ALLOWED);
        assert!(difference(&first, &first) == 0.0);
    }
}
