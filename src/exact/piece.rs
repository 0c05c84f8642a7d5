//! A stretch of motion in one contact state with its closed form, and the works done in it.

use super::clock::Clock;
use super::gauss::integrate;
use super::modal_phase::{ModalPair, Phase};
use super::pattern::{Expansion, Pattern};
use super::sparse::{SparseSystem, TaylorSeries};
use crate::dynamics::State;
use crate::model::{ContactState, OscillatorChain, Works};
use nalgebra::DVector;
use std::sync::Arc;

#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub(super) start: Clock,
    pub(super) duration: f64,
    pub(super) contacts: Arc<[ContactState]>,
    pub(super) law: Law,
}

/// The closed form by which a piece goes on from its start.
#[derive(Debug, Clone)]
pub(super) enum Law {
    Modal { pair: Arc<ModalPair>, phase: Phase },
    Series { pattern: Arc<Pattern>, start: DVector<f64> },
    Taylor { system: Arc<SparseSystem>, start: DVector<f64> },
}

/// A piece ready to be evaluated.
pub(super) struct Evaluator<'a> {
    chain: &'a OscillatorChain,
    contacts: &'a [ContactState],
    form: Form<'a>,
}

enum Form<'a> {
    Modal { pair: &'a ModalPair, phase: &'a Phase },
    Series { expansion: Expansion, cell: f64 },
    Taylor { series: TaylorSeries, length: usize, cell: f64 },
}

impl Piece {
    pub(super) fn evaluator<'a>(&'a self, chain: &'a OscillatorChain) -> Evaluator<'a> {
        let form = match &self.law {
            Law::Modal { pair, phase } => Form::Modal { pair, phase },
            Law::Taylor { system, start } => {
                let series = TaylorSeries::full(system, start.as_slice(), &self.contacts);
                Form::Taylor { series, length: start.len(), cell: system.longest_cell() }
            }
            Law::Series { pattern, start } => Form::Series { expansion: pattern.expand(start), cell: pattern.cell },
        };
        Evaluator { chain, contacts: &self.contacts, form }
    }
}

impl Evaluator<'_> {
    /// State at a time since the start of the piece.
    pub(super) fn state(&self, time: f64) -> State {
        match &self.form {
            Form::Modal { pair, phase } => State::two_mass(pair.physical(phase, &pair.advanced(phase, time))),
            Form::Taylor { series, length, .. } => {
                let mut y = DVector::zeros(*length);
                series.state(time, y.as_mut_slice());
                state_of(self.chain, &y)
            }
            Form::Series { expansion, .. } => state_of(self.chain, &expansion.at(time)),
        }
    }

    /// Time over which the motion is smooth: one over its fastest rate.
    fn smooth_span(&self) -> f64 {
        match &self.form {
            Form::Modal { pair, .. } => pair.smooth_span(),
            Form::Series { cell, .. } | Form::Taylor { cell, .. } => *cell,
        }
    }

    /// Works done between two times since the start of the piece: damping, self-excitation and circulatory stiffness by
    /// quadrature of their powers, friction as `-R |slip|`. Within a slip phase the slider moves one way only.
    pub(super) fn works(&self, from: f64, to: f64) -> Works {
        let mut works = Works::default();
        if to <= from {
            return works;
        }
        integrate(from, to, self.smooth_span(), |time, weight| {
            let state = self.state(time);
            let powers = self.chain.powers(&state.positions, &state.velocities);
            works.damping += weight * powers.damping;
            works.self_excitation += weight * powers.self_excitation;
            works.circulatory += weight * powers.circulatory;
        });
        if self.contacts.iter().any(|contact| !contact.is_stick()) {
            let (before, after) = (self.state(from), self.state(to));
            for (element, _) in self.chain.jenkins().iter().zip(self.contacts.iter()).filter(|(_, c)| !c.is_stick()) {
                let elongation = |state: &State| element.attachment.elongation(&state.positions);
                works.friction -= element.slip_force * (elongation(&after) - elongation(&before)).abs();
            }
        }
        works
    }
}

/// `(x, v, f)` from one vector, |f| <= 1.
pub(super) fn state_of(chain: &OscillatorChain, y: &DVector<f64>) -> State {
    let n = chain.oscillators();
    let y = y.as_slice();
    State {
        positions: y[..n].to_vec(),
        velocities: y[n..2 * n].to_vec(),
        slider_forces: y[2 * n..].iter().map(|f| f.clamp(-1.0, 1.0)).collect(),
    }
}
