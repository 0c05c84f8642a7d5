//! What the pictures show, pixel by pixel, on the built-in rasteriser; and the graphics path against it.

use crate::demonstration;
use glam::{Affine3A, Vec2, Vec3};
use image::{Rgba, RgbaImage};
use sha2::{Digest, Sha256};
use std::sync::Arc;
use stickslip::render::shapes::{block, floor};
use stickslip::render::{
    Anchor, Background, Camera, Colour, CpuRenderer, DrawList, Light, Material, Mesh, Object, OverlayItem, Rectangle,
    RenderError, Renderer, RendererChoice, Stroke, open, text_width,
};

const SKY: Colour = Colour::rgb(0x20_30_40);
const RED: Colour = Colour::rgb(0xff_00_00);

/// Glows red and reflects nothing worth mentioning: its colour does not depend on the light.
const GLOWING: Material = Material { colour: RED, roughness: 1.0, metallic: 0.0, glow: 1.0 };

/// Camera on +z looking at the origin: at z = 0 the picture is 2 units high, so a 100 pixel picture shows 50 pixels a unit.
fn empty() -> DrawList {
    DrawList {
        size: [100, 100],
        background: Background { top: SKY, bottom: SKY },
        camera: Camera {
            eye: Vec3::Z * 2.0,
            target: Vec3::ZERO,
            up: Vec3::Y,
            vertical_field_of_view: 2.0 * 0.5_f32.atan(),
            viewport: [0.0, 0.0, 1.0, 1.0],
        },
        light: Light {
            direction: Vec3::Y,
            colour: Colour::rgb(0xff_ff_ff),
            intensity: 0.6,
            sky: Colour::rgb(0x60_60_60),
            ground: Colour::rgb(0x20_20_20),
            shadow_centre: Vec3::ZERO,
            shadow_radius: 3.0,
        },
        objects: Vec::new(),
        overlay: Vec::new(),
    }
}

fn object(mesh: Mesh, place: Vec3, material: Material) -> Object {
    Object { mesh: Arc::new(mesh), transform: Affine3A::from_translation(place), material, casts_shadow: true }
}

/// A triangle in the plane z = 0, seen from its front.
fn triangle(corners: [[f32; 2]; 3]) -> Mesh {
    Mesh {
        positions: corners.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 3],
        triangles: vec![[0, 1, 2]],
    }
}

fn draw(list: &DrawList) -> RgbaImage {
    CpuRenderer::new("test").draw(list).unwrap().0
}

fn brightness(pixel: &Rgba<u8>) -> u32 {
    pixel.0[..3].iter().map(|&channel| u32::from(channel)).sum()
}

const BACKDROP: Rgba<u8> = Rgba([0x20, 0x30, 0x40, 255]);

#[test]
fn an_empty_scene_is_the_backdrop() {
    let mut list = empty();
    assert!(draw(&list).pixels().all(|pixel| *pixel == BACKDROP));
    list.background.bottom = Colour::rgb(0xe0_30_40);
    let image = draw(&list);
    // 0x20 + 0xc0 x (row + 1/2) / 100: a row in the middle of the gradient.
    assert_eq!(image.get_pixel(3, 25).0, [(32.0 + 192.0 * 0.255_f32).round() as u8, 0x30, 0x40, 255]);
    assert!((0..99).all(|row| image.get_pixel(50, row).0[0] <= image.get_pixel(50, row + 1).0[0]));
}

/// Corners at (-0.8, -0.8), (0.8, -0.8), (-0.8, 0.8): pixels 10 to 90, below the diagonal x + y = 0.
#[test]
fn a_triangle_covers_the_pixels_inside_it_and_no_others() {
    let mut list = empty();
    list.objects.push(object(triangle([[-0.8, -0.8], [0.8, -0.8], [-0.8, 0.8]]), Vec3::ZERO, GLOWING));
    let image = draw(&list);
    for (x, y, pixel) in image.enumerate_pixels() {
        let inside = (10..90).contains(&x) && (10..90).contains(&y) && y > x;
        // Pixels on the diagonal are half covered.
        if x != y || !(10..90).contains(&x) {
            assert_eq!(*pixel != BACKDROP, inside, "pixel {x}, {y}");
        }
    }
    assert!(image.get_pixel(30, 60).0[0] > 200);
}

