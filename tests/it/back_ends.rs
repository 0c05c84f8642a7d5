//! Which back end opens, and whether a graphics adapter draws the picture of the built-in rasteriser.

use crate::demonstration;
use crate::small_scene::draw;
use image::{Rgba, RgbaImage};
use stickslip::render::{RendererChoice, open};

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
    let choices = [RendererChoice::Gpu, RendererChoice::SoftwareVulkan, RendererChoice::SoftwareGl];
    let opened = choices.into_iter().filter_map(|choice| open(choice).ok());
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

/// Two drivers light the same points and round differently: measured between lavapipe and llvmpipe, 0.07 % of the pixels differ by more than
/// 2, by at most 13.
#[test]
fn vulkan_and_opengl_draw_the_same_picture() {
    let opened = [RendererChoice::SoftwareVulkan, RendererChoice::SoftwareGl].map(|choice| open(choice).ok());
    let [Some(mut vulkan), Some(mut gl)] = opened else {
        println!("skipped: software drivers of both Vulkan and OpenGL are needed");
        return;
    };
    assert_eq!([&vulkan.info().backend[..], &gl.info().backend], ["vulkan", "gl"]);
    for (size, phase) in [([640, 360], 0.4), ([333, 217], 2.0)] {
        let list = demonstration::picture(size, phase);
        let [a, b] = [&mut vulkan, &mut gl].map(|renderer| renderer.draw(&list).unwrap().0);
        let apart: Vec<u8> = a.pixels().zip(b.pixels()).map(|(p, q)| apart(p, q)).collect();
        let visible = apart.iter().filter(|&&levels| levels > 2).count() as f64 / apart.len() as f64;
        let worst = apart.into_iter().max().unwrap();
        println!("{size:?}: {:.3} % above 2, at most {worst}", visible * 100.0);
        assert!(visible <= 0.002 && worst <= 16, "{visible} above 2, at most {worst}");
        // Negative control: carriages moved by 3 mm.
        let moved = gl.draw(&demonstration::picture(size, phase + 0.06)).unwrap().0;
        assert!(difference(&a, &moved).0 > 0.002);
    }
}
