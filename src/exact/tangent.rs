//! Linearised flow of the two-mass rig, exact in each phase and through the switches.
//!
//! A perturbation `(dz, df)` of `z = (x1, x2, v1, v2)` and the slider force obeys, with the slider moved by `da = dx1 - df`,
//!
//! ```text
//! stick: dz(t) = p da + exp(K_stick t) (dz - p da),   df(t) = dx1(t) - da       p = equilibrium per slider position
//! slip:  dz(t) = exp(K_slip t) dz,                    df(t) = 0
//! ```
//!
//! With guard normal n and vector fields F-, F+ before and after a switch, perturbations jump by the saltation matrix
//! `S = I + (F+ - F-) n^T / (n^T F-)`. From stick to slip it is `I - e_f e_f^T`: whatever the force was, it is the slip force
//! from then on. From slip to stick it is `I`, because v1 = 0 there makes both fields equal. A force that
//! touches the slip force and turns back leaves perturbations as they are.
//!
//! A state that starts in slip is at `f = +-1` to first order whatever `df` says, so `df` is wiped out there too; motions may
//! therefore be cut anywhere, at a switch included.

use super::error::ExactError;
use super::half_period::exponential;
use super::modal::rotated;
use super::modal_phase::{Contact, ModalPair};
use super::pattern::extended_matrix;
use super::two_mass::TwoMassFlow;
use crate::dynamics::{Outcome, State, TangentFlow};
use nalgebra::{DMatrix, DVector, Matrix5, Vector4};

/// Length of `y = (x1, x2, v1, v2, f)`, and the place of f in it.
const LENGTH: usize = 5;
pub(super) const FORCE: usize = 4;

impl TangentFlow for TwoMassFlow {
    type Error = ExactError;

    fn dimension(&self) -> usize {
        LENGTH
    }

    fn carry(
        &self,
        state: &mut DVector<f64>,
        tangents: &mut DMatrix<f64>,
        duration: f64,
    ) -> Result<Outcome, ExactError> {
        let initial = State::from_components(state.as_slice(), self.rig().chain())?;
        if tangents.nrows() != LENGTH {
            return Err(ExactError::TangentLength { found: tangents.nrows(), expected: LENGTH });
        }
        let Some(pair) = self.modal() else {
            return self.carry_by_series(&initial, state, tangents, duration);
        };
        let mut outcome = Outcome::Completed;
        let mut walk = self.walk(pair, &initial, duration)?;
        for leg in walk.by_ref() {
            pair.carry(leg.phase.contact, leg.exit.time, tangents);
            outcome = self.outcome(&leg);
            state.copy_from_slice(&pair.physical(&leg.phase, &leg.exit.c));
        }
        walk.completed().map(|()| outcome)
    }

    fn vector_field(&self, state: &DVector<f64>) -> Result<DVector<f64>, ExactError> {
        let chain = self.rig().chain();
        let state = State::from_components(state.as_slice(), chain)?.validated(chain)?;
        let acceleration = chain.acceleration(&state.positions, &state.velocities, &state.slider_forces);
        let sticks = state.initial_contacts(chain).iter().all(|contact| contact.is_stick());
        let rate = if sticks { state.velocities[0] } else { 0.0 };
        Ok(DVector::from_iterator(LENGTH, state.velocities.iter().chain(&acceleration).copied().chain([rate])))
    }
}

impl TwoMassFlow {
    fn carry_by_series(
        &self,
        initial: &State,
        state: &mut DVector<f64>,
        tangents: &mut DMatrix<f64>,
        duration: f64,
    ) -> Result<Outcome, ExactError> {
        let motion = self.series().solve(initial, duration)?;
        for (_, contacts, span) in motion.phases() {
            let carried = self.phase_tangent(contacts.iter().all(|contact| contact.is_stick()), span) * &*tangents;
            tangents.copy_from(&carried);
        }
        let end = motion.state_at(motion.end())?.state;
        state.iter_mut().zip(end.components()).for_each(|(y, component)| *y = component);
        Ok(motion.outcome())
    }

    /// Derivative of the flow over one phase, the saltation at its start included.
    pub(super) fn phase_tangent(&self, sticks: bool, span: f64) -> Matrix5<f64> {
        let matrix = extended_matrix(self.rig().chain(), &[sticks]);
        let mut tangent = exponential(Matrix5::from_fn(|row, column| matrix[(row, column)] * span));
        if !sticks {
            tangent.column_mut(FORCE).fill(0.0);
        }
        tangent
    }
}

impl ModalPair {
    fn carry(&self, contact: Contact, span: f64, tangents: &mut DMatrix<f64>) {
        let modes = self.modes(contact);
        let turn = modes.turn(span);
        for mut tangent in tangents.column_iter_mut() {
            let slider = tangent[0] - tangent[FORCE];
            let [e1, e2] = match contact {
                Contact::Stick => self.equilibrium(contact, slider),
                Contact::Slip => [0.0, 0.0],
            };
            let relative = Vector4::new(tangent[0] - e1, tangent[1] - e2, tangent[2], tangent[3]);
            let c = rotated(&(modes.to_modal * relative).into(), &turn);
            let z = modes.to_physical * Vector4::from(c);
            (tangent[0], tangent[1], tangent[2], tangent[3]) = (z[0] + e1, z[1] + e2, z[2], z[3]);
            tangent[FORCE] = match contact {
                Contact::Stick => tangent[0] - slider,
                Contact::Slip => 0.0,
            };
        }
    }
}
