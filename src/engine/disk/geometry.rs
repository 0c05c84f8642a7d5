//! Sizes and places of the bodies of a bladed disk.
//!
//! ```text
//! ring:   hub a cylinder about z, blade j at the angle 2 pi j/N from x towards y, so that forward waves run counterclockwise seen from +z
//! chain:  hub a beam along x, blade j at x = j pitch, standing up along y
//!
//! local axes of a blade or segment:   x direction of motion,   y radially outward (up),   z across
//! tangential:  x towards the next blade        axial:  x along the axis of the disk (of a chain: across the row)
//! ```

use crate::engine::geometry::BodyRole;
use crate::engine::layout::{GRAVITY, Layout, Shape, Stand};
use crate::model::{BladedDisk, ParameterError, Range, Topology};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Which way the blades move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BladeMotion {
    /// In the plane of the disk, positive towards the next blade.
    #[default]
    Tangential,
    /// Along the axis of the disk.
    Axial,
}

/// How large the bodies are; a displacement of 1 is a length of 1. Collisions are off, and the motion does not depend on sizes but for
/// rounding: in f32 a wide ring costs digits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiskGeometry {
    pub motion: BladeMotion,
    /// Distance between neighbours along the rim of the hub, which so has the radius `N pitch/(2 pi)`.
    pub pitch: f64,
    /// Half edge lengths of a blade along its local x, y (root to tip) and z.
    pub blade: [f64; 3],
    /// Of a disk segment, which lies between hub and blade.
    pub segment: [f64; 3],
    /// Half the thickness of the hub.
    pub hub: f64,
}

impl Default for DiskGeometry {
    /// Blades 4 apart: neighbours in opposite motion of amplitude 1.5 just pass.
    fn default() -> Self {
        Self { motion: BladeMotion::Tangential, pitch: 4.0, blade: [0.3, 3.0, 1.0], segment: [0.8, 0.6, 1.2], hub: 1.5 }
    }
}

impl DiskGeometry {
    /// # Errors
    /// [`ParameterError::OutOfRange`] unless all sizes are finite and positive.
    pub fn validated(self) -> Result<Self, ParameterError> {
        Range::Positive.check("pitch", self.pitch)?;
        Range::Positive.check("hub", self.hub)?;
        for axis in 0..3 {
            Range::Positive.check(format!("blade[{axis}]"), self.blade[axis])?;
            Range::Positive.check(format!("segment[{axis}]"), self.segment[axis])?;
        }
        Ok(self)
    }

    /// Radius of the hub of a ring.
    #[must_use]
    pub fn hub_radius(&self, sectors: usize) -> f64 {
        sectors as f64 * self.pitch / TAU
    }

    pub(super) fn layout(&self, disk: &BladedDisk) -> Layout {
        let n = disk.sectors;
        let height = if disk.segments.is_some() { 2.0 * self.segment[1] } else { 0.0 };
        let at = |role, j, rise, half| self.stand(role, disk, j, rise, half);
        let mut movers: Vec<Stand> =
            (0..n).map(|j| at(BodyRole::Blade(j), j, height + self.blade[1], self.blade)).collect();
        if disk.segments.is_some() {
            movers.extend((0..n).map(|j| at(BodyRole::Segment(j), j, self.segment[1], self.segment)));
        }
        // Across the motion of every blade.
        let gravity = match self.motion {
            BladeMotion::Tangential => [0.0, 0.0, -GRAVITY],
            BladeMotion::Axial => [0.0, -GRAVITY, 0.0],
        };
        Layout { gravity, base: self.hub(disk), movers }
    }

    fn hub(&self, disk: &BladedDisk) -> Stand {
        let n = disk.sectors;
        match disk.topology {
            Topology::Ring => Stand {
                role: BodyRole::Hub,
                position: [0.0; 3],
                // Local y along z.
                rotation: [FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2],
                shape: Shape::Cylinder { radius: self.hub_radius(n), half_height: self.hub },
            },
            Topology::Chain => Stand {
                role: BodyRole::Hub,
                position: [0.5 * (n - 1) as f64 * self.pitch, -self.hub, 0.0],
                rotation: crate::engine::layout::UPRIGHT,
                shape: Shape::Cuboid([0.5 * n as f64 * self.pitch, self.hub, self.hub]),
            },
        }
    }

    /// A body whose centre is `rise` above the rim at sector j.
    fn stand(&self, role: BodyRole, disk: &BladedDisk, j: usize, rise: f64, half: [f64; 3]) -> Stand {
        let n = disk.sectors;
        let shape = Shape::Cuboid(half);
        match disk.topology {
            Topology::Ring => {
                let angle = TAU * j as f64 / n as f64;
                let radius = self.hub_radius(n) + rise;
                let position = [radius * angle.cos(), radius * angle.sin(), 0.0];
                Stand { role, position, rotation: self.turned(angle), shape }
            }
            Topology::Chain => {
                // As at the top of a ring: up is y, forward is +x.
                let position = [j as f64 * self.pitch, rise, 0.0];
                Stand { role, position, rotation: self.on_a_row(), shape }
            }
        }
    }

    /// Local axes (x, y, z) at an angle of a ring: (tangent, radius, -axis), or (axis, radius, tangent).
    fn turned(&self, angle: f64) -> [f64; 4] {
        // Half of the angle from the blade at the top, angle pi/2, whose y is up.
        let (s, c) = (0.5 * (angle - 0.25 * TAU)).sin_cos();
        let spin = [0.0, 0.0, s, c];
        let at_the_top = match self.motion {
            // x to -x, z to -z: half a turn about y.
            BladeMotion::Tangential => [0.0, 1.0, 0.0, 0.0],
            // x to z: a quarter turn back about y.
            BladeMotion::Axial => [0.0, -FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2],
        };
        product(spin, at_the_top)
    }

    fn on_a_row(&self) -> [f64; 4] {
        match self.motion {
            BladeMotion::Tangential => crate::engine::layout::UPRIGHT,
            BladeMotion::Axial => [0.0, -FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2],
        }
    }
}

/// Product of quaternions (x, y, z, w): the rotation b, then a.
fn product(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    let ([ax, ay, az, aw], [bx, by, bz, bw]) = (a, b);
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `q v q^-1`.
    fn turn(q: [f64; 4], v: [f64; 3]) -> [f64; 3] {
        let conjugate = [-q[0], -q[1], -q[2], q[3]];
        let [x, y, z, _] = product(product(q, [v[0], v[1], v[2], 0.0]), conjugate);
        [x, y, z]
    }

    #[test]
    fn blades_point_outward_and_move_along_the_rim_or_the_axis() {
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
        for angle in [0.0, 0.7, 2.0, 4.0, 6.0] {
            let (s, c) = f64::sin_cos(angle);
            let (tangent, radius, axis) = ([-s, c, 0.0], [c, s, 0.0], [0.0, 0.0, 1.0]);
            let along = DiskGeometry::default().turned(angle);
            assert!(near(turn(along, [1.0, 0.0, 0.0]), tangent) && near(turn(along, [0.0, 1.0, 0.0]), radius));
            let across = DiskGeometry { motion: BladeMotion::Axial, ..DiskGeometry::default() }.turned(angle);
            assert!(near(turn(across, [1.0, 0.0, 0.0]), axis) && near(turn(across, [0.0, 1.0, 0.0]), radius));
            assert!(near(turn(across, [0.0, 0.0, 1.0]), tangent));
        }
    }
}
