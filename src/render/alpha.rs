//! Pictures with transparency. They are handed on with straight alpha, as PNG files have it; what is averaged or blended must be
//! multiplied by its alpha first, or edges get dark or bright fringes.

use super::portable::{decode, encode};
use image::RgbaImage;

/// Multiplies each sRGB code by its alpha, as the overlay is blended.
pub fn premultiply(image: &mut RgbaImage) {
    for pixel in image.pixels_mut().filter(|pixel| pixel.0[3] < 255) {
        let [r, g, b, a] = pixel.0;
        let times = |code: u8| ((u32::from(code) * u32::from(a) + 127) / 255) as u8;
        pixel.0 = [times(r), times(g), times(b), a];
    }
}

/// Undoes [`premultiply`]; what is clear becomes black.
pub fn straighten(image: &mut RgbaImage) {
    for pixel in image.pixels_mut().filter(|pixel| pixel.0[3] < 255) {
        let [r, g, b, a] = pixel.0;
        let over = |code: u8| {
            let wanted = (u32::from(code) * 255 + u32::from(a) / 2).checked_div(u32::from(a));
            wanted.map_or(0, |code| code.min(255) as u8)
        };
        pixel.0 = [over(r), over(g), over(b), a];
    }
}

/// Straight alpha of a picture whose codes stand for light times alpha, as graphics adapters resolve their samples.
pub(crate) fn straighten_light(image: &mut RgbaImage) {
    for pixel in image.pixels_mut().filter(|pixel| pixel.0[3] < 255) {
        let [r, g, b, a] = pixel.0;
        let alpha = f32::from(a.max(1)) / 255.0;
        pixel.0 = [encode(decode(r) / alpha), encode(decode(g) / alpha), encode(decode(b) / alpha), a];
    }
}

/// Whether something can be seen through the picture.
#[must_use]
pub fn has_transparency(image: &RgbaImage) -> bool {
    image.as_raw().chunks_exact(4).any(|pixel| pixel[3] < 255)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn a_premultiplied_picture_is_straightened_to_within_the_rounding() {
        let image = RgbaImage::from_fn(256, 256, |x, y| Rgba([x as u8, (255 - x) as u8, 128, y as u8]));
        let mut back = image.clone();
        premultiply(&mut back);
        assert!(back.pixels().all(|p| p.0[..3].iter().all(|&code| code <= p.0[3])));
        straighten(&mut back);
        for (before, after) in image.pixels().zip(back.pixels()) {
            let alpha = f32::from(before.0[3]);
            // Half a code of the product is 127.5 / alpha codes of the straight one, and half a code by rounding again.
            let limit = if alpha == 0.0 { 255.0 } else { 127.5 / alpha + 0.5 };
            for (a, b) in before.0[..3].iter().zip(&after.0[..3]) {
                assert!(f32::from(a.abs_diff(*b)) <= limit, "{before:?} {after:?}");
            }
        }
    }

    /// Half covered by white: the light is halved (code 188), the colour is still white.
    #[test]
    fn light_is_divided_by_its_alpha() {
        let mut image = RgbaImage::from_pixel(1, 1, Rgba([188, 188, 188, 128]));
        straighten_light(&mut image);
        assert!(image.get_pixel(0, 0).0[..3].iter().all(|&code| code >= 254), "{image:?}");
    }
}
