//! Pictures with a transparent background: put over the empty stage they are the opaque picture, and no edge has a fringe.

use crate::demonstration;
use crate::small_scene::{GLOWING, RED, empty, object, triangle};
use glam::{Vec2, Vec3};
use image::{Rgba, RgbaImage};
use stickslip::render::{Background, Colour, DrawList, OverlayItem, Rectangle, RendererChoice, open};

const CLEAR: Background = Background { top: Colour([0; 4]), bottom: Colour([0; 4]) };

/// The built-in rasteriser, and every software driver that is installed.
fn each(mut check: impl FnMut(&str, &mut dyn FnMut(&DrawList) -> RgbaImage)) {
    let mut drivers = 0;
    for choice in [RendererChoice::Cpu, RendererChoice::SoftwareVulkan, RendererChoice::SoftwareGl] {
        let Ok(mut renderer) = open(choice) else { continue };
        let name = format!("{} ({})", renderer.info().adapter, renderer.info().backend);
        check(&name, &mut |list| renderer.draw(list).unwrap().0);
        drivers += 1;
    }
    if drivers == 1 {
        println!("only the built-in rasteriser was tried: no software driver is installed");
    }
}

/// Porter and Duff's `over` in sRGB codes, as viewers and browsers do it.
fn over(front: &RgbaImage, back: &RgbaImage) -> RgbaImage {
    RgbaImage::from_fn(front.width(), front.height(), |x, y| {
        let (f, b) = (front.get_pixel(x, y).0, back.get_pixel(x, y).0);
        let alpha = f32::from(f[3]) / 255.0;
        let mix = |i: usize| (f32::from(f[i]) * alpha + f32::from(b[i]) * (1.0 - alpha)).round() as u8;
        Rgba([mix(0), mix(1), mix(2), 255])
    })
}

fn apart(p: &Rgba<u8>, q: &Rgba<u8>) -> u8 {
    (0..3).map(|i| p.0[i].abs_diff(q.0[i])).max().unwrap_or(0)
}

/// The same in light, as edges are averaged where they are drawn.
fn over_in_light(front: &RgbaImage, back: &RgbaImage) -> RgbaImage {
    // IEC 61966-2-1
    let decode = |code: u8| {
        let code = f64::from(code) / 255.0;
        if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
    };
    let encode = |light: f64| {
        let code = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
        (255.0 * code).round() as u8
    };
    RgbaImage::from_fn(front.width(), front.height(), |x, y| {
        let (f, b) = (front.get_pixel(x, y).0, back.get_pixel(x, y).0);
        let alpha = f64::from(f[3]) / 255.0;
        let mix = |i: usize| encode(decode(f[i]) * alpha + decode(b[i]) * (1.0 - alpha));
        Rgba([mix(0), mix(1), mix(2), 255])
    })
}

fn furthest_apart(a: &RgbaImage, b: &RgbaImage) -> u8 {
    a.pixels().zip(b.pixels()).map(|(p, q)| apart(p, q)).max().unwrap_or(0)
}

/// Opaque, with nothing but the floor, and before nothing.
fn pictures() -> [DrawList; 3] {
    let opaque = DrawList { overlay: Vec::new(), ..demonstration::picture([480, 320], 0.4) };
    let stage = DrawList { objects: opaque.objects[..1].to_vec(), ..opaque.clone() };
    let mut clear = DrawList { background: CLEAR, ..opaque.clone() };
    clear.objects[0].material.colour = opaque.objects[0].material.colour.with_alpha(0.0);
    [opaque, stage, clear]
}

