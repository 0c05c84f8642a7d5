//! Aerodynamic influence coefficients and the real matrices they become; the derivation heads the module `disk`.

use super::bladed_disk::Topology;
use super::wave::NodalDiameter;
use crate::model::{ParameterError, Range};
use nalgebra::{Complex, DMatrix};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// `L_k`: how the motion of blade j + k acts on blade j. Real part a stiffness, imaginary part a damping times the reference frequency.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InfluenceCoefficient {
    /// k: 0 the blade itself, 1 the next one, -1 the one before.
    pub offset: i64,
    #[serde(default)]
    pub real: f64,
    #[serde(default)]
    pub imaginary: f64,
}

/// How the aerodynamic forces are given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "given", rename_all = "snake_case", deny_unknown_fields)]
pub enum Aerodynamics {
    /// Complex influence coefficients.
    Coefficients {
        coefficients: Vec<InfluenceCoefficient>,
        /// Angular frequency at which damping and stiffness are meant.
        #[serde(default = "unity")]
        reference_frequency: f64,
    },
    /// Damping and stiffness by nodal diameter, n = 0, 1, ..., N - 1; n beyond N/2 is the backward wave n - N. Rings only.
    Waves {
        damping: Vec<f64>,
        #[serde(default)]
        stiffness: Option<Vec<f64>>,
        #[serde(default = "unity")]
        reference_frequency: f64,
    },
}

fn unity() -> f64 {
    1.0
}

/// The coefficients `L_k` by offset.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct InfluenceCoefficients {
    by_offset: BTreeMap<i64, Complex<f64>>,
    reference_frequency: f64,
}

impl Aerodynamics {
    /// # Errors
    /// [`ParameterError`] for numbers that are not finite, a reference frequency that is not positive, lists by nodal diameter whose length
    /// is not the number of sectors, and coefficients with an offset of N or more.
    pub fn coefficients(&self, sectors: usize) -> Result<InfluenceCoefficients, ParameterError> {
        match self {
            Self::Coefficients { coefficients, reference_frequency } => {
                let mut by_offset = BTreeMap::new();
                for c in coefficients {
                    let field = |part| format!("aerodynamics.coefficients[offset {}].{part}", c.offset);
                    Range::Finite.check(field("real"), c.real)?;
                    Range::Finite.check(field("imaginary"), c.imaginary)?;
                    if c.offset.unsigned_abs() >= sectors as u64 {
                        let found = c.offset.unsigned_abs() as usize;
                        return Err(ParameterError::NoSuchOscillator { field: field("offset"), found, count: sectors });
                    }
                    *by_offset.entry(c.offset).or_default() += Complex::new(c.real, c.imaginary);
                }
                let reference_frequency = frequency(*reference_frequency)?;
                Ok(InfluenceCoefficients { by_offset, reference_frequency })
            }
            Self::Waves { damping, stiffness, reference_frequency } => {
                let w = frequency(*reference_frequency)?;
                let zero = vec![0.0; sectors];
                let stiffness = stiffness.as_ref().unwrap_or(&zero);
                for (field, values) in [("damping", damping), ("stiffness", stiffness)] {
                    if values.len() != sectors {
                        return Err(ParameterError::WrongLength {
                            field: format!("aerodynamics.{field}"),
                            found: values.len(),
                            expected: sectors,
                            per: "nodal diameter 0 to N - 1",
                        });
                    }
                    for (n, &value) in values.iter().enumerate() {
                        Range::Finite.check(format!("aerodynamics.{field}[{n}]"), value)?;
                    }
                }
                Ok(InfluenceCoefficients::from_waves(damping, stiffness, w))
            }
        }
    }
}

fn frequency(value: f64) -> Result<f64, ParameterError> {
    Range::Positive.check("aerodynamics.reference_frequency", value)
}

