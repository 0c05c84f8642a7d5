//! A ledger as a panel of horizontal bars about zero, each with its label and its number, on a scale with marks.

use super::full_scale::marks;
use crate::render::{Anchor, Colour, OverlayItem, Rectangle, Stroke, text_width};
use crate::stage::numbers;
use crate::stage::palette::Palette;
use glam::Vec2;

/// Left ends of labels and bars and right end of the numbers, and first row, pixels of a 720 lines high picture.
const LABEL: f32 = 12.0;
const BARS: f32 = 100.0;
const NUMBERS: f32 = 84.0;
const FIRST_ROW: f32 = 46.0;

/// One row.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    pub label: &'static str,
    pub colour: Colour,
    pub value: f64,
    /// What is written at its end.
    pub number: String,
}

/// Where the bars stand.
#[derive(Debug, Clone)]
pub struct Bars {
    pub place: Rectangle,
    pub scale: f32,
    pub palette: Palette,
    pub title: String,
    /// What a value of 1 is written as.
    pub unit: f64,
}

impl Bars {
    /// A bar as long as there is room has the value `full`.
    pub fn draw(&self, bars: Vec<Bar>, full: f64, out: &mut Vec<OverlayItem>) {
        let (s, palette) = (self.scale, &self.palette);
        out.push(OverlayItem::Box {
            area: self.place,
            corner_radius: 8.0 * s,
            fill: palette.panel,
            stroke: Some(Stroke { width: s, colour: palette.panel_edge }),
        });
        let text = |position, anchor, size, colour, bold, text| self.text(position, anchor, size, colour, bold, text);
        let corner = self.place.min + Vec2::new(LABEL, 19.0) * s;
        out.push(text(corner, Anchor::Left, 13.0, palette.text, true, self.title.clone()));
        let row = (self.place.max.y - self.place.min.y - (FIRST_ROW - 4.0) * s) / bars.len().max(1) as f32;
        let (left, right) = (self.place.min.x + BARS * s, self.place.max.x - NUMBERS * s);
        let zero = 0.5 * (left + right);
        self.draw_marks(zero, 0.5 * (right - left), full, out);
        for (number, bar) in bars.into_iter().enumerate() {
            let middle = self.place.min.y + FIRST_ROW * s + row * number as f32;
            let end = zero + 0.5 * (right - left) * (bar.value / full).clamp(-1.0, 1.0) as f32;
            let half = (0.28 * row).min(9.0 * s);
            out.push(OverlayItem::Box {
                area: Rectangle {
                    min: Vec2::new(zero.min(end), middle - half),
                    max: Vec2::new(zero.max(end), middle + half),
                },
                corner_radius: 0.0,
                fill: bar.colour,
                stroke: None,
            });
            let baseline = middle + 4.0 * s;
            let label = Vec2::new(self.place.min.x + LABEL * s, baseline);
            out.push(text(label, Anchor::Left, 12.0, palette.text, false, bar.label.to_owned()));
            let place = Vec2::new(self.place.max.x - LABEL * s, baseline);
            out.push(text(place, Anchor::Right, 12.0, palette.faint_text, false, bar.number));
        }
    }

    /// Zero and a round value or two at both sides of it, where the longest bar is `half` long.
    fn draw_marks(&self, zero: f32, half: f32, full: f64, out: &mut Vec<OverlayItem>) {
        let (s, palette) = (self.scale, &self.palette);
        let [head, foot] = [self.place.min.y + 36.0 * s, self.place.max.y - 10.0 * s];
        let mut line = |x: f32, colour| {
            let points = vec![Vec2::new(x, head), Vec2::new(x, foot)];
            out.push(OverlayItem::Line { points, stroke: Stroke { width: s, colour }, clip: None });
        };
        let marks = marks(full * self.unit);
        let shift = |value: f64| half * (value / (full * self.unit)) as f32;
        let both = || marks.iter().flat_map(|mark| [(-mark.value, mark), (mark.value, mark)]);
        for (value, mark) in both() {
            line(zero + shift(value), palette.zero_line.with_alpha(0.6 * mark.line));
        }
        line(zero, palette.zero_line);
        for mark in marks.iter().filter(|mark| mark.number > 0.0) {
            let word = if (1e-3..1e4).contains(&mark.value) {
                format!("{}", mark.value)
            } else {
                numbers::with_power(mark.value)
            };
            let negative = format!("−{word}");
            // Where both have no room the sign is plain without the left one.
            let is_free = text_width(&negative, 10.0 * s, false) < 1.8 * shift(mark.value);
            let words = [(-mark.value, negative, is_free), (mark.value, word, true)];
            for (value, word, _) in words.into_iter().filter(|(_, _, is_shown)| *is_shown) {
                let place = Vec2::new(zero + shift(value), head - 3.0 * s);
                let colour = palette.faint_text.with_alpha(mark.number);
                out.push(self.text(place, Anchor::Centre, 10.0, colour, false, word));
            }
        }
    }

    fn text(&self, position: Vec2, anchor: Anchor, size: f32, colour: Colour, bold: bool, text: String) -> OverlayItem {
        OverlayItem::Text { position, anchor, size: size * self.scale, colour, bold, text }
    }
}

/// The largest absolute value.
pub fn largest(bars: &[Bar]) -> f64 {
    bars.iter().map(|bar| bar.value.abs()).fold(0.0, f64::max)
}

/// With its sign; three digits after the point, or two and the power of ten where asked for or where there is no room.
pub fn written(value: f64, with_power: bool) -> String {
    if with_power || value.abs() >= 1000.0 {
        let sign = if value > 0.0 { "+" } else { "" };
        return format!("{sign}{}", numbers::with_power(value));
    }
    let text = format!("{value:+.3}");
    // A sign before nothing says nothing.
    if text == "-0.000" || text == "+0.000" {
        return "0.000".to_owned();
    }
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energies_are_written_with_their_sign() {
        assert_eq!(written(0.12345, false), "+0.123");
        assert_eq!(written(-2.0, false), "−2.000");
        assert_eq!(written(-0.0001, false), "0.000");
        assert_eq!(written(-2.34e-6, true), "−2.3·10⁻⁶");
        assert_eq!(written(2.34e-6, true), "+2.3·10⁻⁶");
        assert_eq!(written(530_954.553, false), "+5.3·10⁵");
    }
}
