//! A framed plot with ticks: maps data to overlay pixels.

use super::palette::Palette;
use crate::render::{Anchor, Colour, OverlayItem, Rectangle, Stroke, text_width};
use glam::Vec2;

/// Steps from tick to tick along an axis, at most; and along one of a small plot.
const MOST_TICKS: f64 = 8.0;
const FEW_TICKS: f64 = 4.5;

/// Length over which the numbers of a sliding axis fade, pixels of a 720 lines high picture.
const FADE: f32 = 16.0;

/// A range of values with round tick marks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    pub min: f64,
    pub max: f64,
    /// Distance of two ticks.
    pub tick: f64,
    /// Numbers are written as multiples of this.
    pub multiple: f64,
    /// Moves with time: its numbers fade in and out at its ends.
    pub is_sliding: bool,
}

impl Axis {
    /// Range that includes `min..=max` with a margin, ticks at round numbers.
    #[must_use]
    pub fn covering(min: f64, max: f64) -> Self {
        let span = (max - min).max(1e-12);
        let margin = 0.06 * span;
        Self {
            min: min - margin,
            max: max + margin,
            tick: round_tick(span / MOST_TICKS),
            multiple: 1.0,
            is_sliding: false,
        }
    }

    /// The range `-limit..=limit` with a margin.
    #[must_use]
    pub fn symmetric(limit: f64) -> Self {
        Self::covering(-limit, limit)
    }

    /// Exactly `min..=max`.
    #[must_use]
    pub fn exactly(min: f64, max: f64) -> Self {
        Self { min, max, tick: round_tick((max - min) / MOST_TICKS), multiple: 1.0, is_sliding: false }
    }

    /// The same range with fewer ticks, for small plots.
    #[must_use]
    pub fn sparse(self) -> Self {
        Self { tick: round_tick((self.max - self.min) / FEW_TICKS), ..self }
    }

    /// From `min` to `max`, with ticks where they are at all times.
    #[must_use]
    pub fn slid_to(self, min: f64, max: f64) -> Self {
        Self { min, max, is_sliding: true, ..self }
    }

    fn ticks(self) -> impl Iterator<Item = f64> {
        let (first, last) = ((self.min / self.tick).ceil() as i64, (self.max / self.tick).floor() as i64);
        (first..=last).map(move |n| n as f64 * self.tick)
    }

    /// Digits after the point that tell two ticks apart.
    fn decimals(self) -> usize {
        // A tick of 1e-3 in thousandths is 1, up to its last digit.
        (-(self.tick / self.multiple * (1.0 + 1e-12)).log10().floor()).clamp(0.0, 9.0) as usize
    }

    fn written(self, tick: f64) -> String {
        format!("{:.*}", self.decimals(), tick / self.multiple).replace('-', "−")
    }

    fn part(self, value: f64) -> f32 {
        ((value - self.min) / (self.max - self.min)) as f32
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `wanted`.
fn round_tick(wanted: f64) -> f64 {
    let decade = 10f64.powf(wanted.log10().floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|m| m * decade)
        .find(|tick| *tick >= wanted * (1.0 - 1e-12))
        .unwrap_or(10.0 * decade)
}

/// A plot: where it is, and what its axes mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// The whole panel.
    pub panel: Rectangle,
    /// Pixels per pixel of a 720 lines high picture.
    pub scale: f32,
    pub palette: Palette,
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub x: Axis,
    pub y: Axis,
    /// Free border at the right of the area, pixels of a 720 lines high picture.
    pub right: f32,
}

/// Free border at the right of a plot with nothing there.
pub const RIGHT: f32 = 14.0;

impl Plot {
    /// The part of the panel that data is drawn in.
    #[must_use]
    pub fn area(&self) -> Rectangle {
        let s = self.scale;
        Rectangle {
            min: self.panel.min + Vec2::new(50.0, 40.0) * s,
            max: self.panel.max - Vec2::new(self.right, 24.0) * s,
        }
    }

