//! Pictures as 4:2:0 luma and chroma, ITU-R BT.709, 8 bit, limited range:
//!
//! ```text
//! Y' = 0.2126 R' + 0.7152 G' + 0.0722 B',   Cb = (B' - Y') / 1.8556,   Cr = (R' - Y') / 1.5748,
//! y = 16 + 219 Y',   u = 128 + 224 Cb,   v = 128 + 224 Cr    with R', G', B' in 0..1.
//! ```
//!
//! Chroma lies on every other luma column and between two rows (H.264's default), hence the weights 1 2 1 along the row. All in
//! integers with 16 fractional bits: the same bytes on every machine.

use image::RgbaImage;
use openh264::formats::YUVSource;

const BITS: u32 = 16;
const HALF: i32 = 1 << (BITS - 1);

/// `value` times 2^16 for a picture of 0..=255, rounded.
const fn fixed(value: f64) -> i32 {
    let scaled = value / 255.0 * (1 << BITS) as f64;
    (if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i32
}

const LUMA: [i32; 3] = [fixed(219.0 * 0.2126), fixed(219.0 * 0.7152), fixed(219.0 * 0.0722)];
const BLUE: [i32; 3] =
    [fixed(-224.0 * 0.2126 / 1.8556), fixed(-224.0 * 0.7152 / 1.8556), fixed(224.0 * (1.0 - 0.0722) / 1.8556)];
const RED: [i32; 3] =
    [fixed(224.0 * (1.0 - 0.2126) / 1.5748), fixed(-224.0 * 0.7152 / 1.5748), fixed(-224.0 * 0.0722 / 1.5748)];

/// Planes of one picture, kept between pictures. Filling them is a hot loop: rows are walked by iterators, without indices.
pub(super) struct Planes {
    width: usize,
    height: usize,
    y: Vec<u8>,
    u: Vec<u8>,
    v: Vec<u8>,
    /// Two rows of the picture, added.
    sums: Vec<[i32; 3]>,
}

impl Planes {
    /// Planes for even `size`, at least 2x2, for pictures of that size or one less in width or height.
    pub fn new(size: [u32; 2]) -> Self {
        let [width, height] = size.map(|side| side as usize);
        let chroma = width / 2 * (height / 2);
        Self {
            width,
            height,
            y: vec![0; width * height],
            u: vec![0; chroma],
            v: vec![0; chroma],
            sums: vec![[0; 3]; width],
        }
    }

    /// Fills the planes. Columns and rows the picture lacks repeat its last ones.
    pub fn fill(&mut self, image: &RgbaImage) {
        let (columns, rows) = (image.width() as usize, image.height() as usize);
        let bytes: &[u8] = image.as_raw();
        let row = |y: usize| bytes[y.min(rows - 1) * columns * 4..][..columns * 4].chunks_exact(4);
        for (y, luma) in self.y.chunks_exact_mut(self.width).enumerate() {
            let (inside, beyond) = luma.split_at_mut(columns.min(self.width));
            for (luma, pixel) in inside.iter_mut().zip(row(y)) {
                *luma = sample(&LUMA, rgb(pixel), 16, 1);
            }
            beyond.fill(inside[inside.len() - 1]);
        }
        let half = self.width / 2;
        let chroma = self.u.chunks_exact_mut(half).zip(self.v.chunks_exact_mut(half));
        for (y, (blue, red)) in chroma.enumerate() {
            for (sum, (upper, lower)) in self.sums.iter_mut().zip(row(2 * y).zip(row(2 * y + 1))) {
                let (upper, lower) = (rgb(upper), rgb(lower));
                *sum = [upper[0] + lower[0], upper[1] + lower[1], upper[2] + lower[2]];
            }
            let last = self.sums[columns - 1];
            self.sums[columns..].fill(last);
            let mut left = self.sums[0];
            for (pair, (blue, red)) in self.sums.chunks_exact(2).zip(blue.iter_mut().zip(red)) {
                let (middle, right) = (pair[0], pair[1]);
                let sum = [0, 1, 2].map(|i| left[i] + 2 * middle[i] + right[i]);
                *blue = sample(&BLUE, sum, 128, 8);
                *red = sample(&RED, sum, 128, 8);
                left = right;
            }
        }
    }
}

fn rgb(pixel: &[u8]) -> [i32; 3] {
    [i32::from(pixel[0]), i32::from(pixel[1]), i32::from(pixel[2])]
}

/// `offset + weights . sum / divisor`, rounded. At most 2^16 * 8 * 255, which fits.
#[inline]
fn sample(weights: &[i32; 3], sum: [i32; 3], offset: i32, divisor: i32) -> u8 {
    let weighted = weights[0] * sum[0] + weights[1] * sum[1] + weights[2] * sum[2];
    // The divisor is a power of two and the shift rounds down, also below zero.
    let value = (weighted + HALF * divisor) >> (BITS + divisor.trailing_zeros());
    (value + offset).clamp(0, 255) as u8
}

impl YUVSource for Planes {
    fn dimensions(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    fn strides(&self) -> (usize, usize, usize) {
        (self.width, self.width / 2, self.width / 2)
    }

    fn y(&self) -> &[u8] {
        &self.y
    }

    fn u(&self) -> &[u8] {
        &self.u
    }

    fn v(&self) -> &[u8] {
        &self.v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    /// Planes of an even picture of one colour.
    fn uniform(colour: [u8; 3]) -> [u8; 3] {
        let [r, g, b] = colour;
        let mut planes = Planes::new([4, 4]);
        planes.fill(&RgbaImage::from_pixel(4, 4, Rgba([r, g, b, 255])));
        for plane in [&planes.y, &planes.u, &planes.v] {
            assert!(plane.iter().all(|value| *value == plane[0]));
        }
        [planes.y[0], planes.u[0], planes.v[0]]
    }

    #[test]
    fn the_colour_bars_have_the_values_of_the_standard() {
        // 100 % bars in 8-bit BT.709 as tabulated, for example, in SMPTE RP 177 and EBU Tech 3325.
        let bars = [
            ([255, 255, 255], [235, 128, 128]),
            ([255, 255, 0], [219, 16, 138]),
            ([0, 255, 255], [188, 154, 16]),
            ([0, 255, 0], [173, 42, 26]),
            ([255, 0, 255], [78, 214, 230]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 0, 255], [32, 240, 118]),
            ([0, 0, 0], [16, 128, 128]),
        ];
        for (rgb, yuv) in bars {
            assert_eq!(uniform(rgb), yuv, "{rgb:?}");
        }
    }

    #[test]
    fn odd_sides_repeat_the_last_column_and_row() {
        let picture = |w, h| RgbaImage::from_fn(w, h, |x, y| Rgba([10 * x.min(2) as u8, 20 * y.min(2) as u8, 7, 255]));
        let (mut odd, mut even) = (Planes::new([4, 4]), Planes::new([4, 4]));
        odd.fill(&picture(3, 3));
        even.fill(&picture(4, 4));
        assert_eq!((odd.y, odd.u, odd.v), (even.y, even.u, even.v));
    }

    #[test]
    fn chroma_is_centred_on_the_even_columns() {
        // A red column at x = 2 of 6 colours only the chroma sample on it; at x = 3 it is shared by the samples at 2 and 4.
        let red_at =
            |at| {
                let mut planes = Planes::new([6, 2]);
                planes.fill(&RgbaImage::from_fn(6, 2, |x, _| {
                    if x == at { Rgba([255, 0, 0, 255]) } else { Rgba([0, 0, 0, 255]) }
                }));
                planes.v
            };
        assert_eq!(red_at(2), [128, 128 + 56, 128]);
        assert_eq!(red_at(3), [128, 128 + 28, 128 + 28]);
    }
}
