//! Springs and the damper between the carriages.

use super::{DAMPER_LINE, HALF, REST, cuboid, object};
use crate::render::Object;
use crate::render::shapes::{Coil, coil, cylinder, open_tube};
use crate::stage::palette;
use glam::Vec3;
use std::sync::Arc;

/// Thickness of a spring's seat.
const SEAT: f32 = 0.035;
/// Radii of the barrel, and how far it reaches beyond the faces of carriage 1: to the left of its left and the right of its right one.
const BARREL: [f32; 2] = [0.1, 0.082];
const REACH: [f32; 2] = [-0.1, 0.36];

/// A coil spring with a seat at either end, from `from` to `to` along x.
pub(super) fn spring(from: f32, to: f32, [y, z]: [f32; 2], radius: f32, turns: f32) -> [Object; 3] {
    let shape = Coil { coil_radius: radius, wire_radius: 0.15 * radius, turns, segments_per_turn: 22, sides: 7 };
    let length = (to - from - 2.0 * SEAT).max(0.02);
    let seat = Arc::new(cylinder(SEAT, 1.32 * radius, 0.008, 24));
    [
        object(Arc::new(coil(length, &shape)), Vec3::new(from + SEAT, y, z), palette::SPRING),
        object(seat.clone(), Vec3::new(from, y, z), palette::SEAT),
        object(seat, Vec3::new(to - SEAT, y, z), palette::SEAT),
    ]
}

/// Barrel along the front of carriage 1, cut open so that the piston in it is seen; rod on a bracket of carriage 2. At rest the
/// piston stands in the middle of the barrel.
pub(super) fn damper(x: [f32; 2]) -> Vec<Object> {
    let [y, z] = DAMPER_LINE;
    let (start, end) = (x[0] - HALF + REACH[0], x[0] + HALF + REACH[1]);
    let middle_at_rest = REST[0] + 0.5 * (REACH[0] + REACH[1]);
    let piston = x[1] + middle_at_rest - REST[1];
    let bracket = x[1] - HALF + 0.08;
    // Towards the camera: in front and above.
    let opening = [0.75, 1.9];
    let round = |length, radius, bevel| Arc::new(cylinder(length, radius, bevel, 24));
    let at = |x: f32| Vec3::new(x, y, z);
    vec![
        object(Arc::new(open_tube(end - start, BARREL[0], BARREL[1], opening, 30)), at(start), palette::BARREL),
        object(round(0.03, BARREL[0], 0.008), at(start - 0.03), palette::SEAT),
        object(round(0.045, BARREL[0], 0.008), at(end), palette::SEAT),
        object(round(0.07, BARREL[1] - 0.004, 0.01), at(piston - 0.035), palette::BRASS),
        object(round((bracket - piston).max(0.05), 0.03, 0.004), at(piston), palette::ROD),
        cuboid([0.06, 0.1, 0.08], 0.015, [bracket, y, HALF + 0.08], palette::SHOE),
        // What holds the barrel on carriage 1.
        cuboid([0.05, 0.045, 0.03], 0.008, [x[0] - 0.22, y - 0.05, HALF + 0.01], palette::SHOE),
        cuboid([0.05, 0.045, 0.03], 0.008, [x[0] + 0.22, y - 0.05, HALF + 0.01], palette::SHOE),
    ]
}
