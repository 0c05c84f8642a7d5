//! One frame of 1280 x 720 on the built-in rasteriser, about 17000 triangles: the scene alone, and with three panels.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use stickslip::render::{CpuRenderer, DrawList, Renderer};

#[path = "../tests/it/demonstration.rs"]
mod demonstration;

fn frames(criterion: &mut Criterion) {
    let with_panels = demonstration::picture([1280, 720], 0.8);
    let scene = DrawList { overlay: Vec::new(), ..with_panels.clone() };
    let panels = DrawList { objects: Vec::new(), ..with_panels.clone() };
    let mut renderer = CpuRenderer::new("benchmark");
    for (name, list) in [("scene", scene), ("panels", panels), ("scene and panels", with_panels)] {
        criterion.bench_function(&format!("cpu 1280x720, {name}"), |bencher| {
            bencher.iter(|| renderer.draw(black_box(&list)).map(|(image, _)| image.into_raw().len()))
        });
    }
    criterion.bench_function("coil of 10 turns", |bencher| {
        let shape = stickslip::render::shapes::Coil { turns: 10.0, ..Default::default() };
        bencher.iter(|| stickslip::render::shapes::coil(black_box(0.4), &shape))
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(30);
    targets = frames
}
criterion_main!(benches);