#[test]
fn the_back_of_a_triangle_does_not_show() {
    let mut list = empty();
    list.objects.push(object(triangle([[-0.8, -0.8], [-0.8, 0.8], [0.8, -0.8]]), Vec3::ZERO, GLOWING));
    assert!(draw(&list).pixels().all(|pixel| *pixel == BACKDROP));
}

/// The diagonal of the triangle above cuts each of its pixels: two of four samples lie inside.
#[test]
fn edges_get_intermediate_values() {
    let mut list = empty();
    list.objects.push(object(triangle([[-0.8, -0.8], [0.8, -0.8], [-0.8, 0.8]]), Vec3::ZERO, GLOWING));
    let image = draw(&list);
    let (inside, edge) = (image.get_pixel(30, 60).0[0], image.get_pixel(50, 50).0[0]);
    assert!(edge > 0x20 + 40 && edge < inside - 40, "{edge} between {} and {inside}", 0x20);
}

/// Two triangles that share an edge leave no gap and draw no sample twice: along the seam the colour is that of the inside.
#[test]
fn neighbours_meet_without_a_seam() {
    let mut list = empty();
    let (a, b, c, d) = ([-0.83, -0.71], [0.77, -0.69], [0.71, 0.83], [-0.79, 0.73]);
    list.objects.push(object(triangle([a, b, c]), Vec3::ZERO, GLOWING));
    list.objects.push(object(triangle([a, c, d]), Vec3::ZERO, GLOWING));
    let image = draw(&list);
    let inside = *image.get_pixel(50, 70);
    assert!((20..80).all(|x| (20..80).all(|y| *image.get_pixel(x, y) == inside)));
}

#[test]
fn the_nearer_object_hides_the_farther_whatever_the_order() {
    let green = Material { colour: Colour::rgb(0x00_ff_00), ..GLOWING };
    let near = object(block(Vec3::splat(0.2), 0.01), Vec3::Z * 0.5, green);
    let far = object(block(Vec3::splat(0.6), 0.01), Vec3::Z * -0.5, GLOWING);
    for objects in [vec![near.clone(), far.clone()], vec![far, near]] {
        let image = draw(&DrawList { objects, ..empty() });
        let ([r, g, ..], [r_beside, g_beside, ..]) = (image.get_pixel(50, 50).0, image.get_pixel(32, 50).0);
        assert!(g > r && r_beside > g_beside, "{:?} {:?}", image.get_pixel(50, 50), image.get_pixel(32, 50));
    }
}

/// A scene seen from above: floor, and a block that floats over its middle, light from straight above or from the side.
fn table(direction: Vec3, casts_shadow: bool) -> DrawList {
    let white = Material { colour: Colour::rgb(0xc0_c0_c0), roughness: 1.0, metallic: 0.0, glow: 0.0 };
    let mut list = empty();
    list.camera.eye = Vec3::new(0.0, 2.0, 0.0);
    list.camera.up = Vec3::NEG_Z;
    list.light.direction = direction;
    list.light.shadow_radius = 1.5;
    list.objects.push(object(floor(1.4, 1.4), Vec3::ZERO, white));
    list.objects.push(object(block(Vec3::new(0.1, 0.05, 0.1), 0.01), Vec3::Y * 0.3, white));
    list.objects[0].casts_shadow = false;
    list.objects[1].casts_shadow = casts_shadow;
    list
}

/// Light along (1, 1, 0): the shadow of a block at height 0.3 falls 0.3 to the left, on pixels around 50 - 15 = 35.
#[test]
fn a_shadow_falls_where_the_light_puts_it_and_only_with_a_caster() {
    let with = draw(&table(Vec3::new(1.0, 1.0, 0.0), true));
    let without = draw(&table(Vec3::new(1.0, 1.0, 0.0), false));
    let (shadow, lit) = (with.get_pixel(35, 50), with.get_pixel(75, 50));
    assert!(brightness(shadow) + 60 < brightness(lit), "{shadow:?} against {lit:?}");
    assert_eq!(without.get_pixel(35, 50), without.get_pixel(35, 20), "a shadow without a caster");
    // Beyond the soft edge nothing changes: half the block (5 pixels) and the filter (3 texels of 3 mm: 1 pixel) either way.
    for (x, y, pixel) in with.enumerate_pixels() {
        let beside = !(28..=57).contains(&x) || !(42..=58).contains(&y);
        assert!(!beside || pixel == without.get_pixel(x, y), "pixel {x}, {y} changed");
    }
}

