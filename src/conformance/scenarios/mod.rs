//! The scenarios, one file each.

mod linear_oscillator;

pub use linear_oscillator::LinearOscillator;
