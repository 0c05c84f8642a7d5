//! Choices by a seed.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

pub struct Dice(ChaCha8Rng);

/// Numbers at which programs break: limits of types, zeros, what overflows, what is no number, and ordinary ones.
const NUMBERS: [&str; 34] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "3",
    "0.5",
    "-0.06",
    "0.05",
    "1e-3",
    "1e-9",
    "1e-160",
    "5e-324",
    "1e-308",
    "1.7976931348623157e308",
    "-1e308",
    "1e26",
    "-1e26",
    "1e16",
    "nan",
    "inf",
    "-inf",
    "4294967295",
    "4294967296",
    "-2147483649",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551616",
    "0x10",
    "1_0",
    "1e400",
    "0.99999999999999989",
    "100",
    "7",
];

impl Dice {
    /// Every input has dice of its own, whatever the number of inputs and threads.
    pub fn of(seed: u64, number: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(number);
        Self(random)
    }

    /// 0 to `count` - 1.
    pub fn below(&mut self, count: usize) -> usize {
        self.0.random_range(0..count.max(1))
    }

    /// Once in `n` times.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    pub fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }

    pub fn number(&mut self) -> String {
        if self.once_in(3) {
            let value = (self.0.random::<f64>() - 0.5) * 10f64.powi(self.below(9) as i32 - 5);
            return format!("{value:?}");
        }
        (*self.pick(&NUMBERS)).to_owned()
    }
}