#[test]
fn shadows_have_soft_edges() {
    let image = draw(&DrawList { size: [800, 800], ..table(Vec3::new(1.0, 1.0, 0.0), true) });
    let row: Vec<u32> = (160..280).map(|x| brightness(image.get_pixel(x, 400))).collect();
    let (low, high) = (row.iter().min().unwrap(), row.iter().max().unwrap());
    let between = row.iter().filter(|&&value| value > low + 10 && value + 10 < *high).count();
    // The filter is 6 texels or 18 mm wide: 7 of 400 pixels a unit, less the ends within 10 levels.
    assert!((4..=9).contains(&between), "{between} pixels of half shadow");
}

/// A plane that passes under and behind the eye must be cut at the near plane, not folded over.
#[test]
fn a_floor_that_reaches_behind_the_eye_is_cut() {
    let mut list = empty();
    list.camera.eye = Vec3::new(0.0, 0.5, 2.0);
    list.camera.target = Vec3::new(0.0, 0.5, 0.0);
    list.light.shadow_radius = 50.0;
    list.objects.push(object(floor(40.0, 40.0), Vec3::ZERO, GLOWING));
    let image = draw(&list);
    assert!((0..100).all(|x| *image.get_pixel(x, 45) == BACKDROP));
    assert!((0..100).all(|x| image.get_pixel(x, 60).0[0] > 200 && image.get_pixel(x, 99).0[0] > 200));
}

#[test]
fn far_surfaces_fade_into_the_backdrop() {
    let mut list = empty();
    list.light.shadow_radius = 0.2;
    list.objects.push(object(block(Vec3::splat(0.1), 0.01), Vec3::X * 0.8, GLOWING));
    assert!(draw(&list).pixels().all(|pixel| *pixel == BACKDROP));
}

#[test]
fn the_same_bytes_on_any_number_of_threads_and_every_time() {
    let list = demonstration::picture([320, 180], 0.4);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| draw(&list))
    };
    let first = on(1);
    assert!(first == on(4) && first == on(3));
    let mut renderer = CpuRenderer::new("test");
    renderer.draw(&demonstration::picture([200, 300], 2.0)).unwrap();
    assert!(renderer.draw(&list).unwrap().0 == first, "the picture depends on the one before");
}

