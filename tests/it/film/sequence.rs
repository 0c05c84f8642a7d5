//! Which frames there are, and what their files are.

use super::fake::{FakeRenderer, FakeSource, SIZE, Stop, finish, index_of, origin, picture, run, settings};
use crate::small_disk::names_in;
use std::fs;
use std::path::Path;
use stickslip::film::{FilmError, FilmSettings, Video, produce};
use stickslip::store::{Existing, OutputDir, StoreError, sha256_hex};

fn frame_path(directory: &Path, index: u64) -> std::path::PathBuf {
    directory.join(format!("frames/{index:06}.png"))
}

#[test]
fn every_frame_is_there_once_and_says_its_index() {
    let place = tempfile::tempdir().unwrap();
    let (report, drawn) = finish(place.path(), &settings(), 40);
    assert_eq!(drawn, (0..40).collect::<Vec<_>>());
    assert_eq!((report.frames, report.drawn, report.reused), (40, 40, 0));
    assert_eq!((report.width, report.height, report.frames_per_second), (SIZE[0], SIZE[1], 25));
    assert_eq!(report.film, Some(place.path().join("film.mp4")));
    assert!(report.files.len() == 42 && report.files.iter().all(|file| file.is_file()));
    assert_eq!(names_in(&place.path().join("frames")).len(), 40);
    for index in 0..40 {
        let image = image::open(frame_path(place.path(), index)).unwrap().to_rgba8();
        assert_eq!(index_of(&image), index);
        assert_eq!(image, picture(SIZE, index));
    }
}

/// All names are looked at before the first frame is drawn; those that are not written are in nobody's way.
#[test]
fn nothing_is_drawn_while_a_file_of_someone_else_is_in_the_way() {
    for name in ["film.mp4", "frames.json", "frames/000004.png"] {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, "mine").unwrap();
        let (result, drawn) = run(place.path(), &settings(), 5, Stop::Never);
        let error = result.unwrap_err();
        assert!(matches!(&error, FilmError::Store(StoreError::Foreign { path: found }) if *found == path), "{error}");
        assert!(drawn.is_empty() && fs::read(&path).unwrap() == b"mine");
        let part = FilmSettings { frames: Some(0..4), ..settings() };
        assert_eq!(run(place.path(), &part, 5, Stop::Never).0.is_ok(), name != "frames.json", "{name}");
        assert_eq!(fs::read(&path).unwrap(), b"mine");
    }
}

#[test]
fn frames_are_rgb_pictures_marked_srgb() {
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &settings(), 2);
    let file = fs::File::open(frame_path(place.path(), 1)).unwrap();
    let reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let info = reader.info();
    assert_eq!((info.width, info.height), (SIZE[0], SIZE[1]));
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    assert!(info.srgb.is_some());
}

#[test]
fn the_manifest_lists_index_time_and_sum_of_each_frame() {
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &settings(), 4);
    let manifest: serde_json::Value =
        serde_json::from_slice(&fs::read(place.path().join("frames.json")).unwrap()).unwrap();
    assert_eq!(manifest["parameters_sha256"], origin().sha256());
    let frames = manifest["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 4);
    for (index, frame) in frames.iter().enumerate() {
        assert_eq!(frame["index"], index);
        assert_eq!(frame["time"], index as f64 / 25.0);
        assert_eq!(frame["file"], format!("frames/{index:06}.png"));
        assert_eq!(frame["sha256"], sha256_hex(&fs::read(frame_path(place.path(), index as u64)).unwrap()));
    }
}

#[test]
fn ranges_drawn_one_after_the_other_give_the_same_film() {
    let (whole, parts) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    finish(whole.path(), &settings(), 12);
    let part = |range| FilmSettings { frames: Some(range), ..settings() };
    let (report, drawn) = finish(parts.path(), &part(5..12), 12);
    assert_eq!((report.film, report.frames), (None, 7));
    assert_eq!(drawn, [5, 6, 7, 8, 9, 10, 11]);
    let (report, drawn) = finish(parts.path(), &part(0..6), 12);
    assert_eq!((report.drawn, report.reused), (5, 1));
    assert_eq!(drawn, [0, 1, 2, 3, 4]);
    for name in ["film.mp4", "frames.json"] {
        assert_eq!(fs::read(parts.path().join(name)).unwrap(), fs::read(whole.path().join(name)).unwrap(), "{name}");
    }
}

#[test]
fn a_film_of_selected_frames_has_its_own_name() {
    let place = tempfile::tempdir().unwrap();
    let selected = FilmSettings { frames: Some(3..6), video: Video::Selected, ..settings() };
    let (report, drawn) = finish(place.path(), &selected, 12);
    assert_eq!(report.film, Some(place.path().join("film-000003-000005.mp4")));
    assert_eq!(drawn, [3, 4, 5]);
    let none = FilmSettings { frames: Some(6..7), video: Video::None, ..settings() };
    assert_eq!(finish(place.path(), &none, 12).0.film, None);
    assert!(!place.path().join("film.mp4").exists());
}

