//! From a motion and its scene to the list of things to draw in each frame.
//!
//! A frame is a pure function of its index: it shows the motion at `index * speed / fps`.

mod labels;
mod motion;
mod palette;
mod panels;
mod plot;
mod rig;

pub use motion::{Instant, Motion};
pub use plot::{Axis, Plot};

use crate::model::ContactState;
use crate::render::{Background, Camera, Colour, DrawList, Light, Rectangle};
use crate::scene::Case;
use glam::{Vec2, Vec3};
use panels::Panels;
use rig::{Extremes, RigModel};

/// Parts of the picture: the scene to the left of this fraction of its width, the plots to the right.
const SCENE_WIDTH: f32 = 0.655;
/// Free border around panels and text, pixels of a 720 lines high picture.
const BORDER: f32 = 20.0;

/// Colour of a contact state, the same wherever it is shown.
fn contact_colour(contact: ContactState) -> Colour {
    match contact {
        ContactState::Stick => palette::STICK,
        ContactState::Slip(_) => palette::SLIP,
    }
}

/// One film: a case and its motion.
#[derive(Debug, Clone)]
pub struct Stage {
    case: Case,
    motion: Motion,
    rig: RigModel,
    panels: Panels,
}

impl Stage {
    #[must_use]
    pub fn new(case: Case, motion: Motion) -> Self {
        let either = |quantity: fn(&Instant) -> [f64; 2]| {
            motion.largest(|i| quantity(i)[0]).max(motion.largest(|i| quantity(i)[1]))
        };
        let largest = Extremes {
            displacement: either(|i| i.positions),
            approach: motion.largest(|i| (i.positions[0] - i.positions[1]).max(0.0)),
            speed: either(|i| i.velocities),
        };
        let (width, height) = (case.film.width as f32, case.film.height as f32);
        let scale = height / 720.0;
        let column = Rectangle {
            min: Vec2::new(width * SCENE_WIDTH + 0.5 * BORDER * scale, BORDER * scale),
            max: Vec2::new(width - BORDER * scale, height - BORDER * scale),
        };
        let panels = Panels::new(&motion, case.scales, column, scale);
        let rig = RigModel::new(&case.parameters, largest);
        Self { case, motion, rig, panels }
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
        let (width, height) = (film.width as f32, film.height as f32);
        let scale = height / 720.0;
        let border = BORDER * scale;
        let mut overlay = Vec::new();
        labels::draw_headline(&self.case, Vec2::splat(border), width * SCENE_WIDTH - 2.0 * border, scale, &mut overlay);
        labels::draw_status(&self.case, &now, Vec2::new(border, height - border - 56.0 * scale), scale, &mut overlay);
        self.panels.draw(&self.motion, &now, &mut overlay);
        DrawList {
            size: [film.width, film.height],
            background: Background { top: palette::BACKDROP_TOP, bottom: palette::BACKDROP_BOTTOM },
            camera: camera(),
            light: light(),
            objects: self.rig.objects(&now),
            overlay,
        }
    }
}

/// From the front, a little above and to the side of the Jenkins element.
fn camera() -> Camera {
    Camera {
        eye: Vec3::new(-1.4, 3.0, 8.6),
        target: Vec3::new(-0.2, 0.45, 0.0),
        up: Vec3::Y,
        vertical_field_of_view: 0.62,
        viewport: [0.0, 0.05, SCENE_WIDTH, 0.95],
    }
}

fn light() -> Light {
    Light {
        direction: Vec3::new(-0.45, 1.0, 0.6),
        colour: Colour::rgb(0xfff1de),
        intensity: 2.6,
        sky: Colour::rgb(0x9db4cc),
        ground: Colour::rgb(0x4a4640),
        shadow_centre: Vec3::new(-0.2, 0.3, 0.0),
        shadow_radius: 3.9,
    }
}
