//! Lines, dots, areas and texts in CSS pixels on a drawing back end of plotters.
//!
//! The back ends know whole pixels only, so figures are drawn several times too large: vector pictures are scaled by their
//! view box, bitmaps are averaged.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, FontFamily, FontStyle, FontTransform, TextStyle};

pub(super) const FONT: &str = "sans-serif";
/// Joints that turn by more than this are rounded off in bitmaps, in rad.
const SHARP: f64 = 0.3;

pub(super) type Point = (f64, f64);

/// What a back end said when it failed. Its own errors have no type that could be named here.
#[derive(Debug)]
pub(super) struct Failure(pub String);

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

/// How a line looks. Lengths in CSS pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pen {
    pub rgb: (u8, u8, u8),
    pub width: f64,
    /// Lengths of dash and gap; a solid line without.
    pub dash: Option<(f64, f64)>,
}

impl Pen {
    pub fn solid(rgb: (u8, u8, u8), width: f64) -> Self {
        Self { rgb, width, dash: None }
    }
}

/// How a text looks.
#[derive(Clone, Copy)]
pub(super) struct Lettering {
    pub size: f64,
    pub bold: bool,
    pub rgb: (u8, u8, u8),
    pub across: HPos,
    /// Turned to read upwards; then centred both ways.
    pub upwards: bool,
}

impl Lettering {
    pub fn centred(size: f64) -> Self {
        Self { size, bold: false, rgb: (0x10, 0x10, 0x10), across: HPos::Center, upwards: false }
    }
}

/// What the pictures of plotters' two back ends differ in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Medium {
    Vector,
    /// Thick lines are filled polygons without joints, so each segment is drawn by itself.
    Bitmap,
}

impl Medium {
    /// Size to ask for, for letters of one CSS pixel: plotters means the height of the line, measured differently.
    fn line_height(self) -> f64 {
        match self {
            Self::Vector => 1.24,
            Self::Bitmap => 1.164,
        }
    }

    /// How far below its centre a text has to be asked for, in letter sizes.
    fn sinking(self) -> f64 {
        match self {
            Self::Vector => 0.1,
            Self::Bitmap => 0.25,
        }
    }
}

pub(super) struct Canvas<'a, B> {
    pub backend: &'a mut B,
    /// Pixels of the back end in a CSS pixel.
    pub scale: f64,
    pub medium: Medium,
}

impl<B: DrawingBackend> Canvas<'_, B> {
    fn pixel(&self, (x, y): Point) -> (i32, i32) {
        ((x * self.scale).round() as i32, (y * self.scale).round() as i32)
    }

    fn pixels(&self, length: f64) -> u32 {
        (length * self.scale).round().max(1.0) as u32
    }

    /// A line through the points, all finite.
    pub fn line(&mut self, points: &[Point], pen: Pen) -> Result<(), Failure> {
        match pen.dash {
            None => self.stroke(points, pen),
            Some((dash, gap)) => dashes(points, dash, gap).iter().try_for_each(|piece| self.stroke(piece, pen)),
        }
    }

    fn stroke(&mut self, points: &[Point], pen: Pen) -> Result<(), Failure> {
        let width = self.pixels(pen.width);
        let style = shape(pen.rgb, 1.0, width);
        let mut path: Vec<_> = points.iter().map(|p| self.pixel(*p)).collect();
        path.dedup();
        if self.medium == Medium::Vector {
            return Ok(self.backend.draw_path(path, &style)?);
        }
        for pair in path.windows(2) {
            self.backend.draw_path([pair[0], pair[1]], &style)?;
        }
        for corner in points.windows(3).filter(|corner| turn(corner) > SHARP) {
            self.backend.draw_circle(self.pixel(corner[1]), width / 2, &style, true)?;
        }
        Ok(())
    }

    pub fn fill(&mut self, outline: &[Point], rgb: (u8, u8, u8), alpha: f64) -> Result<(), Failure> {
        let path: Vec<_> = outline.iter().map(|p| self.pixel(*p)).collect();
        Ok(self.backend.fill_polygon(path, &shape(rgb, alpha, 1))?)
    }

    pub fn dot(&mut self, centre: Point, radius: f64, rgb: (u8, u8, u8)) -> Result<(), Failure> {
        Ok(self.backend.draw_circle(self.pixel(centre), self.pixels(radius), &shape(rgb, 1.0, 1), true)?)
    }

    pub fn text(&mut self, at: Point, text: &str, look: Lettering) -> Result<(), Failure> {
        if text.is_empty() {
            return Ok(());
        }
        let size = look.size * self.scale * self.medium.line_height();
        let weight = if look.bold { FontStyle::Bold } else { FontStyle::Normal };
        let turn = if look.upwards { FontTransform::Rotate270 } else { FontTransform::None };
        let font = FontDesc::new(FontFamily::SansSerif, size, weight).transform(turn);
        let colour = RGBColor(look.rgb.0, look.rgb.1, look.rgb.2);
        let style = TextStyle::from(font).color(&colour).pos(Pos::new(look.across, VPos::Center));
        let sinking = self.medium.sinking() * look.size;
        let at = if look.upwards { (at.0 + sinking, at.1) } else { (at.0, at.1 + sinking) };
        let at = self.pixel(at);
        Ok(self.backend.draw_text(text, &style, at)?)
    }
}

