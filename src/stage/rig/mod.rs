//! The rig in 3D: bench, carriages, springs, damper, Jenkins element, self-excitation.
//!
//! Lengths in the drawing's units. Carriages rest at `REST` along x; displacements are magnified so that the largest of the film fits
//! between the parts, the same factor throughout and in all directions: a carriage that leaves its rail or turns on it is seen to do so.

mod bench;
mod carriage;
mod excitation;
mod jenkins;
mod links;

use super::layout::{Shown, corners};
use super::motion::{Body, Instant, Motion};
use super::palette::Palette;
use crate::render::shapes::block;
use crate::render::{Material, Mesh, Object};
use crate::scene::Case;
use carriage::Carriage;
use excitation::Excitation;
use glam::{Affine3A, Quat, Vec3};
use jenkins::Jenkins;
use std::sync::Arc;

/// Rest positions of the carriages along the rails, and their centres' height above the floor.
const REST: [f32; 2] = [-0.85, 1.2];
const HEIGHT: f32 = 0.67;
/// Drawing units per unit of a collision shape: half edges of 0.4 become 0.36.
const BODY_SCALE: f32 = 0.9;
/// Half an edge of a carriage as it is at rest.
const HALF: f32 = 0.36;
/// Inner faces of the end plates.
const PLATES: [f32; 2] = [-3.0, 2.8];
/// Rest position of the slider, and the line along which the Jenkins element acts: height and depth.
const SLIDER_REST: f32 = -2.08;
const JENKINS_LINE: [f32; 2] = [0.5, 0.62];
/// Line of the springs between ground and carriages, and of the damper.
const SPRING_LINE: [f32; 2] = [HEIGHT + 0.1, -0.1];
const DAMPER_LINE: [f32; 2] = [HEIGHT - 0.13, 0.47];
/// Largest magnified displacement, and largest change of the carriages' distance: more would drive the piston out of its barrel.
const ROOM: f32 = 0.6;
const STROKE: f32 = 0.44;

/// Half the width and height of the end plates with their feet, and highest tip of an arrow.
const PLATE_CORNER: [f32; 2] = [0.55, 1.07];
const ARROW_TIP: f32 = 1.5;
/// The camera's distance.
const DISTANCE: f32 = 10.3;

/// What a camera shows: base plate, end plates, and the arrows over the carriages.
pub fn shown() -> Shown {
    let [left, right] = PLATES;
    let box_of = |[x0, x1]: [f32; 2], height: f32, [z0, z1]: [f32; 2]| {
        corners(Vec3::new(x0, 0.0, z0), Vec3::new(x1, height, z1))
    };
    let ends = [left - 0.48, right + 0.48];
    let [depth, top] = PLATE_CORNER;
    let points = box_of(ends, bench::PLATE_TOP, [-0.8, 1.08]).chain(box_of(ends, top, [-depth, depth])).chain(box_of(
        [REST[0] - ROOM, REST[1] + ROOM],
        ARROW_TIP,
        [0.0, 0.0],
    ));
    Shown { points: points.collect(), middle: Vec3::new(0.5 * (left + right), 0.5, 0.1), distance: DISTANCE }
}

/// The parts of the rig that keep their shape, built once a film.
#[derive(Debug, Clone)]
pub struct RigModel {
    palette: Palette,
    fixed: Vec<Object>,
    carriages: [Carriage; 2],
    jenkins: Jenkins,
    excitation: Option<Excitation>,
    /// Drawing units per non-dimensional unit of length.
    magnification: f32,
}

fn object(mesh: Arc<Mesh>, place: Vec3, material: Material) -> Object {
    Object { mesh, transform: Affine3A::from_translation(place), material, casts_shadow: true }
}

/// A block by its half edges, its bevel and its centre.
fn cuboid(half: [f32; 3], bevel: f32, place: [f32; 3], material: Material) -> Object {
    object(Arc::new(block(Vec3::from(half), bevel)), Vec3::from(place), material)
}

/// A block that stands on a plane: its lower bevel lies below the plane, where it would be a dark line that flickers.
fn standing(half: [f32; 3], bevel: f32, [x, foot, z]: [f32; 3], material: Material) -> Object {
    let [length, height, width] = half;
    cuboid([length, height + 0.5 * bevel, width], bevel, [x, foot + height - 0.5 * bevel, z], material)
}

