//! Round wire along a line of points.

use super::Mesh;
use super::turned::directions;
use glam::Vec3;

/// Wire of the given radius through `points`, joined to a ring where `closed`. Fewer than two points make no wire.
#[must_use]
pub fn wire(points: &[Vec3], radius: f32, sides: usize, closed: bool) -> Mesh {
    let mut mesh = Mesh::default();
    let count = points.len();
    if count < 2 {
        return mesh;
    }
    let section = directions(sides);
    let rings: Vec<Vec<u32>> = (0..count)
        .map(|index| {
            let (before, after) = match closed {
                true => ((index + count - 1) % count, (index + 1) % count),
                false => (index.saturating_sub(1), (index + 1).min(count - 1)),
            };
            let along = (points[after] - points[before]).normalize_or(Vec3::X);
            // Upwards as far as possible: wires here lie more or less level, so that this does not turn over.
            let aside = along.cross(Vec3::Y).try_normalize().unwrap_or(Vec3::X);
            let up = aside.cross(along);
            let normal = |[c, s]: &[f32; 2]| aside * *c + up * *s;
            section.iter().map(normal).map(|n| mesh.corner(points[index] + n * radius, n)).collect()
        })
        .collect();
    let last = if closed { count } else { count - 1 };
    for (left, right) in (0..last).map(|index| (&rings[index], &rings[(index + 1) % count])) {
        for (a, b) in (0..section.len()).map(|side| (side, (side + 1) % section.len())) {
            mesh.quad([left[a], right[a], right[b], left[b]]);
        }
    }
    if !closed {
        let ends = [(0, points[0] - points[1]), (count - 1, points[count - 1] - points[count - 2])];
        for (index, out) in ends {
            let cap: Vec<u32> =
                rings[index].iter().map(|&corner| mesh.corner(mesh.positions[corner as usize], out)).collect();
            for side in 1..section.len() - 1 {
                let [a, b, c] = [cap[0], cap[side], cap[side + 1]];
                mesh.triangles.push(if index == 0 { [a, b, c] } else { [a, c, b] });
            }
        }
    }
    mesh
}
