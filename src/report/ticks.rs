//! Ticks at round values and their labels.

use super::figure::Scale;

/// A labelled position, in the coordinates of the axis (decimal logarithms on a logarithmic one).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub at: f64,
    /// Empty for a minor tick.
    pub label: String,
}

/// Ticks of an axis and the power of ten taken out of their labels.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    pub ticks: Vec<Tick>,
    pub exponent: i32,
}

/// About `count` ticks from `low` to `high`.
pub(super) fn ticks(scale: Scale, low: f64, high: f64, count: f64) -> Ticks {
    match scale {
        Scale::Linear => linear(low, high, count),
        Scale::Log => Ticks { ticks: logarithmic(low, high, count), exponent: 0 },
    }
}

fn linear(low: f64, high: f64, count: f64) -> Ticks {
    let raw = (high - low) / count.max(1.0);
    let power = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().find(|s| s * power >= raw * 0.999).unwrap_or(10.0) * power;
    let largest = low.abs().max(high.abs());
    // Numbers with more than four places before or after the point are written with a power of ten.
    let exponent = if !(1e-2..1e5).contains(&largest) { largest.log10().floor() as i32 } else { 0 };
    let unit = 10_f64.powi(exponent);
    let decimals = decimals(step / unit);
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    let tick = |n: i64| {
        let at = n as f64 * step;
        Tick { at, label: signed(&format!("{:.decimals$}", at / unit)) }
    };
    Ticks { ticks: (first..=last).map(tick).collect(), exponent }
}

/// Decimal places that write multiples of `step` exactly.
fn decimals(step: f64) -> usize {
    (0..12)
        .find(|&d| {
            let s = step * 10_f64.powi(d);
            (s - s.round()).abs() < 1e-6 * s
        })
        .unwrap_or(12) as usize
}

/// With the minus sign of typography, and none before zero.
fn signed(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text.to_owned(),
    }
}

/// Decades, every second or further one where they are many, with 2 and 5 where they are few, and minor ticks.
fn logarithmic(low: f64, high: f64, count: f64) -> Vec<Tick> {
    let (first, last) = (low.floor() as i32, high.ceil() as i32);
    let stride = ((high - low) / count.max(1.0)).ceil().max(1.0) as i32;
    let few = high - low < 1.6;
    let mut found = Vec::new();
    for decade in first..=last {
        for digit in 1..=9 {
            let at = f64::from(decade) + f64::from(digit).log10();
            if at < low - 1e-9 || at > high + 1e-9 {
                continue;
            }
            let label = match digit {
                1 if decade.rem_euclid(stride) == 0 => format!("10{}", superscript(decade)),
                2 | 5 if few => format!("{digit}·10{}", superscript(decade)),
                _ => String::new(),
            };
            if digit == 1 || stride == 1 {
                found.push(Tick { at, label });
            }
        }
    }
    found
}

/// `⁻³` for -3.
pub(super) fn superscript(number: i32) -> String {
    number
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '0' | '4'..='9' => char::from_u32('⁰' as u32 + c as u32 - '0' as u32).unwrap_or(c),
            other => other,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, low: f64, high: f64) -> Vec<String> {
        ticks(scale, low, high, 5.0).ticks.into_iter().map(|tick| tick.label).filter(|l| !l.is_empty()).collect()
    }

    #[test]
    fn ticks_are_round_numbers_inside_the_range() {
        assert_eq!(labels(Scale::Linear, -0.21, 0.01), ["−0.20", "−0.15", "−0.10", "−0.05", "0.00"]);
        assert_eq!(labels(Scale::Linear, 0.0, 500.0), ["0", "100", "200", "300", "400", "500"]);
    }

    #[test]
    fn small_and_large_numbers_are_written_with_a_power_of_ten() {
        let small = ticks(Scale::Linear, -2e-4, 6e-4, 5.0);
        assert_eq!((small.exponent, small.ticks[0].label.as_str()), (-4, "−2"));
        assert_eq!(ticks(Scale::Linear, 0.0, 1.0, 5.0).exponent, 0);
    }

    #[test]
    fn decades_carry_superscripts() {
        assert_eq!(labels(Scale::Log, -3.0, 0.0), ["10⁻³", "10⁻²", "10⁻¹", "10⁰"]);
        assert_eq!(labels(Scale::Log, 0.0, 1.0), ["10⁰", "2·10⁰", "5·10⁰", "10¹"]);
        assert_eq!(superscript(-12), "⁻¹²");
    }
}
