//! Assembling a chain from springs and dampers, or from whole matrices.
//!
//! A spring or damper of coefficient `c` between oscillators i and j adds `c` to the diagonal entries ii and jj and `-c` to ij and ji;
//! one to ground adds `c` to ii.

use super::chain::OscillatorChain;
use super::jenkins::JenkinsElement;
use super::quantity::{ParameterError, Range};
use nalgebra::{DMatrix, DVector};

/// Assembles an [`OscillatorChain`] from springs and dampers, or from whole matrices.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainBuilder {
    mass: Vec<f64>,
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
    self_excitation: DMatrix<f64>,
    jenkins: Vec<JenkinsElement>,
    faults: Vec<ParameterError>,
}

impl ChainBuilder {
    /// Starts from the masses; everything else is zero.
    #[must_use]
    pub fn new(mass: Vec<f64>) -> Self {
        let zero = DMatrix::zeros(mass.len(), mass.len());
        Self {
            mass,
            stiffness: zero.clone(),
            damping: zero.clone(),
            self_excitation: zero,
            jenkins: Vec::new(),
            faults: Vec::new(),
        }
    }

    /// Spring from oscillator `i` to ground.
    #[must_use]
    pub fn ground_spring(mut self, i: usize, stiffness: f64) -> Self {
        let field = format!("ground_stiffness[{i}]");
        if self.accepts(&field, i, Range::NonNegative.check(field.clone(), stiffness)) {
            self.stiffness[(i, i)] += stiffness;
        }
        self
    }

    /// Spring between oscillators `i` and `j`.
    #[must_use]
    pub fn coupling_spring(mut self, i: usize, j: usize, stiffness: f64) -> Self {
        let field = format!("coupling_stiffness[{i}-{j}]");
        let checked = Range::NonNegative.check(field.clone(), stiffness);
        if self.accepts(&field, i.max(j), checked) && self.distinct(&field, i, j) {
            couple(&mut self.stiffness, i, j, stiffness);
        }
        self
    }

    /// Damper between oscillators `i` and `j`; its coefficient may have either sign.
    #[must_use]
    pub fn coupling_damper(mut self, i: usize, j: usize, coefficient: f64) -> Self {
        let field = format!("coupling_damping[{i}-{j}]");
        let checked = Range::Finite.check(field.clone(), coefficient);
        if self.accepts(&field, i.max(j), checked) && self.distinct(&field, i, j) {
            couple(&mut self.damping, i, j, coefficient);
        }
        self
    }

    /// Damper from oscillator `i` to ground.
    #[must_use]
    pub fn ground_damper(mut self, i: usize, coefficient: f64) -> Self {
        let field = format!("ground_damping[{i}]");
        if self.accepts(&field, i, Range::Finite.check(field.clone(), coefficient)) {
            self.damping[(i, i)] += coefficient;
        }
        self
    }

    /// Self-excitation of oscillator `i`: a damper to ground, negative where it excites.
    #[must_use]
    pub fn self_excited(mut self, i: usize, coefficient: f64) -> Self {
        let field = format!("self_excitation[{i}]");
        if self.accepts(&field, i, Range::Finite.check(field.clone(), coefficient)) {
            self.self_excitation[(i, i)] += coefficient;
        }
        self
    }

    /// Adds a general, possibly non-symmetric stiffness matrix, N x N.
    #[must_use]
    pub fn add_stiffness(mut self, matrix: &DMatrix<f64>) -> Self {
        if self.accepts_matrix("stiffness", matrix) {
            self.stiffness += matrix;
        }
        self
    }

    /// Adds a general, possibly non-symmetric damping matrix, N x N.
    #[must_use]
    pub fn add_damping(mut self, matrix: &DMatrix<f64>) -> Self {
        if self.accepts_matrix("damping", matrix) {
            self.damping += matrix;
        }
        self
    }

    /// Adds a general, possibly non-symmetric self-excitation matrix, N x N.
    #[must_use]
    pub fn add_self_excitation(mut self, matrix: &DMatrix<f64>) -> Self {
        if self.accepts_matrix("self_excitation", matrix) {
            self.self_excitation += matrix;
        }
        self
    }

