//! A self-excitation that changes in the course of a motion.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sweeps xi1 from the rig's own value at time 0 to another at the end of the motion, evenly, in steps: both engine and exact solution
/// hold it constant for a while, so that both solve the same problem.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    /// xi1 at the end of the motion.
    pub xi1_end: f64,
    /// Length of a step, non-dimensional time units.
    #[serde(default = "default_hold")]
    pub hold: f64,
}

fn default_hold() -> f64 {
    1.0
}

/// xi1 over the time of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Excitation {
    pub start: f64,
    pub duration: f64,
    pub ramp: Option<Ramp>,
}

impl Excitation {
    /// The value at a time: that in the middle of its step.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let Some(Ramp { xi1_end, hold }) = self.ramp else { return self.start };
        let middle = ((time / hold).floor() + 0.5) * hold;
        self.start + (xi1_end - self.start) * (middle / self.duration).clamp(0.0, 1.0)
    }

    /// The strongest excitation of the motion: the most negative value.
    #[must_use]
    pub fn strongest(&self) -> f64 {
        self.ramp.map_or(self.start, |ramp| self.start.min(ramp.xi1_end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_goes_evenly_in_steps_from_its_start_to_its_end() {
        let ramp = Some(Ramp { xi1_end: -0.2, hold: 2.0 });
        let excitation = Excitation { start: -0.1, duration: 10.0, ramp };
        // Five steps, their middles at 1, 3, 5, 7, 9 of 10.
        for (time, expected) in [(0.0, -0.11), (1.99, -0.11), (2.0, -0.13), (5.0, -0.15), (9.9, -0.19)] {
            assert!((excitation.at(time) - expected).abs() < 1e-15, "{time}");
        }
        assert_eq!(excitation.strongest(), -0.2);
        assert_eq!(Excitation { ramp: None, ..excitation }.at(7.0), -0.1);
    }
}
