//! Extended state `y = (x, v, f)` of a chain, and the contact state in which it starts.

use super::first_motion::contacts_at;
use crate::model::{ContactState, OscillatorChain};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A state that cannot start a motion.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StateError {
    #[error("{field} has {found} entries, expected {expected}: give one per {per}")]
    WrongLength { field: &'static str, found: usize, expected: usize, per: &'static str },
    #[error("{field}[{index}] = {found} is not allowed: it must be a finite number")]
    NotFinite { field: &'static str, index: usize, found: f64 },
    #[error(
        "slider force f[{index}] = {found} is not allowed: a Jenkins element carries at most its slip force, -1 <= f <= 1"
    )]
    BeyondSlipForce { index: usize, found: f64 },
}

/// Positions and velocities (length N), normalised slider forces (one per Jenkins element, |f| <= 1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    pub positions: Vec<f64>,
    pub velocities: Vec<f64>,
    pub slider_forces: Vec<f64>,
}

impl State {
    /// State of the two-mass rig, `y = (x1, x2, v1, v2, f)`.
    #[must_use]
    pub fn two_mass([x1, x2, v1, v2, f]: [f64; 5]) -> Self {
        Self { positions: vec![x1, x2], velocities: vec![v1, v2], slider_forces: vec![f] }
    }

    /// From the components in the order x, v, f, for a chain of `oscillators`.
    ///
    /// # Errors
    /// [`StateError::WrongLength`] unless there are `2 oscillators + sliders` components.
    pub fn from_components(y: &[f64], chain: &OscillatorChain) -> Result<Self, StateError> {
        let (n, expected) = (chain.oscillators(), 2 * chain.oscillators() + chain.sliders());
        if y.len() != expected {
            return Err(StateError::WrongLength {
                field: "components",
                found: y.len(),
                expected,
                per: "state variable",
            });
        }
        let (positions, rest) = y.split_at(n);
        let (velocities, slider_forces) = rest.split_at(n);
        Ok(Self {
            positions: positions.to_vec(),
            velocities: velocities.to_vec(),
            slider_forces: slider_forces.to_vec(),
        })
    }

    /// At rest, without force.
    #[must_use]
    pub fn rest(chain: &OscillatorChain) -> Self {
        let n = chain.oscillators();
        Self { positions: vec![0.0; n], velocities: vec![0.0; n], slider_forces: vec![0.0; chain.sliders()] }
    }

    /// All components in the order x, v, f.
    pub fn components(&self) -> impl Iterator<Item = f64> + '_ {
        self.positions.iter().chain(&self.velocities).chain(&self.slider_forces).copied()
    }

    /// Largest difference of any component, the distance used for state errors. States of one chain only.
    #[must_use]
    pub fn max_difference(&self, other: &Self) -> f64 {
        self.components().zip(other.components()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// The mirrored state `-y`, a solution wherever `y` is one.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let negate = |values: &[f64]| values.iter().map(|v| -v).collect();
        Self {
            positions: negate(&self.positions),
            velocities: negate(&self.velocities),
            slider_forces: negate(&self.slider_forces),
        }
    }

    /// Passes the state through if it fits `chain` and can start a motion.
    ///
    /// # Errors
    /// [`StateError`] for wrong lengths, numbers that are not finite, and `|f| > 1`.
    pub fn validated(self, chain: &OscillatorChain) -> Result<Self, StateError> {
        let (n, m) = (chain.oscillators(), chain.sliders());
        let parts: [(&'static str, &[f64], usize, &'static str); 3] = [
            ("positions", &self.positions, n, "oscillator"),
            ("velocities", &self.velocities, n, "oscillator"),
            ("slider_forces", &self.slider_forces, m, "Jenkins element"),
        ];
        for (field, values, expected, per) in parts {
            if values.len() != expected {
                return Err(StateError::WrongLength { field, found: values.len(), expected, per });
            }
            if let Some(index) = values.iter().position(|v| !v.is_finite()) {
                return Err(StateError::NotFinite { field, index, found: values[index] });
            }
        }
        match self.slider_forces.iter().position(|f| f.abs() > 1.0) {
            Some(index) => Err(StateError::BeyondSlipForce { index, found: self.slider_forces[index] }),
            None => Ok(self),
        }
    }

    /// Contact state of each element at the start: slip if `|f| = 1` and the elongation rate, or where that vanishes its first
    /// derivative that does not, has the sign of `f`; stick otherwise. What vanishes is decided in exact terms.
    #[must_use]
    pub fn initial_contacts(&self, chain: &OscillatorChain) -> Vec<ContactState> {
        contacts_at(chain, &self.positions, &self.velocities, &self.slider_forces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Direction, RigParameters, TwoMassRig};

    fn contact(y: [f64; 5]) -> ContactState {
        let rig = TwoMassRig::new(RigParameters::default()).unwrap();
        State::two_mass(y).initial_contacts(rig.chain())[0]
    }

    #[test]
    fn the_element_starts_slipping_only_when_loaded_further() {
        assert_eq!(contact([1.2, 0.9, 0.1, -0.5, 1.0]), ContactState::Slip(Direction::Positive));
        assert_eq!(contact([1.2, 0.9, -0.1, -0.5, 1.0]), ContactState::Stick);
        assert_eq!(contact([1.2, 0.9, 0.1, -0.5, 0.999]), ContactState::Stick);
        // v1 = 0: the acceleration decides, here negative.
        assert_eq!(contact([1.2, 0.9, 0.0, -0.5, 1.0]), ContactState::Stick);
        assert_eq!(contact([-1.2, 0.9, 0.0, -0.5, 1.0]), ContactState::Slip(Direction::Positive));
    }

    #[test]
    fn a_slider_force_beyond_the_slip_force_is_refused() {
        let rig = TwoMassRig::new(RigParameters::default()).unwrap();
        let error = State::two_mass([0.0, 0.0, 0.0, 0.0, 1.5]).validated(rig.chain()).unwrap_err();
        assert!(error.to_string().contains("f[0] = 1.5"));
        assert!(State::two_mass([f64::NAN, 0.0, 0.0, 0.0, 0.0]).validated(rig.chain()).is_err());
    }
}
