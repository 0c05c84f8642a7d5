//! Bodies of revolution about the x axis.

use super::Mesh;
use crate::render::portable::sin_cos;
use glam::Vec3;
use std::f64::consts::{PI, TAU};

/// A point of the profile: place along the axis, radius, and the outward normal in that plane.
#[derive(Clone, Copy)]
struct Point {
    x: f32,
    radius: f32,
    normal: [f32; 2],
}

const fn point(x: f32, radius: f32, normal_x: f32, normal_radial: f32) -> Point {
    Point { x, radius, normal: [normal_x, normal_radial] }
}

/// Cosine and sine around the axis, `segments` (at least three) directions.
pub(super) fn directions(segments: usize) -> Vec<[f32; 2]> {
    let count = segments.max(3);
    (0..count)
        .map(|step| {
            let (sine, cosine) = sin_cos(TAU * step as f64 / count as f64);
            [cosine as f32, sine as f32]
        })
        .collect()
}

/// Turns profiles that run from the left end over the outside to the right end. Points on the axis become one corner each;
/// between one profile and the next the edge is hard.
fn turn(profiles: &[&[Point]], segments: usize) -> Mesh {
    let around = directions(segments);
    let mut mesh = Mesh::default();
    for profile in profiles {
        let rings: Vec<Vec<u32>> = profile.iter().map(|p| ring(&mut mesh, p, &around)).collect();
        for pair in rings.windows(2) {
            let [left, right] = pair else { continue };
            for (step, next) in (0..around.len()).map(|step| (step, (step + 1) % around.len())) {
                match (left.len(), right.len()) {
                    (1, 1) => {}
                    (1, _) => mesh.triangles.push([left[0], right[next], right[step]]),
                    (_, 1) => mesh.triangles.push([left[step], left[next], right[0]]),
                    _ => mesh.quad([left[step], left[next], right[next], right[step]]),
                }
            }
        }
    }
    mesh
}

fn ring(mesh: &mut Mesh, p: &Point, around: &[[f32; 2]]) -> Vec<u32> {
    let used = if p.radius == 0.0 { &around[..1] } else { around };
    used.iter()
        .map(|[cosine, sine]| {
            let place = |along, radial| Vec3::new(along, radial * cosine, radial * sine);
            mesh.corner(place(p.x, p.radius), place(p.normal[0], p.normal[1]))
        })
        .collect()
}

/// Solid cylinder from x = 0 to `length`.
#[must_use]
pub fn cylinder(length: f32, radius: f32, bevel: f32, segments: usize) -> Mesh {
    let b = fitting(bevel, length, radius);
    let profile = [
        point(0.0, 0.0, -1.0, 0.0),
        point(0.0, radius - b, -1.0, 0.0),
        point(b, radius, 0.0, 1.0),
        point(length - b, radius, 0.0, 1.0),
        point(length, radius - b, 1.0, 0.0),
        point(length, 0.0, 1.0, 0.0),
    ];
    turn(&[&profile], segments)
}

/// Hollow cylinder from x = 0 to `length`, open at both ends.
#[must_use]
pub fn tube(length: f32, outer_radius: f32, inner_radius: f32, bevel: f32, segments: usize) -> Mesh {
    let b = fitting(bevel, length, (outer_radius - inner_radius) / 2.0);
    let profile = [
        point(b, inner_radius, 0.0, -1.0),
        point(0.0, inner_radius + b, -1.0, 0.0),
        point(0.0, outer_radius - b, -1.0, 0.0),
        point(b, outer_radius, 0.0, 1.0),
        point(length - b, outer_radius, 0.0, 1.0),
        point(length, outer_radius - b, 1.0, 0.0),
        point(length, inner_radius + b, 1.0, 0.0),
        point(length - b, inner_radius, 0.0, -1.0),
        point(b, inner_radius, 0.0, -1.0),
    ];
    turn(&[&profile], segments)
}

