//! What the pictures of the built-in rasteriser show, pixel by pixel.

use crate::demonstration;
use crate::small_scene::{BACKDROP, GLOWING, RED, brightness, draw, empty, object, triangle};
use glam::{Affine3A, Vec2, Vec3};
use sha2::{Digest, Sha256};
use stickslip::render::shapes::{block, floor};
use stickslip::render::{
    Background, Colour, CpuRenderer, DrawList, Light, Material, OverlayItem, RenderError, Renderer, Stroke,
};

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

/// The rounded lower edge of a dark block turns away from the eye and from the sky: no pixel of it is brighter than the face above it. (Where a
/// mixed normal that points away from the eye is mirrored as it is, the edge shows bright dots of sky.)
#[test]
fn the_lower_edge_of_a_block_does_not_sparkle() {
    let dark = Material { colour: Colour::rgb(0x50_50_50), roughness: 0.3, metallic: 0.0, glow: 0.0 };
    let mut list = DrawList { size: [400, 400], ..empty() };
    list.camera.eye = Vec3::new(0.0, 0.8, 2.0);
    list.light = Light { intensity: 0.0, sky: Colour::rgb(0xff_ff_ff), ground: Colour::rgb(0x40_40_40), ..list.light };
    list.background = Background { top: Colour::rgb(0), bottom: Colour::rgb(0) };
    for shift in 0..8 {
        let place = Vec3::Y * (0.0013 * shift as f32);
        list.objects = vec![object(block(Vec3::new(0.4, 0.3, 0.1), 0.012), place, dark)];
        let image = draw(&list);
        let face = brightness(image.get_pixel(200, 220));
        let below = (230..400).flat_map(|y| (150..250).map(move |x| (x, y)));
        let brightest = below.map(|(x, y)| brightness(image.get_pixel(x, y))).max().unwrap();
        assert!(face > 0 && brightest <= face, "{brightest} at the edge, {face} on the face");
    }
}

fn hash(list: &DrawList) -> String {
    Sha256::digest(draw(list).as_raw()).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Bit for bit on every machine: the rasteriser uses only operations that IEEE 754 fixes. When the look is changed on purpose, look at the picture
/// of `cargo run --example render_still -- cpu`, then put the new hash here.
#[test]
fn the_demonstration_scene_is_the_known_picture() {
    let list = DrawList { overlay: Vec::new(), ..demonstration::picture([320, 180], 0.4) };
    assert_eq!(hash(&list), "174b1e19994689e3105dfe84d335d166b509eb4f774162ff20c725bcea6e434b");
    let mut other = list.clone();
    other.camera.eye.x += 1e-4;
    assert_ne!(hash(&other), hash(&list), "negative control: a tenth of a millimetre must show");
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
