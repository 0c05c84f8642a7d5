//! Colour of a deflection: blue, grey, yellow, which readers with any colour vision can tell apart, evenly from -limit to +limit.

use crate::render::Colour;
use crate::scene::Theme;

/// A diverging scale of colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeflectionColours {
    /// Negative limit, zero, positive limit.
    stops: [Colour; 3],
    limit: f64,
}

impl DeflectionColours {
    /// `limit` is the deflection of the strongest colours, positive.
    #[must_use]
    pub fn new(theme: Theme, limit: f64) -> Self {
        // Zero stands out from the floor of its theme: brighter than the dark one, darker than the light one.
        let stops = match theme {
            Theme::Dark => [0x1f6fe0, 0x9aa3ab, 0xffd60a],
            Theme::Light => [0x0a4fb3, 0xa8b0b8, 0xd9a300],
        };
        Self { stops: stops.map(Colour::rgb), limit }
    }

    #[must_use]
    pub fn limit(&self) -> f64 {
        self.limit
    }

    /// Beyond the limit as at the limit.
    #[must_use]
    pub fn of(&self, deflection: f64) -> Colour {
        let part = (deflection / self.limit).clamp(-1.0, 1.0);
        let [negative, zero, positive] = self.stops;
        let end = if part < 0.0 { negative } else { positive };
        let mix = |i: usize| {
            let (a, b) = (f64::from(zero.0[i]), f64::from(end.0[i]));
            (a + (b - a) * part.abs()).round() as u8
        };
        Colour([mix(0), mix(1), mix(2), 255])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_run_from_one_end_over_grey_to_the_other() {
        let colours = DeflectionColours::new(Theme::Light, 2.0);
        assert_eq!([-2.0, 0.0, 2.0].map(|x| colours.of(x)), colours.stops);
        assert_eq!(colours.of(5.0), colours.of(2.0));
        // Half way from a8b0b8 to d9a300, channel by channel: 192.5, 169.5, 92, halves rounded up.
        assert_eq!(colours.of(1.0), Colour::rgb(0xc1aa5c));
    }
}