impl RigModel {
    /// Where mass 1 is moved from outside nothing excites itself.
    #[must_use]
    pub fn new(case: &Case, motion: &Motion, palette: Palette) -> Self {
        let largest = |of: fn(&Instant) -> f64| motion.largest(of) as f32;
        let displacement = largest(|i| i.positions[0].abs().max(i.positions[1].abs()));
        let distance = largest(|i| i.positions[1] - i.positions[0]);
        let fitting = (ROOM / displacement.max(1.0)).min(STROKE / distance.max(0.1));
        let magnification = case.direction.magnification as f32 * fitting;
        let colours = palette.masses;
        Self {
            palette,
            fixed: bench::fixed_parts(&palette),
            carriages: [Carriage::new(colours[0]), Carriage::new(colours[1])],
            jenkins: Jenkins::new(motion, magnification),
            excitation: case
                .prescribed
                .is_none()
                .then(|| Excitation::new(case.excitation(), motion, palette.excitation)),
            magnification,
        }
    }

    /// Drawing units per non-dimensional unit of length.
    #[must_use]
    pub fn magnification(&self) -> f32 {
        self.magnification
    }

    /// Widths of a carriage at rest per non-dimensional unit of length.
    #[must_use]
    pub fn carriage_widths(&self) -> f32 {
        self.magnification / (2.0 * HALF)
    }

    /// Where a body is drawn.
    fn pose(&self, index: usize, body: &Body) -> Affine3A {
        let [x, y, z] = body.displacement.map(|d| self.magnification * d as f32);
        let [i, j, k, w] = body.rotation.map(|c| c as f32);
        let rotation = Quat::from_xyzw(i, j, k, w).normalize();
        Affine3A::from_rotation_translation(rotation, Vec3::new(REST[index] + x, HEIGHT + y, z))
    }

    /// Everything as it stands at one instant of `motion`.
    #[must_use]
    pub fn objects(&self, motion: &Motion, now: &Instant) -> Vec<Object> {
        let poses = [0, 1].map(|i| self.pose(i, &now.bodies[i]));
        let x = poses.map(|pose| pose.translation.x);
        let mut objects = self.fixed.clone();
        for ((carriage, pose), body) in self.carriages.iter().zip(poses).zip(&now.bodies) {
            carriage.draw(pose, body, &mut objects);
        }
        let [left, right] = SPRING_LINE;
        let line = [left, right];
        objects.extend(links::spring(PLATES[0], x[0] - HALF, line, 0.13, 12.0));
        objects.extend(links::spring(x[0] + HALF, x[1] - HALF, line, 0.12, 9.0));
        objects.extend(links::spring(x[1] + HALF, PLATES[1], line, 0.13, 9.0));
        objects.extend(links::damper(x));
        self.jenkins.draw(motion, now, x[0], &self.palette, &mut objects);
        if let Some(excitation) = &self.excitation {
            excitation.draw(x, now, &mut objects);
        }
        objects
    }

    /// Corners of carriage `index` displaced by `position` along its rail.
    #[must_use]
    pub fn outline(&self, index: usize, position: f64) -> [Vec3; 8] {
        let body = Body::on_the_rail(position);
        let pose = self.pose(index, &body);
        let half = Vec3::from(body.half_extents.map(|h| BODY_SCALE * h as f32));
        std::array::from_fn(|bits| {
            let sign = [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 });
            pose.transform_point3(half * Vec3::from(sign))
        })
    }

    /// Places in the world that words are written at; those of the carriages on their front or back.
    #[must_use]
    pub fn anchors(&self, now: &Instant, from_front: bool) -> Anchors {
        let depth = if from_front { HALF } else { -HALF };
        let front = |i: usize| self.pose(i, &now.bodies[i]).transform_point3(Vec3::new(0.0, 0.19, depth));
        let slider = self.jenkins.place(now);
        Anchors {
            masses: [front(0), front(1)],
            normal_force: Vec3::new(slider - 0.15, jenkins::NORMAL_TOP - 0.04, JENKINS_LINE[1]),
            pad: Vec3::new(SLIDER_REST, 0.2, JENKINS_LINE[1] + 0.24),
        }
    }
}

