//! A scene that looks like the rig, for pictures and timings: shapes and colours only, no physics. Its objects use no function that differs between
//! platforms, so that their picture is the same everywhere.

use glam::{Affine3A, Mat3, Vec2, Vec3};
use std::f32::consts::TAU;
use std::sync::Arc;
use stickslip::render::shapes::{Coil, arrow, block, coil, cylinder, floor, sphere, tube};
use stickslip::render::{
    Anchor, Background, Camera, Colour, DrawList, Light, Material, Mesh, Object, OverlayItem, Rectangle, Stroke,
    text_width,
};

const STEEL: Material = material(0xb8_bd_c4, 0.32, 1.0);
const DARK_STEEL: Material = material(0x5c_62_6b, 0.45, 0.9);
const BRASS: Material = material(0xd9_b3_6a, 0.3, 1.0);
const BLUE: Material = material(0x2f_6f_b5, 0.38, 0.0);
const ORANGE: Material = material(0xd9_7a_2b, 0.38, 0.0);
const GRAPHITE: Material = material(0x3a_3f_47, 0.55, 0.0);
const FLOOR: Material = material(0xb9_bc_c1, 0.75, 0.0);
const STICK: Material = material(0x35_a8_6b, 0.5, 0.0);

const fn material(colour: u32, roughness: f32, metallic: f32) -> Material {
    Material { colour: Colour::rgb(colour), roughness, metallic, glow: 0.0 }
}

/// One picture; `phase` in rad moves the carriages.
pub fn picture(size: [u32; 2], phase: f32) -> DrawList {
    let scale = size[1] as f32 / 720.0;
    DrawList {
        size,
        background: Background { top: Colour::rgb(0xe9_ed_f2), bottom: Colour::rgb(0xb4_bb_c5) },
        camera: Camera {
            eye: Vec3::new(0.62, 1.25, 2.9),
            target: Vec3::new(0.0, 0.09, 0.06),
            up: Vec3::Y,
            vertical_field_of_view: 0.53,
            viewport: [0.0, 0.0, 0.68, 1.0],
        },
        light: Light {
            direction: Vec3::new(-0.55, 1.0, 0.75),
            colour: Colour::rgb(0xff_f4_e6),
            intensity: 0.95,
            sky: Colour::rgb(0xbc_c6_d4),
            ground: Colour::rgb(0x94_90_8c),
            shadow_centre: Vec3::new(0.0, 0.05, 0.0),
            shadow_radius: 1.1,
        },
        objects: rig(phase),
        overlay: panels(scale, size[0] as f32, phase),
    }
}

fn rig(phase: f32) -> Vec<Object> {
    let mut rig = Rig { objects: Vec::new() };
    let [first, second] = [-0.28 + 0.05 * swing(phase), 0.3 + 0.06 * swing(phase - 0.9)];
    rig.add(floor(8.0, 8.0), Vec3::ZERO, FLOOR);
    rig.objects[0].casts_shadow = false;
    // Bed, rail and end stops.
    rig.add(block(Vec3::new(0.86, 0.015, 0.2), 0.004), Vec3::Y * 0.015, GRAPHITE);
    for z in [-0.07, 0.07] {
        rig.add(block(Vec3::new(0.82, 0.012, 0.012), 0.003), Vec3::new(0.0, 0.042, z), STEEL);
    }
    for x in [-0.8, 0.8] {
        rig.add(block(Vec3::new(0.02, 0.11, 0.14), 0.005), Vec3::new(x, 0.13, 0.0), DARK_STEEL);
    }
    for (x, paint) in [(first, BLUE), (second, ORANGE)] {
        rig.carriage(x, paint);
    }
    rig.spring_and_damper(-0.78, first - 0.1);
    rig.spring_and_damper(first + 0.1, second - 0.1);
    rig.spring_and_damper(second + 0.1, 0.78);
    // Jenkins spring, slider and pad in front.
    let slider = first + 0.34;
    rig.add(block(Vec3::new(0.3, 0.012, 0.06), 0.004), Vec3::new(0.15, 0.042, 0.32), DARK_STEEL);
    rig.add(block(Vec3::new(0.27, 0.004, 0.045), 0.002), Vec3::new(0.15, 0.057, 0.32), STICK);
    rig.add(block(Vec3::new(0.045, 0.03, 0.035), 0.005), Vec3::new(slider, 0.092, 0.32), BRASS);
    rig.add(block(Vec3::new(0.02, 0.012, 0.11), 0.004), Vec3::new(first, 0.13, 0.23), DARK_STEEL);
    rig.add(block(Vec3::new(0.012, 0.035, 0.02), 0.003), Vec3::new(first, 0.11, 0.32), DARK_STEEL);
    rig.coil(first + 0.012, slider - 0.045, Vec3::new(0.0, 0.092, 0.32), [0.022, 0.0032, 9.0], BRASS);
    rig.arrow(first, 0.16 * swing(phase + 1.57));
    rig.objects
}

