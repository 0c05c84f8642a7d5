//! Bladed disks in Rapier: N blades (and their disk segments) on prismatic joints round a fixed hub, or along a beam.

mod flow;
mod geometry;

pub use flow::{DiskArrival, DiskFlow};
pub use geometry::{BladeMotion, DiskGeometry};
