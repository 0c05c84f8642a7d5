//! Linearised flow of a large chain: perturbations obey the same linear recursion, the force of a slipping element being zero to first order.
//!
//! A switch from stick to slip of element j multiplies by `S = I - e_f e_f^T` (only the rate of `f_j` jumps there, and the guard is `f_j = +-1`), one from slip to
//! stick by `I` (the sliding velocity vanishes). Dropping the force component of slipping elements at the start of every leg does both,
//! at the start of the motion too; so motions may be cut anywhere.

use super::super::error::ExactError;
use super::flow::SparseFlow;
use super::series::TaylorSeries;
use super::system::SparseSystem;
use super::walk::SparseWalk;
use crate::dynamics::{Outcome, State, TangentFlow};
use crate::model::ContactState;
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

impl TangentFlow for SparseFlow {
    type Error = ExactError;

    fn dimension(&self) -> usize {
        self.system.length()
    }

    fn carry(
        &self,
        state: &mut DVector<f64>,
        tangents: &mut DMatrix<f64>,
        duration: f64,
    ) -> Result<Outcome, ExactError> {
        let expected = self.dimension();
        let initial = State::from_components(state.as_slice(), self.chain())?;
        if tangents.nrows() != expected {
            return Err(ExactError::TangentLength { found: tangents.nrows(), expected });
        }
        let mut walk: SparseWalk<'_> = self.walk(&initial, duration)?;
        let mut contacts = Arc::clone(&walk.contacts);
        let (mut series, mut outcome) = (TaylorSeries::default(), Outcome::Completed);
        while let Some(leg) = walk.advance()? {
            if leg.duration > 0.0 {
                let order = order_for(&self.system, leg.duration);
                for mut tangent in tangents.column_iter_mut() {
                    carry_column(&self.system, &mut series, tangent.as_mut_slice(), &contacts, order, leg.duration);
                }
            } else {
                tangents.column_iter_mut().for_each(|mut t| drop_slipping(&self.system, t.as_mut_slice(), &contacts));
            }
            outcome = self.outcome(&leg);
            contacts = Arc::clone(&walk.contacts);
        }
        // A switch to slip at the very end counts.
        tangents.column_iter_mut().for_each(|mut t| drop_slipping(&self.system, t.as_mut_slice(), &contacts));
        state.copy_from_slice(&walk.y);
        Ok(outcome)
    }

    fn vector_field(&self, state: &DVector<f64>) -> Result<DVector<f64>, ExactError> {
        let state = State::from_components(state.as_slice(), self.chain())?.validated(self.chain())?;
        let contacts = state.initial_contacts(self.chain());
        let n = self.system.oscillators;
        let mut field = DVector::zeros(self.dimension());
        let field_slice = field.as_mut_slice();
        field_slice[..n].copy_from_slice(&state.velocities);
        let forces = state.slider_forces.iter().copied();
        self.system.acceleration(&state.positions, &state.velocities, forces, &mut field_slice[n..2 * n]);
        for (j, element) in self.system.elements.iter().enumerate().filter(|(j, _)| contacts[*j].is_stick()) {
            field_slice[2 * n + j] = element.normalised_stiffness * element.elongation(&state.velocities);
        }
        Ok(field)
    }
}

/// The least order whose cell is at least `span`.
fn order_for(system: &SparseSystem, span: f64) -> usize {
    use super::series::HIGHEST_ORDER;
    (1..HIGHEST_ORDER).find(|order| system.cell(*order) >= span).unwrap_or(HIGHEST_ORDER)
}

fn drop_slipping(system: &SparseSystem, tangent: &mut [f64], contacts: &[ContactState]) {
    let forces = &mut tangent[2 * system.oscillators..];
    forces.iter_mut().zip(contacts).filter(|(_, contact)| !contact.is_stick()).for_each(|(f, _)| *f = 0.0);
}

fn carry_column(
    system: &SparseSystem,
    series: &mut TaylorSeries,
    tangent: &mut [f64],
    contacts: &[ContactState],
    order: usize,
    span: f64,
) {
    drop_slipping(system, tangent, contacts);
    series.expand(system, tangent, contacts, order);
    series.linear_state(span, tangent);
}
