//! Words over the scene: headline, parameters, time, contact state, energy.

use super::Solution;
use super::motion::Instant;
use super::numbers::with_power;
use super::palette::Palette;
use crate::model::Scales;
use crate::render::{Anchor, Colour, OverlayItem, Rectangle, text_width};
use crate::scene::Case;
use glam::Vec2;

fn text(position: Vec2, size: f32, colour: Colour, bold: bool, text: String) -> OverlayItem {
    OverlayItem::Text { position, anchor: Anchor::Left, size, colour, bold, text }
}

/// Sizes of a headline, the usual and the smallest, and of a caption, and distance of their lines; pixels of a 720 lines high picture.
const HEADLINE: [f32; 2] = [28.0, 19.0];
const CAPTION: [f32; 2] = [15.0, 20.0];
/// Height of the lines above the status: what computed the motion, and how far the exact solution is from it.
pub const ABOVE: [f32; 2] = [14.0, 33.0];

/// Headline and caption as they break into lines that fit the width.
struct Headline {
    size: f32,
    title: Vec<String>,
    caption: Vec<String>,
}

impl Headline {
    /// A long headline is written smaller, a very long one in several lines.
    fn new(title: &str, caption: &str, width: f32, scale: f32) -> Self {
        let [usual, least] = HEADLINE.map(|size| size * scale);
        let size = (usual * width / text_width(title, usual, true)).clamp(least, usual);
        let title = wrap(title, size, true, width);
        Self { size, title, caption: wrap(caption, CAPTION[0] * scale, false, width) }
    }

    /// Below the top: lines of the headline, and of the caption.
    fn title_line(&self, row: usize, scale: f32) -> f32 {
        26.0 * scale + 1.2 * self.size * row as f32
    }

    fn caption_line(&self, row: usize, scale: f32) -> f32 {
        self.title_line(self.title.len().saturating_sub(1), scale) + (26.0 + CAPTION[1] * row as f32) * scale
    }
}

/// Height of headline and caption with the highest of the captions.
pub fn headline_height<'a>(title: &str, captions: impl Iterator<Item = &'a str>, width: f32, scale: f32) -> f32 {
    let foot = |caption| {
        let headline = Headline::new(title, caption, width, scale);
        headline.caption_line(headline.caption.len().saturating_sub(1), scale)
    };
    captions.map(foot).fold(0.0, f32::max) + 12.0 * scale
}

/// Headline and caption, top left; the caption is shown as far as its second part says.
pub fn draw_headline(
    title: &str,
    (caption, shown): (&str, f64),
    palette: &Palette,
    (origin, width): (Vec2, f32),
    scale: f32,
    out: &mut Vec<OverlayItem>,
) {
    let headline = Headline::new(title, caption, width, scale);
    for (row, line) in headline.title.iter().enumerate() {
        let place = origin + Vec2::new(0.0, headline.title_line(row, scale));
        out.push(text(place, headline.size, palette.text, true, line.clone()));
    }
    let colour = palette.faint_text.with_alpha(shown as f32);
    for (row, line) in headline.caption.iter().enumerate() {
        let place = origin + Vec2::new(0.0, headline.caption_line(row, scale));
        out.push(text(place, CAPTION[0] * scale, colour, false, line.clone()));
    }
}

/// What computed the motion.
pub fn draw_solution(solution: &Solution, palette: &Palette, place: Vec2, scale: f32, out: &mut Vec<OverlayItem>) {
    let words = match solution {
        Solution::Exact => "motion: exact solution".to_owned(),
        Solution::Engine(name) => format!("motion: {name}"),
        Solution::Stored(name) => format!("motion: {name}"),
    };
    out.push(text(place, 13.0 * scale, palette.faint_text, false, words));
}

/// Breaks a text between words into lines no wider than `width`.
fn wrap(words: &str, size: f32, bold: bool, width: f32) -> Vec<String> {
    words.split_whitespace().fold(Vec::new(), |mut lines: Vec<String>, word| {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size, bold) <= width * (1.0 + 1e-5) => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
        lines
    })
}

