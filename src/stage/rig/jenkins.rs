//! The Jenkins element: a spring from carriage 1 to a slider block that a normal force presses on a friction pad. It glows in the colour of
//! its contact state, and leaves a trail on the pad where it slid, which fades.

use super::{HALF, HEIGHT, JENKINS_LINE, SLIDER_REST, cuboid, links, object};
use crate::render::shapes::{arrow, block};
use crate::render::{Colour, Material, Mesh, Object};
use crate::stage::motion::{Instant, Motion};
use crate::stage::palette::{self, Palette};
use glam::{Affine3A, Mat3, Vec3};
use std::sync::Arc;

/// Upper face of the pad, its thickness, and its half length and width.
pub(super) const PAD_TOP: f32 = 0.34;
pub(super) const PAD_THICKNESS: f32 = 0.06;
pub(super) const PAD_HALF: [f32; 2] = [0.72, 0.2];
/// Half edges of the slider block, and half length and height of its foot on the pad.
const SLIDER: Vec3 = Vec3::new(0.1, 0.09, 0.12);
const FOOT: [f32; 2] = [0.06, 0.035];
/// Where the arrow of the normal force begins and how long it is.
pub(super) const NORMAL_TOP: f32 = JENKINS_LINE[0] + SLIDER.y + 0.42;
const NORMAL_LENGTH: f32 = 0.38;
/// Time after which a trail has faded to 1/e, and how far back it is looked for, non-dimensional.
const FADING: f64 = 9.0;
const MEMORY: f64 = 30.0;
/// Pieces of the pad's length that have their own colour.
const CELLS: usize = 72;

#[derive(Debug, Clone)]
pub(super) struct Jenkins {
    slider: Arc<Mesh>,
    foot: Arc<Mesh>,
    cell: Arc<Mesh>,
    normal_force: Arc<Mesh>,
    magnification: f32,
    /// Largest rate at which the slider slid in the film.
    fastest: f64,
}

/// Speed of the slider on its pad: that of mass 1 while slipping.
fn sliding_speed(at: &Instant) -> f64 {
    if at.contact.is_stick() { 0.0 } else { at.velocities[0].abs() }
}

impl Jenkins {
    pub fn new(motion: &Motion, magnification: f32) -> Self {
        let cell = Vec3::new(PAD_HALF[0] / CELLS as f32, 0.002, SLIDER.z - 0.012);
        Self {
            slider: Arc::new(block(SLIDER, 0.022)),
            foot: Arc::new(block(Vec3::new(FOOT[0], 0.5 * FOOT[1], SLIDER.z - 0.012), 0.006)),
            cell: Arc::new(block(cell, 0.0)),
            normal_force: Arc::new(arrow(NORMAL_LENGTH, 0.028, 0.15, 0.075, 20)),
            magnification,
            fastest: motion.largest(sliding_speed),
        }
    }

    /// Place of the slider along x. The spring is as long as at rest where f = 0: its elongation is f, and the slider stands at x1 - f.
    pub fn place(&self, at: &Instant) -> f32 {
        SLIDER_REST + self.magnification * (at.bodies[0].displacement[0] - at.slider_force) as f32
    }

    pub fn draw(&self, motion: &Motion, now: &Instant, carriage: f32, palette: &Palette, objects: &mut Vec<Object>) {
        let [y, z] = JENKINS_LINE;
        let x = self.place(now);
        objects.push(cuboid(
            [PAD_HALF[0], 0.5 * PAD_THICKNESS, PAD_HALF[1]],
            0.012,
            [SLIDER_REST, PAD_TOP - 0.5 * PAD_THICKNESS, z],
            palette::PAD,
        ));
        self.draw_trail(motion, now, palette, objects);
        // The faster it slides, the brighter it glows.
        let heat = if self.fastest > 0.0 { (sliding_speed(now) / self.fastest) as f32 } else { 0.0 };
        let body = palette::glowing(palette.contact(now.contact), 0.1 + 0.4 * heat);
        objects.push(object(self.slider.clone(), Vec3::new(x, y, z), body));
        let foot = Material { glow: 0.6 * heat, ..palette::BRASS };
        let foot = if heat > 0.0 { Material { colour: palette.slip, ..foot } } else { foot };
        objects.push(object(self.foot.clone(), Vec3::new(x, PAD_TOP + 0.5 * FOOT[1], z), foot));
        let downwards = Mat3::from_cols(Vec3::NEG_Y, Vec3::X, Vec3::Z);
        let transform = Affine3A::from_mat3_translation(downwards, Vec3::new(x, NORMAL_TOP, z));
        let mesh = self.normal_force.clone();
        objects.push(Object { mesh, transform, material: palette.normal_force, casts_shadow: true });
        // A bracket carries the spring in front of carriage 1.
        let face = carriage - HALF - 0.05;
        objects.push(cuboid([0.045, 0.1, 0.14], 0.015, [face + 0.05, y, z], palette::SHOE));
        objects.push(cuboid([0.045, 0.06, 0.16], 0.012, [face + 0.09, HEIGHT - 0.12, HALF + 0.1], palette::SHOE));
        objects.extend(links::spring(x + SLIDER.x, face, JENKINS_LINE, 0.075, 9.0));
    }

    /// One strip for each piece of the pad over which the foot slid of late, the brighter the more recently.
    fn draw_trail(&self, motion: &Motion, now: &Instant, palette: &Palette, objects: &mut Vec<Object>) {
        let [left, width] = [SLIDER_REST - PAD_HALF[0], 2.0 * PAD_HALF[0] / CELLS as f32];
        let mut ages = [f64::INFINITY; CELLS];
        for at in motion.between((now.time - MEMORY).max(0.0), now.time, usize::MAX).filter(|at| !at.contact.is_stick())
        {
            let place = self.place(&at);
            let cell = |x: f32| ((x - left) / width).clamp(0.0, CELLS as f32 - 1.0) as usize;
            ages[cell(place - FOOT[0])..=cell(place + FOOT[0])].fill(now.time - at.time);
        }
        for (index, age) in ages.into_iter().enumerate().filter(|(_, age)| age.is_finite()) {
            let freshness = (-age / FADING).exp() as f32;
            let x = left + width * (index as f32 + 0.5);
            let colour = mixed(palette::PAD.colour, palette.slip, freshness);
            let material = palette::glowing(colour, 0.25 * freshness * freshness);
            let strip = object(self.cell.clone(), Vec3::new(x, PAD_TOP + 0.0005, JENKINS_LINE[1]), material);
            objects.push(Object { casts_shadow: false, ..strip });
        }
    }
}

/// From `a` at 0 to `b` at 1.
fn mixed(a: Colour, b: Colour, part: f32) -> Colour {
    let mix = |i: usize| (f32::from(a.0[i]) + (f32::from(b.0[i]) - f32::from(a.0[i])) * part).round() as u8;
    Colour([mix(0), mix(1), mix(2), 255])
}
