//! From a motion and its scene to the list of things to draw in each frame.
//!
//! A frame is a pure function of its index: it shows the motion at `index * speed / fps`.

mod disk;
mod envelope;
mod ghost;
mod labels;
mod layout;
mod motion;
mod numbers;
mod palette;
mod panels;
mod plot;
mod rig;
mod take;

pub use disk::{DeflectionColours, DiskInstant, DiskMotion, DiskStage};
pub use motion::{Body, Instant, Motion};
pub use palette::data_colours;
pub use panels::DampingMap;
pub use plot::{Axis, Plot};
pub use take::Take;

use crate::render::{Anchor, Camera, DrawList, OverlayItem, Rectangle};
use crate::scene::{Case, View};
use ghost::Ghost;
use glam::{Vec2, Vec3};
use layout::Layout;
use palette::Palette;
use panels::Panels;
use rig::RigModel;

/// Middle of the rig, half of the width and height that show all of it, and the camera's distance; drawing units.
const MIDDLE: Vec3 = Vec3::new(-0.1, 0.52, 0.12);
const EXTENT: [f32; 2] = [3.7, 1.4];
const DISTANCE: f32 = 10.3;
/// Width of the shade beside the panels in a close view, pixels of a 720 lines high picture, and its steps.
const SCRIM: f32 = 56.0;
const SCRIM_STEPS: u32 = 28;

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
        let palette = Palette::of(case.film.theme).before(case.film.background);
        let layout = Layout::new([case.film.width, case.film.height], case.panels().len());
        let panels = Panels::new(&case, &motion, beside.map.as_ref(), &layout.panels, layout.scale, palette);
        let rig = RigModel::new(&case, &motion, palette);
        let ghost = beside.exact.and_then(|exact| Ghost::new(&motion, exact, rig.magnification()));
        Self { case, motion, palette, layout, rig, ghost, panels }
    }

    /// Frames that show the motion from its start to its end; fewer than the scene asks for where the motion diverged.
    #[must_use]
    pub fn frame_count(&self) -> u64 {
        self.case.frames_until(self.motion.end()).min(self.case.frame_count())
    }

    /// Time of the motion shown in a frame.
    #[must_use]
    pub fn time(&self, index: u64) -> f64 {
        self.case.motion_time(index)
    }

    /// Time at which the motion ends.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.motion.end()
    }

    /// What a frame shows.
    #[must_use]
    pub fn instant(&self, index: u64) -> Instant {
        self.motion.at(self.time(index))
    }

    /// The frame at `index`.
    #[must_use]
    pub fn frame(&self, index: u64) -> DrawList {
        self.picture(self.time(index), index as f64 / f64::from(self.case.film.fps))
    }

    /// The frame that would show the motion at exactly `time`.
    #[must_use]
    pub fn frame_at(&self, time: f64) -> DrawList {
        self.picture(time, self.case.direction.film_time(time / self.case.film.speed))
    }

    /// The motion at `time`, after `seconds` of film.
    fn picture(&self, time: f64, seconds: f64) -> DrawList {
        let now = self.motion.at(time);
        let film = self.case.film;
        let size = [film.width, film.height];
        let camera = self.camera(seconds);
        let mut overlay = Vec::new();
        self.draw_scrim(seconds, &mut overlay);
        self.draw_words(&now, seconds, &camera, &mut overlay);
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
    fn draw_words(&self, now: &Instant, seconds: f64, camera: &Camera, out: &mut Vec<OverlayItem>) {
        let (scale, palette) = (self.layout.scale, &self.palette);
        let size = [self.case.film.width, self.case.film.height];
        let scene = self.layout.scene;
        let caption = self.case.direction.caption(seconds).unwrap_or((&self.case.caption, 1.0));
        let room = scene.max.x - scene.min.x;
        labels::draw_headline(&self.case.title, caption, palette, (scene.min, room), scale, out);
        let status = self.layout.status();
        labels::draw_status(&self.case, palette, now, (status, scene.max.x), scale, out);
        out.push(OverlayItem::Text {
            position: Vec2::new(scene.max.x - 14.0 * scale, status.y + 3.0 * scale),
            anchor: Anchor::Right,
            size: 12.0 * scale,
            colour: palette.faint_text,
            bold: false,
            text: labels::magnification(&self.case.scales, self.rig.carriage_widths()),
        });
        let anchors = self.rig.anchors(now);
        // The springs pass behind the letter of the normal force.
        if let Some(centre) = camera.project(anchors.normal_force, size) {
            let fill = palette.panel.with_alpha(0.65);
            out.push(OverlayItem::Disc { centre, radius: 10.0 * scale, fill, stroke: None });
        }
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
        word(anchors.normal_force, 14.0, palette.text, "N", Vec2::new(0.0, 5.0));
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

    /// Darkens the column of panels where a close view would show parts of the rig between them.
    fn draw_scrim(&self, seconds: f64, out: &mut Vec<OverlayItem>) {
        let closeness = ((self.view(seconds).zoom - 1.0) / 0.5).clamp(0.0, 1.0) as f32;
        let backdrop = self.palette.backdrop;
        if closeness == 0.0 || self.layout.panels.is_empty() || backdrop.is_transparent() {
            return;
        }
        let (width, left) = (SCRIM * self.layout.scale, self.layout.scene.max.x);
        let [right, height] = [self.case.film.width, self.case.film.height].map(|side| side as f32);
        let mut strip = |from: f32, to: f32, part: f32| {
            out.push(OverlayItem::Box {
                area: Rectangle { min: Vec2::new(from.round(), 0.0), max: Vec2::new(to.round(), height) },
                corner_radius: 0.0,
                fill: backdrop.top.with_alpha(part * closeness),
                stroke: None,
            });
        };
        for number in 0..SCRIM_STEPS {
            let place = |n: u32| left - width * (1.0 - n as f32 / SCRIM_STEPS as f32);
            strip(place(number), place(number + 1), (number as f32 + 0.5) / SCRIM_STEPS as f32);
        }
        strip(left, right, 1.0);
    }

    fn view(&self, seconds: f64) -> View {
        let length = self.frame_count().saturating_sub(1) as f64 / f64::from(self.case.film.fps);
        self.case.direction.camera.view(seconds, length)
    }

    /// Where the direction of the scene puts it.
    fn camera(&self, seconds: f64) -> Camera {
        let view = self.view(seconds);
        let shift = Vec3::from(view.shift.map(|shift| shift as f32));
        let direction = [view.azimuth, view.elevation].map(|angle| angle.to_radians() as f32);
        self.layout.camera(MIDDLE + shift, direction, DISTANCE, EXTENT.map(|half| half / view.zoom as f32))
    }
}
