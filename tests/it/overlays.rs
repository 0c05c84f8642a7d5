//! Lines, shapes and text over a picture, pixel by pixel.

use crate::small_scene::{BACKDROP, RED, draw, empty};
use glam::Vec2;
use image::{Rgba, RgbaImage};
use stickslip::render::{Anchor, DrawList, OverlayItem, Rectangle, Stroke, text_width};

fn overlay(items: Vec<OverlayItem>) -> RgbaImage {
    draw(&DrawList { overlay: items, ..empty() })
}

#[test]
fn a_line_is_drawn_inside_its_clip_and_not_outside() {
    let image = overlay(vec![OverlayItem::Line {
        points: vec![Vec2::new(-20.0, 50.5), Vec2::new(120.0, 50.5)],
        stroke: Stroke { width: 1.0, colour: RED },
        clip: Some(Rectangle { min: Vec2::new(30.0, 20.0), max: Vec2::new(70.0, 80.0) }),
    }]);
    for (x, y, pixel) in image.enumerate_pixels() {
        let expected = if y == 50 && (30..70).contains(&x) { Rgba([255, 0, 0, 255]) } else { BACKDROP };
        assert_eq!(*pixel, expected, "pixel {x}, {y}");
    }
}

#[test]
fn boxes_and_polygons_blend_by_their_alpha() {
    let square = [[20.0, 20.0], [40.0, 20.0], [40.0, 40.0], [20.0, 40.0]].map(Vec2::from).to_vec();
    let area = Rectangle { min: Vec2::new(60.0, 20.0), max: Vec2::new(80.0, 40.0) };
    let fill = RED.with_alpha(0.5);
    let image = overlay(vec![
        OverlayItem::Polygon { points: square, fill, clip: None },
        OverlayItem::Box { area, corner_radius: 0.0, fill, stroke: None },
    ]);
    for x in [30, 70] {
        let [r, g, b, a] = image.get_pixel(x, 30).0;
        // 128/255 of red over (32, 48, 64); one level for the rounding of two products.
        let close = |value: u8, expected: f32| (f32::from(value) - expected).abs() <= 1.5;
        assert!(close(r, 143.9) && close(g, 23.9) && close(b, 31.9) && a == 255, "{r} {g} {b} {a}");
    }
    assert_eq!(*image.get_pixel(50, 30), BACKDROP);
}

/// The stem of a capital I stands in the middle of its advance, from the baseline up to 0.73 of the font size.
#[test]
fn text_stands_on_its_baseline_and_its_anchor() {
    for (anchor, shift) in [(Anchor::Left, 0.5), (Anchor::Centre, 0.0), (Anchor::Right, -0.5)] {
        let item = |text: &str| OverlayItem::Text {
            position: Vec2::new(50.0, 60.0),
            anchor,
            size: 40.0,
            colour: RED,
            bold: false,
            text: text.into(),
        };
        let image = overlay(vec![item("I")]);
        let drawn: Vec<(u32, u32)> =
            image.enumerate_pixels().filter(|(_, _, p)| p.0[0] > 140).map(|(x, y, _)| (x, y)).collect();
        let (top, bottom) = (drawn.iter().map(|p| p.1).min().unwrap(), drawn.iter().map(|p| p.1).max().unwrap());
        let middle = drawn.iter().map(|p| p.0 as f32 + 0.5).sum::<f32>() / drawn.len() as f32;
        assert!(bottom == 59 && (30..=32).contains(&top), "rows {top} to {bottom}");
        // Half a pixel each for the two edges of the stem.
        assert!((middle - 50.0 - shift * text_width("I", 40.0, false)).abs() <= 1.0, "{anchor:?}: {middle}");
        assert!(overlay(vec![item("")]).pixels().all(|pixel| *pixel == BACKDROP), "text without letters");
    }
}
