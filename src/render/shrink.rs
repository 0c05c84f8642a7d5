//! Pictures drawn larger than wanted, made smaller: supersampling.

use super::portable::{decode, encode};
use image::{Rgba, RgbaImage};
use rayon::prelude::*;

/// The picture `factor` times smaller along both sides: each pixel the mean light of a square of `factor` by `factor`, weighted by
/// alpha. What is left over at
/// the right and lower edges is cut off. A factor of 0 counts as 1.
#[must_use]
pub fn shrunk(image: &RgbaImage, factor: u32) -> RgbaImage {
    if factor <= 1 {
        return image.clone();
    }
    let (width, height) = (image.width() / factor, image.height() / factor);
    let mut small = RgbaImage::new(width, height);
    let count = (factor * factor) as f32;
    small.par_chunks_mut(4 * width.max(1) as usize).zip(0..height).for_each(|(row, y)| {
        for (x, pixel) in (0..width).zip(row.chunks_exact_mut(4)) {
            let square =
                (0..factor * factor).map(|n| image.get_pixel(x * factor + n % factor, y * factor + n / factor));
            let (mut light, mut alpha) = ([0.0_f32; 3], 0.0_f32);
            for Rgba([r, g, b, a]) in square {
                // Exact for 255: opaque pictures are the plain mean.
                let weight = f32::from(*a) / 255.0;
                light =
                    [light[0] + decode(*r) * weight, light[1] + decode(*g) * weight, light[2] + decode(*b) * weight];
                alpha += weight;
            }
            let [r, g, b] = light.map(|sum| encode(sum / alpha.max(1e-6)));
            pixel.copy_from_slice(&[r, g, b, (alpha / count * 255.0 + 0.5) as u8]);
        }
    });
    small
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_becomes_the_mean_light_of_its_square() {
        let image = RgbaImage::from_fn(4, 2, |x, _| Rgba(if x % 2 == 0 || x > 1 { [255; 4] } else { [0, 0, 0, 255] }));
        let small = shrunk(&image, 2);
        assert_eq!(small.dimensions(), (2, 1));
        // Half the light is the sRGB code 188 (IEC 61966-2-1); half the code would be 128.
        assert_eq!(small.get_pixel(0, 0).0, [188, 188, 188, 255]);
        assert_eq!(small.get_pixel(1, 0).0, [255; 4]);
        assert_eq!(shrunk(&image, 1), image);
    }

    /// Clear pixels have no colour to mix in.
    #[test]
    fn transparent_edges_keep_their_colour() {
        let image = RgbaImage::from_fn(2, 2, |x, _| Rgba(if x == 0 { [200, 40, 90, 255] } else { [0, 255, 0, 0] }));
        assert_eq!(shrunk(&image, 2).get_pixel(0, 0).0, [200, 40, 90, 128]);
    }
}
