//! Elementary functions from additions, multiplications, divisions and square roots alone.
//!
//! IEEE 754 fixes those to the last bit, while every platform's `sin`, `tan` and `pow` differ: with these the CPU picture is the
//! same on every machine.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::sync::OnceLock;

/// Sine and cosine of an angle in radians, to about 1e-15 for angles of some hundred turns.
pub(crate) fn sin_cos(angle: f64) -> (f64, f64) {
    let quarter = (angle / FRAC_PI_2).round();
    let (sine, cosine) = sin_cos_near_zero(angle - quarter * FRAC_PI_2);
    match (quarter as i64).rem_euclid(4) {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// Taylor series, |x| <= pi/4: the first term left out is below 1e-17.
fn sin_cos_near_zero(x: f64) -> (f64, f64) {
    debug_assert!(x.abs() <= FRAC_PI_4 * 1.001);
    let square = x * x;
    let series = |first: f64| (0..8).rev().fold(1.0, |sum, k| 1.0 - sum * square / term(first + 2.0 * f64::from(k)));
    let term_free_cosine = series(1.0);
    let sine = x * series(2.0);
    (sine, term_free_cosine)
}

/// Ratio of neighbouring factorials, n (n + 1).
fn term(n: f64) -> f64 {
    n * (n + 1.0)
}

/// Tangent of half an angle in (0, pi).
pub(crate) fn tan_half(angle: f32) -> f32 {
    let (sine, cosine) = sin_cos(f64::from(angle) / 2.0);
    (sine / cosine) as f32
}

/// sRGB electro-optical transfer function (IEC 61966-2-1), argument and value in 0..=1.
fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        return encoded / 12.92;
    }
    let base = (encoded + 0.055) / 1.055;
    base * base * fifth_root(base * base)
}

/// Newton's iteration for y^5 = x, x in 0.001..=1: from above, so it falls monotonically to the root.
fn fifth_root(x: f64) -> f64 {
    (0..40).fold(1.0, |y: f64, _| (4.0 * y + x / (y * y * y * y)) / 5.0)
}

/// Entries of the encoding table, spaced evenly in the square root of the light: fine where the eye is.
const ENCODE_STEPS: usize = 8192;

/// Tables for [`decode`] and [`encode`].
struct SrgbTables {
    decode: [f32; 256],
    encode: Vec<u8>,
}

fn tables() -> &'static SrgbTables {
    static TABLES: OnceLock<SrgbTables> = OnceLock::new();
    TABLES.get_or_init(|| {
        let mut decode = [0.0; 256];
        for (code, linear) in decode.iter_mut().enumerate() {
            *linear = srgb_to_linear(code as f64 / 255.0) as f32;
        }
        let mut code = 0_u8;
        let encode = (0..ENCODE_STEPS)
            .map(|step| {
                let root = (step as f64 + 0.5) / (ENCODE_STEPS - 1) as f64;
                while code < 255 && srgb_to_linear((f64::from(code) + 0.5) / 255.0) < root * root {
                    code += 1;
                }
                code
            })
            .collect();
        SrgbTables { decode, encode }
    })
}

/// Light of an sRGB code, 0..=1.
pub(crate) fn decode(code: u8) -> f32 {
    tables().decode[usize::from(code)]
}

/// Nearest sRGB code of a light in 0..=1 (clamped).
pub(crate) fn encode(linear: f32) -> u8 {
    // The i32 conversion is the cheap one, and the clamp makes it exact.
    let step = (linear.clamp(0.0, 1.0).sqrt() * (ENCODE_STEPS - 1) as f32) as i32;
    tables().encode[step as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the platform's functions, which are good to about one unit in the last place.
    #[test]
    fn sine_cosine_and_tangent_agree_with_the_platform() {
        for step in -2000..=2000 {
            let angle = f64::from(step) * 0.0531;
            let (sine, cosine) = sin_cos(angle);
            // 1e-13: the reduction by a rounded pi/2 loses up to 70 turns x 1.2e-16.
            assert!((sine - angle.sin()).abs() < 1e-13, "{angle}");
            assert!((cosine - angle.cos()).abs() < 1e-13, "{angle}");
        }
        assert!((tan_half(0.7) - 0.35_f32.tan()).abs() < 1e-7);
    }

    #[test]
    fn every_srgb_code_survives_decoding_and_encoding() {
        for code in 0..=255 {
            assert_eq!(encode(decode(code)), code);
        }
        assert_eq!((encode(-1.0), encode(2.0)), (0, 255));
    }

    /// IEC 61966-2-1 through the platform's power function.
    #[test]
    fn the_transfer_function_is_the_standard_one() {
        for code in 11..=255_u8 {
            let expected = ((f64::from(code) / 255.0 + 0.055) / 1.055).powf(2.4);
            // f32 rounding of the table
            assert!((f64::from(decode(code)) - expected).abs() < 6e-8 * expected.max(0.01), "{code}");
        }
    }
}
