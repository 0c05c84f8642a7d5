//! Where things stand in the picture: the first three panels in a column at the right, the others in a row below the scene.

use crate::render::{Camera, Rectangle};
use glam::{Vec2, Vec3};

/// Width of the scene where panels stand beside it, as a part of the picture's.
const SCENE_WIDTH: f32 = 0.655;
/// Free border around panels and text, gap between panels, and height of the row below: pixels of a 720 lines high picture.
const BORDER: f32 = 20.0;
const GAP: f32 = 10.0;
const ROW: f32 = 196.0;
/// Room for the headline above the scene and the status below it.
const HEADLINE: f32 = 84.0;
const STATUS: f32 = 62.0;
/// Panels in the column.
const IN_COLUMN: usize = 3;

/// The places of one film.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    size: [u32; 2],
    /// Pixels per pixel of a 1280 x 720 picture that fits into this one.
    pub scale: f32,
    /// One for each panel.
    pub panels: Vec<Rectangle>,
    /// What is left for the scene with its words.
    pub scene: Rectangle,
}

impl Layout {
    #[must_use]
    pub fn new(size: [u32; 2], panels: usize) -> Self {
        let [width, height] = size.map(|side| side as f32);
        // Words and borders fit in both directions, whatever the shape of the picture.
        let scale = (height / 720.0).min(width / 1280.0);
        let (border, gap) = (BORDER * scale, GAP * scale);
        let (in_column, in_row) = (panels.min(IN_COLUMN), panels.saturating_sub(IN_COLUMN));
        let right = if panels == 0 { width - border } else { width * SCENE_WIDTH };
        let bottom = height - border - if in_row == 0 { 0.0 } else { ROW * scale + gap };
        let place = |min: [f32; 2], max: [f32; 2]| Rectangle { min: Vec2::from(min), max: Vec2::from(max) };
        let tall = (height - 2.0 * border - gap * (in_column.max(1) - 1) as f32) / in_column.max(1) as f32;
        let wide = (right - border - gap * (in_row.max(1) - 1) as f32) / in_row.max(1) as f32;
        let column = (0..in_column).map(|row| {
            let top = border + row as f32 * (tall + gap);
            place([right + 0.5 * border, top], [width - border, top + tall])
        });
        let row = (0..in_row).map(|number| {
            let left = border + number as f32 * (wide + gap);
            place([left, height - border - ROW * scale], [left + wide, height - border])
        });
        let panels = column.chain(row).collect();
        Self { size, scale, panels, scene: place([border, border], [right, bottom]) }
    }

    /// Upper left corner of the status line.
    #[must_use]
    pub fn status(&self) -> Vec2 {
        Vec2::new(self.scene.min.x, self.scene.max.y - 32.0 * self.scale)
    }

    /// A camera that looks at `target` from a direction (azimuth from the front, elevation; rad) such that a box of the given half
    /// width and half height fits between headline and status, at `distance`.
    #[must_use]
    pub fn camera(&self, target: Vec3, [azimuth, elevation]: [f32; 2], distance: f32, half: [f32; 2]) -> Camera {
        let [width, height] = self.size.map(|side| side as f32);
        let (top, bottom) = (self.scene.min.y + HEADLINE * self.scale, self.scene.max.y - STATUS * self.scale);
        let aspect = (self.scene.max.x - self.scene.min.x) / (bottom - top);
        let needed = (half[0] / aspect).max(half[1]);
        let towards = Vec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos());
        Camera {
            eye: target + towards * distance,
            target,
            up: Vec3::Y,
            vertical_field_of_view: 2.0 * (needed / distance).atan(),
            viewport: [self.scene.min.x / width, top / height, self.scene.max.x / width, bottom / height],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wide, upright, square, and the old shape of screens.
    const SIZES: [[u32; 2]; 4] = [[1920, 1080], [1080, 1920], [1080, 1080], [1024, 768]];

    #[test]
    fn panels_lie_in_the_picture_and_apart_from_each_other_and_the_scene() {
        for (count, size) in (0..=6).flat_map(|count| SIZES.map(|size| (count, size))) {
            let layout = Layout::new(size, count);
            let whole = Vec2::from(size.map(|side| side as f32));
            assert_eq!(layout.panels.len(), count);
            let mut all = layout.panels.clone();
            all.push(layout.scene);
            for (i, a) in all.iter().enumerate() {
                assert!(a.min.cmpge(Vec2::ZERO).all() && a.max.cmple(whole).all());
                assert!(a.max.x - a.min.x > 100.0 && a.max.y - a.min.y > 100.0);
                let meets =
                    |b: &Rectangle| a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y;
                assert!(!all[i + 1..].iter().any(meets), "{count} panels on {size:?}: number {i} overlaps another");
            }
        }
    }
}