/// Tube from x = 0 to `length` without the sector of `opening` (rad) about the direction `towards` (rad from +y to +z): what is inside
/// can be seen. Edges are hard.
#[must_use]
pub fn open_tube(
    length: f32,
    outer_radius: f32,
    inner_radius: f32,
    [towards, opening]: [f32; 2],
    segments: usize,
) -> Mesh {
    let count = segments.max(3);
    let angle = |value: f32, least, most| if value.is_finite() { f64::from(value).clamp(least, most) } else { 0.0 };
    let (towards, opening) = (angle(towards, -TAU, TAU), angle(opening, 0.0, 6.0));
    let (first, span) = (towards + opening / 2.0, TAU - opening);
    let around: Vec<[f32; 2]> = (0..=count)
        .map(|step| {
            let (sine, cosine) = sin_cos(first + span * step as f64 / count as f64);
            [cosine as f32, sine as f32]
        })
        .collect();
    let inner = inner_radius.min(outer_radius * 0.999);
    let mut mesh = Mesh::default();
    let mut strip = |from: [f32; 2], to: [f32; 2], normal: [f32; 2]| {
        let mut previous: Option<[u32; 2]> = None;
        for [cosine, sine] in &around {
            let place = |[x, radius]: [f32; 2]| Vec3::new(x, radius * cosine, radius * sine);
            let ring = [from, to].map(|end| mesh.corner(place(end), place(normal)));
            if let Some([left, right]) = previous {
                mesh.quad([left, ring[0], ring[1], right]);
            }
            previous = Some(ring);
        }
    };
    strip([0.0, outer_radius], [length, outer_radius], [0.0, 1.0]);
    strip([length, inner], [0.0, inner], [0.0, -1.0]);
    strip([0.0, inner], [0.0, outer_radius], [-1.0, 0.0]);
    strip([length, outer_radius], [length, inner], [1.0, 0.0]);
    for (end, sign) in [(around[0], -1.0), (around[count], 1.0)] {
        let [cosine, sine] = end;
        let normal = Vec3::new(0.0, -sine, cosine) * sign;
        let corners = [[0.0, inner], [0.0, outer_radius], [length, outer_radius], [length, inner]]
            .map(|[x, radius]| mesh.corner(Vec3::new(x, radius * cosine, radius * sine), normal));
        let [a, b, c, d] = corners;
        mesh.quad(if sign > 0.0 { [d, c, b, a] } else { [a, b, c, d] });
    }
    mesh
}

/// Sphere about the origin, `segments` around and half as many from pole to pole.
#[must_use]
pub fn sphere(radius: f32, segments: usize) -> Mesh {
    let steps = (segments / 2).max(2);
    let profile: Vec<Point> = (0..=steps)
        .map(|step| match step {
            0 => point(-radius, 0.0, -1.0, 0.0),
            last if last == steps => point(radius, 0.0, 1.0, 0.0),
            _ => {
                let (sine, cosine) = sin_cos(PI * step as f64 / steps as f64);
                let (sine, cosine) = (sine as f32, -cosine as f32);
                point(radius * cosine, radius * sine, cosine, sine)
            }
        })
        .collect();
    turn(&[&profile], segments)
}

/// Arrow from x = 0 to `length`: a shaft and a conical head.
#[must_use]
pub fn arrow(length: f32, shaft_radius: f32, head_length: f32, head_radius: f32, segments: usize) -> Mesh {
    let neck = length - head_length.min(length);
    let b = fitting(shaft_radius * 0.2, neck, shaft_radius);
    let shaft = [
        point(0.0, 0.0, -1.0, 0.0),
        point(0.0, shaft_radius - b, -1.0, 0.0),
        point(b, shaft_radius, 0.0, 1.0),
        point(neck, shaft_radius, 0.0, 1.0),
    ];
    let back = [point(neck, shaft_radius, -1.0, 0.0), point(neck, head_radius, -1.0, 0.0)];
    // Cut off just before the axis: so the tip keeps a slanted normal in every direction.
    let tip = [length - head_length * 1e-3, head_radius * 1e-3];
    let cone = [point(neck, head_radius, head_radius, head_length), point(tip[0], tip[1], head_radius, head_length)];
    let end = [point(tip[0], tip[1], 1.0, 0.0), point(tip[0], 0.0, 1.0, 0.0)];
    turn(&[&shaft, &back, &cone, &end], segments)
}

/// A bevel that leaves something of the body, and is never zero, so that no face loses its area.
fn fitting(bevel: f32, length: f32, radius: f32) -> f32 {
    let room = (length / 2.0).min(radius).max(0.0);
    bevel.max(room * 1e-3).min(room * 0.9)
}
