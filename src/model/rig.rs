//! The paper's two-mass rig, non-dimensional, equations (1)-(3):
//!
//! ```text
//! x1'' + d1 x1' + d2 x2' + (1 - g) x1 + k (x1 - x2) + g f[x1] = 0
//! x2'' + d1 x2' + d2 x1' +        x2 + k (x2 - x1)             = 0
//! d1 = (xi1 + xi2)/2,  d2 = (xi1 - xi2)/2
//! ```
//!
//! Two unit masses; mass 1 carries the Jenkins element. As elements: self-excitation `xi1` from each mass to ground and a
//! damper `(xi2 - xi1)/2` between them, so that the in-phase mode has damping `xi1` and the out-of-phase mode `xi2`.

use super::chain::OscillatorChain;
use super::chain_builder::ChainBuilder;
use super::jenkins::{Attachment, JenkinsElement};
use super::quantity::{ParameterError, Range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Non-dimensional parameters. `Default` is the paper's nominal set with `xi1 = -0.06`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigParameters {
    /// Damping of the in-phase mode; negative: self-excitation.
    #[serde(default = "RigParameters::nominal_xi1")]
    pub xi1: f64,
    /// Damping of the out-of-phase mode.
    #[serde(default = "RigParameters::nominal_xi2")]
    pub xi2: f64,
    /// Coupling stiffness kappa, not negative.
    #[serde(default = "RigParameters::nominal_kappa")]
    pub kappa: f64,
    /// Friction intensity gamma, greater than 0 and at most 1.
    #[serde(default = "RigParameters::nominal_gamma")]
    pub gamma: f64,
}

impl Default for RigParameters {
    fn default() -> Self {
        Self {
            xi1: Self::nominal_xi1(),
            xi2: Self::nominal_xi2(),
            kappa: Self::nominal_kappa(),
            gamma: Self::nominal_gamma(),
        }
    }
}

impl RigParameters {
    fn nominal_xi1() -> f64 {
        -0.06
    }

    fn nominal_xi2() -> f64 {
        0.011
    }

    fn nominal_kappa() -> f64 {
        0.1
    }

    fn nominal_gamma() -> f64 {
        0.5
    }

    /// Passes the parameters through if each lies in its range.
    ///
    /// # Errors
    /// [`ParameterError::OutOfRange`] for NaN, infinities, damping beyond 100, kappa outside 0 to 10000 and gamma outside (0, 1].
    pub fn validated(self) -> Result<Self, ParameterError> {
        Range::Damping.check("xi1", self.xi1)?;
        Range::Damping.check("xi2", self.xi2)?;
        Range::Coupling.check("kappa", self.kappa)?;
        Range::UnitInterval.check("gamma", self.gamma)?;
        Ok(self)
    }
}

/// The two-mass rig with validated parameters, and as an [`OscillatorChain`].
#[derive(Debug, Clone, PartialEq)]
pub struct TwoMassRig {
    parameters: RigParameters,
    chain: OscillatorChain,
}

impl TwoMassRig {
    /// # Errors
    /// As [`RigParameters::validated`].
    pub fn new(parameters: RigParameters) -> Result<Self, ParameterError> {
        let RigParameters { xi1, xi2, kappa, gamma } = parameters.validated()?;
        let chain = ChainBuilder::new(vec![1.0, 1.0])
            .ground_spring(0, 1.0 - gamma)
            .ground_spring(1, 1.0)
            .coupling_spring(0, 1, kappa)
            .self_excited(0, xi1)
            .self_excited(1, xi1)
            .coupling_damper(0, 1, 0.5 * (xi2 - xi1))
            .jenkins(JenkinsElement { attachment: Attachment::Ground(0), stiffness: gamma, slip_force: gamma })
            .build()?;
        Ok(Self { parameters, chain })
    }

    #[must_use]
    pub fn parameters(&self) -> RigParameters {
        self.parameters
    }

    #[must_use]
    pub fn chain(&self) -> &OscillatorChain {
        &self.chain
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chain_has_the_matrices_of_equations_1_and_2() {
        let p = RigParameters { xi1: -0.06, xi2: 0.011, kappa: 0.1, gamma: 0.5 };
        let rig = TwoMassRig::new(p).unwrap();
        let (d1, d2) = (0.5 * (p.xi1 + p.xi2), 0.5 * (p.xi1 - p.xi2));
        let damping = rig.chain().total_damping();
        // One rounding in each of a sum and a product: 1e-16 is the spacing of numbers near 0.1.
        assert!((damping[(0, 0)] - d1).abs() < 1e-16 && (damping[(0, 1)] - d2).abs() < 1e-16);
        assert_eq!(rig.chain().stiffness()[(0, 0)], 1.0 - p.gamma + p.kappa);
        assert_eq!(rig.chain().stiffness()[(1, 1)], 1.0 + p.kappa);
        assert_eq!(rig.chain().stiffness()[(1, 0)], -p.kappa);
        assert_eq!(rig.chain().jenkins()[0].normalised_stiffness(), 1.0);
    }

    #[test]
    fn gamma_above_one_and_negative_kappa_are_refused() {
        let refused = |p| TwoMassRig::new(p).is_err();
        assert!(refused(RigParameters { gamma: 1.5, ..Default::default() }));
        assert!(refused(RigParameters { gamma: 0.0, ..Default::default() }));
        assert!(refused(RigParameters { kappa: -0.1, ..Default::default() }));
        assert!(refused(RigParameters { xi1: f64::NAN, ..Default::default() }));
    }
}
