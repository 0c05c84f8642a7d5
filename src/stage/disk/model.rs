//! The disk in 3D: hub, blades coloured by their deflection, contacts coloured by their state, and a line through the tips that shows the wave.

use super::colours::DeflectionColours;
use super::geometry::{DiskGeometry, HEIGHT, SHROUD, TIP_RADIUS};
use super::motion::{DiskInstant, DiskMotion};
use crate::model::{Attachment, BladedDisk};
use crate::render::shapes::{block, cylinder, floor, sphere, tube, wire};
use crate::render::{Colour, Material, Mesh, Object};
use crate::stage::palette::{self, Palette};
use glam::{Affine3A, Mat3, Vec3};
use std::sync::Arc;

/// Height that the largest deflection of a film reaches at a blade's tip, and half the height of the hub.
const ROOM: f32 = 0.52;
pub const HUB_HALF: f32 = 0.15;
/// Inner and outer edge of the hub's upper ring, inside of the blades' feet.
const RING: [f32; 2] = [0.4, 0.18];
/// Radius of the line through the tips beyond them, and that of its zero.
const LINE_BEYOND: f32 = 0.1;
/// Light given off by a contact that sticks, and one that slips.
const GLOW: [f32; 2] = [0.0, 0.2];
/// Radius of what joins two blades at the shroud, and that of the mark in its middle.
const LINK: f32 = 0.032;
const PAD: f32 = 0.062;
/// Points of the line through the tips, at most.
const MOST_POINTS: usize = 240;

/// The parts of the disk that keep their shape, built once a film.
#[derive(Debug, Clone)]
pub struct DiskModel {
    palette: Palette,
    geometry: DiskGeometry,
    colours: DeflectionColours,
    has_segments: bool,
    /// Drawing units per non-dimensional unit of deflection.
    magnification: f32,
    fixed: Vec<Object>,
    foot: Arc<Mesh>,
    root: Arc<Mesh>,
    shroud: Arc<Mesh>,
    pad: Arc<Mesh>,
    tip: Arc<Mesh>,
}

impl DiskModel {
    /// `magnification` multiplies what fits.
    #[must_use]
    pub fn new(disk: &BladedDisk, colours: DeflectionColours, magnification: f32, palette: Palette) -> Self {
        let geometry = DiskGeometry::new(disk);
        let (pitch, radius) = (geometry.pitch, geometry.hub_radius);
        let across = (0.36 * pitch * radius).min(0.16);
        let part = SHROUD * geometry.blade.length + radius;
        let wing = (0.25 * pitch * part - 0.012).max(0.01);
        Self {
            palette,
            geometry,
            colours,
            has_segments: disk.segments.is_some(),
            magnification: magnification * ROOM / colours.limit() as f32,
            fixed: fixed_parts(&geometry, &palette),
            foot: Arc::new(block(Vec3::new(0.075, 0.045, across), 0.012)),
            root: Arc::new(block(Vec3::new(0.13, 0.085, 1.15 * across), 0.02)),
            shroud: Arc::new(block(Vec3::new(0.05, 0.022, wing), 0.008)),
            pad: Arc::new(sphere(PAD.min(0.3 * pitch * part), 14)),
            tip: Arc::new(sphere(if geometry.blades > 36 { 0.022 } else { 0.036 }, 12)),
        }
    }

    /// Drawing units per non-dimensional unit of deflection.
    #[must_use]
    pub fn magnification(&self) -> f32 {
        self.magnification
    }

    /// Radius of the middle of the hub's upper ring.
    #[must_use]
    pub fn ring_radius(&self) -> f32 {
        self.geometry.hub_radius - 0.5 * (RING[0] + RING[1])
    }

    #[must_use]
    pub fn geometry(&self) -> &DiskGeometry {
        &self.geometry
    }

    /// Heights of a blade's root, and of its tip against the root: the disk segment carries the blade where there is one.
    fn deflection(&self, now: &DiskInstant, blade: usize) -> [f32; 2] {
        let root = if self.has_segments { now.positions[self.geometry.blades + blade] } else { 0.0 };
        [root, now.positions[blade] - root].map(|x| self.magnification * x as f32)
    }

