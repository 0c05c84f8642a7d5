//! A fingerprint of a trajectory, to show that a run repeats bit by bit.

use crate::dynamics::Trajectory;
use crate::model::Works;
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// SHA-256 over the bits of all samples (time, state, ledger) and events (time, element, kind, state), 64 hexadecimal digits.
#[must_use]
pub fn trajectory_hash(trajectory: &Trajectory) -> String {
    let mut hasher = Sha256::new();
    for sample in &trajectory.samples {
        let Works { damping, self_excitation, circulatory, friction, drive } = sample.ledger.works;
        let works = [sample.ledger.stored, damping, self_excitation, circulatory, friction, drive];
        let numbers = std::iter::once(sample.time).chain(sample.state.components()).chain(works);
        numbers.for_each(|number| hasher.update(number.to_bits().to_le_bytes()));
    }
    for event in &trajectory.events {
        hasher.update(event.time.to_bits().to_le_bytes());
        hasher.update((event.element as u64).to_le_bytes());
        hasher.update([event.kind as u8]);
        event.state.components().for_each(|number| hasher.update(number.to_bits().to_le_bytes()));
    }
    hasher.finalize().iter().fold(String::with_capacity(64), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}