fn hash(list: &DrawList) -> String {
    Sha256::digest(draw(list).as_raw()).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Bit for bit on every machine: the rasteriser uses only operations that IEEE 754 fixes. When the look is changed on purpose, look at the picture
/// of `cargo run --example render_still -- cpu`, then put the new hash here.
#[test]
fn the_demonstration_scene_is_the_known_picture() {
    let list = DrawList { overlay: Vec::new(), ..demonstration::picture([320, 180], 0.4) };
    assert_eq!(hash(&list), "b779b6cfd516059176eaeb7c0358c9459c446160e0ae70d6534d77e633081a27");
    let mut other = list.clone();
    other.camera.eye.x += 1e-4;
    assert_ne!(hash(&other), hash(&list), "negative control: a tenth of a millimetre must show");
}

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

#[test]
fn what_cannot_be_drawn_is_refused_with_its_place() {
    let mut renderer = CpuRenderer::new("test");
    let mut refused = |list: DrawList| renderer.draw(&list).unwrap_err();
    assert!(matches!(refused(DrawList { size: [0, 10], ..empty() }), RenderError::Size { width: 0, .. }));
    let lost = Affine3A::from_translation(Vec3::X * f32::NAN);
    let mut list = empty();
    list.objects = vec![object(block(Vec3::ONE, 0.1), Vec3::ZERO, GLOWING); 2];
    list.objects[1].transform = lost;
    assert!(matches!(refused(list), RenderError::Mesh { object: 1, .. }));
    let points = vec![Vec2::ZERO, Vec2::new(f32::NAN, 0.0)];
    let line = OverlayItem::Line { points, stroke: Stroke { width: 1.0, colour: RED }, clip: None };
    assert!(matches!(refused(DrawList { overlay: vec![line], ..empty() }), RenderError::Overlay { item: 0, .. }));
    let mut list = empty();
    list.camera.target = list.camera.eye;
    assert!(matches!(refused(list), RenderError::View { .. }));
}

/// Projections overflow here; the picture may be anything, but there is one.
#[test]
fn absurd_scenes_do_not_panic() {
    for (scale, radius) in [(1e8, 1.0), (1e-30, 1e-30), (1e8, 1e-35), (1.0, 1e30)] {
        let mut list = empty();
        list.light.shadow_radius = radius;
        list.light.direction = Vec3::new(1.0, 1.0, 0.0);
        list.objects.push(object(block(Vec3::splat(scale), 0.01), Vec3::X, GLOWING));
        list.objects.push(object(floor(scale, scale), Vec3::NEG_Y, GLOWING));
        list.camera.viewport = [0.0, 0.0, 1e-3, 1e-3];
        assert_eq!(draw(&list).dimensions(), (100, 100));
    }
}

#[test]
fn auto_and_cpu_always_open_and_say_why() {
    for choice in [RendererChoice::Auto, RendererChoice::Cpu] {
        let renderer = open(choice).unwrap();
        assert!(!renderer.info().reason.is_empty() && !renderer.info().backend.is_empty());
    }
}

fn apart(p: &Rgba<u8>, q: &Rgba<u8>) -> u8 {
    (0..4).map(|i| p.0[i].abs_diff(q.0[i])).max().unwrap_or(0)
}

/// Whether the picture changes little around a pixel: no edge of an object or a shadow passes through.
fn is_even(image: &RgbaImage, x: u32, y: u32) -> bool {
    let around = |centre: u32, size: u32| centre.saturating_sub(1)..=(centre + 1).min(size - 1);
    let here = image.get_pixel(x, y);
    around(x, image.width()).all(|x| around(y, image.height()).all(|y| apart(image.get_pixel(x, y), here) <= 6))
}

/// Part of the pixels that differ by more than 2, and the largest difference where the second picture is even.
fn difference(a: &RgbaImage, b: &RgbaImage) -> (f64, u8) {
    let pixels = || b.enumerate_pixels().map(|(x, y, p)| (x, y, apart(a.get_pixel(x, y), p)));
    let visible = pixels().filter(|&(_, _, difference)| difference > 2).count();
    let worst = pixels().filter(|&(x, y, _)| is_even(b, x, y)).map(|(_, _, difference)| difference).max();
    (visible as f64 / f64::from(a.width() * a.height()), worst.unwrap_or(255))
}

/// Where an edge passes, WebGPU leaves to the adapter at which covered point a triangle is lit, and the thin bright bevels make
/// that visible: measured on two software adapters, 1.6 % of the pixels of a small picture differ by more than 2. Elsewhere only
/// roundings differ, most in half shadows, which adapters filter with 8 bits: measured 3 levels.
#[test]
fn the_graphics_adapter_draws_the_picture_of_the_rasteriser() {
    let opened = [RendererChoice::Gpu, RendererChoice::Software].into_iter().filter_map(|choice| open(choice).ok());
    let mut compared = 0;
    for mut renderer in opened {
        for (size, phase) in [([640, 360], 0.4), ([333, 217], 2.0)] {
            let list = demonstration::picture(size, phase);
            let (image, _) = renderer.draw(&list).unwrap();
            assert!(image == renderer.draw(&list).unwrap().0, "the second picture of the same list differs");
            let (visible, worst) = difference(&image, &draw(&list));
            println!("{} {size:?}: {:.2} % above 2, even parts {worst}", renderer.info().adapter, visible * 100.0);
            assert!(visible < 0.025 && worst <= 4, "{:.2} % above 2, even parts {worst}", visible * 100.0);
            // Negative controls: carriages moved by 3 mm, and a sun brighter by 10 %, are farther away than that.
            let moved = demonstration::picture(size, phase + 0.06);
            assert!(difference(&image, &draw(&moved)).0 > 0.025);
            let mut brighter = list;
            brighter.light.intensity *= 1.1;
            assert!(difference(&image, &draw(&brighter)).1 > 4);
        }
        compared += 1;
    }
    if compared == 0 {
        println!("skipped: no graphics adapter, hardware or software");
    }
}
