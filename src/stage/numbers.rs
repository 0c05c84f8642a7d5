//! Numbers as they are written over the picture.

/// Two digits and the power of ten: `6.1·10⁻⁷`.
pub fn with_power(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let text = format!("{value:.1e}");
    let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
    let raised = power.chars().map(|letter| match letter {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    });
    let raised: String = raised.collect();
    format!("{}·10{raised}", digits.replace('-', "−"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_ten_are_raised() {
        assert_eq!(with_power(6.14e-7), "6.1·10⁻⁷");
        assert_eq!(with_power(-2.0e12), "−2.0·10¹²");
        assert_eq!(with_power(0.0), "0");
    }
}
