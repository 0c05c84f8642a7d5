//! Blades of a turbomachine: twisted, tapered plates with a lens-shaped section, bent like a cantilever.
//!
//! With the span s from 0 (root) to 1 (tip), length L and tip deflection d of a cantilever loaded at its tip,
//!
//! ```text
//! y(s) = y_root + d s^2 (3 - s)/2,     x(s) = s L - d^2/(2 L) (3 s^3 - 9/4 s^4 + 9/20 s^5)
//! ```
//!
//! the second term keeping the length of the bent blade to second order.

use super::Mesh;
use crate::render::portable::sin_cos;
use glam::Vec3;

/// Place along the chord (-1/2 to 1/2) and half thickness, as a part of the largest, of the upper side's corners; blunt edges.
const SECTION: [[f32; 2]; 4] = [[-0.5, 0.16], [-0.22, 0.92], [0.12, 0.86], [0.5, 0.1]];
/// Height of the mean line over the chord there, as a part of the chord: camber.
const CAMBER: [f32; 4] = [0.0, 0.07, 0.075, 0.0];
const AROUND: usize = 2 * SECTION.len();

/// A blade along +x from its root at the origin; y is up, across the disk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blade {
    pub length: f32,
    /// At root and tip, as are the following.
    pub chord: [f32; 2],
    pub thickness: [f32; 2],
    /// Angle of the chord from the y axis towards +z, rad.
    pub stagger: [f32; 2],
    /// Sections along the span, at least 2.
    pub stations: usize,
}

impl Blade {
    /// Place of the middle of the section at span `s`, for the root at height `root` and the tip deflected by `bend` against it.
    #[must_use]
    pub fn middle(&self, s: f32, [root, bend]: [f32; 2]) -> Vec3 {
        let shortening = s * s * s * (3.0 - 2.25 * s + 0.45 * s * s);
        Vec3::new(
            s * self.length - 0.5 * bend * bend / self.length * shortening,
            root + 0.5 * bend * s * s * (3.0 - s),
            0.0,
        )
    }

    /// The bent blade.
    #[must_use]
    pub fn mesh(&self, deflection: [f32; 2]) -> Mesh {
        let stations = self.stations.max(2);
        let mut mesh = Mesh::default();
        let mut previous: Option<[u32; AROUND]> = None;
        for station in 0..stations {
            let ring = self.ring(&mut mesh, station as f32 / (stations - 1) as f32, deflection);
            if let Some(inner) = previous {
                for (a, b) in (0..AROUND).map(|corner| (corner, (corner + 1) % AROUND)) {
                    mesh.quad([inner[a], ring[a], ring[b], inner[b]]);
                }
            }
            previous = Some(ring);
        }
        for (s, sign) in [(0.0, -1.0), (1.0, 1.0)] {
            let ring = self.ring(&mut mesh, s, deflection);
            let along = self.axes(s, deflection)[0] * sign;
            ring.iter().for_each(|&corner| mesh.normals[corner as usize] = along);
            // From the upper side to the lower one, which is hollow: a fan would fold over.
            for corner in 0..SECTION.len() - 1 {
                let face = [corner, corner + 1, AROUND - 2 - corner, AROUND - 1 - corner].map(|place| ring[place]);
                let [a, b, c, d] = face;
                mesh.quad(if sign > 0.0 { [d, c, b, a] } else { face });
            }
        }
        mesh
    }

    /// Unit vectors along the span, along the chord, and out of the upper side.
    fn axes(&self, s: f32, [root, bend]: [f32; 2]) -> [Vec3; 3] {
        let ahead = self.middle(s + 0.01, [root, bend]) - self.middle(s - 0.01, [root, bend]);
        let along = ahead.normalize_or(Vec3::X);
        let [from, to] = self.stagger;
        let (sine, cosine) = sin_cos(f64::from(from + (to - from) * s));
        let chord = Vec3::new(0.0, cosine as f32, sine as f32);
        let out = along.cross(chord).normalize_or(Vec3::Z);
        [along, out.cross(along), out]
    }

    fn ring(&self, mesh: &mut Mesh, s: f32, deflection: [f32; 2]) -> [u32; AROUND] {
        let mix = |[from, to]: [f32; 2]| from + (to - from) * s;
        let (chord, half) = (mix(self.chord), 0.5 * mix(self.thickness));
        let [_, across, out] = self.axes(s, deflection);
        let middle = self.middle(s, deflection);
        let corner = |index: usize| {
            let (place, side) = if index < SECTION.len() { (index, 1.0) } else { (AROUND - 1 - index, -1.0) };
            let [u, thickness] = SECTION[place];
            [u * chord, CAMBER[place] * chord + side * thickness * half]
        };
        std::array::from_fn(|index| {
            let [u, t] = corner(index);
            let (before, after) = (corner((index + AROUND - 1) % AROUND), corner((index + 1) % AROUND));
            // Out of the section: across the line between its neighbours, which run from the leading edge over the upper side.
            let normal = across * (before[1] - after[1]) + out * (after[0] - before[0]);
            mesh.corner(middle + across * u + out * t, normal)
        })
    }
}
