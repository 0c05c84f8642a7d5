//! Where things stand in the picture: scene and words above up to three panels in a row; of more, three stand in a column beside the scene.
//! In an upright or square picture all stand below it, two in a row.

use super::labels;
use crate::render::{Camera, Rectangle};
use crate::scene::Case;
use glam::{Vec2, Vec3};

/// Width of the scene where panels stand beside it, as a part of the picture's.
const SCENE_WIDTH: f32 = 0.655;
/// Free border around panels and text, gap between panels, and height of the row below six panels' scene and of the only row: pixels of a
/// 720 lines high picture.
const BORDER: f32 = 20.0;
const GAP: f32 = 10.0;
const ROW: f32 = 196.0;
const ONLY_ROW: f32 = 236.0;
/// Room for the headline above the scene and the status below it.
const HEADLINE: f32 = 84.0;
const STATUS: f32 = 62.0;
/// Panels in the column.
const IN_COLUMN: usize = 3;
/// A picture is upright from this ratio of height to width on; then it counts as this many pixels wide and high, what fits, and a row of
/// panels is this part of its height.
const UPRIGHT: f32 = 0.9;
const UPRIGHT_SIZE: [f32; 2] = [760.0, 1130.0];
const UPRIGHT_ROW: f32 = 0.185;
/// Steps in which the camera is centred: seen along the rig each leaves half of the shift.
const CENTRING: usize = 12;

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
    /// Height of the headline and its captions, at least the usual one.
    headline: f32,
}

/// Places side by side between `left` and `right`.
fn row(count: usize, [left, right]: [f32; 2], [top, bottom]: [f32; 2], gap: f32) -> impl Iterator<Item = Rectangle> {
    let wide = (right - left - gap * (count.max(1) - 1) as f32) / count.max(1) as f32;
    (0..count).map(move |number| {
        let start = left + number as f32 * (wide + gap);
        Rectangle { min: Vec2::new(start, top), max: Vec2::new(start + wide, bottom) }
    })
}

impl Layout {
    #[must_use]
    pub fn new(size: [u32; 2], panels: usize) -> Self {
        let [width, height] = size.map(|side| side as f32);
        if height >= UPRIGHT * width {
            return Self::upright(size, panels);
        }
        // Words and borders fit in both directions, whatever the shape of the picture.
        let scale = (height / 720.0).min(width / 1280.0);
        let (border, gap) = (BORDER * scale, GAP * scale);
        let (in_column, in_row) = if panels <= IN_COLUMN { (0, panels) } else { (IN_COLUMN, panels - IN_COLUMN) };
        let right = if in_column == 0 { width - border } else { width * SCENE_WIDTH };
        let low = scale * if in_column == 0 { ONLY_ROW } else { ROW };
        let bottom = height - border - if in_row == 0 { 0.0 } else { low + gap };
        let tall = (height - 2.0 * border - gap * (IN_COLUMN - 1) as f32) / IN_COLUMN as f32;
        let column = (0..in_column).flat_map(|number| {
            let top = border + number as f32 * (tall + gap);
            row(1, [right + 0.5 * border, width - border], [top, top + tall], gap)
        });
        let below = row(in_row, [border, right], [height - border - low, height - border], gap);
        let panels = column.chain(below).collect();
        let scene = Rectangle { min: Vec2::splat(border), max: Vec2::new(right, bottom) };
        Self { size, scale, panels, scene, headline: HEADLINE * scale }
    }

    fn upright(size: [u32; 2], panels: usize) -> Self {
        let [width, height] = size.map(|side| side as f32);
        let scale = (width / UPRIGHT_SIZE[0]).min(height / UPRIGHT_SIZE[1]);
        let (border, gap) = (BORDER * scale, GAP * scale);
        let rows = panels.div_ceil(2);
        let tall = UPRIGHT_ROW * height;
        let head = height - border - rows as f32 * (tall + gap);
        let below = (0..rows).flat_map(|number| {
            let top = head + gap + number as f32 * (tall + gap);
            row((panels - 2 * number).min(2), [border, width - border], [top, top + tall], gap)
        });
        let scene = Rectangle { min: Vec2::splat(border), max: Vec2::new(width - border, head) };
        Self { size, scale, panels: below.collect(), scene, headline: HEADLINE * scale }
    }

    /// That of a case, with room for its title and the highest of its captions.
    #[must_use]
    pub fn of(case: &Case) -> Self {
        let layout = Self::new([case.film.width, case.film.height], case.panels().len());
        let captions = case.direction.captions.iter().map(|caption| caption.text.as_str());
        let captions = captions.chain([case.caption.as_str()]);
        let width = layout.scene.max.x - layout.scene.min.x;
        let height = labels::headline_height(&case.title, captions, width, layout.scale);
        layout.below_headline(height)
    }

