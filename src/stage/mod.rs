//! From a motion and its scene to the list of things to draw in each frame.
//!
//! A frame is a pure function of its index: it shows the motion at `index * speed / fps`.

mod envelope;
mod ghost;
mod labels;
mod layout;
mod motion;
mod palette;
mod panels;
mod plot;
mod rig;

pub use motion::{Body, Instant, Motion};
pub use panels::DampingMap;
pub use plot::{Axis, Plot};

use crate::render::{Anchor, Camera, DrawList, OverlayItem};
use crate::scene::Case;
use ghost::Ghost;
use glam::{Vec2, Vec3};
use layout::Layout;
use palette::Palette;
use panels::Panels;
use rig::RigModel;

/// What a film may show beside its motion.
#[derive(Debug, Clone, Default)]
pub struct Beside {
    /// The exact motion from the same start.
    pub exact: Option<Motion>,
    /// The diagram the scene is a part of.
    pub map: Option<DampingMap>,
}

/// One film: a case and its motion.
#[derive(Debug, Clone)]
pub struct Stage {
    case: Case,
    motion: Motion,
    palette: Palette,
    layout: Layout,
    rig: RigModel,
    ghost: Option<Ghost>,
    panels: Panels,
}

impl Stage {
    /// With what stands beside the motion, where there is something.
    #[must_use]
    pub fn new(case: Case, motion: Motion, beside: Beside) -> Self {
        let palette = Palette::of(case.film.theme);
        let layout = Layout::new([case.film.width, case.film.height], case.direction.panels().len());
        let panels = Panels::new(&case, &motion, beside.map.as_ref(), &layout.panels, layout.scale, palette);
        let rig = RigModel::new(&case.parameters, &motion, palette, case.prescribed.is_some());
        let ghost = beside.exact.and_then(|exact| Ghost::new(&motion, exact, rig.magnification()));
        Self { case, motion, palette, layout, rig, ghost, panels }
    }

    /// Frames that show the motion from its start to its end; fewer than the scene asks for where the motion diverged.
    #[must_use]
    pub fn frame_count(&self) -> u64 {
        let filled = (self.motion.end() / self.case.frame_interval() + 1e-9).floor() as u64 + 1;
        filled.min(self.case.frame_count())
    }

    /// Time of the motion shown in a frame.
    #[must_use]
    pub fn time(&self, index: u64) -> f64 {
        index as f64 * self.case.frame_interval()
    }

    /// The frame at `index`.
    #[must_use]
    pub fn frame(&self, index: u64) -> DrawList {
        let now = self.motion.at(self.time(index));
        let film = self.case.film;
        let size = [film.width, film.height];
        let camera = self.camera();
        let mut overlay = Vec::new();
        self.draw_words(&now, &camera, &mut overlay);
        self.panels.draw(&self.motion, &now, &mut overlay);
        DrawList {
            size,
            background: self.palette.backdrop,
            camera,
            light: self.palette.light(),
            objects: self.rig.objects(&self.motion, &now),
            overlay,
        }
    }

    /// Everything written over the scene.
    fn draw_words(&self, now: &Instant, camera: &Camera, out: &mut Vec<OverlayItem>) {
        let (scale, palette) = (self.layout.scale, &self.palette);
        let size = [self.case.film.width, self.case.film.height];
        let scene = self.layout.scene;
        labels::draw_headline(&self.case, palette, scene.min, scene.max.x - scene.min.x, scale, out);
        let status = self.layout.status();
        labels::draw_status(&self.case, palette, now, (status, scene.max.x), scale, out);
        let anchors = self.rig.anchors(now);
        let mut word = |place: Vec3, size_px: f32, colour, text: &str, shift: Vec2| {
            if let Some(position) = camera.project(place, size) {
                out.push(OverlayItem::Text {
                    position: position + shift * scale,
                    anchor: Anchor::Centre,
                    size: size_px * scale,
                    colour,
                    bold: true,
                    text: text.to_owned(),
                });
            }
        };
        for (place, name) in anchors.masses.into_iter().zip(["1", "2"]) {
            word(place, 22.0, palette::CARRIAGE_TEXT, name, Vec2::new(0.0, 8.0));
        }
        word(anchors.normal_force, 14.0, palette.text, "N", Vec2::new(-16.0, 10.0));
        word(anchors.pad, 11.0, palette::LABEL_ON_METAL, "friction pad", Vec2::ZERO);
        let above_status = Vec2::new(0.0, 14.0) * scale;
        if self.case.prescribed.is_none() {
            out.push(OverlayItem::Text {
                position: Vec2::new(scene.max.x - 14.0 * scale, status.y) - above_status,
                anchor: Anchor::Right,
                size: 13.0 * scale,
                colour: palette.excitation,
                bold: false,
                text: "arrows: power fed in by self-excitation".to_owned(),
            });
        }
        if let Some(ghost) = &self.ghost {
            let place = status - above_status;
            ghost.draw(&self.rig, camera, size, now, (palette, place, scale), out);
        }
    }

    /// From the front, a little above and to the side of the Jenkins element.
    fn camera(&self) -> Camera {
        self.layout.camera(Vec3::new(-0.1, 0.52, 0.12), [-0.27, 0.40], 10.3, [3.75, 1.45])
    }
}
