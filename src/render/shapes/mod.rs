//! Meshes of simple bodies: closed, outward wound, hard edges softened by bevels whose normals run smoothly from face to face.
//!
//! Turned bodies lie along +x and begin at the origin; blocks and spheres are centred. Lengths in world units. Sizes that do not fit
//! (a bevel wider than its body, fewer than three segments) are reduced or raised to the nearest that does.

mod blade;
mod block;
mod coil;
mod turned;
mod wire;

pub use blade::Blade;
pub use block::{block, floor};
pub use coil::{Coil, coil};
pub use turned::{arrow, cylinder, open_tube, sphere, tube};
pub use wire::wire;

use super::draw_list::Mesh;
use glam::Vec3;

impl Mesh {
    /// Adds a corner and returns its index.
    fn corner(&mut self, position: Vec3, normal: Vec3) -> u32 {
        self.positions.push(position);
        self.normals.push(normal.normalize_or(Vec3::X));
        (self.positions.len() - 1) as u32
    }

    /// Adds a four-sided face, corners counter-clockwise seen from outside.
    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangles.extend([[a, b, c], [a, c, d]]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::PI;

    fn corners(mesh: &Mesh, triangle: [u32; 3]) -> [Vec3; 3] {
        triangle.map(|index| mesh.positions[index as usize])
    }

    /// Divergence theorem: sum of a . (b x c) / 6, positive when wound outwards.
    fn signed_volume(mesh: &Mesh) -> f32 {
        mesh.triangles.iter().map(|&t| corners(mesh, t)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    /// Sum of the area vectors: zero for a closed surface.
    fn opening(mesh: &Mesh) -> f32 {
        mesh.triangles.iter().map(|&t| corners(mesh, t)).map(|[a, b, c]| (b - a).cross(c - a)).sum::<Vec3>().length()
    }

    /// Part of chord times thickness that the section of a blade fills: trapezoids between its four corners.
    const BLADE_SECTION: f32 = 0.28 * 0.54 + 0.34 * 0.89 + 0.38 * 0.48;

    fn bent_blade() -> Blade {
        Blade { length: 2.0, chord: [0.5, 0.5], thickness: [0.08, 0.08], stagger: [0.3, 0.9], stations: 9 }
    }

    #[test]
    fn a_bent_blade_keeps_its_length_and_reaches_its_deflection() {
        let blade = bent_blade();
        let deflection = [0.1, 0.5];
        let line: Vec<Vec3> = (0..=200).map(|n| blade.middle(n as f32 / 200.0, deflection)).collect();
        assert_eq!((line[0].y, line[200].y), (0.1, 0.6));
        let length: f32 = line.windows(2).map(|pair| (pair[1] - pair[0]).length()).sum();
        // What is left out is of fourth order in the slope, 3/2 of 0.5/2 at the tip: its mean over the span is below a tenth of that.
        assert!((length / 2.0 - 1.0).abs() < 0.1 * 0.375_f32.powi(4), "{length}");
    }

    fn bodies() -> Vec<(&'static str, Mesh, f32)> {
        let coil_shape = Coil { coil_radius: 0.5, wire_radius: 0.05, turns: 8.0, ..Coil::default() };
        let wire_length = 8.0 * (2.0 * PI * 0.5_f32).hypot((2.0 - 0.1) / 8.0);
        vec![
            ("block", block(Vec3::new(1.0, 2.0, 3.0), 0.05), 48.0),
            ("cylinder", cylinder(2.0, 0.5, 0.02, 48), 2.0 * PI * 0.25),
            ("tube", tube(2.0, 0.5, 0.3, 0.01, 48), 2.0 * PI * (0.25 - 0.09)),
            ("open tube", open_tube(2.0, 0.5, 0.3, [0.4, 1.2], 48), (PI - 0.6) * 2.0 * (0.25 - 0.09)),
            ("sphere", sphere(0.5, 32), 4.0 / 3.0 * PI * 0.125),
            ("arrow", arrow(2.0, 0.1, 0.5, 0.3, 32), PI * (0.01 * 1.5 + 0.09 * 0.5 / 3.0)),
            // The diagonals of twisted faces stand out, by some 5 % of the thickness.
            ("blade", bent_blade().mesh([0.1, 0.4]), 1.06 * BLADE_SECTION * 0.5 * 0.08 * 2.0),
            ("wire", wire(&[Vec3::ZERO, Vec3::X, Vec3::new(2.0, 0.5, 0.0)], 0.1, 24, false), PI * 0.01 * 2.118),
            ("coil", coil(2.0, &coil_shape), PI * 0.05 * 0.05 * wire_length),
        ]
    }

    #[test]
    fn bodies_are_closed_and_have_the_volume_of_their_formula() {
        for (name, mesh, expected) in bodies() {
            let volume = signed_volume(&mesh);
            // Inscribed polygons and bevels take away a few percent; the wire's seven sides most: 1 - sin(2 pi/7)/(2 pi/7) = 13 %.
            assert!(volume < expected && volume > 0.85 * expected, "{name}: {volume} against {expected}");
            // Rounding of some thousand area vectors of size below 1.
            assert!(opening(&mesh) < 1e-3, "{name} is open by {}", opening(&mesh));
        }
    }

    #[test]
    fn normals_are_unit_and_point_outwards() {
        for (name, mesh, _) in bodies().into_iter().chain([("floor", floor(2.0, 3.0), 0.0)]) {
            assert_eq!(mesh.positions.len(), mesh.normals.len());
            for &triangle in &mesh.triangles {
                let [a, b, c] = corners(&mesh, triangle);
                let face = (b - a).cross(c - a);
                assert!(face.length() > 0.0, "{name}: a triangle without area");
                for index in triangle {
                    let normal = mesh.normals[index as usize];
                    assert!((normal.length() - 1.0).abs() < 1e-5, "{name}: normal {normal}");
                    assert!(normal.dot(face) > 0.0, "{name}: normal {normal} against winding {face}");
                }
            }
        }
    }

    /// Negative control of the two tests above.
    #[test]
    fn a_reversed_body_has_negative_volume() {
        let mut mesh = block(Vec3::ONE, 0.1);
        mesh.triangles.iter_mut().for_each(|triangle| triangle.reverse());
        assert!(signed_volume(&mesh) < -7.0);
    }

    #[test]
    fn coil_reaches_from_zero_to_its_length_and_keeps_its_end_turns_closed() {
        let shape = Coil { coil_radius: 0.1, wire_radius: 0.01, turns: 8.0, ..Coil::default() };
        for length in [0.4, 0.6, 1.0] {
            let mesh = coil(length, &shape);
            let extent = |pick: fn(f32, f32) -> f32, start| mesh.positions.iter().map(|p| p.x).fold(start, pick);
            // The seven-sided wire and its slope leave up to 1 - cos(pi/7) = 10 % of the wire radius.
            assert!((extent(f32::min, 9.0)).abs() < 0.0012, "{length}");
            assert!((extent(f32::max, -9.0) - length).abs() < 0.0012, "{length}");
            let first_turn = &mesh.positions[..shape.sides * shape.segments_per_turn / 2];
            assert!(first_turn.iter().all(|p| p.x < 0.035), "the first half turn opened at length {length}");
        }
    }

    #[test]
    fn absurd_sizes_give_meshes_and_no_panic() {
        for size in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let shape = Coil { coil_radius: size, wire_radius: size, turns: size, segments_per_turn: 0, sides: 0 };
            let meshes = [
                block(Vec3::splat(size), size),
                cylinder(size, size, size, 0),
                tube(size, size, size, size, 0),
                open_tube(size, size, size, [size; 2], 0),
                sphere(size, 0),
                arrow(size, size, size, size, 0),
                coil(size, &shape),
            ];
            assert!(meshes.iter().all(|m| m.triangles.iter().flatten().all(|&i| (i as usize) < m.positions.len())));
        }
    }
}
