//! From the draw list to one list of lit triangles in world coordinates, the same for both back ends.

use super::RenderError;
use super::draw_list::{DrawList, Material, Object};
use super::portable::decode;
use glam::Vec3;

/// A material in linear light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Surface {
    pub colour: Vec3,
    pub roughness: f32,
    pub metallic: f32,
    /// [`SHADOW_ONLY`] where nothing but shadows shows.
    pub glow: f32,
}

/// Stands in the place of a glow.
const SHADOW_ONLY: f32 = -1.0;

impl Surface {
    fn new(material: &Material, before_nothing: bool) -> Self {
        let is_clear = before_nothing && material.colour.0[3] == 0;
        Self {
            colour: linear(material.colour.0),
            // Below this the highlight is smaller than a pixel and only flickers.
            roughness: material.roughness.clamp(0.08, 1.0),
            metallic: material.metallic.clamp(0.0, 1.0),
            glow: if is_clear { SHADOW_ONLY } else { material.glow.max(0.0) },
        }
    }
}

/// Linear light of an sRGB colour, without its alpha.
pub(crate) fn linear([r, g, b, _]: [u8; 4]) -> Vec3 {
    Vec3::new(decode(r), decode(g), decode(b))
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vertex {
    pub position: Vec3,
    pub normal: Vec3,
    /// Index into [`Geometry::surfaces`].
    pub surface: u32,
}

/// All triangles of a frame, counter-clockwise seen from outside. Those that cast shadows come first.
#[derive(Debug, Default)]
pub(crate) struct Geometry {
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<[u32; 3]>,
    pub surfaces: Vec<Surface>,
    /// Number of triangles that cast shadows.
    pub casting: usize,
}

impl Geometry {
    pub fn gather(list: &DrawList) -> Result<Self, RenderError> {
        let mut geometry = Self::default();
        for casting in [true, false] {
            for (index, object) in list.objects.iter().enumerate().filter(|(_, o)| o.casts_shadow == casting) {
                geometry
                    .add(object, list.background.is_transparent())
                    .map_err(|problem| RenderError::Mesh { object: index, problem })?;
            }
            if casting {
                geometry.casting = geometry.triangles.len();
            }
        }
        Ok(geometry)
    }

    fn add(&mut self, object: &Object, before_nothing: bool) -> Result<(), &'static str> {
        let (mesh, first) = (&object.mesh, self.vertices.len() as u32);
        if mesh.positions.len() != mesh.normals.len() {
            return Err("as many normals as positions are needed");
        }
        let matrix = object.transform.matrix3;
        let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(Vec3::from);
        let origin = Vec3::from(object.transform.translation);
        // Cofactors: the inverse transpose up to a factor, and they need no division.
        let (nx, ny, nz) = (y.cross(z), z.cross(x), x.cross(y));
        let mirrored = x.dot(nx) < 0.0;
        let facing = if mirrored { -1.0 } else { 1.0 };
        let surface = self.surfaces.len() as u32;
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            let position = origin + x * p.x + y * p.y + z * p.z;
            let normal = (nx * n.x + ny * n.y + nz * n.z) * facing;
            // Far beyond any scene, yet small enough that no product in the back ends overflows.
            if position.abs().max_element() > 1e9 || !position.is_finite() {
                return Err("its positions must be finite and below 1e9");
            }
            self.vertices.push(Vertex { position, normal: normal.normalize_or(Vec3::Y), surface });
        }
        for &[a, b, c] in &mesh.triangles {
            if [a, b, c].iter().any(|&index| index as usize >= mesh.positions.len()) {
                return Err("a triangle names a corner that is not there");
            }
            let [b, c] = if mirrored { [c, b] } else { [b, c] };
            self.triangles.push([a + first, b + first, c + first]);
        }
        self.surfaces.push(Surface::new(&object.material, before_nothing));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{Colour, shapes::block};
    use glam::Affine3A;
    use std::sync::Arc;

    fn object(transform: Affine3A) -> Object {
        let material = Material { colour: Colour::rgb(0xff_ff_ff), roughness: 0.5, metallic: 0.0, glow: 0.0 };
        Object { mesh: Arc::new(block(Vec3::ONE, 0.1)), transform, material, casts_shadow: true }
    }

    #[test]
    fn a_mirrored_body_still_faces_outwards() {
        for scale in [Vec3::new(1.0, 2.0, 0.5), Vec3::new(-1.0, 2.0, 0.5)] {
            let mut geometry = Geometry::default();
            geometry.add(&object(Affine3A::from_scale(scale)), false).unwrap();
            for &triangle in &geometry.triangles {
                let [a, b, c] = triangle.map(|i| geometry.vertices[i as usize].position);
                let face = (b - a).cross(c - a);
                assert!(face.dot(a + b + c) > 0.0, "inward triangle for scale {scale}");
                assert!(triangle.iter().all(|&i| geometry.vertices[i as usize].normal.dot(face) > 0.0));
            }
        }
    }

    #[test]
    fn broken_meshes_are_refused() {
        let mut geometry = Geometry::default();
        assert!(geometry.add(&object(Affine3A::from_translation(Vec3::X * f32::NAN)), false).is_err());
        let mut broken = object(Affine3A::IDENTITY);
        Arc::make_mut(&mut broken.mesh).triangles.push([0, 1, 999]);
        assert!(geometry.add(&broken, false).is_err());
    }
}
