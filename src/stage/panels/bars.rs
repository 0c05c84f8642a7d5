//! A ledger as a panel of horizontal bars about zero, each with its label and its number.

use crate::render::{Anchor, Colour, OverlayItem, Rectangle, Stroke};
use crate::stage::numbers;
use crate::stage::palette::Palette;
use glam::Vec2;

/// Left ends of labels and bars and right end of the numbers, and first row, pixels of a 720 lines high picture.
const LABEL: f32 = 12.0;
const BARS: f32 = 100.0;
const NUMBERS: f32 = 72.0;
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
    /// Value of the longest bar.
    pub largest: f64,
}

impl Bars {
    pub fn draw(&self, bars: Vec<Bar>, out: &mut Vec<OverlayItem>) {
        let (s, palette) = (self.scale, &self.palette);
        out.push(OverlayItem::Box {
            area: self.place,
            corner_radius: 8.0 * s,
            fill: palette.panel,
            stroke: Some(Stroke { width: s, colour: palette.panel_edge }),
        });
        let text = |position, anchor, size: f32, colour, bold, text| OverlayItem::Text {
            position,
            anchor,
            size: size * s,
            colour,
            bold,
            text,
        };
        let corner = self.place.min + Vec2::new(LABEL, 19.0) * s;
        out.push(text(corner, Anchor::Left, 13.0, palette.text, true, self.title.clone()));
        let row = (self.place.max.y - self.place.min.y - (FIRST_ROW - 4.0) * s) / bars.len().max(1) as f32;
        let (left, right) = (self.place.min.x + BARS * s, self.place.max.x - NUMBERS * s);
        let zero = 0.5 * (left + right);
        let foot = self.place.max.y - 10.0 * s;
        out.push(OverlayItem::Line {
            points: vec![Vec2::new(zero, self.place.min.y + 32.0 * s), Vec2::new(zero, foot)],
            stroke: Stroke { width: s, colour: palette.zero_line },
            clip: None,
        });
        for (number, bar) in bars.into_iter().enumerate() {
            let middle = self.place.min.y + FIRST_ROW * s + row * number as f32;
            let end = zero + 0.5 * (right - left) * (bar.value / self.largest).clamp(-1.0, 1.0) as f32;
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
}

/// With its sign; three digits after the point, or two and the power of ten.
pub fn written(value: f64, with_power: bool) -> String {
    if with_power {
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
    }
}
