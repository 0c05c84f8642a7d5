//! Time as an unevaluated sum `time + rest`.
//!
//! Event times are sums of phase durations. Added naively, 10^3 durations at t = 2000 leave an error of about 5e-12; carried
//! with its rounding error (Knuth's two-sum) the sum is right to one rounding.

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Clock {
    time: f64,
    rest: f64,
}

impl Clock {
    pub(super) fn time(self) -> f64 {
        self.time
    }

    #[inline]
    pub(super) fn advanced(self, duration: f64) -> Self {
        let sum = self.time + duration;
        let virtual_part = sum - self.time;
        let error = (self.time - (sum - virtual_part)) + (duration - virtual_part);
        let rest = self.rest + error;
        let time = sum + rest;
        Self { time, rest: rest - (time - sum) }
    }

    /// Time from now until `later`.
    #[inline]
    pub(super) fn until(self, later: f64) -> f64 {
        (later - self.time) - self.rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_tenths_are_counted_to_one_rounding() {
        let clock = (0..1_000_000).fold(Clock::default(), |clock, _| clock.advanced(0.1));
        // The double nearest 0.1 is 0.1 + 5.55e-18: a million of them exceed 1e5 by 5.6e-12, below half the spacing there.
        assert_eq!(clock.time(), 1e5);
        let naive = (0..1_000_000).fold(0.0, |time, _| time + 0.1);
        assert!((naive - 1e5_f64).abs() > 1e-6, "plain addition should be visibly worse: {naive}");
    }
}
