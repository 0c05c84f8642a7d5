//! What does not move: floor, base plate with grooves, guide rails with their screws, end plates, the pedestal of the friction pad.

use super::{JENKINS_LINE, PLATES, SLIDER_REST, cuboid, jenkins, object, standing};
use crate::render::shapes::{cylinder, floor};
use crate::render::{Mesh, Object};
use crate::stage::palette::{self, Palette};
use glam::{Affine3A, Mat3, Vec3};
use std::sync::Arc;

/// Depth of the base plate: its middle and half its width.
const DEPTH: [f32; 2] = [0.14, 0.86];
pub(super) const PLATE_TOP: f32 = 0.12;
/// Distance of the guide rails from the middle, and their upper faces.
pub(super) const RAIL_OFFSET: f32 = 0.22;
pub(super) const RAIL_TOP: f32 = 0.21;
/// Distance of two screws along a rail.
const PITCH: f32 = 0.34;

/// An upright cylinder, its foot at `place`.
pub(super) fn upright(mesh: &Arc<Mesh>, place: Vec3, material: crate::render::Material) -> Object {
    let turn = Mat3::from_cols(Vec3::Y, Vec3::NEG_X, Vec3::Z);
    Object {
        mesh: mesh.clone(),
        transform: Affine3A::from_mat3_translation(turn, place),
        material,
        casts_shadow: false,
    }
}

pub(super) fn fixed_parts(palette: &Palette) -> Vec<Object> {
    let [left, right] = PLATES;
    let (middle, half) = (0.5 * (left + right), 0.5 * (right - left));
    let [depth, width] = DEPTH;
    let ground = object(Arc::new(floor(40.0, 40.0)), Vec3::ZERO, palette.floor);
    let mut parts = vec![
        Object { casts_shadow: false, ..ground },
        standing([half + 0.42, 0.06, width], 0.025, [middle, 0.0, depth], palette::PLATE),
    ];
    for z in [-0.5, 0.9] {
        let groove = cuboid([half + 0.4, 0.002, 0.022], 0.001, [middle, PLATE_TOP + 0.001, z], palette::GROOVE);
        parts.push(Object { casts_shadow: false, ..groove });
    }
    for x in [left - 0.09, right + 0.09] {
        parts.push(standing([0.09, 0.475, 0.5], 0.03, [x, PLATE_TOP, -0.02], palette::PLATE));
        // A foot with two screws.
        let outside = if x < middle { -0.2 } else { 0.2 };
        parts.push(standing([0.14, 0.04, 0.5], 0.015, [x + outside, PLATE_TOP, -0.02], palette::PLATE));
        for z in [-0.3, 0.26] {
            let screw = Arc::new(cylinder(0.045, 0.045, 0.01, 14));
            parts.push(upright(&screw, Vec3::new(x + outside, PLATE_TOP + 0.075, z), palette::SCREW));
        }
    }
    add_rails(&mut parts);
    add_pedestal(&mut parts);
    parts
}

fn add_rails(parts: &mut Vec<Object>) {
    let [left, right] = PLATES;
    let (start, end) = (left + 1.02, right - 0.1);
    let screw = Arc::new(cylinder(0.004, 0.022, 0.001, 10));
    for z in [-RAIL_OFFSET, RAIL_OFFSET] {
        let height = 0.5 * (RAIL_TOP - PLATE_TOP);
        let half = [0.5 * (end - start), height, 0.055];
        parts.push(standing(half, 0.014, [0.5 * (start + end), PLATE_TOP, z], palette::RAIL));
        let count = ((end - start - 0.1) / PITCH) as usize;
        for number in 0..=count {
            let x = start + 0.1 + PITCH * number as f32;
            parts.push(upright(&screw, Vec3::new(x, RAIL_TOP, z), palette::SCREW));
        }
    }
}

/// Carries the friction pad, whose upper face is `jenkins::PAD_TOP`.
fn add_pedestal(parts: &mut Vec<Object>) {
    let z = JENKINS_LINE[1];
    let foot = 0.5 * (jenkins::PAD_TOP - jenkins::PAD_THICKNESS - PLATE_TOP);
    let half = [jenkins::PAD_HALF[0] - 0.06, foot, jenkins::PAD_HALF[1] - 0.03];
    parts.push(standing(half, 0.02, [SLIDER_REST, PLATE_TOP, z], palette::PLATE));
}
