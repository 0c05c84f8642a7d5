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

use crate::render::{Anchor, Camera, Colour, DrawList, OverlayItem, Rectangle};
use crate::scene::{Case, View};
use ghost::Ghost;
use glam::{Vec2, Vec3};
use layout::Layout;
use palette::Palette;
use panels::Panels;
use rig::RigModel;

/// The shade behind panels and words in a close view: width of its soft edges, how far it ends above the foot of the headline and begins above that of the scene, pixels of a 720 lines
/// high picture; steps of an edge, and its opacity behind words.
const SCRIM: f32 = 48.0;
const SCRIM_HEAD: f32 = 12.0;
const SCRIM_FOOT: f32 = 76.0;
const SCRIM_STEPS: u32 = 24;
const WORDS: f32 = 0.72;

/// What computed a motion: written below the scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Solution {
    Exact,
    /// A physics engine: name, version, number format.
    Engine(String),
    /// A stored trajectory, by the name of its file.
    Stored(String),
}

/// What a film may show beside its motion.
#[derive(Debug, Clone, Default)]
pub struct Beside {
    /// Where the motion is from.
    pub solution: Option<Solution>,
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
    solution: Option<Solution>,
}

impl Stage {
    /// With what stands beside the motion, where there is something.
    #[must_use]
    pub fn new(case: Case, motion: Motion, beside: Beside) -> Self {
        let palette = Palette::of(case.film.theme).before(case.film.background);
        let layout = Layout::of(&case);
        let panels = Panels::new(&case, &motion, beside.map.as_ref(), &layout.panels, layout.scale, palette);
        let rig = RigModel::new(&case, &motion, palette);
        let ghost = beside.exact.and_then(|exact| Ghost::new(&motion, exact, rig.magnification()));
        Self { case, motion, palette, layout, rig, ghost, panels, solution: beside.solution }
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
        if let Some(solution) = &self.solution {
            labels::draw_solution(solution, palette, status - Vec2::new(0.0, labels::ABOVE[0]) * scale, scale, out);
        }
        labels::draw_status(&self.case, palette, now, (status, scene.max.x), scale, out);
        out.push(OverlayItem::Text {
            position: Vec2::new(scene.max.x - 14.0 * scale, status.y + 3.0 * scale),
            anchor: Anchor::Right,
            size: 12.0 * scale,
            colour: palette.faint_text,
            bold: false,
            text: labels::magnification(&self.case.scales, self.rig.carriage_widths()),
        });
        self.draw_names(now, camera, out);
        let above_status = Vec2::new(0.0, 14.0) * scale;
        if self.case.prescribed.is_none() && self.case.excitation().strongest() < 0.0 {
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
            let place = status - Vec2::new(0.0, labels::ABOVE[1]) * scale;
            ghost.draw(&self.rig, camera, size, now, (palette, place, scale), out);
        }
    }

    /// Names on the parts of the rig, as far as their faces are turned to the camera.
    fn draw_names(&self, now: &Instant, camera: &Camera, out: &mut Vec<OverlayItem>) {
        let (scale, palette) = (self.layout.scale, &self.palette);
        let size = [self.case.film.width, self.case.film.height];
        // 1 from the front, -1 from behind; in between nothing can be read.
        let facing = (camera.eye - camera.target).normalize_or_zero().z;
        let turned = |facing: f32| ((facing - 0.1) / 0.3).clamp(0.0, 1.0);
        let anchors = self.rig.anchors(now, facing >= 0.0);
        // The springs pass behind the letter of the normal force.
        if let Some(centre) = camera.project(anchors.normal_force, size).filter(|_| turned(facing) > 0.0) {
            let fill = palette.panel.with_alpha(0.65 * turned(facing));
            out.push(OverlayItem::Disc { centre, radius: 10.0 * scale, fill, stroke: None });
        }
        let mut word = |place: Vec3, size_px: f32, colour: Colour, text: &str, (shift, shown): (f32, f32)| {
            if let Some(position) = camera.project(place, size).filter(|_| shown > 0.0) {
                out.push(OverlayItem::Text {
                    position: position + Vec2::new(0.0, shift) * scale,
                    anchor: Anchor::Centre,
                    size: size_px * scale,
                    colour: colour.with_alpha(shown),
                    bold: true,
                    text: text.to_owned(),
                });
            }
        };
        for (place, name) in anchors.masses.into_iter().zip(["1", "2"]) {
            word(place, 22.0, palette::CARRIAGE_TEXT, name, (8.0, turned(facing.abs())));
        }
        word(anchors.normal_force, 14.0, palette.text, "N", (5.0, turned(facing)));
        word(anchors.pad, 11.0, palette::LABEL_ON_METAL, "friction pad", (0.0, turned(facing)));
    }

    /// Darkens the places of panels and words where a close view would show parts of the rig behind them, with soft edges.
    fn draw_scrim(&self, seconds: f64, out: &mut Vec<OverlayItem>) {
        let closeness = ((self.view(seconds).zoom - 1.0) / 0.5).clamp(0.0, 1.0) as f32;
        let backdrop = self.palette.backdrop;
        if closeness == 0.0 || backdrop.is_transparent() {
            return;
        }
        let scale = self.layout.scale;
        let end = Vec2::new(self.case.film.width as f32, self.case.film.height as f32);
        let edge = self.layout.scene.max;
        let beside = self.layout.panels.iter().any(|panel| panel.min.x >= edge.x);
        let mut shade = |min: Vec2, max: Vec2, part: f32| {
            out.push(OverlayItem::Box {
                area: Rectangle { min: min.round(), max: max.round() },
                corner_radius: 0.0,
                fill: backdrop.top.with_alpha(part * closeness),
                stroke: None,
            });
        };
        let right = if beside { edge.x } else { end.x };
        // The last line of the caption, and the first of the words above the status, are in the full shade.
        let [head, foot] = [self.layout.headline_foot() - SCRIM_HEAD * scale, edge.y - SCRIM_FOOT * scale];
        let soft = SCRIM * scale;
        for n in 0..SCRIM_STEPS {
            let (from, to) = (n as f32 / SCRIM_STEPS as f32, (n + 1) as f32 / SCRIM_STEPS as f32);
            let part = 0.5 * (from + to);
            shade(Vec2::new(0.0, head + soft * (1.0 - to)), Vec2::new(right, head + soft * (1.0 - from)), WORDS * part);
            shade(Vec2::new(0.0, foot - soft * (1.0 - from)), Vec2::new(right, foot - soft * (1.0 - to)), WORDS * part);
            if beside {
                shade(Vec2::new(edge.x - soft * (1.0 - from), 0.0), Vec2::new(edge.x - soft * (1.0 - to), end.y), part);
            }
        }
        shade(Vec2::ZERO, Vec2::new(right, head), WORDS);
        shade(Vec2::new(0.0, foot), Vec2::new(right, edge.y), WORDS);
        shade(Vec2::new(0.0, edge.y), Vec2::new(right, end.y), 1.0);
        if beside {
            shade(Vec2::new(edge.x, 0.0), end, 1.0);
        }
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
        self.layout.camera(&rig::shown(), direction, view.zoom as f32, shift)
    }
}
