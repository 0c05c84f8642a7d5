//! A bladed disk from its motion and scene to the list of things to draw in each frame.
//!
//! Blades are numbered counter-clockwise seen from above; a forward wave runs counter-clockwise.

mod colours;
mod geometry;
mod model;
mod motion;
mod panels;
mod words;

pub use colours::DeflectionColours;
pub use motion::{DiskInstant, DiskMotion};

use super::Solution;
use super::layout::{Layout, Shown};
use super::palette::Palette;
use crate::render::{Camera, DrawList, Light};
use crate::scene::{CameraMove, Case, Direction, View};
use glam::Vec3;
use model::DiskModel;
use panels::{Frame, Panels};
use words::Words;

/// Middle of the disk, radius and half the height of a ring that holds the tips of the blades, how far words reach beside it, and the
/// camera's distance; drawing units.
const MIDDLE: Vec3 = Vec3::new(0.0, 0.85, 0.0);
const RING: [f32; 2] = [2.55, 0.3];
const BESIDE: f32 = 3.3;
const DISTANCE: f32 = 10.0;
/// From where a disk is seen unless its scene says.
const VIEW: View = View { azimuth: -12.0, elevation: 36.0, zoom: 1.0, shift: [0.0; 3] };
const SMALLEST: f64 = 1e-9;
/// Time of the motion in a second of film up to which panels that move with time show their usual stretch.
const USUAL_SPEED: f64 = 8.0;
/// Sun on a disk, as a part of that on the rig: colours stand for numbers here and may not be bleached.
const SUN: f32 = 0.5;

/// What a camera shows: points round the ring, and the words beside it.
fn shown() -> Shown {
    let [radius, half] = RING;
    let around = (0..24).flat_map(|n| {
        let (sin, cos) = (std::f32::consts::TAU * n as f32 / 24.0).sin_cos();
        [-half, half].map(|y| MIDDLE + Vec3::new(radius * cos, y, radius * sin))
    });
    let words = [-BESIDE, BESIDE].map(|x| MIDDLE + Vec3::new(x, 0.0, 0.0));
    Shown { points: around.chain(words).collect(), middle: MIDDLE, distance: DISTANCE }
}

/// One film of a disk.
#[derive(Debug, Clone)]
pub struct DiskStage {
    case: Case,
    motion: DiskMotion,
    /// Mean period of the motion.
    period: f64,
    exact: Option<DiskMotion>,
    solution: Option<Solution>,
    palette: Palette,
    layout: Layout,
    model: DiskModel,
    panels: Panels,
    words: Words,
}

impl DiskStage {
    /// With the exact motion from the same start, where there is one. `None` where the case is not about a disk.
    #[must_use]
    pub fn new(case: Case, motion: DiskMotion, exact: Option<DiskMotion>) -> Option<Self> {
        let disk = case.disk.as_ref()?.disk.clone();
        let palette = Palette::of(case.film.theme).before(case.film.background);
        let layout = Layout::of(&case);
        let colours = DeflectionColours::new(case.film.theme, motion.largest_deflection().max(SMALLEST));
        let pace = (case.film.speed / USUAL_SPEED).max(1.0);
        let frame = Frame { disk: &disk, motion: &motion, colours, pace, scale: layout.scale, palette };
        let panels = Panels::new(&case, &frame, &layout.panels);
        let model = DiskModel::new(&disk, colours, case.direction.magnification as f32, palette);
        let words = Words::new(&disk, &motion, &model, layout.scale, palette);
        let period = std::f64::consts::TAU / motion.angular_frequency();
        Some(Self { period, exact, solution: None, palette, layout, model, panels, words, case, motion })
    }

    /// Says what computed the motion.
    #[must_use]
    pub fn computed_by(self, solution: Solution) -> Self {
        Self { solution: Some(solution), ..self }
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

    /// Mean period of the motion.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.period
    }

    /// What a frame shows.
    #[must_use]
    pub fn instant(&self, index: u64) -> DiskInstant {
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
        let size = [self.case.film.width, self.case.film.height];
        let camera = self.camera(seconds);
        let mut overlay = Vec::new();
        self.words.draw_numbers(&self.model, (&camera, size), &mut overlay);
        let caption = self.case.direction.caption(seconds).unwrap_or((&self.case.caption, 1.0));
        self.words.draw_headline(&self.case.title, caption, &self.layout, &mut overlay);
        let apart = self.exact.as_ref().filter(|exact| time <= exact.end()).map(|exact| self.distance(&now, exact));
        // Over a period: how many slip at one moment flickers too fast to be read, and the contacts in the scene show it.
        let slipping = self.motion.slipped(time - self.period, time).into_iter().filter(|slipped| *slipped).count();
        let beside = (apart, self.solution.as_ref());
        self.words.draw_status(&now, slipping, beside, &self.layout, &mut overlay);
        self.panels.draw(&self.motion, &now, &mut overlay);
        let light = self.palette.light();
        DrawList {
            size,
            background: self.palette.backdrop,
            camera,
            light: Light {
                direction: Vec3::new(-0.55, 1.0, 0.5),
                shadow_centre: MIDDLE,
                shadow_radius: 3.0,
                intensity: SUN * light.intensity,
                ..light
            },
            objects: self.model.objects(&self.motion, &now),
            overlay,
        }
    }

    /// Largest difference of a blade's deflection from the exact solution's.
    fn distance(&self, now: &DiskInstant, exact: &DiskMotion) -> f64 {
        let there = exact.at(now.time);
        let pairs = now.positions.iter().zip(&there.positions).take(self.motion.blades());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// Where the direction of the scene puts it.
    fn camera(&self, seconds: f64) -> Camera {
        let length = self.frame_count().saturating_sub(1) as f64 / f64::from(self.case.film.fps);
        let Direction { camera, .. } = &self.case.direction;
        let view = if *camera == CameraMove::default() { VIEW } else { camera.view(seconds, length) };
        let shift = Vec3::from(view.shift.map(|shift| shift as f32));
        let direction = [view.azimuth, view.elevation].map(|angle| angle.to_radians() as f32);
        self.layout.camera(&shown(), direction, view.zoom as f32, shift)
    }
}