/// Something like a sine, of arithmetic alone: Bhaskara's formula.
fn swing(phase: f32) -> f32 {
    let turn = (phase / TAU).rem_euclid(1.0);
    let (half, sign) = if turn < 0.5 { (2.0 * turn, 1.0) } else { (2.0 * turn - 1.0, -1.0) };
    let hump = half * (1.0 - half);
    sign * 16.0 * hump / (5.0 - 4.0 * hump)
}

struct Rig {
    objects: Vec<Object>,
}

impl Rig {
    fn add(&mut self, mesh: Mesh, place: Vec3, material: Material) {
        self.place(mesh, Affine3A::from_translation(place), material);
    }

    fn place(&mut self, mesh: Mesh, transform: Affine3A, material: Material) {
        self.objects.push(Object { mesh: Arc::new(mesh), transform, material, casts_shadow: true });
    }

    fn carriage(&mut self, x: f32, paint: Material) {
        self.add(block(Vec3::new(0.1, 0.06, 0.11), 0.01), Vec3::new(x, 0.145, 0.0), paint);
        self.add(block(Vec3::new(0.085, 0.012, 0.1), 0.004), Vec3::new(x, 0.07, 0.0), DARK_STEEL);
        self.add(block(Vec3::new(0.05, 0.008, 0.06), 0.003), Vec3::new(x, 0.212, 0.0), STEEL);
        for (dx, dz) in [(-0.075, -0.085), (0.075, -0.085), (-0.075, 0.085), (0.075, 0.085)] {
            let turned = Mat3::from_cols(Vec3::Y, Vec3::NEG_X, Vec3::Z);
            let upright = Affine3A::from_mat3_translation(turned, Vec3::new(x + dx, 0.2, dz));
            self.place(cylinder(0.01, 0.008, 0.002, 12), upright, STEEL);
        }
    }

    fn coil(
        &mut self,
        from: f32,
        to: f32,
        place: Vec3,
        [coil_radius, wire_radius, turns]: [f32; 3],
        material: Material,
    ) {
        let shape = Coil { coil_radius, wire_radius, turns, ..Coil::default() };
        self.add(coil(to - from, &shape), place + Vec3::X * from, material);
    }

    fn spring_and_damper(&mut self, from: f32, to: f32) {
        self.coil(from, to, Vec3::new(0.0, 0.165, -0.045), [0.032, 0.005, 10.0], STEEL);
        let axis = Vec3::new(0.0, 0.135, 0.06);
        self.add(tube(0.17, 0.024, 0.019, 0.002, 28), axis + Vec3::X * (from + 0.03), GRAPHITE);
        self.add(cylinder(0.03, 0.01, 0.001, 16), axis + Vec3::X * from, DARK_STEEL);
        self.add(cylinder(0.012, 0.0235, 0.001, 28), axis + Vec3::X * (from + 0.024), DARK_STEEL);
        self.add(cylinder(to - from - 0.1, 0.0075, 0.001, 16), axis + Vec3::X * (from + 0.1), STEEL);
        self.add(cylinder(0.02, 0.0185, 0.002, 24), axis + Vec3::X * (from + 0.1), BRASS);
    }

    fn arrow(&mut self, x: f32, length: f32) {
        let sign = if length < 0.0 { -1.0 } else { 1.0 };
        let turn = Mat3::from_diagonal(Vec3::new(sign, 1.0, sign));
        let place = Affine3A::from_mat3_translation(turn, Vec3::new(x, 0.27, 0.0));
        let glow = Material { glow: 0.35, ..material(0xe0_38_3e, 0.5, 0.0) };
        self.place(arrow(length.abs().max(0.05), 0.008, 0.045, 0.02, 20), place, glow);
        self.place(sphere(0.012, 20), place, glow);
    }
}

const INK: Colour = Colour::rgb(0x2b_31_3a);
const FAINT: Colour = Colour::rgb(0x7b_84_90);

/// Three plots at the right, and a title.
fn panels(scale: f32, width: f32, phase: f32) -> Vec<OverlayItem> {
    let mut overlay = Page { scale, items: Vec::new() };
    overlay.text(28.0, 44.0, 22.0, INK, true, Anchor::Left, "Two masses with a Jenkins element");
    overlay.text(
        28.0,
        68.0,
        14.0,
        FAINT,
        false,
        Anchor::Left,
        "ζ = −0.02    μN = 1.0    Ω₁ = 1.00 rad/s    x₁, ẋ₁, ẍ₁",
    );
    let left = width / scale - 408.0;
    for (index, title) in ["Displacement", "Phase plane", "Friction force"].into_iter().enumerate() {
        overlay.panel(left, 16.0 + 232.0 * index as f32, title, index, phase);
    }
    overlay.text(28.0, 696.0, 14.0, INK, false, Anchor::Left, "t = 12.40 s    stick");
    let end = 28.0 + text_width("t = 12.40 s    stick", 14.0, false);
    overlay.items.push(OverlayItem::Disc {
        centre: Vec2::new((end + 14.0) * scale, 691.0 * scale),
        radius: 5.0 * scale,
        fill: STICK.colour,
        stroke: None,
    });
    overlay.items
}