    /// Pixel of a data point.
    #[must_use]
    pub fn pixel(&self, x: f64, y: f64) -> Vec2 {
        let area = self.area();
        let size = area.max - area.min;
        Vec2::new(area.min.x + size.x * self.x.part(x), area.max.y - size.y * self.y.part(y))
    }

    /// Panel, grid, ticks, labels.
    pub fn draw_frame(&self, out: &mut Vec<OverlayItem>) {
        out.push(OverlayItem::Box {
            area: self.panel,
            corner_radius: 8.0 * self.scale,
            fill: self.palette.panel,
            stroke: Some(self.stroke(1.0, self.palette.panel_edge)),
        });
        for value in self.x.ticks() {
            self.draw_rule([self.pixel(value, self.y.min), self.pixel(value, self.y.max)], value == 0.0, out);
        }
        self.draw_x_numbers(out);
        for value in self.y.ticks() {
            self.draw_rule([self.pixel(self.x.min, value), self.pixel(self.x.max, value)], value == 0.0, out);
            let place = self.pixel(self.x.min, value) + Vec2::new(-6.0, 3.5) * self.scale;
            out.push(self.text(place, Anchor::Right, self.y.written(value)));
        }
        self.draw_labels(out);
    }

    /// The label of the x axis stands at the right end of the numbers, which leave it room. Along a sliding axis they fade within [`FADE`]
    /// of it, and beyond the left end.
    fn draw_x_numbers(&self, out: &mut Vec<OverlayItem>) {
        let (s, area) = (self.scale, self.area());
        let wide = |text: &str| text_width(text, 11.0 * s, false);
        let room = area.max.x - wide(&self.x_label) - 6.0 * s;
        let beyond = if self.x.is_sliding { self.x.tick } else { 0.0 };
        for value in (Axis { min: self.x.min - beyond, ..self.x }).ticks() {
            let place = self.pixel(value, self.y.min) + Vec2::new(0.0, 14.0) * s;
            let number = self.x.written(value);
            let free = room - (place.x + 0.5 * wide(&number));
            let inside = FADE * s + (place.x - area.min.x).min(0.0);
            let shown = if self.x.is_sliding { free.min(inside) / (FADE * s) } else { f32::from(free > 0.0) };
            if shown > 0.0 {
                out.push(OverlayItem::Text {
                    position: place,
                    anchor: Anchor::Centre,
                    size: 11.0 * s,
                    colour: self.palette.faint_text.with_alpha(shown.min(1.0)),
                    bold: false,
                    text: number,
                });
            }
        }
    }

    fn draw_labels(&self, out: &mut Vec<OverlayItem>) {
        let s = self.scale;
        let area = self.area();
        out.push(OverlayItem::Text {
            position: self.panel.min + Vec2::new(12.0, 19.0) * s,
            anchor: Anchor::Left,
            size: 13.0 * s,
            colour: self.palette.text,
            bold: true,
            text: self.title.clone(),
        });
        out.push(self.text(area.max + Vec2::new(0.0, 14.0) * s, Anchor::Right, self.x_label.clone()));
        let place = Vec2::new(self.panel.min.x + 12.0 * s, area.min.y - 5.0 * s);
        out.push(self.text(place, Anchor::Left, self.y_label.clone()));
    }

    fn draw_rule(&self, ends: [Vec2; 2], zero: bool, out: &mut Vec<OverlayItem>) {
        let colour = if zero { self.palette.zero_line } else { self.palette.grid };
        out.push(OverlayItem::Line { points: ends.to_vec(), stroke: self.stroke(1.0, colour), clip: None });
    }

