//! Helical compression spring.
//!
//! The wire's centre runs at x(theta) = r_wire + integral of p(theta) dtheta / 2 pi. The pitch p is the wire's thickness in the dead turn
//! at either end, so that those turns stay closed, and one value in the middle that makes the spring as long as asked, with a linear passage
//! of half a turn between them.

use super::Mesh;
use super::turned::directions;
use crate::render::portable::sin_cos;
use glam::Vec3;
use std::f64::consts::TAU;

/// Closed turns at either end.
const DEAD_TURNS: f64 = 1.0;
/// Turns over which the pitch passes from closed to open.
const PASSAGE: f64 = 0.5;

/// What a coil spring is made of, apart from its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coil {
    /// Of the wire's centre line.
    pub coil_radius: f32,
    pub wire_radius: f32,
    /// All of them, with the closed turn at either end.
    pub turns: f32,
    pub segments_per_turn: usize,
    /// Of the wire's cross section.
    pub sides: usize,
}

impl Default for Coil {
    fn default() -> Self {
        Self { coil_radius: 0.05, wire_radius: 0.006, turns: 9.0, segments_per_turn: 22, sides: 7 }
    }
}

/// Spring along +x from 0 to `length`. The same shape at every length has the same triangles, so only its positions change.
#[must_use]
pub fn coil(length: f32, shape: &Coil) -> Mesh {
    let turns = f64::from(if shape.turns.is_finite() { shape.turns.clamp(3.0, 200.0) } else { 3.0 });
    let segments = (turns * shape.segments_per_turn.clamp(3, 256) as f64).ceil() as usize;
    let wire = Wire {
        coil_radius: shape.coil_radius,
        radius: shape.wire_radius,
        section: directions(shape.sides.clamp(3, 64)),
        pitch: Pitch::new(f64::from(length), f64::from(shape.wire_radius), turns),
    };
    let mut mesh = Mesh::default();
    let start = wire.cap(&mut mesh, 0.0, -1.0);
    let mut previous: Option<Vec<u32>> = None;
    for segment in 0..=segments {
        let turn = turns * segment as f64 / segments as f64;
        let ring = wire.ring(&mut mesh, turn);
        if let Some(left) = previous {
            for (side, next) in (0..ring.len()).map(|side| (side, (side + 1) % ring.len())) {
                mesh.quad([left[side], left[next], ring[next], ring[side]]);
            }
        }
        previous = Some(ring);
    }
    let end = wire.cap(&mut mesh, turns, 1.0);
    for side in 1..wire.section.len() - 1 {
        mesh.triangles.push([start[0], start[side + 1], start[side]]);
        mesh.triangles.push([end[0], end[side], end[side + 1]]);
    }
    mesh
}

/// The wire bent into a coil: places on it are counted in turns from its start.
struct Wire {
    coil_radius: f32,
    radius: f32,
    section: Vec<[f32; 2]>,
    pitch: Pitch,
}

/// Centre and axes of one cross section; `outward x binormal = tangent`.
struct Frame {
    centre: Vec3,
    outward: Vec3,
    binormal: Vec3,
    tangent: Vec3,
}

impl Wire {
    fn frame(&self, turn: f64) -> Frame {
        let (sine, cosine) = sin_cos(TAU * turn);
        let outward = Vec3::new(0.0, cosine as f32, sine as f32);
        let around = Vec3::new(0.0, -sine as f32, cosine as f32);
        let tangent =
            (Vec3::X * (self.pitch.slope(turn) / TAU) as f32 + around * self.coil_radius).normalize_or(around);
        let centre = Vec3::X * (self.radius + self.pitch.advance(turn) as f32) + outward * self.coil_radius;
        Frame { centre, outward, binormal: tangent.cross(outward), tangent }
    }

    fn ring(&self, mesh: &mut Mesh, turn: f64) -> Vec<u32> {
        let frame = self.frame(turn);
        let normal = |[cosine, sine]: &[f32; 2]| frame.outward * *cosine + frame.binormal * *sine;
        self.section.iter().map(normal).map(|n| mesh.corner(frame.centre + n * self.radius, n)).collect()
    }

    /// The cross section again, its normals along the wire.
    fn cap(&self, mesh: &mut Mesh, turn: f64, sign: f32) -> Vec<u32> {
        let tangent = self.frame(turn).tangent;
        let ring = self.ring(mesh, turn);
        ring.iter().for_each(|&index| mesh.normals[index as usize] = tangent * sign);
        ring
    }
}

/// Advance per turn along the coil.
struct Pitch {
    turns: f64,
    total: f64,
    closed: f64,
    open: f64,
}

impl Pitch {
    fn new(length: f64, wire: f64, turns: f64) -> Self {
        let total = (length - 2.0 * wire).max(0.0);
        let closed = (2.0 * wire).min(total / turns);
        let ends = 2.0 * DEAD_TURNS + PASSAGE;
        Self { turns, total, closed, open: (total - closed * ends) / (turns - ends) }
    }

    fn slope(&self, turn: f64) -> f64 {
        let from_end = turn.min(self.turns - turn);
        self.closed + (self.open - self.closed) * ((from_end - DEAD_TURNS) / PASSAGE).clamp(0.0, 1.0)
    }

    /// Integral of [`Pitch::slope`].
    fn advance(&self, turn: f64) -> f64 {
        if turn > self.turns / 2.0 {
            return self.total - self.advance(self.turns - turn);
        }
        let opened = (turn - DEAD_TURNS).max(0.0);
        let gained = if opened < PASSAGE { opened * opened / (2.0 * PASSAGE) } else { opened - PASSAGE / 2.0 };
        self.closed * turn + (self.open - self.closed) * gained
    }
}
