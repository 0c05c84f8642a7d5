//! Sizes, places and poses of the rig's bodies: what a renderer needs to draw the engine's own world.

use crate::model::{ParameterError, Range};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Where the carriages stand and how large their collision shapes are. Collisions between bodies are off.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigGeometry {
    /// Half edge lengths of a carriage along x (the rail), y (up) and z.
    pub carriage: [f64; 3],
    /// From the rest position of one carriage to that of the next; the first rests at the origin. An offset along x costs
    /// digits in f32, since the engine then stores rest position plus displacement.
    pub offset: [f64; 3],
    /// Half edge lengths of the rail body, which carries all joints and is centred below the carriages.
    pub rail: [f64; 3],
}

impl Default for RigGeometry {
    /// Carriages side by side, one unit cube of edge 0.8 per unit of z.
    fn default() -> Self {
        Self { carriage: [0.4, 0.4, 0.4], offset: [0.0, 0.0, 1.0], rail: [4.0, 0.05, 0.5] }
    }
}

impl RigGeometry {
    /// # Errors
    /// [`ParameterError::OutOfRange`] unless half edges are finite and positive and offsets finite.
    pub fn validated(self) -> Result<Self, ParameterError> {
        for axis in 0..3 {
            Range::Positive.check(format!("carriage[{axis}]"), self.carriage[axis])?;
            Range::Positive.check(format!("rail[{axis}]"), self.rail[axis])?;
            Range::Finite.check(format!("offset[{axis}]"), self.offset[axis])?;
        }
        Ok(self)
    }

    /// Rest position of carriage `index`.
    #[must_use]
    pub fn rest_position(&self, index: usize) -> [f64; 3] {
        self.offset.map(|offset| index as f64 * offset)
    }

    /// Centre of the rail under `count` carriages.
    #[must_use]
    pub fn rail_position(&self, count: usize) -> [f64; 3] {
        let middle = 0.5 * count.saturating_sub(1) as f64;
        let [x, y, z] = self.offset.map(|offset| middle * offset);
        [x, y - self.carriage[1] - self.rail[1], z]
    }
}

/// Which body of the rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BodyRole {
    Rail,
    /// The carriage of an oscillator, numbered from 0.
    Carriage(usize),
    /// The fixed middle of a bladed disk; of a chain the beam below the blades.
    Hub,
    /// A blade, numbered from 0.
    Blade(usize),
    /// The disk segment under a blade, numbered as the blade.
    Segment(usize),
}

impl fmt::Display for BodyRole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rail => write!(f, "rail"),
            Self::Carriage(i) => write!(f, "carriage {i}"),
            Self::Hub => write!(f, "hub"),
            Self::Blade(j) => write!(f, "blade {j}"),
            Self::Segment(j) => write!(f, "segment {j}"),
        }
    }
}

/// A body as the engine has it: pose, and the size of its collision shape, a cuboid; the hub of a ring is a cylinder about its local y axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BodyPose {
    pub role: BodyRole,
    pub translation: [f64; 3],
    /// Unit quaternion x, y, z, w.
    pub rotation: [f64; 4],
    /// Along the local axes; of a cylinder its radius, half its height, its radius.
    pub half_extents: [f64; 3],
}

/// How far any carriage has left its rail, the largest values over all steps of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct JointDrift {
    /// Displacement across the rail, in the chain's unit of length.
    pub lateral: f64,
    /// Rotation, rad.
    pub rotation: f64,
}

impl JointDrift {
    pub(super) fn or_larger(self, other: Self) -> Self {
        Self { lateral: self.lateral.max(other.lateral), rotation: self.rotation.max(other.rotation) }
    }
}
