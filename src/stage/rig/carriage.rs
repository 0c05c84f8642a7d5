//! A carriage: the body as its owner has it (pose and collision shape), and the parts screwed to it.

use super::bench::{RAIL_OFFSET, RAIL_TOP};
use super::{BODY_SCALE, HALF, HEIGHT};
use crate::render::shapes::{block, cylinder};
use crate::render::{Colour, Material, Mesh, Object};
use crate::stage::motion::Body;
use crate::stage::palette;
use glam::{Affine3A, Mat3, Vec3};
use std::sync::Arc;

/// A carriage in its own coordinates: origin in the body's middle.
#[derive(Debug, Clone)]
pub(super) struct Carriage {
    paint: Material,
    body: Arc<Mesh>,
    fittings: Vec<Object>,
}

impl Carriage {
    pub fn new(colour: Colour) -> Self {
        // Of half edge 1: the body's own half edges are put in where it is drawn.
        Self { paint: palette::painted(colour), body: Arc::new(block(Vec3::ONE, 0.07)), fittings: fittings() }
    }

    pub fn draw(&self, pose: Affine3A, body: &Body, objects: &mut Vec<Object>) {
        let half = Vec3::from(body.half_extents.map(|h| BODY_SCALE * h as f32));
        let transform = pose * Affine3A::from_scale(half);
        objects.push(Object { mesh: self.body.clone(), transform, material: self.paint, casts_shadow: true });
        let placed = |part: &Object| Object { transform: pose * part.transform, ..part.clone() };
        objects.extend(self.fittings.iter().map(placed));
    }
}

fn fittings() -> Vec<Object> {
    let part = |mesh: &Arc<Mesh>, place: Vec3, material| Object {
        mesh: mesh.clone(),
        transform: Affine3A::from_translation(place),
        material,
        casts_shadow: true,
    };
    // Shoes that ride on the rails, from just above their upper faces to the body, with lips beside the rail.
    let top = -HALF;
    let bottom = RAIL_TOP - HEIGHT - 0.05;
    let shoe = Arc::new(block(Vec3::new(0.13, 0.5 * (top - bottom), 0.1), 0.015));
    let cover = Arc::new(block(Vec3::new(0.27, 0.012, 0.27), 0.008));
    let mut parts = vec![part(&cover, Vec3::Y * (HALF + 0.008), palette::RAIL)];
    for x in [-0.21, 0.21] {
        for z in [-RAIL_OFFSET, RAIL_OFFSET] {
            parts.push(part(&shoe, Vec3::new(x, 0.5 * (top + bottom), z), palette::SHOE));
        }
    }
    let screw = Arc::new(cylinder(0.022, 0.03, 0.006, 12));
    let turn = Mat3::from_cols(Vec3::Y, Vec3::NEG_X, Vec3::Z);
    for [x, z] in [[-0.22, -0.22], [-0.22, 0.22], [0.22, -0.22], [0.22, 0.22]] {
        let transform = Affine3A::from_mat3_translation(turn, Vec3::new(x, HALF + 0.016, z));
        parts.push(Object { mesh: screw.clone(), transform, material: palette::SCREW, casts_shadow: false });
    }
    parts
}