    /// A line through data points.
    pub fn draw_line(
        &self,
        data: impl Iterator<Item = (f64, f64)>,
        width: f32,
        colour: Colour,
        out: &mut Vec<OverlayItem>,
    ) {
        let points: Vec<Vec2> = data.map(|(x, y)| self.pixel(x, y)).collect();
        if points.len() > 1 {
            out.push(OverlayItem::Line { points, stroke: self.stroke(width, colour), clip: Some(self.area()) });
        }
    }

    /// The current point.
    pub fn draw_marker(&self, x: f64, y: f64, colour: Colour, out: &mut Vec<OverlayItem>) {
        self.draw_disc([x, y], 4.5, colour, out);
    }

    /// A disc with a rim at a data point, its radius in pixels of a 720 lines high picture.
    pub fn draw_disc(&self, [x, y]: [f64; 2], radius: f32, colour: Colour, out: &mut Vec<OverlayItem>) {
        out.push(OverlayItem::Disc {
            centre: self.pixel(x, y),
            radius: radius * self.scale,
            fill: colour,
            stroke: Some(self.stroke(1.5, self.palette.text)),
        });
    }

    /// The current point where its value is beyond the upper end: a tip that points there.
    pub fn draw_beyond(&self, x: f64, colour: Colour, out: &mut Vec<OverlayItem>) {
        let tip = self.pixel(x, self.y.max);
        let points = [[0.0, 0.0], [6.5, 10.0], [-6.5, 10.0]].map(|shift| tip + Vec2::from(shift) * self.scale);
        out.push(OverlayItem::Polygon { points: points.to_vec(), fill: colour, clip: None });
        let outline = points.into_iter().chain([tip]).collect();
        out.push(OverlayItem::Line { points: outline, stroke: self.stroke(1.5, self.palette.text), clip: None });
    }

    /// A small word beside a data point.
    pub fn draw_word(
        &self,
        [x, y]: [f64; 2],
        shift: Vec2,
        anchor: Anchor,
        word: &str,
        colour: Colour,
        out: &mut Vec<OverlayItem>,
    ) {
        out.push(OverlayItem::Text {
            position: self.pixel(x, y) + shift * self.scale,
            anchor,
            size: 10.0 * self.scale,
            colour,
            bold: false,
            text: word.to_owned(),
        });
    }

    fn stroke(&self, width: f32, colour: Colour) -> Stroke {
        Stroke { width: width * self.scale, colour }
    }

    fn text(&self, position: Vec2, anchor: Anchor, text: String) -> OverlayItem {
        OverlayItem::Text {
            position,
            anchor,
            size: 11.0 * self.scale,
            colour: self.palette.faint_text,
            bold: false,
            text,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside_the_axis() {
        let axis = Axis::symmetric(1.62);
        let ticks: Vec<f64> = axis.ticks().collect();
        assert_eq!(ticks, [-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5]);
        assert_eq!(axis.decimals(), 1);
        assert_eq!(Axis::exactly(0.0, 60.0).tick, 10.0);
        let millimetres = Axis { multiple: 1e-3, ..Axis::exactly(-0.002, 0.002) };
        assert_eq!(
            millimetres.sparse().ticks().map(|x| millimetres.sparse().written(x)).collect::<Vec<_>>(),
            ["−2", "−1", "0", "1", "2"]
        );
    }

    #[test]
    fn data_map_to_the_corners_of_the_area() {
        let plot = Plot {
            panel: Rectangle { min: Vec2::new(100.0, 50.0), max: Vec2::new(400.0, 250.0) },
            scale: 1.0,
            palette: Palette::of(crate::scene::Theme::Dark),
            title: String::new(),
            x_label: String::new(),
            y_label: String::new(),
            x: Axis::exactly(0.0, 10.0),
            y: Axis::exactly(-1.0, 1.0),
            right: RIGHT,
        };
        assert_eq!(plot.pixel(0.0, -1.0), Vec2::new(150.0, 226.0));
        assert_eq!(plot.pixel(10.0, 1.0), Vec2::new(386.0, 90.0));
    }
}