fn shape((r, g, b): (u8, u8, u8), alpha: f64, width: u32) -> ShapeStyle {
    ShapeStyle { color: RGBColor(r, g, b).mix(alpha), filled: true, stroke_width: width }
}

/// Width of a text in CSS pixels; 0 if the font cannot be read, which drawing reports.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    // Measured large, for whole pixels are all one gets.
    let font = FontDesc::new(FontFamily::SansSerif, 100.0 * Medium::Bitmap.line_height(), FontStyle::Normal);
    font.layout_box(text).map_or(0.0, |(_, (width, _))| f64::from(width) * size / 100.0)
}

/// Angle by which a line turns at the middle one of three points, rad in [0, pi].
fn turn(corner: &[Point]) -> f64 {
    let [a, b] = [0, 1].map(|i| (corner[i + 1].0 - corner[i].0, corner[i + 1].1 - corner[i].1));
    (a.0 * b.1 - a.1 * b.0).atan2(a.0 * b.0 + a.1 * b.1).abs()
}

/// Pieces of a line that are drawn, gaps left out.
fn dashes(points: &[Point], dash: f64, gap: f64) -> Vec<Vec<Point>> {
    let (mut pieces, mut piece) = (Vec::new(), Vec::new());
    let (mut drawing, mut left) = (true, dash);
    for pair in points.windows(2) {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        let length = (x1 - x0).hypot(y1 - y0);
        let mut done = 0.0;
        if drawing && piece.is_empty() {
            piece.push(pair[0]);
        }
        while length - done > left {
            done += left;
            let at = (x0 + (x1 - x0) * done / length, y0 + (y1 - y0) * done / length);
            if drawing {
                piece.push(at);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![at];
            }
            drawing = !drawing;
            left = if drawing { dash } else { gap };
        }
        left -= length - done;
        if drawing {
            piece.push(pair[1]);
        }
    }
    if piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_and_gaps_have_their_lengths_whatever_the_points() {
        let whole = dashes(&[(0.0, 0.0), (9.0, 0.0)], 3.0, 2.0);
        assert_eq!(whole, [vec![(0.0, 0.0), (3.0, 0.0)], vec![(5.0, 0.0), (8.0, 0.0)]]);
        let fine: Vec<Point> = (0..=90).map(|n| (0.1 * f64::from(n), 0.0)).collect();
        let ends = |pieces: &[Vec<Point>]| pieces.iter().map(|p| (p[0].0, p[p.len() - 1].0)).collect::<Vec<_>>();
        for (a, b) in ends(&dashes(&fine, 3.0, 2.0)).iter().zip(ends(&whole)) {
            assert!((a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9);
        }
    }
}
