//! Times of stick and slip in the engine against the exact ones.
//!
//! A state error e moves a switch by about e over the rate at which its event function crosses zero: `|v_1|` where slip begins,
//! `|x_1''|` where it ends. The times are interpolated within the step, with an error of order h^2 of their own.

use crate::dynamics::{Event, EventKind, Trajectory};
use crate::model::OscillatorChain;

/// Largest error of a switching time, and the largest that follows from the state error; `None` if the motions do not have the same
/// switches in the same order.
#[must_use]
pub fn switching_error(
    chain: &OscillatorChain,
    exact: &[Event],
    tested: &Trajectory,
    state_error: f64,
    step: f64,
) -> Option<(f64, f64)> {
    let end = tested.last()?.time;
    // A switch at the very end may fall on either side of it.
    let counts = |event: &&Event| event.kind != EventKind::Grazing && event.time < end - 20.0 * step.max(state_error);
    let (a, b): (Vec<&Event>, Vec<&Event>) = (
        exact.iter().filter(counts).collect(),
        tested.events.iter().filter(|e| e.kind != EventKind::Grazing).collect(),
    );
    if b.len() < a.len() {
        return None;
    }
    let mut largest = (0.0f64, 0.0f64);
    for (a, b) in a.iter().zip(&b) {
        if a.kind != b.kind {
            return None;
        }
        let state = &a.state;
        let acceleration = chain.acceleration(&state.positions, &state.velocities, &state.slider_forces);
        let attachment = chain.jenkins()[a.element].attachment;
        let rate = match a.kind {
            EventKind::StickToSlip => attachment.elongation(&state.velocities),
            _ => attachment.elongation(&acceleration),
        };
        largest.0 = largest.0.max((a.time - b.time).abs());
        largest.1 = largest.1.max(2.0 * state_error / rate.abs() + step * step);
    }
    Some(largest)
}
