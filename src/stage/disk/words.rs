//! Words over a disk: headline, numbers of the blades, the sense in which forward waves run, contacts, time, what is magnified.

use super::geometry::{HEIGHT, TIP_RADIUS};
use super::model::{DiskModel, HUB_HALF};
use super::motion::{DiskInstant, DiskMotion};
use crate::model::{BladedDisk, Topology};
use crate::render::{Anchor, Camera, Colour, OverlayItem, Rectangle, Stroke, text_width};
use crate::stage::Solution;
use crate::stage::labels;
use crate::stage::layout::Layout;
use crate::stage::numbers;
use crate::stage::palette::{self, Palette};
use glam::{Vec2, Vec3};

/// Radius of the arrow of forward waves.
const ARROW: f32 = TIP_RADIUS + 0.5;
/// The arrow's ends, rad counter-clockwise from the right of the picture, and its points.
const ARROW_ENDS: [f32; 2] = [-0.84, -0.26];
const ARROW_POINTS: u32 = 16;

#[derive(Debug, Clone)]
pub struct Words {
    scale: f32,
    palette: Palette,
    /// Every so many blades have their number written.
    every: usize,
    /// The disk in a line, and what is magnified.
    parameters: String,
    magnified: String,
    place: &'static str,
}

impl Words {
    #[must_use]
    pub fn new(disk: &BladedDisk, motion: &DiskMotion, model: &DiskModel, scale: f32, palette: Palette) -> Self {
        let every = match disk.sectors {
            0..=16 => 1,
            17..=36 => 2,
            37..=120 => 10,
            _ => 50,
        };
        let kind = if disk.topology == Topology::Ring { "ring" } else { "open chain" };
        let unit = model.magnification() / model.geometry().blade.length;
        let between = motion.elements().first().is_some_and(|element| element.attachment.direction().count() == 2);
        Self {
            scale,
            palette,
            every,
            parameters: format!("{kind} of {} blades   κ = {}", disk.sectors, labels::short(disk.coupling)),
            magnified: format!("deflection 1 drawn as {unit:.2} blade lengths"),
            place: if between && disk.segments.is_none() { "between neighbours" } else { "contacts" },
        }
    }

    pub fn draw_headline(&self, title: &str, caption: (&str, f64), layout: &Layout, out: &mut Vec<OverlayItem>) {
        let room = layout.scene.max.x - layout.scene.min.x;
        labels::draw_headline(title, caption, &self.palette, (layout.scene.min, room), self.scale, out);
    }

    /// Numbers of the blades on the ring of the hub, where no blade hides them and they stand still, and the arrow of forward waves.
    pub fn draw_numbers(&self, model: &DiskModel, (camera, size): (&Camera, [u32; 2]), out: &mut Vec<OverlayItem>) {
        let geometry = model.geometry();
        for blade in (0..geometry.blades).step_by(self.every) {
            let place = geometry.place(model.ring_radius(), blade as f32, HUB_HALF);
            if let Some(position) = camera.project(place, size) {
                out.push(OverlayItem::Text {
                    position: position + Vec2::new(0.0, 4.5) * self.scale,
                    anchor: Anchor::Centre,
                    size: 12.0 * self.scale,
                    colour: palette::CARRIAGE_TEXT,
                    bold: true,
                    text: blade.to_string(),
                });
            }
        }
        if geometry.topology == Topology::Ring {
            self.draw_arrow(camera, size, out);
        }
    }

    /// Counter-clockwise seen from above, in front of the disk at the right.
    fn draw_arrow(&self, camera: &Camera, size: [u32; 2], out: &mut Vec<OverlayItem>) {
        // In front of the disk wherever it is seen from.
        let towards = camera.eye - camera.target;
        let [from, to] = ARROW_ENDS.map(|end| end + towards.x.atan2(towards.z));
        let place = |angle: f32, radius: f32| Vec3::new(radius * angle.cos(), HEIGHT, -radius * angle.sin());
        let at = |angle: f32, radius: f32| camera.project(place(angle, radius), size);
        let arc = (0..=ARROW_POINTS).map(|n| from + (to - from) * n as f32 / ARROW_POINTS as f32);
        let points: Option<Vec<Vec2>> = arc.map(|angle| at(angle, ARROW)).collect();
        let head: Option<Vec<Vec2>> = [(to + 0.075, ARROW), (to - 0.02, ARROW + 0.085), (to - 0.02, ARROW - 0.085)]
            .map(|(a, r)| at(a, r))
            .into_iter()
            .collect();
        let (Some(points), Some(head)) = (points, head) else { return };
        let colour = self.palette.masses[0];
        let mut beside = points[points.len() / 2] + Vec2::new(14.0, 12.0) * self.scale;
        let name = "forward waves";
        let most = size[0] as f32 - text_width(name, 12.0 * self.scale, false) - 6.0 * self.scale;
        if beside.x > most {
            // In a narrow picture below the arrow rather than cut.
            beside = Vec2::new(most, points[0].y + 16.0 * self.scale);
        }
        out.push(OverlayItem::Line { points, stroke: Stroke { width: 2.4 * self.scale, colour }, clip: None });
        out.push(OverlayItem::Polygon { points: head, fill: colour, clip: None });
        out.push(self.text(beside, Anchor::Left, 12.0, colour, name.to_owned()));
    }

