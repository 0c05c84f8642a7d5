//! One line of text in DejaVu Sans: glyphs side by side by their advance widths, unhinted along the line.

use crate::render::draw_list::Anchor;
use glam::Vec2;
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};
use std::fmt;
use std::sync::{Arc, OnceLock};
use vello_cpu::Glyph;
use vello_cpu::peniko::{Blob, FontData};

/// Regular and bold face.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Fonts;

impl Fonts {
    pub fn face(&self, bold: bool) -> &'static Face {
        static FACES: [OnceLock<Face>; 2] = [OnceLock::new(), OnceLock::new()];
        FACES[usize::from(bold)]
            .get_or_init(|| Face::new(if bold { dejavu::sans::bold() } else { dejavu::sans::regular() }))
    }
}

/// A font file, parsed.
pub(super) struct Face {
    data: FontData,
    font: FontRef<'static>,
}

impl fmt::Debug for Face {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Face").finish_non_exhaustive()
    }
}

impl Face {
    /// For the two files that are part of this program: no input can make it fail.
    fn new(file: &'static [u8]) -> Self {
        let font = FontRef::new(file).expect("the built-in font is a font");
        Self { data: FontData::new(Blob::new(Arc::new(file)), 0), font }
    }

    pub fn data(&self) -> &FontData {
        &self.data
    }

    /// Glyph numbers and their advances in pixels.
    fn advances(&self, text: &str, size: f32) -> impl Iterator<Item = (u32, f32)> {
        let letters = self.font.charmap();
        let metrics = self.font.glyph_metrics(Size::new(size), LocationRef::default());
        text.chars().map(move |letter| {
            let glyph = letters.map(letter).unwrap_or_default();
            (glyph.to_u32(), metrics.advance_width(glyph).unwrap_or_default())
        })
    }

    fn width(&self, text: &str, size: f32) -> f32 {
        self.advances(text, size).map(|(_, advance)| advance).sum()
    }

    /// Glyphs with their places; `position` on the baseline is the line's left end, middle or right end.
    pub fn lay_out(&self, text: &str, size: f32, anchor: Anchor, position: Vec2) -> Vec<Glyph> {
        let before = match anchor {
            Anchor::Left => 0.0,
            Anchor::Centre => self.width(text, size) / 2.0,
            Anchor::Right => self.width(text, size),
        };
        let mut x = position.x - before;
        self.advances(text, size)
            .map(|(id, advance)| {
                let glyph = Glyph { id, x, y: position.y };
                x += advance;
                glyph
            })
            .collect()
    }
}

/// Width in pixels of a line of text of the given font size in pixels, as drawn by [`OverlayItem::Text`](crate::render::OverlayItem::Text).
#[must_use]
pub fn text_width(text: &str, size: f32, bold: bool) -> f32 {
    Fonts.face(bold).width(text, size)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The advance of a digit is 1303 of 2048 units in DejaVu Sans, 1425 in its bold.
    #[test]
    fn digits_have_the_width_of_the_font_file() {
        // Advances come in 64ths of a pixel.
        assert!((text_width("0000", 20.48, false) - 4.0 * 13.03).abs() <= 4.0 / 64.0);
        assert!((text_width("0000", 20.48, true) - 4.0 * 14.25).abs() <= 4.0 / 64.0);
        assert!(text_width("", 20.0, false) == 0.0);
    }

    #[test]
    fn the_letters_of_the_subject_are_in_the_font() {
        for bold in [false, true] {
            for letter in "xẋẍω₁₂₃ζμδΔΩπ²√−±×°·≤≥→µτφθλ".chars() {
                let glyph = Fonts.face(bold).advances(&letter.to_string(), 16.0).next().unwrap().0;
                assert_ne!(glyph, 0, "{letter} is missing, bold: {bold}");
            }
        }
    }

    #[test]
    fn anchors_shift_by_the_width() {
        let face = Fonts.face(false);
        let start = |anchor| face.lay_out("abc", 16.0, anchor, Vec2::new(100.0, 5.0))[0].x;
        let width = text_width("abc", 16.0, false);
        assert_eq!(start(Anchor::Left), 100.0);
        assert_eq!(start(Anchor::Centre), 100.0 - width / 2.0);
        assert_eq!(start(Anchor::Right), 100.0 - width);
    }
}