#[test]
fn over_the_empty_stage_it_is_the_opaque_picture() {
    each(|name, draw| {
        let [opaque, stage, clear] = pictures().map(|list| draw(&list));
        let composed = over(&clear, &stage);
        let counts = [0, 255].map(|alpha| clear.pixels().filter(|p| p.0[3] == alpha).count());
        let shadow = clear.pixels().filter(|p| p.0[3] > 20 && p.0[3] < 235 && p.0[..3] == [0; 3]).count();
        assert!(counts.iter().all(|count| *count > 10_000) && shadow > 500, "{name}: {counts:?}, {shadow}");
        let mut worst = [0; 3];
        for (x, y, pixel) in clear.enumerate_pixels() {
            let apart = apart(composed.get_pixel(x, y), opaque.get_pixel(x, y));
            // A pixel of a shadow is black; all others that are not opaque lie on edges.
            let kind = if [0, 255].contains(&pixel.0[3]) { 0 } else { 1 + usize::from(pixel.0[..3] != [0; 3]) };
            worst[kind] = worst[kind].max(apart);
        }
        println!("{name}: whole pixels {}, shadows {}, edges {}", worst[0], worst[1], worst[2]);
        // Opaque pixels are the same to the rounding, and so are clear ones but for a last breath of shadow below half a level of alpha.
        assert!(worst[0] <= 2, "{name}: {}", worst[0]);
        // One alpha stands for three channels, of which sunless ones are bluer: 1/2 of their largest difference, measured 8.
        assert!(worst[1] <= 10, "{name}: {}", worst[1]);
        // Edges are averaged in light where they are drawn, and in codes where they are composed: half of black and white is 188 or 128.
        assert!(worst[2] <= 61, "{name}: {}", worst[2]);
    });
}

/// Without shadows only edges are translucent: in light they are those of the opaque picture to the rounding of alpha, 1/510 of the light,
/// which is most codes in the dark beside a bright body: 12.92 x 255/510 = 6.5.
#[test]
fn edges_composed_in_light_are_those_of_the_opaque_picture() {
    each(|name, draw| {
        let [opaque, stage, clear] = pictures().map(|mut list| {
            list.objects.iter_mut().for_each(|object| object.casts_shadow = false);
            draw(&list)
        });
        assert!(clear.pixels().filter(|p| (1..255).contains(&p.0[3])).count() > 1_000, "{name}: no edges");
        let found = furthest_apart(&over_in_light(&clear, &stage), &opaque);
        // Negative control: colours that are multiplied by alpha already have dark fringes.
        let mut wrong = clear.clone();
        stickslip::render::premultiply(&mut wrong);
        let control = furthest_apart(&over_in_light(&wrong, &stage), &opaque);
        println!("{name}: edges {found}, control {control}");
        assert!(found <= 7 && control > 40, "{name}: {found}, control {control}");
    });
}

#[test]
fn edges_have_the_colour_of_their_body_and_its_part_of_the_pixel() {
    let mut list = DrawList { background: CLEAR, ..empty() };
    list.objects.push(object(triangle([[-0.8, -0.8], [0.8, -0.8], [-0.8, 0.8]]), Vec3::ZERO, GLOWING));
    each(|name, draw| {
        let image = draw(&list);
        let inside = image.get_pixel(30, 60).0;
        assert_eq!(inside[3], 255);
        assert_eq!(image.get_pixel(95, 5).0, [0; 4]);
        // The diagonal passes between two and two of four samples. On a driver the light is divided by its alpha: 0.25 and a code of 8 bits.
        assert!(image.get_pixel(50, 50).0[3].abs_diff(128) <= 1, "{name}: {:?}", image.get_pixel(50, 50));
        for pixel in image.pixels().filter(|pixel| pixel.0[3] > 0) {
            assert!(apart(pixel, &Rgba(inside)) <= 3, "{name}: {pixel:?} is not {inside:?}");
        }
    });
}

#[test]
fn what_is_written_over_nothing_keeps_its_own_alpha() {
    let area = |left: f32| Rectangle { min: Vec2::new(left, 10.0), max: Vec2::new(left + 20.0, 30.0) };
    let item = |left, fill| OverlayItem::Box { area: area(left), corner_radius: 0.0, fill, stroke: None };
    let overlay = vec![item(10.0, RED.with_alpha(0.5)), item(50.0, RED)];
    let list = DrawList { background: CLEAR, overlay, ..empty() };
    each(|name, draw| {
        let image = draw(&list);
        // 128 of 255 times 255 is the code, and back.
        assert_eq!(image.get_pixel(20, 20).0, [255, 0, 0, 128], "{name}");
        assert_eq!(image.get_pixel(60, 20).0, [255, 0, 0, 255], "{name}");
        assert_eq!(image.get_pixel(40, 20).0, [0; 4], "{name}");
    });
}
