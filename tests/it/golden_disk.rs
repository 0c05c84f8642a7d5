//! A whole frame of a disk against a stored one, as `golden` does it for the rig.
//!
//! The stored picture is renewed with the others.

use crate::golden::{differences, draw, on_cpu, worst};
use std::path::PathBuf;
use stickslip::dynamics::{Flow, Sampling, State};
use stickslip::exact::SparseFlow;
use stickslip::render::{DrawList, OverlayItem, RendererChoice};
use stickslip::scene::{BUILT_IN_DISKS, Scene};
use stickslip::stage::{DiskMotion, DiskStage};

/// As for the rig: a last digit of the platform's functions moves an edge by 1e-10 pixels and a channel by one level.
const TOLERANCE: f64 = 0.01;
/// Part of the windows that another back end may draw otherwise: those along edges, of which a disk has more than the rig.
const ELSEWHERE: f64 = 0.09;

fn list() -> DrawList {
    let (name, text) = BUILT_IN_DISKS.into_iter().find(|(name, _)| *name == "disk_shroud").unwrap();
    let (mut scene, _) = Scene::parse(text, name).unwrap();
    (scene.film.width, scene.film.height, scene.film.fps) = (640, 360, 25);
    (scene.simulation.duration, scene.film.speed) = (40.0, 9.0);
    scene.direction = stickslip::scene::Direction::default();
    let case = scene.checked(name).unwrap();
    let disk = case.disk.clone().unwrap().disk;
    let chain = disk.chain().unwrap();
    let mut start = State::rest(&chain);
    for j in 0..disk.sectors {
        let angle = std::f64::consts::TAU * 2.0 * j as f64 / disk.sectors as f64;
        (start.positions[j], start.velocities[j]) = (2.0 * angle.cos(), 2.0 * angle.sin());
    }
    let sampling = Sampling { interval: 0.1, t_end: case.duration };
    let trajectory = SparseFlow::new(&chain).trajectory(&start, sampling).unwrap();
    let motion = DiskMotion::new(&disk, &trajectory).unwrap().unwrap();
    DiskStage::new(case, motion, None).unwrap().frame(77)
}

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden/disk.png")
}

fn stored() -> image::RgbaImage {
    image::open(path()).unwrap().to_rgba8()
}

pub fn renew() {
    std::fs::write(path(), stickslip::film::encode_png(&on_cpu(&list())).unwrap()).unwrap();
}

#[test]
fn a_frame_of_a_disk_is_the_golden_picture_on_every_back_end() {
    let (list, picture) = (list(), stored());
    let found = worst(&differences(&on_cpu(&list), &picture));
    assert!(found <= TOLERANCE, "a window differs by {found:.3}");
    for choice in [RendererChoice::Gpu, RendererChoice::Software] {
        let Some(image) = draw(&list, choice) else {
            println!("skipped: no adapter for {choice:?}");
            continue;
        };
        let found = differences(&image, &picture);
        let part = found.iter().filter(|d| **d > TOLERANCE).count() as f64 / found.len() as f64;
        println!("{choice:?}: {:.2} % of the windows differ", 100.0 * part);
        assert!(part <= ELSEWHERE, "{choice:?}: {part}");
    }
}

/// Negative controls: the picture without a blade, a contact, the carpet, a bar, a number.
#[test]
fn a_missing_blade_contact_carpet_or_number_is_found() {
    let (whole, picture) = (list(), stored());
    let differs = |list: &DrawList| worst(&differences(&on_cpu(list), &picture)) > 10.0 * TOLERANCE;
    let most = whole.objects.iter().map(|object| object.mesh.triangles.len()).max().unwrap();
    assert!(most > 100);
    // Blades come after the fixed parts, each with its root; contacts after them; the line through the tips is the last.
    let count = whole.objects.len();
    let contact = (0..count).find(|&i| whole.objects[i].material.glow > 0.1 || i + 14 == count).unwrap();
    let blade = (0..count).filter(|&i| whole.objects[i].mesh.positions.len() == 88).nth(7).unwrap();
    for missing in [blade, contact, count - 1] {
        let mut without = whole.clone();
        without.objects.remove(missing);
        assert!(differs(&without), "object {missing} of {count} is not missed");
    }
    let is_number = |item: &OverlayItem| matches!(item, OverlayItem::Text { text, .. } if text == "7");
    let is_raster = |item: &OverlayItem| matches!(item, OverlayItem::Raster { .. });
    for wanted in [&is_number as &dyn Fn(&OverlayItem) -> bool, &is_raster] {
        let mut without = whole.clone();
        let index = without.overlay.iter().position(wanted).unwrap();
        without.overlay.remove(index);
        assert!(differs(&without), "item {index} is not missed");
    }
}