/// Contact state and time at the left, parameters at the right end of the line below the scene.
pub fn draw_status(
    case: &Case,
    palette: &Palette,
    now: &Instant,
    (origin, right): (Vec2, f32),
    scale: f32,
    out: &mut Vec<OverlayItem>,
) {
    let colour = palette.contact(now.contact);
    let word = if now.contact.is_stick() { "STICK" } else { "SLIP" };
    let chip = Rectangle { min: origin, max: origin + Vec2::new(78.0, 28.0) * scale };
    out.push(OverlayItem::Box { area: chip, corner_radius: 14.0 * scale, fill: colour, stroke: None });
    out.push(OverlayItem::Text {
        position: origin + Vec2::new(39.0, 19.5) * scale,
        anchor: Anchor::Centre,
        size: 15.0 * scale,
        colour: palette.chip_text,
        bold: true,
        text: word.to_owned(),
    });
    let time = if case.scales == Scales::UNITY {
        format!("t = {:.1}", now.time)
    } else {
        format!("t = {:.3} s", now.time * case.scales.time)
    };
    out.push(text(origin + Vec2::new(94.0, 21.0) * scale, 20.0 * scale, palette.text, true, time));
    let (p, xi1) = (case.parameters, case.excitation().at(now.time));
    let parameters = match case.prescribed {
        None => {
            format!("ξ₁ = {}   ξ₂ = {}   κ = {}   γ = {}", short(xi1), short(p.xi2), short(p.kappa), short(p.gamma))
        }
        Some(m) if m.angular_frequency == 1.0 => format!("x₁ = {} sin t", short(m.amplitude)),
        Some(m) => format!("x₁ = {} sin({} t)", short(m.amplitude), short(m.angular_frequency)),
    };
    out.push(OverlayItem::Text {
        position: Vec2::new(right - 14.0 * scale, origin.y + 20.0 * scale),
        anchor: Anchor::Right,
        size: 14.0 * scale,
        colour: palette.faint_text,
        bold: false,
        text: parameters,
    });
}

/// How much displacements are magnified; in SI those of a millimetre. `carriage_widths` is what a non-dimensional displacement of 1 is
/// drawn as.
pub fn magnification(scales: &Scales, carriage_widths: f32) -> String {
    let (unit, drawn) = match *scales {
        Scales::UNITY => ("1", f64::from(carriage_widths)),
        Scales { length, .. } => ("1 mm", 1e-3 * f64::from(carriage_widths) / length),
    };
    let drawn = match drawn {
        0.1..100.0 => format!("{drawn:.2}"),
        0.01..0.1 => format!("{drawn:.3}"),
        _ => with_power(drawn),
    };
    format!("displacement {unit} drawn as {drawn} carriage widths")
}

/// At most four significant digits after the point, without trailing zeros.
pub fn short(value: f64) -> String {
    let digits = format!("{value:.4}");
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    digits.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_without_needless_zeros() {
        assert_eq!(short(-0.06), "−0.06");
        assert_eq!(short(1.0), "1");
        assert_eq!(short(0.0346), "0.0346");
    }

    #[test]
    fn the_magnification_is_that_of_the_unit_shown() {
        let says = |scales, drawn: &str| {
            assert_eq!(magnification(&scales, 0.5), format!("displacement {drawn} carriage widths"));
        };
        says(Scales::UNITY, "1 drawn as 0.50");
        // 2 mm are half a carriage, or 5 m are.
        says(Scales { length: 0.002, ..Scales::UNITY }, "1 mm drawn as 0.25");
        says(Scales { length: 5.0, ..Scales::UNITY }, "1 mm drawn as 1.0·10⁻⁴");
    }

    #[test]
    fn a_long_headline_is_written_smaller_and_then_in_lines() {
        let palette = Palette::of(crate::scene::Theme::Dark);
        let drawn = |title: &str| {
            let mut out = Vec::new();
            draw_headline(title, ("", 1.0), &palette, (Vec2::ZERO, 400.0), 1.0, &mut out);
            let lines = out.into_iter().map(|item| match item {
                OverlayItem::Text { size, text, .. } => (size, text),
                other => panic!("a headline is text, not {other:?}"),
            });
            lines.collect::<Vec<_>>()
        };
        assert_eq!(drawn("Stick"), [(28.0, "Stick".to_owned())]);
        let long = drawn("A headline for seven blades");
        assert!(long.len() == 1 && (HEADLINE[1]..HEADLINE[0]).contains(&long[0].0), "{long:?}");
        let longer = drawn("A headline that goes on and on about all that is seen in the film");
        assert!(longer.len() == 2 && longer.iter().all(|(size, text)| text_width(text, *size, true) <= 400.0));
    }

    #[test]
    fn a_caption_is_broken_between_words_and_keeps_them_all() {
        let caption = "one two three four five six seven eight nine ten";
        let lines = wrap(caption, 15.0, false, 120.0);
        assert!(lines.len() > 1 && lines.iter().all(|line| text_width(line, 15.0, false) <= 120.0));
        assert_eq!(lines.join(" "), caption);
    }
}
