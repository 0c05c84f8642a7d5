//! Draws one picture of a demonstration scene with the back end given as an argument (`auto`, `cpu`, `gpu`, `vulkan`, `gl`, `software`) and writes
//! it to `target/render_still_<backend>.png`.

use std::error::Error;
use std::time::Duration;
use stickslip::render::{Renderer, RendererChoice, open};

#[path = "../tests/it/demonstration.rs"]
mod demonstration;

const REPEATS: u32 = 20;

fn main() -> Result<(), Box<dyn Error>> {
    let choice = match std::env::args().nth(1).as_deref() {
        None | Some("auto") => RendererChoice::Auto,
        Some("cpu") => RendererChoice::Cpu,
        Some("gpu") => RendererChoice::Gpu,
        Some("vulkan") => RendererChoice::Vulkan,
        Some("gl") => RendererChoice::Gl,
        Some("software") => RendererChoice::Software,
        Some(other) => return Err(format!("no back end is called {other}").into()),
    };
    let mut renderer: Box<dyn Renderer> = open(choice)?;
    let info = renderer.info().clone();
    println!("{} through {}: {}", info.adapter, info.backend, info.reason);
    let list = demonstration::picture([1280, 720], 0.8);
    let triangles: usize = list.objects.iter().map(|object| object.mesh.triangles.len()).sum();
    let (image, _) = renderer.draw(&list)?;
    let path = format!("target/render_still_{}.png", info.backend);
    image.save(&path)?;
    let mut sum = [Duration::ZERO; 3];
    for _ in 0..REPEATS {
        let (_, times) = renderer.draw(&list)?;
        for (total, part) in sum.iter_mut().zip([times.draw, times.read_back, times.overlay]) {
            *total += part;
        }
    }
    let [draw, read_back, overlay] = sum.map(|total| total.as_secs_f64() * 1e3 / f64::from(REPEATS));
    println!("{path}: {triangles} triangles, scene {draw:.1} ms, read back {read_back:.1} ms, overlay {overlay:.1} ms");
    Ok(())
}