    /// Contacts that slipped in the last period and time at the left, the disk and what is magnified at the right of the lines below the scene.
    pub fn draw_status(
        &self,
        now: &DiskInstant,
        slipping: usize,
        (apart, solution): (Option<f64>, Option<&Solution>),
        layout: &Layout,
        out: &mut Vec<OverlayItem>,
    ) {
        let (s, palette, origin, right) =
            (self.scale, &self.palette, layout.status(), layout.scene.max.x - 14.0 * self.scale);
        let mut left = origin.x;
        if !now.contacts.is_empty() {
            let count = now.contacts.len();
            let words = |slipping: usize| format!("one period: {slipping} of {count} slip");
            let colour = if slipping > 0 { palette.slip } else { palette.stick };
            let width = crate::render::text_width(&words(count), 15.0 * s, true) + 28.0 * s;
            let chip = Rectangle { min: origin, max: origin + Vec2::new(width, 28.0 * s) };
            out.push(OverlayItem::Box { area: chip, corner_radius: 14.0 * s, fill: colour, stroke: None });
            let middle = origin + Vec2::new(0.5 * width, 19.5 * s);
            out.push(OverlayItem::Text {
                position: middle,
                anchor: Anchor::Centre,
                size: 15.0 * s,
                colour: palette.chip_text,
                bold: true,
                text: words(slipping),
            });
            left += width + 16.0 * s;
        }
        out.push(OverlayItem::Text {
            position: Vec2::new(left, origin.y + 21.0 * s),
            anchor: Anchor::Left,
            size: 20.0 * s,
            colour: palette.text,
            bold: true,
            text: format!("t = {:.1}", now.time),
        });
        if let Some(solution) = solution {
            labels::draw_solution(solution, palette, origin - Vec2::new(0.0, labels::ABOVE[0]) * s, s, out);
        }
        let lower = Vec2::new(right, origin.y + 22.0 * s);
        out.push(self.text(lower, Anchor::Right, 14.0, palette.faint_text, self.parameters.clone()));
        let upper = Vec2::new(right, origin.y + 4.0 * s);
        out.push(self.text(upper, Anchor::Right, 12.0, palette.faint_text, self.magnified.clone()));
        if let Some(apart) = apart {
            let place = origin - Vec2::new(0.0, labels::ABOVE[1]) * s;
            let text = format!("exact solution {} away", numbers::with_power(apart));
            out.push(self.text(place, Anchor::Left, 13.0, palette.faint_text, text));
        }
        self.draw_key(layout, out);
    }

    /// What the colours of the contacts mean.
    fn draw_key(&self, layout: &Layout, out: &mut Vec<OverlayItem>) {
        let (s, palette) = (self.scale, &self.palette);
        let mut right = layout.scene.max.x - 14.0 * s;
        let y = layout.status().y - 14.0 * s;
        for (word, colour) in [("slip", palette.slip), ("stick", palette.stick)] {
            out.push(self.text(Vec2::new(right, y), Anchor::Right, 12.0, colour, word.to_owned()));
            right -= crate::render::text_width(word, 12.0 * s, false) + 6.0 * s;
            let centre = Vec2::new(right, y - 4.0 * s);
            out.push(OverlayItem::Disc { centre, radius: 4.0 * s, fill: colour, stroke: None });
            right -= 12.0 * s;
        }
        out.push(self.text(Vec2::new(right, y), Anchor::Right, 12.0, palette.faint_text, self.place.to_owned()));
    }

    fn text(&self, position: Vec2, anchor: Anchor, size: f32, colour: Colour, text: String) -> OverlayItem {
        OverlayItem::Text { position, anchor, size: size * self.scale, colour, bold: false, text }
    }
}