/// See [`RigModel::anchors`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anchors {
    pub masses: [Vec3; 2],
    pub normal_force: Vec3,
    pub pad: Vec3,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Outcome, Sample, State, Trajectory};
    use crate::model::{ContactState, Direction, EnergyLedger};
    use crate::scene::{Scene, Theme};

    /// Three instants: at rest, pulled to x1 = 1.5 with the slider slipping, and back by 0.5 sticking.
    fn motion() -> Motion {
        let slip = ContactState::Slip(Direction::Positive);
        let instants = [
            (0.0, [0.0, 0.0, 0.5, 0.0, 0.0], ContactState::Stick),
            (1.0, [1.5, 0.3, 0.5, 0.0, 1.0], slip),
            (2.0, [1.0, 0.3, -0.5, 0.0, 0.5], ContactState::Stick),
        ];
        let sample = |(time, state, contact)| Sample {
            time,
            state: State::two_mass(state),
            contacts: vec![contact],
            ledger: EnergyLedger::default(),
        };
        let samples = instants.map(sample).to_vec();
        Motion::new(&Trajectory { samples, events: vec![], outcome: Outcome::Completed }).unwrap()
    }

    fn model(motion: &Motion) -> RigModel {
        RigModel::new(&Scene::built_in().unwrap().1, motion, Palette::of(Theme::Dark))
    }

    /// The objects painted in a colour, and where they stand.
    fn painted(objects: &[Object], colour: crate::render::Colour) -> Vec<Affine3A> {
        objects.iter().filter(|o| o.material.colour == colour).map(|o| o.transform).collect()
    }

    #[test]
    fn carriages_stand_where_their_bodies_are() {
        let motion = motion();
        let (rig, palette) = (model(&motion), Palette::of(Theme::Dark));
        let now = motion.at(1.0);
        for (i, x) in [1.5, 0.3].into_iter().enumerate() {
            let found = painted(&rig.objects(&motion, &now), palette.masses[i]);
            assert_eq!(found.len(), 1);
            let expected = Vec3::new(REST[i] + rig.magnification * x, HEIGHT, 0.0);
            // Roundings of f32 numbers of size 1.
            assert!((Vec3::from(found[0].translation) - expected).length() < 1e-6);
        }
    }

    /// A fault of the engine: the second carriage has left its rail by 0.1 and is turned by a tenth of a radian.
    #[test]
    fn a_carriage_off_its_rail_is_drawn_off_its_rail() {
        let motion = motion();
        let (rig, colour) = (model(&motion), Palette::of(Theme::Dark).masses[1]);
        let mut now = motion.at(1.0);
        let sound = painted(&rig.objects(&motion, &now), colour)[0];
        now.bodies[1].displacement[1] += 0.1;
        now.bodies[1].rotation = [0.0, 0.05_f64.sin(), 0.0, 0.05_f64.cos()];
        let faulty = painted(&rig.objects(&motion, &now), colour)[0];
        assert!((faulty.translation.y - sound.translation.y - 0.1 * rig.magnification).abs() < 1e-6);
        let (edge, turned) = (sound.matrix3.x_axis.normalize(), faulty.matrix3.x_axis.normalize());
        assert!((edge.dot(turned) - 0.1_f32.cos()).abs() < 1e-6);
    }

    #[test]
    fn the_slider_stands_at_the_end_of_its_spring_and_shows_its_contact() {
        let motion = motion();
        let rig = model(&motion);
        let palette = Palette::of(Theme::Dark);
        for (time, x1, f, colour) in [(1.0, 1.5, 1.0, palette.slip), (2.0, 1.0, 0.5, palette.stick)] {
            let now = motion.at(time);
            let expected = SLIDER_REST + rig.magnification * (x1 - f);
            assert!((rig.jenkins.place(&now) - expected).abs() < 1e-6);
            let sliders = painted(&rig.objects(&motion, &now), colour);
            assert!(sliders.iter().any(|s| (s.translation.x - expected).abs() < 1e-6), "no slider in its colour");
        }
    }

    #[test]
    fn a_trail_is_left_where_the_slider_slid_and_nowhere_before() {
        let motion = motion();
        let rig = model(&motion);
        let strips = |time| {
            let now = motion.at(time);
            rig.objects(&motion, &now)
                .iter()
                .filter(|o| (o.transform.translation.y - jenkins::PAD_TOP - 0.0005).abs() < 1e-6)
                .count()
        };
        assert_eq!(strips(0.0), 0);
        assert!(strips(2.0) > 2, "{}", strips(2.0));
    }

    #[test]
    fn the_largest_motion_fits_between_the_parts() {
        let motion = motion();
        let rig = model(&motion);
        assert!(rig.magnification * 1.5 <= ROOM + 1e-6 && rig.magnification * 1.2 <= STROKE + 1e-6);
    }
}