impl InfluenceCoefficients {
    /// `L_k = 1/N sum_n (stiffness_n + i w damping_n) exp(i k sigma_n)`; both lists by n = 0, ..., N - 1 and of equal length.
    fn from_waves(damping: &[f64], stiffness: &[f64], reference_frequency: f64) -> Self {
        let sectors = damping.len();
        let coefficient = |k: i64| {
            let term = |n: usize| {
                let given = Complex::new(stiffness[n], reference_frequency * damping[n]);
                given * Complex::from_polar(1.0, NodalDiameter::new(n as i64, sectors).multiple(k))
            };
            (0..sectors).map(term).sum::<Complex<f64>>() / sectors as f64
        };
        let offsets = NodalDiameter::all(sectors).map(NodalDiameter::signed);
        Self { by_offset: offsets.map(|k| (k, coefficient(k))).collect(), reference_frequency }
    }

    /// `L(sigma) = sum_k L_k exp(-i k sigma)` for a wave.
    #[must_use]
    pub fn at(&self, wave: NodalDiameter) -> Complex<f64> {
        self.by_offset.iter().map(|(&k, l)| l * Complex::from_polar(1.0, -wave.multiple(k))).sum()
    }

    /// Damping of a wave, `Im L(sigma)/w_ref`, positive where it takes energy out.
    #[must_use]
    pub fn damping(&self, wave: NodalDiameter) -> f64 {
        self.at(wave).im / self.reference_frequency
    }

    /// Stiffness and damping matrices of the blades, N x N. In an open chain blades beyond the ends do not exist.
    #[must_use]
    pub fn matrices(&self, sectors: usize, topology: Topology) -> [DMatrix<f64>; 2] {
        let mut matrices = [DMatrix::zeros(sectors, sectors), DMatrix::zeros(sectors, sectors)];
        for (&offset, l) in &self.by_offset {
            for j in 0..sectors {
                let Some(other) = topology.neighbour(j, offset, sectors) else { continue };
                matrices[0][(j, other)] += l.re;
                matrices[1][(j, other)] += l.im / self.reference_frequency;
            }
        }
        matrices
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_from_waves_give_the_waves_back() {
        for sectors in [5, 6] {
            let damping: Vec<f64> = (0..sectors).map(|n| 0.01 - 0.02 * (1.3 * n as f64).sin()).collect();
            let stiffness: Vec<f64> = (0..sectors).map(|n| 0.003 * (2.1 * n as f64).cos()).collect();
            let l = InfluenceCoefficients::from_waves(&damping, &stiffness, 0.9);
            for n in 0..sectors {
                let found = l.at(NodalDiameter::new(n as i64, sectors));
                // Rounding of two sums of six terms below 0.03.
                assert!((found - Complex::new(stiffness[n], 0.9 * damping[n])).norm() < 1e-16);
            }
        }
    }

    #[test]
    fn an_odd_damping_makes_the_stiffness_antisymmetric_and_an_even_one_the_damping_symmetric() {
        let sectors = 6;
        let of = |damping: &dyn Fn(f64) -> f64| {
            let damping: Vec<f64> =
                (0..sectors).map(|n| damping(NodalDiameter::new(n as i64, sectors).phase_angle())).collect();
            InfluenceCoefficients::from_waves(&damping, &vec![0.0; sectors], 1.0).matrices(sectors, Topology::Ring)
        };
        let [stiffness, damping] = of(&f64::sin);
        assert!((&stiffness + stiffness.transpose()).amax() < 1e-16 && stiffness.amax() > 0.4);
        assert!(damping.amax() < 1e-16);
        // damping(sigma) = -sum K_k sin(k sigma): K_1 = -1/2, K_-1 = +1/2.
        assert!((stiffness[(0, 1)] + 0.5).abs() < 1e-15 && (stiffness[(1, 0)] - 0.5).abs() < 1e-15);
        let [stiffness, damping] = of(&f64::cos);
        assert!(stiffness.amax() < 1e-16 && (&damping - damping.transpose()).amax() < 1e-16);
    }
}
