//! The film file, taken apart and decoded.

use super::fake::{SIZE, finish, index_of, picture, settings};
use super::mp4::{self, Planes, at, boxes, colour_description, u32_at};
use image::{Rgba, RgbaImage};
use std::fs;
use stickslip::film::FilmSettings;

/// The bytes of a film of `count` frames.
fn film(settings: &FilmSettings, count: u64) -> Vec<u8> {
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), settings, count);
    fs::read(place.path().join("film.mp4")).unwrap()
}

/// ITU-R BT.709, limited range, to 8-bit RGB, in floating point. Chroma is taken from the nearest sample.
fn to_rgb(planes: &Planes, kr: f64, kb: f64) -> RgbaImage {
    let [width, height] = planes.size;
    RgbaImage::from_fn(width as u32, height as u32, |x, y| {
        let (x, y) = (x as usize, y as usize);
        let chroma = y / 2 * (width / 2) + x / 2;
        let luma = (f64::from(planes.y[y * width + x]) - 16.0) / 219.0;
        let cb = (f64::from(planes.u[chroma]) - 128.0) / 224.0;
        let cr = (f64::from(planes.v[chroma]) - 128.0) / 224.0;
        let red = luma + 2.0 * (1.0 - kr) * cr;
        let blue = luma + 2.0 * (1.0 - kb) * cb;
        let green = (luma - kr * red - kb * blue) / (1.0 - kr - kb);
        let [r, g, b] = [red, green, blue].map(|c| (255.0 * c).round().clamp(0.0, 255.0) as u8);
        Rgba([r, g, b, 255])
    })
}

pub fn bt709(planes: &Planes) -> RgbaImage {
    to_rgb(planes, 0.2126, 0.0722)
}

fn bt601(planes: &Planes) -> RgbaImage {
    to_rgb(planes, 0.299, 0.114)
}

/// Peak signal to noise ratio of the luma, dB, against the picture that was drawn.
pub fn luma_psnr(planes: &Planes, drawn: &RgbaImage) -> f64 {
    let squares = drawn.pixels().zip(&planes.y).map(|(pixel, &luma)| {
        let [r, g, b, _] = pixel.0.map(f64::from);
        let exact = 16.0 + 219.0 / 255.0 * (0.2126 * r + 0.7152 * g + 0.0722 * b);
        (f64::from(luma) - exact).powi(2)
    });
    let mean = squares.sum::<f64>() / planes.y.len() as f64;
    10.0 * (255.0 * 255.0 / mean).log10()
}

/// The quantiser step of H.264 doubles every 6 and is 10 at 24. With the rounding of inter blocks, 1/6, an error reaches 5/6 of
/// a step; spread evenly over that range its mean square is (5/6)^2/3 steps squared. No coefficient can be worse than
/// that on average, so neither can a picture: 37.6 dB at quantiser 20 (step 6.5), and 0.5 dB for rounding to 8 bits.
pub fn least_psnr(quantiser: u8) -> f64 {
    let step = 10.0 * 2.0_f64.powf((f64::from(quantiser) - 24.0) / 6.0);
    10.0 * (255.0 * 255.0 / ((5.0_f64 / 6.0).powi(2) / 3.0 * step * step)).log10() - 0.5
}

#[test]
fn the_file_says_size_rate_and_length_and_begins_with_its_header() {
    let bytes = film(&settings(), 60);
    let kinds: Vec<_> = boxes(&bytes).into_iter().map(|(kind, _)| kind).collect();
    assert_eq!(kinds, ["ftyp", "moov", "mdat"]);
    let movie = mp4::read(&bytes);
    assert_eq!(movie.size, [64, 48]);
    assert_eq!(movie.durations.len(), 60);
    // 25 per second.
    assert!(movie.durations.iter().all(|&ticks| ticks * 25 == movie.timescale));
    let header = at(&bytes, "moov/mvhd");
    let (timescale, duration) = (u32_at(header, 12), u32_at(header, 16));
    assert_eq!(f64::from(duration) / f64::from(timescale), 60.0 / 25.0);
    // A key frame every two seconds.
    assert_eq!(movie.key_frames, [1, 51]);
}

#[test]
fn frame_times_do_not_drift_where_the_clock_does_not_divide() {
    // 90000 / 7 is no integer.
    let bytes = film(&FilmSettings { frames_per_second: 7, ..settings() }, 30);
    let movie = mp4::read(&bytes);
    let mut ticks = 0;
    for (index, duration) in movie.durations.iter().enumerate() {
        let exact = index as f64 / 7.0 * f64::from(movie.timescale);
        // Rounded to the nearest tick, never added up.
        assert!((f64::from(ticks) - exact).abs() <= 0.5, "{index}");
        ticks += duration;
    }
}