    #[must_use]
    pub fn jenkins(mut self, element: JenkinsElement) -> Self {
        self.jenkins.push(element);
        self
    }

    /// Checks everything and builds the chain.
    ///
    /// # Errors
    /// The first fault in the order in which the parts were given: no oscillators, numbers outside their range, wrong sizes,
    /// elements attached to oscillators that are not there.
    pub fn build(self) -> Result<OscillatorChain, ParameterError> {
        let count = self.mass.len();
        if count == 0 {
            return Err(ParameterError::NoOscillators);
        }
        for (i, &mass) in self.mass.iter().enumerate() {
            Range::Positive.check(format!("mass[{i}]"), mass)?;
        }
        if let Some(fault) = self.faults.into_iter().next() {
            return Err(fault);
        }
        for (index, element) in self.jenkins.iter().enumerate() {
            element.validate(index, count)?;
        }
        Ok(OscillatorChain {
            mass: DVector::from_vec(self.mass),
            stiffness: self.stiffness,
            damping: self.damping,
            self_excitation: self.self_excitation,
            jenkins: self.jenkins,
        })
    }

    fn accepts(&mut self, field: &str, index: usize, checked: Result<f64, ParameterError>) -> bool {
        let count = self.mass.len();
        if index >= count {
            self.faults.push(ParameterError::NoSuchOscillator { field: field.to_owned(), found: index, count });
            return false;
        }
        checked.map_err(|fault| self.faults.push(fault)).is_ok()
    }

    fn distinct(&mut self, field: &str, i: usize, j: usize) -> bool {
        if i == j {
            self.faults.push(ParameterError::SelfAttached { field: field.to_owned(), found: i });
        }
        i != j
    }

    fn accepts_matrix(&mut self, field: &str, matrix: &DMatrix<f64>) -> bool {
        let n = self.mass.len();
        if matrix.shape() != (n, n) {
            self.faults.push(ParameterError::WrongLength {
                field: field.to_owned(),
                found: matrix.len(),
                expected: n * n,
                per: "pair of oscillators",
            });
            return false;
        }
        for row in 0..n {
            for column in 0..n {
                let checked = Range::Finite.check(format!("{field}[{row}][{column}]"), matrix[(row, column)]);
                if let Err(fault) = checked {
                    self.faults.push(fault);
                    return false;
                }
            }
        }
        true
    }
}

fn couple(matrix: &mut DMatrix<f64>, i: usize, j: usize, value: f64) {
    matrix[(i, i)] += value;
    matrix[(j, j)] += value;
    matrix[(i, j)] -= value;
    matrix[(j, i)] -= value;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Attachment;

    #[test]
    fn faults_name_field_value_and_range() {
        let fault = |builder: ChainBuilder| builder.build().unwrap_err().to_string();
        assert!(fault(ChainBuilder::new(vec![])).contains("oscillators = 0"));
        assert!(fault(ChainBuilder::new(vec![f64::NAN])).contains("mass[0] = NaN"));
        assert!(
            fault(ChainBuilder::new(vec![1.0]).ground_spring(0, -2.0))
                .contains("ground_stiffness[0] = -2 is not allowed")
        );
        assert!(fault(ChainBuilder::new(vec![1.0, 1.0]).coupling_spring(0, 2, 1.0)).contains("oscillator 2"));
        assert!(fault(ChainBuilder::new(vec![1.0, 1.0]).coupling_spring(1, 1, 1.0)).contains("to itself"));
        let infinite = DMatrix::from_element(1, 1, f64::INFINITY);
        assert!(fault(ChainBuilder::new(vec![1.0]).add_damping(&infinite)).contains("damping[0][0] = inf"));
        let element = JenkinsElement { attachment: Attachment::Ground(0), stiffness: 1.0, slip_force: 0.0 };
        assert!(fault(ChainBuilder::new(vec![1.0]).jenkins(element)).contains("jenkins[0].slip_force = 0"));
    }
}