    /// Where the tip of a blade stands.
    #[must_use]
    pub fn tip(&self, now: &DiskInstant, blade: usize) -> Vec3 {
        self.geometry.on_blade(blade, 1.0, self.deflection(now, blade))
    }

    /// Everything as it stands at one instant.
    #[must_use]
    pub fn objects(&self, motion: &DiskMotion, now: &DiskInstant) -> Vec<Object> {
        let mut objects = self.fixed.clone();
        for blade in 0..self.geometry.blades {
            self.draw_blade(now, blade, &mut objects);
        }
        for (element, contact) in motion.elements().iter().zip(&now.contacts) {
            let material = palette::glowing(self.palette.contact(*contact), GLOW[usize::from(!contact.is_stick())]);
            self.draw_contact(now, element.attachment, material, &mut objects);
        }
        self.draw_line(now, &mut objects);
        objects
    }

    fn draw_blade(&self, now: &DiskInstant, blade: usize, objects: &mut Vec<Object>) {
        let deflection = self.deflection(now, blade);
        let place = self.geometry.at(blade as f32);
        let material = painted(self.colours.of(now.positions[blade]));
        let mesh = Arc::new(self.geometry.blade.mesh(deflection));
        objects.push(Object { mesh, transform: place, material, casts_shadow: true });
        let shift = Affine3A::from_translation(Vec3::new(-0.1, deflection[0], 0.0));
        let material = match self.has_segments {
            true => painted(self.colours.of(now.positions[self.geometry.blades + blade])),
            false => palette::SHOE,
        };
        objects.push(Object { mesh: self.root.clone(), transform: place * shift, material, casts_shadow: false });
    }

    fn draw_contact(&self, now: &DiskInstant, place: Attachment, material: Material, objects: &mut Vec<Object>) {
        let blades = self.geometry.blades;
        let push = |objects: &mut Vec<Object>, mesh: &Arc<Mesh>, transform, material| {
            objects.push(Object { mesh: mesh.clone(), transform, material, casts_shadow: false });
        };
        match place {
            Attachment::Between(i, j) if i < blades && j < blades => {
                let height = |blade: usize| {
                    let [root, bend] = self.deflection(now, blade);
                    self.geometry.blade.middle(SHROUD, [root, bend]).y
                };
                let radius = self.geometry.hub_radius + SHROUD * self.geometry.blade.length;
                let (first, next) = (i as f32, i as f32 + 1.0);
                for (blade, middle) in [(i, first + 0.25), (j, next - 0.25)] {
                    let radial = Vec3::new(radius - self.geometry.hub_radius, height(blade), 0.0);
                    let transform = self.geometry.at(middle) * Affine3A::from_translation(radial);
                    push(objects, &self.shroud, transform, palette::SEAT);
                }
                // The contact joins the ends of both wings, however far they are apart.
                let ends = [i, j].map(|blade| self.geometry.place(radius, first + 0.5, height(blade)));
                let link = Arc::new(wire(&ends, LINK, 6, false));
                push(objects, &link, Affine3A::IDENTITY, material);
                push(objects, &self.pad, Affine3A::from_translation(ends[0].midpoint(ends[1])), material);
            }
            Attachment::Ground(i) | Attachment::Between(i, _) => {
                let [root, _] = self.deflection(now, i);
                let shift = Affine3A::from_translation(Vec3::new(-0.1, root + 0.1, 0.0));
                push(objects, &self.foot, self.geometry.at(i as f32) * shift, material);
            }
        }
    }

    /// The line through the tips, smoothly from blade to blade (Catmull-Rom), with a mark at each.
    fn draw_line(&self, now: &DiskInstant, objects: &mut Vec<Object>) {
        let DiskGeometry { blades, .. } = self.geometry;
        let tips: Vec<Vec3> = (0..blades).map(|blade| self.tip(now, blade)).collect();
        for (blade, tip) in tips.iter().enumerate() {
            let transform = Affine3A::from_translation(*tip);
            let material = painted(self.colours.of(now.positions[blade]));
            objects.push(Object { mesh: self.tip.clone(), transform, material, casts_shadow: false });
        }
        let closed = self.geometry.next(blades - 1).is_some();
        let steps = (MOST_POINTS / blades).clamp(2, 12);
        let mesh = Arc::new(wire(&smooth(&tips, steps, closed), if blades > 36 { 0.008 } else { 0.014 }, 5, closed));
        let material = palette::glowing(self.palette.text, 0.25);
        objects.push(Object { mesh, transform: Affine3A::IDENTITY, material, casts_shadow: true });
    }
}

