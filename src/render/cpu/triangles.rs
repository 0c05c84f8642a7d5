//! From world triangles to screen triangles: projection, near clipping, back faces, and the planes that interpolate over the screen.

use crate::render::geometry::{Geometry, Vertex};
use glam::{Mat4, Vec2, Vec3, Vec4};

/// A vertex where it lands on the screen.
#[derive(Debug, Clone, Copy)]
struct Corner {
    clip: Vec4,
    index: u32,
}

/// Quantity linear over the screen, given by its value at a reference point and its change per pixel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Plane {
    pub at_reference: f32,
    pub slope: Vec2,
}

impl Plane {
    pub fn at(&self, from_reference: Vec2) -> f32 {
        self.at_reference + (self.slope.x * from_reference.x + self.slope.y * from_reference.y)
    }
}

/// A triangle seen from its front, pixels from the top left corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct ScreenTriangle {
    /// In the order in which the edge functions are positive inside.
    pub corners: [Vec2; 3],
    pub vertices: [u32; 3],
    /// 1 / distance, which serves as depth; and the second and third corner's weight times it. Reference: the first corner.
    pub inverse_distance: Plane,
    pub weights: [Plane; 2],
}

/// All front triangles of a frame, and the vertices they name: those of the scene, then those born at the near plane.
#[derive(Debug)]
pub(super) struct Projected {
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<ScreenTriangle>,
}

impl Projected {
    pub fn new(geometry: &Geometry, camera: &Mat4, [width, height]: [u32; 2]) -> Self {
        let size = Vec2::new(width as f32, height as f32);
        let clip: Vec<Vec4> = geometry.vertices.iter().map(|v| transform(camera, v.position)).collect();
        let triangles = Vec::with_capacity(geometry.triangles.len());
        let mut projected = Self { vertices: geometry.vertices.clone(), triangles };
        for &triangle in &geometry.triangles {
            let corners = triangle.map(|index| Corner { clip: clip[index as usize], index });
            if corners.iter().all(|corner| before_near(corner.clip)) {
                projected.push(corners, size);
            } else {
                projected.clip(corners, size);
            }
        }
        projected
    }

    /// Cuts a triangle at the near plane: none, one or two remain.
    fn clip(&mut self, corners: [Corner; 3], size: Vec2) {
        let mut polygon = Vec::with_capacity(4);
        for (here, next) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
            if before_near(here.clip) {
                polygon.push(here);
            }
            match (before_near(here.clip), before_near(next.clip)) {
                (true, false) => polygon.push(self.cut(here, next)),
                (false, true) => polygon.push(self.cut(next, here)),
                _ => {}
            }
        }
        for pair in polygon.get(1..).unwrap_or_default().windows(2) {
            self.push([polygon[0], pair[0], pair[1]], size);
        }
    }

    /// Where the edge meets the near plane, counted from its visible end so that both neighbours get the same point.
    fn cut(&mut self, visible: Corner, hidden: Corner) -> Corner {
        let near = visible.clip.z;
        let part = (visible.clip.w - near) / (visible.clip.w - hidden.clip.w);
        let mix = |a: Vec3, b: Vec3| a + (b - a) * part;
        let [a, b] = [visible, hidden].map(|corner| self.vertices[corner.index as usize]);
        let mut clip = visible.clip + (hidden.clip - visible.clip) * part;
        clip.w = near;
        self.vertices.push(Vertex {
            position: mix(a.position, b.position),
            normal: mix(a.normal, b.normal),
            surface: a.surface,
        });
        Corner { clip, index: (self.vertices.len() - 1) as u32 }
    }

    /// Keeps the triangle if its front shows.
    fn push(&mut self, [a, b, c]: [Corner; 3], size: Vec2) {
        // Rows run downwards, which turns counter-clockwise into clockwise.
        let corners = [a, c, b];
        let [pa, pb, pc] = corners.map(|corner| on_screen(corner.clip, size));
        let (ab, ac) = (pb - pa, pc - pa);
        let area = ab.x * ac.y - ac.x * ab.y;
        if !(area > 0.0 && area.is_finite()) || outside(&[pa, pb, pc], size) {
            return;
        }
        let inverse = corners.map(|corner| 1.0 / corner.clip.w);
        // Weights of the second and third corner rise from 0 at the opposite edge to 1.
        let [second, third] = [Vec2::new(ac.y, -ac.x) / area, Vec2::new(-ab.y, ab.x) / area];
        let weight = |slope: Vec2, inverse: f32| Plane { at_reference: 0.0, slope: slope * inverse };
        let slope = second * (inverse[1] - inverse[0]) + third * (inverse[2] - inverse[0]);
        self.triangles.push(ScreenTriangle {
            corners: [pa, pb, pc],
            vertices: corners.map(|corner| corner.index),
            inverse_distance: Plane { at_reference: inverse[0], slope },
            weights: [weight(second, inverse[1]), weight(third, inverse[2])],
        });
    }
}

/// Matrix times point, in an order of operations that no instruction set changes.
fn transform(matrix: &Mat4, p: Vec3) -> Vec4 {
    matrix.x_axis * p.x + matrix.y_axis * p.y + matrix.z_axis * p.z + matrix.w_axis
}

/// The reversed depth z / w is 1 on the near plane.
fn before_near(clip: Vec4) -> bool {
    clip.w >= clip.z
}

fn on_screen(clip: Vec4, size: Vec2) -> Vec2 {
    Vec2::new(clip.x / clip.w * 0.5 + 0.5, 0.5 - clip.y / clip.w * 0.5) * size
}

fn outside(corners: &[Vec2; 3], size: Vec2) -> bool {
    let [a, b, c] = *corners;
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    high.x < 0.0 || high.y < 0.0 || low.x > size.x || low.y > size.y
}
