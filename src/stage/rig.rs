//! The rig in 3D: rail, carriages, springs, damper, Jenkins element, self-excitation.
//!
//! Lengths in the drawing's units. Carriages rest at `REST` along x; displacements are magnified so that the largest of the
//! film fits between the parts, the same factor throughout.

use super::motion::Instant;
use super::{contact_colour, palette};
use crate::model::RigParameters;
use crate::render::shapes::{Coil, arrow, block, coil, cylinder, floor};
use crate::render::{Material, Mesh, Object};
use glam::{Affine3A, Quat, Vec3};
use std::sync::Arc;

/// Rest positions of the carriages along the rail, and half edges of a carriage.
const REST: [f32; 2] = [-0.95, 1.15];
const CARRIAGE: Vec3 = Vec3::new(0.38, 0.33, 0.48);
/// Centre of the carriages above the floor, and the posts' inner faces.
const HEIGHT: f32 = 0.6;
const POSTS: [f32; 2] = [-2.95, 2.6];
/// Rest position and half edges of the slider block.
const SLIDER_REST: f32 = -2.05;
const SLIDER: Vec3 = Vec3::new(0.19, 0.13, 0.11);
/// Largest magnified displacement, and largest approach of the carriages: more would drive the damper's barrel into mass 2.
const ROOM: f32 = 0.5;
const APPROACH: f32 = 0.72;
/// Lines along which the elements act: height and depth.
const GROUND_LINE: [f32; 2] = [HEIGHT + 0.09, -0.17];
const COUPLING_LINE: [f32; 2] = [HEIGHT + 0.11, -0.14];
const DAMPER_LINE: [f32; 2] = [HEIGHT - 0.1, 0.22];
const JENKINS_LINE: [f32; 2] = [HEIGHT - 0.22, 0.36];
/// Length of the self-excitation's arrow at the largest speed.
const ARROW: f32 = 0.75;

/// The parts of the rig that keep their shape, built once a film.
#[derive(Debug, Clone)]
pub struct RigModel {
    carriage: Arc<Mesh>,
    slider: Arc<Mesh>,
    fixed: Vec<Object>,
    /// Drawing units per non-dimensional unit of length.
    magnification: f32,
    /// Arrow length per unit of velocity, signed: along the force of the self-excitation.
    arrow_per_velocity: f32,
}

/// Largest values over a film, non-dimensional.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    pub displacement: f64,
    /// Of mass 1 towards mass 2.
    pub approach: f64,
    pub speed: f64,
}

fn object(mesh: Arc<Mesh>, place: Vec3, material: Material) -> Object {
    Object { mesh, transform: Affine3A::from_translation(place), material, casts_shadow: true }
}

impl RigModel {
    #[must_use]
    pub fn new(parameters: &RigParameters, largest: Extremes) -> Self {
        let room = ROOM / (largest.displacement as f32).max(1.0);
        let approach = APPROACH / (largest.approach as f32).max(0.1);
        let sign = if parameters.xi1 < 0.0 { 1.0 } else { -1.0 };
        Self {
            carriage: Arc::new(block(CARRIAGE, 0.035)),
            slider: Arc::new(block(SLIDER, 0.025)),
            fixed: fixed_parts(),
            magnification: room.min(approach),
            arrow_per_velocity: sign * ARROW / (largest.speed as f32).max(0.1),
        }
    }

    /// Everything as it stands at one instant.
    #[must_use]
    pub fn objects(&self, now: &Instant) -> Vec<Object> {
        let x: [f32; 2] = std::array::from_fn(|i| REST[i] + self.magnification * now.positions[i] as f32);
        // The Jenkins spring is as long as at rest where f = 0: its elongation is f, and the slider stands at x1 - f.
        let slider = SLIDER_REST + self.magnification * (now.positions[0] - now.slider_force) as f32;
        let mut objects = self.fixed.clone();
        for (place, colour) in x.into_iter().zip([palette::FIRST, palette::SECOND]) {
            objects.push(object(self.carriage.clone(), Vec3::new(place, HEIGHT, 0.0), palette::painted(colour)));
        }
        let faces = [x[0] - CARRIAGE.x, x[0] + CARRIAGE.x, x[1] - CARRIAGE.x, x[1] + CARRIAGE.x];
        objects.push(spring(POSTS[0], faces[0], GROUND_LINE, 0.105, 13.0));
        objects.push(spring(faces[1], faces[2], COUPLING_LINE, 0.095, 9.0));
        objects.push(spring(faces[3], POSTS[1], GROUND_LINE, 0.105, 9.0));
        objects.extend(damper(faces[1], faces[2]));
        objects.extend(self.jenkins(slider, faces[0], now));
        objects.extend(self.excitation(x, now));
        objects
    }

