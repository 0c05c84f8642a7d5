//! From a rig in SI units to the non-dimensional one and back (model of equations (1)-(3)).
//!
//! Mass `m` on each carriage, ground spring `k1` and Jenkins element (`kt`, slip force `R`) on mass 1, ground spring
//! `k1 + kt` on mass 2, coupling spring `kc`, dampers `cg` to ground (negative: self-excitation) and `cc` between the masses:
//!
//! ```text
//! w0 = sqrt((k1 + kt)/m),  t = w0 T,  x = X kt/R,
//! gamma = kt/(k1 + kt),  kappa = kc/(k1 + kt),  xi1 = cg/(m w0),  xi2 = (cg + 2 cc)/(m w0).
//! ```

use super::quantity::{ParameterError, Range};
use super::rig::RigParameters;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A two-mass rig in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DimensionalRig {
    /// Mass of each carriage, kg.
    pub mass: f64,
    /// Ground spring of mass 1, N/m.
    pub ground_stiffness: f64,
    /// Stiffness of the Jenkins element, N/m.
    pub jenkins_stiffness: f64,
    /// Slip force of the Jenkins element (friction coefficient times normal force), N.
    pub slip_force: f64,
    /// Coupling spring, N/m.
    pub coupling_stiffness: f64,
    /// Damper from each mass to ground, N s/m; negative: self-excitation.
    pub ground_damping: f64,
    /// Damper between the masses, N s/m.
    pub coupling_damping: f64,
}

/// What one non-dimensional unit is in SI.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scales {
    /// s
    pub time: f64,
    /// m
    pub length: f64,
    /// m/s
    pub velocity: f64,
    /// N: unit of the non-dimensional force in equations (1)-(2)
    pub force: f64,
    /// J
    pub energy: f64,
    /// N: slip force, the unit of the normalised slider force f
    pub slip_force: f64,
}

impl Scales {
    /// Non-dimensional quantities left as they are.
    pub const UNITY: Self = Self { time: 1.0, length: 1.0, velocity: 1.0, force: 1.0, energy: 1.0, slip_force: 1.0 };
}

impl DimensionalRig {
    /// # Errors
    /// [`ParameterError::OutOfRange`] for NaN, infinities, negative stiffness, non-positive mass, Jenkins stiffness or slip force.
    pub fn validated(self) -> Result<Self, ParameterError> {
        Range::Positive.check("mass", self.mass)?;
        Range::NonNegative.check("ground_stiffness", self.ground_stiffness)?;
        Range::Positive.check("jenkins_stiffness", self.jenkins_stiffness)?;
        Range::Positive.check("slip_force", self.slip_force)?;
        Range::NonNegative.check("coupling_stiffness", self.coupling_stiffness)?;
        Range::Finite.check("ground_damping", self.ground_damping)?;
        Range::Finite.check("coupling_damping", self.coupling_damping)?;
        Ok(self)
    }

    fn total_stiffness(&self) -> f64 {
        self.ground_stiffness + self.jenkins_stiffness
    }

    fn reference_angular_frequency(&self) -> f64 {
        (self.total_stiffness() / self.mass).sqrt()
    }

    /// The non-dimensional parameters.
    ///
    /// # Errors
    /// As [`Self::validated`].
    pub fn parameters(&self) -> Result<RigParameters, ParameterError> {
        self.validated()?;
        let damping_unit = self.mass * self.reference_angular_frequency();
        RigParameters {
            xi1: self.ground_damping / damping_unit,
            xi2: (self.ground_damping + 2.0 * self.coupling_damping) / damping_unit,
            kappa: self.coupling_stiffness / self.total_stiffness(),
            gamma: self.jenkins_stiffness / self.total_stiffness(),
        }
        .validated()
    }

    /// The units in which this rig is non-dimensional.
    ///
    /// # Errors
    /// As [`Self::validated`].
    pub fn scales(&self) -> Result<Scales, ParameterError> {
        self.validated()?;
        let time = 1.0 / self.reference_angular_frequency();
        let length = self.slip_force / self.jenkins_stiffness;
        let force = length * self.total_stiffness();
        Ok(Scales { time, length, velocity: length / time, force, energy: force * length, slip_force: self.slip_force })
    }

    /// The SI rig with given non-dimensional parameters, mass (kg), reference angular frequency `w0` (rad/s) and slip force (N).
    ///
    /// # Errors
    /// [`ParameterError::OutOfRange`] naming the field.
    pub fn from_parameters(
        parameters: RigParameters,
        mass: f64,
        reference_angular_frequency: f64,
        slip_force: f64,
    ) -> Result<Self, ParameterError> {
        let RigParameters { xi1, xi2, kappa, gamma } = parameters.validated()?;
        Range::Positive.check("mass", mass)?;
        Range::Positive.check("reference_angular_frequency", reference_angular_frequency)?;
        let stiffness = mass * reference_angular_frequency.powi(2);
        let damping = mass * reference_angular_frequency;
        Self {
            mass,
            ground_stiffness: (1.0 - gamma) * stiffness,
            jenkins_stiffness: gamma * stiffness,
            slip_force,
            coupling_stiffness: kappa * stiffness,
            ground_damping: xi1 * damping,
            coupling_damping: 0.5 * (xi2 - xi1) * damping,
        }
        .validated()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rig() -> DimensionalRig {
        DimensionalRig {
            mass: 2.0,
            ground_stiffness: 300.0,
            jenkins_stiffness: 500.0,
            slip_force: 10.0,
            coupling_stiffness: 80.0,
            ground_damping: -2.4,
            coupling_damping: 1.42,
        }
    }

    #[test]
    fn scaling_to_si_and_back_is_the_identity() {
        let p = rig().parameters().unwrap();
        let back = DimensionalRig::from_parameters(p, 2.0, 20.0, 10.0).unwrap();
        for (a, b) in [
            (back.ground_stiffness, 300.0),
            (back.jenkins_stiffness, 500.0),
            (back.coupling_stiffness, 80.0),
            (back.ground_damping, -2.4),
            (back.coupling_damping, 1.42),
        ] {
            // A handful of roundings.
            assert!((a / b - 1.0).abs() < 1e-14, "{a} {b}");
        }
    }

    #[test]
    fn the_equation_of_motion_holds_in_both_units() {
        // Acceleration of mass 1 from Newton's law in SI, and from (1) scaled by length/time^2.
        let (rig, s) = (rig(), rig().scales().unwrap());
        let (x, v, f) = ([0.013, -0.004], [0.3, -0.7], 0.4);
        let si = (-rig.ground_stiffness * x[0]
            - rig.coupling_stiffness * (x[0] - x[1])
            - rig.ground_damping * v[0]
            - rig.coupling_damping * (v[0] - v[1])
            - rig.slip_force * f)
            / rig.mass;
        let chain = crate::model::TwoMassRig::new(rig.parameters().unwrap()).unwrap();
        let a = chain.chain().acceleration(&x.map(|x| x / s.length), &v.map(|v| v / s.velocity), &[f])[0];
        let scaled = a * s.length / s.time.powi(2);
        // Terms of order 10 cancel in part; 1e-13 of them is rounding.
        assert!((scaled - si).abs() < 1e-12, "{scaled} {si}");
    }
}