fn painted(colour: Colour) -> Material {
    Material { colour, roughness: 0.7, metallic: 0.0, glow: 0.12 }
}

/// Points on a Catmull-Rom curve through `points`, `steps` from each to the next.
fn smooth(points: &[Vec3], steps: usize, closed: bool) -> Vec<Vec3> {
    let count = points.len() as i64;
    let at = |index: i64| match closed {
        true => points[index.rem_euclid(count) as usize],
        false => points[index.clamp(0, count - 1) as usize],
    };
    let pieces = if closed { count } else { count - 1 };
    let inner = (0..pieces).flat_map(|piece| {
        let [a, b, c, d] = [-1, 0, 1, 2].map(|offset| at(piece + offset));
        (0..steps).map(move |step| {
            let t = step as f32 / steps as f32;
            0.5 * (2.0 * b
                + (c - a) * t
                + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t
                + (3.0 * b - a - 3.0 * c + d) * t * t * t)
        })
    });
    inner.chain((!closed).then(|| at(count - 1))).collect()
}

/// An upright body of revolution, its lower end at a height.
fn upright(mesh: Mesh, height: f32, material: Material) -> Object {
    let turn = Mat3::from_cols(Vec3::Y, Vec3::NEG_X, Vec3::Z);
    let transform = Affine3A::from_mat3_translation(turn, Vec3::Y * height);
    Object { mesh: Arc::new(mesh), transform, material, casts_shadow: true }
}

/// Floor, hub with its bore and bolts, pedestal, and the zero line of the tips.
fn fixed_parts(geometry: &DiskGeometry, palette: &Palette) -> Vec<Object> {
    let radius = geometry.hub_radius - 0.2;
    let [inner, outer] = RING.map(|inside| geometry.hub_radius - inside);
    let flat = |mesh: Mesh, material| Object {
        mesh: Arc::new(mesh),
        transform: Affine3A::IDENTITY,
        material,
        casts_shadow: false,
    };
    let mut parts = vec![
        flat(floor(40.0, 40.0), palette.floor),
        upright(tube(2.0 * HUB_HALF, outer, inner, 0.02, 72), HEIGHT - HUB_HALF, palette::PLATE),
        upright(cylinder(0.12, radius - 0.19, 0.01, 64), HEIGHT - 0.06, palette::SHOE),
        upright(cylinder(0.34, 0.3, 0.03, 40), HEIGHT - 0.12, palette::PLATE),
        upright(cylinder(0.06, 0.13, 0.015, 28), HEIGHT + 0.22, palette::ROD),
        upright(cylinder(HEIGHT, 0.2, 0.02, 32), 0.0, palette::SHOE),
        upright(cylinder(0.07, 0.6, 0.03, 48), 0.0, palette::PLATE),
    ];
    let bolts = 12;
    for bolt in 0..bolts {
        let angle = std::f32::consts::TAU * bolt as f32 / bolts as f32;
        let mut object = upright(cylinder(0.05, 0.035, 0.01, 10), HEIGHT + 0.06, palette::SCREW);
        let out = 0.5 * (0.3 + radius - 0.2);
        object.transform.translation += glam::Vec3A::new(out * angle.cos(), 0.0, -out * angle.sin());
        parts.push(object);
    }
    let count = geometry.blades;
    let closed = geometry.next(count - 1).is_some();
    let points = if closed { 96 } else { 72 };
    let last = if closed { count as f32 } else { (count - 1) as f32 };
    let rim: Vec<Vec3> = (0..points)
        .map(|n| n as f32 / (points - usize::from(!closed)) as f32 * last)
        .map(|blade| geometry.place(TIP_RADIUS + LINE_BEYOND, blade, 0.0))
        .collect();
    parts.push(flat(wire(&rim, 0.006, 4, closed), palette::glowing(palette.damping, 0.1)));
    parts
}