struct Page {
    scale: f32,
    items: Vec<OverlayItem>,
}

impl Page {
    fn area(&self, [left, top, right, bottom]: [f32; 4]) -> Rectangle {
        Rectangle { min: Vec2::new(left, top) * self.scale, max: Vec2::new(right, bottom) * self.scale }
    }

    #[expect(clippy::too_many_arguments, reason = "a line of text has that many properties")]
    fn text(&mut self, x: f32, y: f32, size: f32, colour: Colour, bold: bool, anchor: Anchor, text: &str) {
        let position = Vec2::new(x, y) * self.scale;
        self.items.push(OverlayItem::Text {
            position,
            anchor,
            size: size * self.scale,
            colour,
            bold,
            text: text.into(),
        });
    }

    fn line(&mut self, points: Vec<Vec2>, width: f32, colour: Colour, clip: Option<Rectangle>) {
        let points = points.into_iter().map(|point| point * self.scale).collect();
        self.items.push(OverlayItem::Line { points, stroke: Stroke { width: width * self.scale, colour }, clip });
    }

    fn panel(&mut self, left: f32, top: f32, title: &str, kind: usize, phase: f32) {
        let (right, bottom) = (left + 392.0, top + 224.0);
        let edge = Some(Stroke { width: self.scale, colour: Colour::rgb(0xc3_c9_d1) });
        let fill = Colour::rgb(0xfb_fc_fd).with_alpha(0.94);
        let area = self.area([left + 0.5, top + 0.5, right - 0.5, bottom - 0.5]);
        self.items.push(OverlayItem::Box { area, corner_radius: 8.0 * self.scale, fill, stroke: edge });
        self.text(left + 16.0, top + 26.0, 15.0, INK, true, Anchor::Left, title);
        let [x0, y0, x1, y1] = [left + 52.0, top + 40.0, right - 16.0, bottom - 36.0];
        let grid = Colour::rgb(0xdd_e1_e6);
        for step in 0..=4 {
            let part = step as f32 / 4.0;
            let (x, y) = ((x0 + (x1 - x0) * part).floor() + 0.5, (y0 + (y1 - y0) * part).floor() + 0.5);
            self.line(vec![Vec2::new(x, y0), Vec2::new(x, y1)], 1.0, grid, None);
            self.line(vec![Vec2::new(x0, y), Vec2::new(x1, y)], 1.0, grid, None);
            self.text(x, y1 + 15.0, 11.0, FAINT, false, Anchor::Centre, &format!("{}", step * 5));
            self.text(x0 - 7.0, y + 4.0, 11.0, FAINT, false, Anchor::Right, &format!("{:.1}", 1.0 - 2.0 * part));
        }
        self.text(
            (x0 + x1) / 2.0,
            y1 + 30.0,
            12.0,
            INK,
            false,
            Anchor::Centre,
            ["t in s", "x₁ in mm", "ẋ₁ in mm/s"][kind],
        );
        let clip = Some(self.area([x0, y0, x1, y1]));
        let place = |u: f32, v: f32| Vec2::new(x0 + (x1 - x0) * (0.5 + 0.5 * u), y0 + (y1 - y0) * (0.5 - 0.5 * v));
        let curve = |shift: f32| -> Vec<Vec2> {
            (0..=400)
                .map(|step| {
                    let part = step as f32 / 400.0;
                    let angle = part * TAU * 3.0 + shift + phase;
                    match kind {
                        0 => place(2.0 * part - 1.0, (0.3 + 0.55 * part) * angle.sin()),
                        1 => place((0.2 + 0.7 * part) * angle.sin(), (0.2 + 0.7 * part) * angle.cos()),
                        _ => place(2.0 * part - 1.0, (1.6 * angle.sin()).clamp(-0.8, 0.8)),
                    }
                })
                .collect()
        };
        let blue = curve(0.0);
        let marker = blue.last().copied().unwrap_or_default();
        self.line(curve(1.3), 1.6, ORANGE.colour, clip);
        self.line(blue, 1.6, BLUE.colour, clip);
        let stroke = Some(Stroke { width: 1.5 * self.scale, colour: Colour::rgb(0xff_ff_ff) });
        self.items.push(OverlayItem::Disc {
            centre: marker * self.scale,
            radius: 4.5 * self.scale,
            fill: BLUE.colour,
            stroke,
        });
    }
}
