//! Force laws: what the springs, dampers and friction elements of the rig do to its carriages.
//!
//! Rapier has no callback for forces, so each law is evaluated before a step from what is known then, and its force is held constant
//! over the step:
//!
//! ```text
//! F = -K x  (springs),   -D v  (passive damping),   -S v  (self-excitation),   -sum_j R_j f_j b_j  (Jenkins elements).
//! ```
//!
//! Matrices may be non-symmetric. Laws have no memory: the slider forces f are part of the rig's state and handed to them.

use super::step_path::{Along, StepPath, along};
use crate::model::{Attachment, JenkinsElement, OscillatorChain, ParameterError};
use nalgebra::{DMatrix, DVectorView, DVectorViewMut};
use std::fmt::Debug;
use std::sync::Arc;

/// What a law may use: the state at the beginning of a step.
#[derive(Debug, Clone, Copy)]
pub struct Known<'a> {
    pub time: f64,
    /// Displacements, length N.
    pub positions: &'a [f64],
    /// Velocities as well as they are known (see [`super::Scheme`]), length N.
    pub velocities: &'a [f64],
    /// Normalised slider forces, one per Jenkins element.
    pub slider_forces: &'a [f64],
}

/// A force on the carriages along their rail.
pub trait ForceLaw: Debug + Send + Sync {
    /// Does the law fit the chain it is to move?
    ///
    /// # Errors
    /// [`ParameterError`] naming the size that does not fit.
    fn check(&self, _chain: &OscillatorChain) -> Result<(), ParameterError> {
        Ok(())
    }

