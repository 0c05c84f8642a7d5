//! What the shaders read: the draw list as rows of numbers.

use super::pipelines::VERTEX_FLOATS;
use crate::render::draw_list::{Colour, DrawList};
use crate::render::geometry::{Geometry, Vertex, linear};
use crate::render::view::{LightView, SHADOW_SIZE};
use glam::{Mat4, Vec4};

/// Bytes of the uniform `Frame` in `scene.wgsl`, and of `Light` in `shadow.wgsl`.
pub(super) const FRAME_BYTES: u64 = (16 + 11 * 4) * 4;
pub(super) const LIGHT_BYTES: u64 = 4 * 4 * 4;

/// One vertex, as the pipelines' layout has it.
pub(super) fn vertex_numbers(geometry: &Geometry, vertex: &Vertex) -> [f32; VERTEX_FLOATS] {
    let (p, n, surface) = (vertex.position, vertex.normal, &geometry.surfaces[vertex.surface as usize]);
    let c = surface.colour;
    [p.x, p.y, p.z, n.x, n.y, n.z, c.x, c.y, c.z, surface.roughness, surface.metallic, surface.glow]
}

/// The fields of `Light` in `shadow.wgsl`.
pub(super) fn light_numbers(view: &LightView) -> [Vec4; 4] {
    let [u, v, towards] = view.axes.map(|axis| axis.extend(0.0));
    [view.centre.extend(view.radius), u, v, towards]
}

/// The fields of `Frame` in `scene.wgsl`.
pub(super) fn frame_numbers(list: &DrawList, camera: &Mat4, view: &LightView) -> Vec<f32> {
    let (sun, background) = (&list.light, &list.background);
    let colour = |colour: Colour, factor: f32| (linear(colour.0) * factor).extend(0.0);
    let code = |colour: Colour| Vec4::from_array(colour.0.map(|code| f32::from(code) / 255.0));
    let size = Vec4::new(list.size[0] as f32, list.size[1] as f32, view.texel, SHADOW_SIZE as f32);
    let head =
        [list.camera.eye.extend(1.0), colour(sun.colour, sun.intensity), colour(sun.sky, 1.0), colour(sun.ground, 1.0)];
    let tail = [code(background.top), code(background.bottom), size];
    let rows = head.into_iter().chain(light_numbers(view)).chain(tail);
    camera.to_cols_array().into_iter().chain(rows.flat_map(|row| row.to_array())).collect()
}