    fn jenkins(&self, slider: f32, carriage_face: f32, now: &Instant) -> [Object; 2] {
        let [y, z] = JENKINS_LINE;
        let material = palette::glowing(contact_colour(now.contact));
        [
            object(self.slider.clone(), Vec3::new(slider, y, z), material),
            spring(slider + SLIDER.x, carriage_face, JENKINS_LINE, 0.06, 9.0),
        ]
    }

    /// Arrows over the carriages along the force of the self-excitation, which follows the velocity.
    fn excitation(&self, x: [f32; 2], now: &Instant) -> Vec<Object> {
        (0..2)
            .filter_map(|i| {
                let length = self.arrow_per_velocity * now.velocities[i] as f32;
                (length.abs() > 0.04).then(|| {
                    let head = 0.16_f32.min(0.6 * length.abs());
                    let mesh = Arc::new(arrow(length.abs(), 0.025_f32.min(0.4 * head), head, 0.44 * head, 16));
                    let turn = if length < 0.0 { Quat::from_rotation_y(std::f32::consts::PI) } else { Quat::IDENTITY };
                    let place = Vec3::new(x[i], HEIGHT + CARRIAGE.y + 0.17, 0.0);
                    let transform = Affine3A::from_rotation_translation(turn, place);
                    Object { mesh, transform, material: palette::glowing(palette::EXCITATION), casts_shadow: true }
                })
            })
            .collect()
    }
}

/// A coil spring from `from` to `to` along x.
fn spring(from: f32, to: f32, [y, z]: [f32; 2], radius: f32, turns: f32) -> Object {
    let shape = Coil { coil_radius: radius, wire_radius: 0.14 * radius, turns, segments_per_turn: 20, sides: 6 };
    object(Arc::new(coil((to - from).max(0.02), &shape)), Vec3::new(from, y, z), palette::SPRING)
}

/// Cylinder held by the left carriage, piston rod by the right one.
fn damper(from: f32, to: f32) -> [Object; 2] {
    let [y, z] = DAMPER_LINE;
    let barrel = 0.44 * (REST[1] - REST[0] - 2.0 * CARRIAGE.x);
    let rod = (to - from - 0.3 * barrel).max(0.05);
    [
        object(Arc::new(cylinder(barrel, 0.085, 0.015, 28)), Vec3::new(from, y, z), palette::DAMPER),
        object(Arc::new(cylinder(rod, 0.03, 0.005, 18)), Vec3::new(to - rod, y, z), palette::ROD),
    ]
}

fn fixed_parts() -> Vec<Object> {
    let [left, right] = POSTS;
    let middle = 0.5 * (left + right);
    let half_length = 0.5 * (right - left) + 0.45;
    let block = |half, bevel, place, material| object(Arc::new(block(half, bevel)), place, material);
    let pad_top = JENKINS_LINE[0] - SLIDER.y;
    let mut parts = vec![
        Object { casts_shadow: false, ..object(Arc::new(floor(40.0, 40.0)), Vec3::ZERO, palette::FLOOR) },
        block(Vec3::new(half_length, 0.05, 0.62), 0.02, Vec3::new(middle, 0.05, 0.0), palette::POST),
        block(
            Vec3::new(0.62, 0.5 * (pad_top - 0.1), 0.13),
            0.012,
            Vec3::new(SLIDER_REST - 0.02, 0.1 + 0.5 * (pad_top - 0.1), JENKINS_LINE[1]),
            palette::PAD,
        ),
    ];
    for z in [-0.2, 0.2] {
        let rail = Arc::new(cylinder(right - left, 0.045, 0.005, 24));
        parts.push(object(rail, Vec3::new(left, HEIGHT - CARRIAGE.y - 0.035, z), palette::RAIL));
    }
    for x in [left - 0.1, right + 0.1] {
        parts.push(block(Vec3::new(0.1, 0.5, 0.56), 0.03, Vec3::new(x, 0.58, 0.0), palette::POST));
    }
    parts
}