#[test]
fn progress_counts_every_frame_once() {
    let place = tempfile::tempdir().unwrap();
    let three = FilmSettings { frames: Some(0..3), ..settings() };
    finish(place.path(), &three, 10);
    let output = OutputDir::open(place.path(), &origin(), Existing::Resume).unwrap();
    let source = FakeSource { count: 10, size: SIZE, stop: Stop::Never };
    let mut told = Vec::new();
    let mut renderer = FakeRenderer::new(Stop::Never);
    let report = produce(&settings(), &output, &mut renderer, &source, &mut |p| told.push(p)).unwrap();
    assert_eq!(told.iter().map(|p| p.done).collect::<Vec<_>>(), (1..=10).collect::<Vec<_>>());
    assert!(told.iter().all(|p| p.total == 10 && p.drawn + p.reused == p.done));
    let last = told.last().unwrap();
    assert_eq!((last.drawn, last.reused), (7, 3));
    assert_eq!((report.drawn, report.reused), (7, 3));
    // The fake says 1 microsecond a frame.
    assert_eq!(report.times.draw.as_micros(), 7);
    assert!(!report.times.encode_png.is_zero() && !report.times.encode_video.is_zero());
}

#[test]
fn impossible_settings_are_errors_before_anything_is_drawn() {
    let place = tempfile::tempdir().unwrap();
    let check = |settings: &FilmSettings, count, expected: fn(&FilmError) -> bool| {
        let (result, drawn) = run(place.path(), settings, count, Stop::Never);
        let error = result.unwrap_err();
        assert!(expected(&error) && drawn.is_empty(), "{error}");
    };
    check(&settings(), 0, |e| matches!(e, FilmError::NoFrames));
    for frames in [5..11, 4..4, 11..12] {
        let range = FilmSettings { frames: Some(frames), ..settings() };
        check(&range, 10, |e| matches!(e, FilmError::Range { count: 10, .. }));
    }
    for frames_per_second in [0, 1001] {
        let rate = FilmSettings { frames_per_second, ..settings() };
        check(&rate, 10, |e| matches!(e, FilmError::FrameRate { .. }));
    }
    for quantiser in [11, 52] {
        let coded = FilmSettings { quantiser, ..settings() };
        check(&coded, 10, |e| matches!(e, FilmError::Quantiser { .. }));
    }
    for size in [[8, 8], [4096, 16], [3840, 2162]] {
        check(&FilmSettings { size, ..settings() }, 10, |e| matches!(e, FilmError::VideoSize { .. }));
    }
}

#[test]
fn a_frame_of_another_size_is_an_error() {
    let place = tempfile::tempdir().unwrap();
    let output = OutputDir::open(place.path(), &origin(), Existing::Resume).unwrap();
    let source = FakeSource { count: 3, size: [64, 64], stop: Stop::Never };
    let error = produce(&settings(), &output, &mut FakeRenderer::new(Stop::Never), &source, &mut |_| ()).unwrap_err();
    assert!(matches!(error, FilmError::FrameSize { index: 0, .. }), "{error}");
    assert!(error.to_string().contains("64 x 64") && error.to_string().contains("64 x 48"), "{error}");
}

/// The fake draws a block of 8 by 8 pixels, of which a film half as large shows 4 by 4.
#[test]
fn supersampled_frames_are_drawn_larger_and_made_smaller() {
    let place = tempfile::tempdir().unwrap();
    let output = OutputDir::open(place.path(), &origin(), Existing::Resume).unwrap();
    let source = FakeSource { count: 6, size: SIZE, stop: Stop::Never };
    let half = FilmSettings { size: [SIZE[0] / 2, SIZE[1] / 2], supersampling: 2, ..settings() };
    produce(&half, &output, &mut FakeRenderer::new(Stop::Never), &source, &mut |_| ()).unwrap();
    let image = image::open(frame_path(place.path(), 5)).unwrap().to_rgba8();
    assert_eq!(image.dimensions(), (32, 24));
    // Bits of the index 5.
    let bits = [0, 1, 2, 3].map(|bit| image.get_pixel(4 * bit + 2, 2).0[1] > 127);
    assert_eq!(bits, [true, false, true, false]);
    let error = FilmSettings { supersampling: 5, ..settings() };
    let elsewhere = tempfile::tempdir().unwrap();
    let (result, _) = run(elsewhere.path(), &error, 6, Stop::Never);
    assert!(matches!(result.unwrap_err(), FilmError::Supersampling { found: 5, limit: 4 }));
}
