//! The scenarios, one file each.

mod linear_oscillator;
mod secondary_hopf;

pub use linear_oscillator::LinearOscillator;
pub use secondary_hopf::SecondaryHopf;