    /// Adds the forces of this law to `force`, length N.
    fn add_force(&self, known: &Known<'_>, force: &mut [f64]);

    /// Moves the sliders on after the carriages went `from` one sampled position `to` the next. Laws without friction have none.
    fn move_sliders(&self, _from: &[f64], _to: &[f64], _slider_forces: &mut [f64]) {}

    /// Moves the sliders on along a path, and sets the means of their forces over it. For [`super::Scheme::AveragedFriction`].
    fn drag_sliders(&self, _path: &StepPath<'_>, _slider_forces: &mut [f64], _means: &mut [f64]) {}
}

/// Springs to ground and between carriages, and any other linear force of position: `-K x`.
#[derive(Debug, Clone, PartialEq)]
pub struct Springs(pub DMatrix<f64>);

impl ForceLaw for Springs {
    fn check(&self, chain: &OscillatorChain) -> Result<(), ParameterError> {
        check_size("springs", &self.0, chain)
    }

    fn add_force(&self, known: &Known<'_>, force: &mut [f64]) {
        subtract_product(&self.0, known.positions, force);
    }
}

/// Passive dampers: `-D v`.
#[derive(Debug, Clone, PartialEq)]
pub struct Dampers(pub DMatrix<f64>);

impl ForceLaw for Dampers {
    fn check(&self, chain: &OscillatorChain) -> Result<(), ParameterError> {
        check_size("dampers", &self.0, chain)
    }

    fn add_force(&self, known: &Known<'_>, force: &mut [f64]) {
        subtract_product(&self.0, known.velocities, force);
    }
}

/// Self-excitation, damping with the other sign: `-S v`.
#[derive(Debug, Clone, PartialEq)]
pub struct SelfExcitation(pub DMatrix<f64>);

impl ForceLaw for SelfExcitation {
    fn check(&self, chain: &OscillatorChain) -> Result<(), ParameterError> {
        check_size("self_excitation", &self.0, chain)
    }

    fn add_force(&self, known: &Known<'_>, force: &mut [f64]) {
        subtract_product(&self.0, known.velocities, force);
    }
}

/// Jenkins elements by incremental return mapping on sampled positions: with `du` the change of elongation from one sample to the
/// next,
///
/// ```text
/// f <- clamp(f + (k/R) du, -1, 1).
/// ```
///
/// Exact as long as the elongation is monotone between samples; where it turns, the extreme lies up to `h^2 |u''|/8` beyond the
/// samples, and f is wrong by that much times k/R.
#[derive(Debug, Clone, PartialEq)]
pub struct JenkinsElements(pub Vec<JenkinsElement>);

impl ForceLaw for JenkinsElements {
    fn check(&self, chain: &OscillatorChain) -> Result<(), ParameterError> {
        let (found, expected) = (self.0.len(), chain.sliders());
        if found != expected {
            let field = "jenkins".to_owned();
            return Err(ParameterError::WrongLength { field, found, expected, per: "Jenkins element of the chain" });
        }
        let count = chain.oscillators();
        let ends = |element: &JenkinsElement| match element.attachment {
            Attachment::Ground(i) => i,
            Attachment::Between(i, j) => i.max(j),
        };
        match self.0.iter().map(ends).position(|last| last >= count) {
            Some(j) => {
                Err(ParameterError::NoSuchOscillator { field: format!("jenkins[{j}]"), found: ends(&self.0[j]), count })
            }
            None => Ok(()),
        }
    }

    fn add_force(&self, known: &Known<'_>, force: &mut [f64]) {
        for (element, f) in self.0.iter().zip(known.slider_forces) {
            element.attachment.scatter(-element.slip_force * f, force);
        }
    }

    fn move_sliders(&self, from: &[f64], to: &[f64], slider_forces: &mut [f64]) {
        for (element, f) in self.0.iter().zip(slider_forces) {
            let du = element.attachment.elongation(to) - element.attachment.elongation(from);
            *f = return_mapping(element, *f, du);
        }
    }

    fn drag_sliders(&self, path: &StepPath<'_>, slider_forces: &mut [f64], means: &mut [f64]) {
        for ((element, f), mean) in self.0.iter().zip(slider_forces).zip(means) {
            let Along { end, mean: over_path } = along(element, *f, path);
            (*f, *mean) = (end, over_path);
        }
    }
}

/// The law of [`JenkinsElements`] for one element.
pub(super) fn return_mapping(element: &JenkinsElement, f: f64, du: f64) -> f64 {
    (f + element.normalised_stiffness() * du).clamp(-1.0, 1.0)
}

/// The laws of a chain, one per kind of element.
#[must_use]
pub fn laws_of(chain: &OscillatorChain) -> Vec<Arc<dyn ForceLaw>> {
    vec![
        Arc::new(Springs(chain.stiffness().clone())),
        Arc::new(Dampers(chain.damping().clone())),
        Arc::new(SelfExcitation(chain.self_excitation().clone())),
        Arc::new(JenkinsElements(chain.jenkins().to_vec())),
    ]
}

fn check_size(field: &str, matrix: &DMatrix<f64>, chain: &OscillatorChain) -> Result<(), ParameterError> {
    let n = chain.oscillators();
    if matrix.shape() == (n, n) {
        return Ok(());
    }
    let (found, expected) = (matrix.len(), n * n);
    Err(ParameterError::WrongLength { field: field.to_owned(), found, expected, per: "pair of oscillators" })
}

/// `target -= matrix * values`, with sizes that fit (laws are checked before they are used).
pub(super) fn subtract_product(matrix: &DMatrix<f64>, values: &[f64], target: &mut [f64]) {
    let values = DVectorView::from_slice(values, values.len());
    let rows = target.len();
    DVectorViewMut::from_slice(target, rows).gemv(-1.0, matrix, &values, 1.0);
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn the_slider_loads_slips_and_unloads_with_the_same_stiffness() {
        let element = JenkinsElement { attachment: Attachment::Ground(0), stiffness: 2.0, slip_force: 4.0 };
        let law = JenkinsElements(vec![element]);
        let mut f = [0.0];
        law.move_sliders(&[0.0], &[1.0], &mut f);
        assert_eq!(f, [0.5]);
        law.move_sliders(&[1.0], &[5.0], &mut f);
        assert_eq!(f, [1.0]);
        law.move_sliders(&[5.0], &[4.0], &mut f);
        assert_eq!(f, [0.5]);
        let mut force = [0.0];
        let known = Known { time: 0.0, positions: &[4.0], velocities: &[0.0], slider_forces: &f };
        law.add_force(&known, &mut force);
        assert_eq!(force, [-2.0]);
    }

    #[test]
    fn laws_of_another_chain_are_refused() {
        let chain = crate::model::ChainBuilder::new(vec![1.0, 1.0]).build().unwrap();
        let refused = |law: &dyn ForceLaw| law.check(&chain).unwrap_err().to_string();
        assert!(refused(&Springs(DMatrix::zeros(3, 3))).contains("springs has 9 entries, expected 4"));
        assert!(refused(&Dampers(DMatrix::zeros(1, 4))).contains("dampers"));
        let element = JenkinsElement { attachment: Attachment::Ground(5), stiffness: 1.0, slip_force: 1.0 };
        assert!(refused(&JenkinsElements(vec![element])).contains("jenkins has 1 entries, expected 0"));
        assert!(laws_of(&chain).iter().all(|law| law.check(&chain).is_ok()));
    }

    #[test]
    fn the_laws_of_a_chain_sum_to_its_equation_of_motion() {
        let chain = crate::model::ChainBuilder::new(vec![2.0, 1.0])
            .add_stiffness(&DMatrix::from_row_slice(2, 2, &[3.0, 1.0, -2.0, 5.0]))
            .ground_damper(0, 0.25)
            .self_excited(1, -0.5)
            .jenkins(JenkinsElement { attachment: Attachment::Between(1, 0), stiffness: 1.0, slip_force: 4.0 })
            .build()
            .unwrap();
        let known = Known { time: 0.0, positions: &[1.0, 2.0], velocities: &[3.0, 4.0], slider_forces: &[0.5] };
        let mut force = [0.0; 2];
        laws_of(&chain).iter().for_each(|law| law.add_force(&known, &mut force));
        // By hand: first row -(3 + 2) - 0.25 * 3 + 4 * 0.5, second -(-2 + 10) + 0.5 * 4 - 4 * 0.5.
        assert_eq!(force, [-3.75, -8.0]);
    }
}