    /// The scene begins below words of this height, if they are higher than usual.
    #[must_use]
    fn below_headline(self, height: f32) -> Self {
        // Whatever is written, half of the place is the scene's.
        let most = 0.5 * (self.scene.max.y - self.scene.min.y);
        Self { headline: self.headline.max(height.min(most)), ..self }
    }

    /// Lower end of headline and captions.
    #[must_use]
    pub fn headline_foot(&self) -> f32 {
        self.scene.min.y + self.headline
    }

    /// Upper left corner of the status line.
    #[must_use]
    pub fn status(&self) -> Vec2 {
        Vec2::new(self.scene.min.x, self.scene.max.y - 32.0 * self.scale)
    }

    /// A camera that looks from a direction (azimuth from the front, elevation; rad) such that what is shown fits between headline and
    /// status, as large as it can, drawn `zoom` times as large; `shift` moves the place looked at away from its middle.
    #[must_use]
    pub fn camera(&self, shown: &Shown, [azimuth, elevation]: [f32; 2], zoom: f32, shift: Vec3) -> Camera {
        let [width, height] = self.size.map(|side| side as f32);
        let (top, bottom) = (self.headline_foot(), self.scene.max.y - STATUS * self.scale);
        let aspect = (self.scene.max.x - self.scene.min.x) / (bottom - top);
        let towards = Vec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos());
        let right = Vec3::new(azimuth.cos(), 0.0, -azimuth.sin());
        let up = towards.cross(right);
        let distance = shown.distance;
        // Tangents of the angles under which the corners are seen: least and largest to the right and up.
        let seen = |target: Vec3| {
            let tangents = shown.points.iter().map(|&point| {
                let place = point - target;
                Vec2::new(place.dot(right), place.dot(up)) / (distance - place.dot(towards))
            });
            tangents.fold((Vec2::MAX, Vec2::MIN), |(least, largest), at| (least.min(at), largest.max(at)))
        };
        let mut target = shown.middle;
        for _ in 0..CENTRING {
            let (least, largest) = seen(target);
            let middle = 0.5 * distance * (least + largest);
            target += right * middle.x + up * middle.y;
        }
        let (_, half) = seen(target);
        let target = target + shift;
        Camera {
            eye: target + towards * distance,
            target,
            up: Vec3::Y,
            vertical_field_of_view: 2.0 * ((half.x / aspect).max(half.y) / zoom).atan(),
            viewport: [self.scene.min.x / width, top / height, self.scene.max.x / width, bottom / height],
        }
    }
}

/// What a camera is to show: points that include all of it, a place in their middle, and the distance it is seen from; drawing units.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    pub points: Vec<Vec3>,
    pub middle: Vec3,
    pub distance: f32,
}

/// Corners of the box between two of them.
pub fn corners(min: Vec3, max: Vec3) -> impl Iterator<Item = Vec3> {
    (0..8).map(move |bits| {
        let side = |axis: usize| if bits >> axis & 1 == 1 { max[axis] } else { min[axis] };
        Vec3::new(side(0), side(1), side(2))
    })
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

    /// From all sides and heights nothing is cut, nothing lies under a panel, and the room is used in one direction at least.
    #[test]
    fn what_is_shown_fits_its_place_from_all_sides_and_fills_it() {
        let [min, max] = [Vec3::new(-3.0, 0.0, -0.5), Vec3::new(3.0, 1.0, 1.0)];
        let shown = Shown { points: corners(min, max).collect(), middle: 0.5 * (min + max), distance: 10.0 };
        for (count, size) in [0, 3, 6].into_iter().flat_map(|count| SIZES.map(|size| (count, size))) {
            let layout = Layout::new(size, count);
            for (azimuth, elevation) in (0..24).flat_map(|n| [0.1, 0.4, 1.2].map(|e| (0.3 * n as f32, e))) {
                let camera = layout.camera(&shown, [azimuth, elevation], 1.0, Vec3::ZERO);
                let places: Vec<Vec2> = shown.points.iter().map(|&p| camera.project(p, size).unwrap()).collect();
                let min = places.iter().copied().fold(Vec2::MAX, Vec2::min);
                let max = places.iter().copied().fold(Vec2::MIN, Vec2::max);
                // The last step of the centring leaves less than 1 % of the picture.
                let margin = 0.01 * size[0].max(size[1]) as f32;
                let head = Vec2::new(0.0, HEADLINE * layout.scale);
                let foot = Vec2::new(0.0, STATUS * layout.scale);
                assert!(min.cmpge(layout.scene.min + head - margin).all(), "{azimuth} {elevation} {min}");
                assert!(max.cmple(layout.scene.max - foot + margin).all(), "{azimuth} {elevation} {max}");
                let room = layout.scene.max - layout.scene.min - head - foot;
                assert!(((max - min) / room).max_element() > 0.98);
            }
        }
    }
}
