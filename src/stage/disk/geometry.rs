//! Where blades stand: round a hub that lies level, blade 0 at the right, higher numbers counter-clockwise seen from above. A forward wave so
//! runs counter-clockwise. An open chain is the same with a gap between its last and its first blade.
//!
//! Lengths in the drawing's units; y is up, across the disk, and the direction in which blades move.

use crate::model::{BladedDisk, Topology};
use crate::render::shapes::Blade;
use glam::{Affine3A, Quat, Vec3};
use std::f32::consts::TAU;

/// Radius of the blade tips.
pub const TIP_RADIUS: f32 = 2.25;
/// Height of the disk's middle plane above the floor.
pub const HEIGHT: f32 = 0.95;
/// Largest angle between two blades of a chain, and the gap of a long one, rad.
const WIDEST: f32 = 0.5;
const GAP: f32 = 0.6;
/// Part of the span at which blades touch their neighbours.
pub const SHROUD: f32 = 0.62;

/// The shape of the whole disk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiskGeometry {
    pub blades: usize,
    pub topology: Topology,
    /// Angle from one blade to the next, rad.
    pub pitch: f32,
    pub hub_radius: f32,
    pub blade: Blade,
}

impl DiskGeometry {
    #[must_use]
    pub fn new(disk: &BladedDisk) -> Self {
        let blades = disk.sectors;
        let count = blades.max(1) as f32;
        let pitch = match disk.topology {
            Topology::Ring => TAU / count,
            Topology::Chain => ((TAU - GAP) / (count - 1.0).max(1.0)).min(WIDEST),
        };
        // Many blades are short and stand on a large hub, so that they are apart.
        let hub_radius = if blades > 36 { 1.3 } else { 0.95 };
        let chord = (0.9 * pitch * hub_radius).min(0.34);
        let blade = Blade {
            length: TIP_RADIUS - hub_radius,
            chord: [chord, 1.2 * chord],
            thickness: [0.24 * chord, 0.1 * chord],
            // Nearly level, so that those at either side show their faces, not their edges.
            stagger: [1.1, 1.35],
            stations: if blades > 36 { 6 } else { 9 },
        };
        Self { blades, topology: disk.topology, pitch, hub_radius, blade }
    }

    /// Angle of a place between blades, counted in blades, from the right counter-clockwise seen from above, rad.
    #[must_use]
    pub fn angle(&self, blade: f32) -> f32 {
        match self.topology {
            Topology::Ring => blade * self.pitch,
            // The middle of the row stands at the back, so that the gap is in front.
            Topology::Chain => 0.25 * TAU + (blade - 0.5 * (self.blades.max(1) - 1) as f32) * self.pitch,
        }
    }

    /// From a blade's own coordinates (x outwards, y up, z along the ring against the numbering) at the radius of its foot to the world.
    #[must_use]
    pub fn at(&self, blade: f32) -> Affine3A {
        let turn = Quat::from_rotation_y(self.angle(blade));
        Affine3A::from_rotation_translation(turn, turn * Vec3::new(self.hub_radius, 0.0, 0.0) + Vec3::Y * HEIGHT)
    }

    /// Place on the blade's middle line at a part of its span, for heights of its root and of its tip against the root.
    #[must_use]
    pub fn on_blade(&self, blade: usize, span: f32, deflection: [f32; 2]) -> Vec3 {
        self.at(blade as f32).transform_point3(self.blade.middle(span, deflection))
    }

    /// A place in the disk's plane by radius, place between blades, and height above the plane.
    #[must_use]
    pub fn place(&self, radius: f32, blade: f32, height: f32) -> Vec3 {
        self.at(blade).transform_point3(Vec3::new(radius - self.hub_radius, height, 0.0))
    }

    /// The blade after this one, if there is one.
    #[must_use]
    pub fn next(&self, blade: usize) -> Option<usize> {
        self.topology.neighbour(blade, 1, self.blades)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blades_are_numbered_counter_clockwise_seen_from_above_from_the_right() {
        let geometry = DiskGeometry::new(&BladedDisk::ring(12, 0.1));
        let tip = |blade| geometry.on_blade(blade, 1.0, [0.0; 2]) - Vec3::Y * HEIGHT;
        // Seen from above with x to the right, -z is up in the picture.
        assert!((tip(0) - Vec3::X * TIP_RADIUS).length() < 1e-5);
        assert!((tip(3) + Vec3::Z * TIP_RADIUS).length() < 1e-5);
        assert_eq!(geometry.next(11), Some(0));
    }

    #[test]
    fn a_chain_is_open_between_its_last_and_its_first_blade() {
        let disk = BladedDisk { topology: Topology::Chain, ..BladedDisk::ring(100, 0.1) };
        let geometry = DiskGeometry::new(&disk);
        let span = geometry.angle(99.0) - geometry.angle(0.0);
        assert!((TAU - span - GAP).abs() < 1e-4, "{span}");
        assert_eq!(geometry.next(99), None);
    }
}
