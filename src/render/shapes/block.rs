//! Flat-faced bodies.

use super::Mesh;
use glam::Vec3;

/// Box centred at the origin, `half` its half extents, edges bevelled by `bevel`: 44 triangles.
#[must_use]
pub fn block(half: Vec3, bevel: f32) -> Mesh {
    let bevel = bevel.clamp(0.0, half.min_element().max(0.0) * 0.999).max(half.max_element() * 1e-4);
    let mut mesh = Mesh::default();
    // Every corner of the box becomes three: one on each adjoining face, drawn in by the bevel along the other two axes.
    let corners: Vec<[u32; 3]> = (0..8_usize)
        .map(|bits| {
            let sign = Vec3::from_array([0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 }));
            [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| {
                let inset = (Vec3::ONE - axis) * bevel;
                mesh.corner((half - inset) * sign, axis * sign)
            })
        })
        .collect();
    let at = |axis: usize, first: usize, second: usize, bits: [usize; 3]| {
        let mut shift = [0; 3];
        (shift[axis], shift[(axis + 1) % 3], shift[(axis + 2) % 3]) = (bits[0], bits[1], bits[2]);
        let index = shift[0] | shift[1] << 1 | shift[2] << 2;
        [corners[index][first], corners[index][second]]
    };
    for axis in 0..3 {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        for side in 0..2 {
            let face = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| at(axis, axis, axis, [side, u, v])[0]);
            mesh.quad(outward(face, side == 1));
        }
        for (u, v) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let [a, b] = at(axis, next, last, [0, u, v]);
            let [d, c] = at(axis, next, last, [1, u, v]);
            mesh.quad(outward([a, b, c, d], u == v));
        }
    }
    for (bits, &[x, y, z]) in corners.iter().enumerate() {
        mesh.triangles.push(if bits.count_ones() % 2 == 1 { [x, y, z] } else { [x, z, y] });
    }
    mesh
}

/// The face as listed, or seen from its other side.
fn outward(face: [u32; 4], listed: bool) -> [u32; 4] {
    let [a, b, c, d] = face;
    if listed { face } else { [d, c, b, a] }
}

/// Horizontal rectangle at y = 0 facing up, centred at the origin.
#[must_use]
pub fn floor(half_x: f32, half_z: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let face = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]]
        .map(|[x, z]| mesh.corner(Vec3::new(x * half_x, 0.0, z * half_z), Vec3::Y));
    mesh.quad(face);
    mesh
}