#[test]
fn the_decoded_frames_are_the_drawn_ones_in_order() {
    let bytes = film(&settings(), 60);
    let decoded = mp4::read(&bytes).decode();
    assert_eq!(decoded.len(), 60);
    let limit = least_psnr(settings().quantiser);
    for (index, planes) in (0..).zip(&decoded) {
        assert_eq!(planes.size, [64, 48]);
        assert_eq!(index_of(&bt709(planes)), index);
        let psnr = luma_psnr(planes, &picture(SIZE, index));
        assert!(psnr > limit, "frame {index}: {psnr:.1} dB, at least {limit:.1} expected");
        // Negative control: the next frame's picture is not taken for this one.
        let shifted = luma_psnr(planes, &picture(SIZE, index + 1));
        assert!(shifted < limit, "frame {index} passes for its successor with {shifted:.1} dB");
    }
}

#[test]
fn the_quantiser_decides_quality_and_size() {
    let [fine, coarse] = [12, 40].map(|quantiser| film(&FilmSettings { quantiser, ..settings() }, 10));
    assert!(fine.len() > coarse.len());
    let psnr = |bytes: &[u8]| luma_psnr(&mp4::read(bytes).decode()[9], &picture(SIZE, 9));
    assert!(psnr(&fine) > least_psnr(12), "{:.1}", psnr(&fine));
    assert!(psnr(&coarse) < least_psnr(12), "{:.1}", psnr(&coarse));
}

#[test]
fn no_frame_is_dropped_to_save_bits() {
    // The encoder's own default budget, 120 kbit/s, is exceeded many times over: this is where some of its modes leave frames out.
    let costly = FilmSettings { size: [320, 240], quantiser: 12, ..settings() };
    let bytes = film(&costly, 40);
    assert!(bytes.len() * 8 > 2 * 120_000 * 40 / 25, "{} bytes are no test", bytes.len());
    let indices: Vec<_> = mp4::read(&bytes).decode().iter().map(|planes| index_of(&bt709(planes))).collect();
    assert_eq!(indices, (0..40).collect::<Vec<_>>());
}

#[test]
fn colours_are_signalled_and_stored_as_bt709() {
    let bytes = film(&FilmSettings { quantiser: 12, ..settings() }, 1);
    let movie = mp4::read(&bytes);
    // Limited range; primaries, transfer and matrix of BT.709 (H.264 tables E-3 to E-5).
    assert_eq!(colour_description(movie.sps), Some((false, [1, 1, 1])));
    let decoded = &movie.decode()[0];
    let far_off = |image: &RgbaImage| {
        // The middle of the moving square: 0xd04020.
        let pixel = image.get_pixel(4, 28).0;
        [0xd0, 0x40, 0x20].iter().zip(pixel).map(|(&drawn, found)| i32::from(found).abs_diff(drawn)).max().unwrap()
    };
    // 8-bit chroma and luma of limited range alone cost up to 2 levels, the quantiser's step of 2.5 some more.
    assert!(far_off(&bt709(decoded)) <= 5, "{}", far_off(&bt709(decoded)));
    // Negative control: the other usual matrix is told apart.
    assert!(far_off(&bt601(decoded)) > 10, "{}", far_off(&bt601(decoded)));
}

#[test]
fn odd_sizes_keep_their_frames_and_get_an_even_film() {
    let odd = FilmSettings { size: [65, 47], ..settings() };
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &odd, 3);
    let frame = image::open(place.path().join("frames/000002.png")).unwrap().to_rgba8();
    assert_eq!(frame.dimensions(), (65, 47));
    let bytes = fs::read(place.path().join("film.mp4")).unwrap();
    let movie = mp4::read(&bytes);
    assert_eq!(movie.size, [66, 48]);
    let decoded = movie.decode();
    let even = RgbaImage::from_fn(66, 48, |x, y| *frame.get_pixel(x.min(64), y.min(46)));
    assert_eq!(decoded[2].size, [66, 48]);
    assert!(luma_psnr(&decoded[2], &even) > least_psnr(odd.quantiser));
}

#[test]
fn the_film_is_the_same_every_time() {
    assert_eq!(film(&settings(), 30), film(&settings(), 30));
}
