//! Short loops for pages that show pictures but play no video: GIF and animated PNG; and pictures of several frames side by side.

use super::{colours, picture};
use crate::render::{Colour, has_transparency, premultiply, straighten};
use image::codecs::gif::{GifEncoder, Repeat};
use image::imageops::{FilterType, overlay, resize};
use image::{Delay, Frame, ImageResult, Rgba, RgbaImage};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

/// Gap between the pictures of a contact sheet, pixels, and its colour.
const GAP: u32 = 8;
const PAPER: Rgba<u8> = Rgba([0x10, 0x16, 0x1d, 255]);

/// The picture at another width, its sides kept in proportion.
#[must_use]
pub fn scaled(image: &RgbaImage, width: u32) -> RgbaImage {
    let height = (f64::from(image.height()) * f64::from(width) / f64::from(image.width())).round().max(1.0);
    if !has_transparency(image) {
        return resize(image, width.max(1), height as u32, FilterType::Lanczos3);
    }
    let mut image = image.clone();
    premultiply(&mut image);
    let mut image = resize(&image, width.max(1), height as u32, FilterType::Lanczos3);
    straighten(&mut image);
    image
}

/// An endless loop as animated PNG, lossless, alpha included; each picture stands for `delay.0 / delay.1` seconds. All pictures have one size.
///
/// # Errors
/// For no pictures, and pictures of different sizes.
pub fn animated_png(frames: &[RgbaImage], delay: (u16, u16)) -> Result<Vec<u8>, EncodingError> {
    let [width, height] = frames.first().map_or([0, 0], |frame| [frame.width(), frame.height()]);
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    let is_clear = frames.iter().any(has_transparency);
    encoder.set_color(if is_clear { ColorType::Rgba } else { ColorType::Rgb });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::Adaptive);
    encoder.set_animated(frames.len() as u32, 0)?;
    encoder.set_frame_delay(delay.0, delay.1)?;
    let mut writer = encoder.write_header()?;
    for frame in frames {
        if is_clear {
            writer.write_image_data(frame.as_raw())?;
        } else {
            writer.write_image_data(&picture::rgb(frame))?;
        }
    }
    writer.finish()?;
    Ok(bytes)
}

/// An endless loop as GIF, in 256 colours, among them all of `kept`; each picture stands for `delay.0 / delay.1` seconds, in hundredths.
///
/// # Errors
/// For pictures of different sizes, or larger than 65535 pixels.
pub fn gif(frames: &[RgbaImage], delay: (u16, u16), kept: &[Colour]) -> ImageResult<Vec<u8>> {
    let mut bytes = Vec::new();
    let kept: Vec<[u8; 3]> = kept.iter().map(|Colour([r, g, b, _])| [*r, *g, *b]).collect();
    // 1 is the best palette and 30 the fastest, for pictures of more colours than are left here.
    let mut encoder = GifEncoder::new_with_speed(&mut bytes, 1);
    encoder.set_repeat(Repeat::Infinite)?;
    let delay = Delay::from_numer_denom_ms(1000 * u32::from(delay.0), u32::from(delay.1).max(1));
    for frame in colours::reduced(frames, &kept) {
        encoder.encode_frame(Frame::from_parts(frame, 0, 0, delay))?;
    }
    drop(encoder);
    Ok(bytes)
}

/// Pictures of one size in rows of `columns`, in reading order.
#[must_use]
pub fn contact_sheet(pictures: &[RgbaImage], columns: u32) -> RgbaImage {
    let [width, height] = pictures.first().map_or([0, 0], |picture| [picture.width(), picture.height()]);
    let columns = columns.clamp(1, pictures.len().max(1) as u32);
    let rows = (pictures.len() as u32).div_ceil(columns);
    let side = |count: u32, length: u32| count * (length + GAP) + GAP;
    let mut sheet = RgbaImage::from_pixel(side(columns, width), side(rows, height), PAPER);
    for (number, picture) in (0..).zip(pictures) {
        let (column, row) = (number % columns, number / columns);
        overlay(&mut sheet, picture, i64::from(side(column, width)), i64::from(side(row, height)));
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::AnimationDecoder;
    use image::codecs::gif::GifDecoder;
    use image::codecs::png::PngDecoder;
    use std::io::Cursor;

    /// Pictures of one colour each.
    fn frames() -> Vec<RgbaImage> {
        [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]].map(|c| RgbaImage::from_pixel(20, 10, Rgba(c))).to_vec()
    }

    #[test]
    fn loops_hold_their_pictures_in_order_for_their_time() {
        let delay = (1, 10);
        let gif = gif(&frames(), delay, &[]).unwrap();
        let apng = animated_png(&frames(), delay).unwrap();
        let gif = GifDecoder::new(Cursor::new(gif)).unwrap().into_frames().collect_frames().unwrap();
        let apng = PngDecoder::new(Cursor::new(apng)).unwrap().apng().unwrap().into_frames().collect_frames().unwrap();
        for found in [gif, apng] {
            assert_eq!(found.len(), 3);
            for (found, drawn) in found.iter().zip(frames()) {
                assert_eq!(found.delay().numer_denom_ms(), (100, 1));
                assert_eq!(found.buffer(), &drawn);
            }
        }
    }

    #[test]
    fn a_contact_sheet_shows_pictures_in_reading_order() {
        let sheet = contact_sheet(&frames(), 2);
        assert_eq!(sheet.dimensions(), (2 * 28 + 8, 2 * 18 + 8));
        let at = |x, y| sheet.get_pixel(x, y).0[..3].to_vec();
        assert_eq!([at(18, 13), at(46, 13), at(18, 31)], [[255, 0, 0], [0, 255, 0], [0, 0, 255]]);
        assert_eq!(*sheet.get_pixel(46, 31), PAPER);
    }

    #[test]
    fn scaled_pictures_keep_their_proportions() {
        assert_eq!(scaled(&frames()[0], 10).dimensions(), (10, 5));
        assert_eq!(*scaled(&frames()[1], 10).get_pixel(5, 2), Rgba([0, 255, 0, 255]));
    }

    /// Red before nothing, where the colour of what is clear is green: no green comes in, and the loop keeps the alpha.
    #[test]
    fn transparent_pictures_keep_colour_and_alpha() {
        let half = RgbaImage::from_fn(20, 10, |x, _| Rgba(if x < 11 { [255, 0, 0, 255] } else { [0, 255, 0, 0] }));
        let small = scaled(&half, 10);
        assert!(small.pixels().any(|p| (1..255).contains(&p.0[3])));
        assert!(small.pixels().all(|p| p.0[3] < 8 || (p.0[0] > 240 && p.0[1] == 0)), "{small:?}");
        let bytes = animated_png(&[half.clone(), half.clone()], (1, 10)).unwrap();
        let found =
            PngDecoder::new(Cursor::new(bytes)).unwrap().apng().unwrap().into_frames().collect_frames().unwrap();
        assert_eq!(found[1].buffer(), &half);
    }
}
