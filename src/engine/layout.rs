//! Where the bodies of a world stand: one fixed base, and one movable body per oscillator that slides along its own local x axis.

use super::geometry::{BodyRole, RigGeometry};

/// Acceleration of gravity, in the chain's units. Its amount does not matter for the motion, across which it points: it is there so that
/// the joints have a load to carry, as those of a real rig do.
pub(super) const GRAVITY: f64 = 9.81;

/// Unit quaternion x, y, z, w of no rotation.
pub(super) const UPRIGHT: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

/// A collision shape by its half extents along the body's own axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    Cuboid([f64; 3]),
    /// About the local y axis.
    Cylinder {
        radius: f64,
        half_height: f64,
    },
}

/// A body at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stand {
    pub role: BodyRole,
    pub position: [f64; 3],
    /// Unit quaternion x, y, z, w; turns the local x axis into the direction of motion.
    pub rotation: [f64; 4],
    pub shape: Shape,
}

/// The bodies of a world.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    pub gravity: [f64; 3],
    pub base: Stand,
    /// One per oscillator, in their order.
    pub movers: Vec<Stand>,
}

impl Layout {
    /// `count` carriages on a rail along x.
    pub(super) fn rig(geometry: &RigGeometry, count: usize) -> Self {
        let upright = |role, position, half| Stand { role, position, rotation: UPRIGHT, shape: Shape::Cuboid(half) };
        let carriage = |i| upright(BodyRole::Carriage(i), geometry.rest_position(i), geometry.carriage);
        Self {
            gravity: [0.0, -GRAVITY, 0.0],
            base: upright(BodyRole::Rail, geometry.rail_position(count), geometry.rail),
            movers: (0..count).map(carriage).collect(),
        }
    }
}
