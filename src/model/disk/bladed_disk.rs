//! The description of a bladed disk, and the chain of oscillators it is.
//!
//! Without disk segments, blade j has, its contact stuck, stiffness `1 + delta_j` to ground and `kappa` to either neighbour, so that the
//! sticking frequencies of a tuned ring are `sqrt(1 + 4 kappa sin^2(pi n/N))`. With disk segments the blade stands on its segment
//! (mass, stiffness to ground), and `kappa` joins the segments.
//!
//! Oscillator j is blade j; oscillator N + j is the disk segment of sector j.

use super::friction::{ContactPlace, FrictionContacts};
use super::influence::{Aerodynamics, InfluenceCoefficients};
use super::mistuning::Mistuning;
use crate::model::{ChainBuilder, OscillatorChain, ParameterError, Range};
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest number of sectors: the matrices of a chain are dense.
const MOST_SECTORS: usize = 4096;

/// How the sectors hang together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Topology {
    /// The last sector is coupled to the first; at least 3 sectors.
    #[default]
    Ring,
    /// Open at both ends.
    Chain,
}

impl Topology {
    /// The sector `offset` further on, `None` beyond the ends of a chain.
    #[must_use]
    pub fn neighbour(self, sector: usize, offset: i64, sectors: usize) -> Option<usize> {
        let found = sector as i64 + offset;
        match self {
            Self::Ring => usize::try_from(found.rem_euclid(sectors as i64)).ok(),
            Self::Chain => usize::try_from(found).ok().filter(|&found| found < sectors),
        }
    }
}

/// The part of the disk under a blade, as one oscillator per sector.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DiskSegments {
    /// Mass of a segment; a blade has 1.
    pub mass: f64,
    /// Stiffness of a segment to ground; a blade has 1 to its segment.
    pub stiffness: f64,
}

/// A bladed disk, non-dimensional.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BladedDisk {
    /// Number N of sectors: at least 3 in a ring, 1 in a chain.
    pub sectors: usize,
    #[serde(default)]
    pub topology: Topology,
    /// Coupling stiffness kappa between neighbours.
    #[serde(default)]
    pub coupling: f64,
    /// Passive damping of each blade against its foot.
    #[serde(default)]
    pub damping: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segments: Option<DiskSegments>,
    #[serde(default)]
    pub friction: Vec<FrictionContacts>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub aerodynamics: Option<Aerodynamics>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mistuning: Option<Mistuning>,
}

impl BladedDisk {
    /// A ring with coupling and nothing else.
    #[must_use]
    pub fn ring(sectors: usize, coupling: f64) -> Self {
        Self {
            sectors,
            topology: Topology::Ring,
            coupling,
            damping: 0.0,
            segments: None,
            friction: Vec::new(),
            aerodynamics: None,
            mistuning: None,
        }
    }

    /// The same without mistuning.
    #[must_use]
    pub fn tuned(&self) -> Self {
        Self { mistuning: None, ..self.clone() }
    }

    /// Oscillators per sector: 1, or 2 with disk segments.
    #[must_use]
    pub fn oscillators_per_sector(&self) -> usize {
        1 + usize::from(self.segments.is_some())
    }

    /// Whether every sector is like every other, so that waves are modes.
    ///
    /// # Errors
    /// As [`Mistuning::deviations`].
    pub fn is_cyclic(&self) -> Result<bool, ParameterError> {
        let everywhere = |contacts: &FrictionContacts| match &contacts.sectors {
            None => true,
            Some(chosen) => (0..self.sectors).all(|j| chosen.iter().filter(|c| **c == j).count() == 1),
        };
        let deviations = self.deviations()?;
        Ok(self.topology == Topology::Ring
            && self.friction.iter().all(everywhere)
            && deviations.iter().all(|d| *d == deviations[0]))
    }

    /// Relative stiffness deviation of each blade; zeros where the disk is tuned.
    ///
    /// # Errors
    /// As [`Mistuning::deviations`].
    pub fn deviations(&self) -> Result<Vec<f64>, ParameterError> {
        match &self.mistuning {
            Some(mistuning) => mistuning.deviations(self.sectors),
            None => Ok(vec![0.0; self.sectors]),
        }
    }

    /// # Errors
    /// As [`Aerodynamics::coefficients`].
    pub fn influence_coefficients(&self) -> Result<InfluenceCoefficients, ParameterError> {
        if self.topology == Topology::Chain && matches!(self.aerodynamics, Some(Aerodynamics::Waves { .. })) {
            return Err(ParameterError::OutOfRange {
                field: "sectors of an open chain whose aerodynamics are given by waves".to_owned(),
                found: self.sectors as f64,
                allowed: "those of a ring: give influence coefficients instead",
            });
        }
        self.aerodynamics
            .as_ref()
            .map_or_else(|| Ok(InfluenceCoefficients::default()), |a| a.coefficients(self.sectors))
    }

    /// The chain of oscillators.
    ///
    /// # Errors
    /// [`ParameterError`] for the first field outside its range: among them a ring of fewer than 3 sectors, friction that takes more than
    /// the stiffness of a blade, and elements on sectors that are not there.
    pub fn chain(&self) -> Result<OscillatorChain, ParameterError> {
        self.check_sectors()?;
        let n = self.sectors;
        let mut mass = vec![1.0; n];
        if let Some(segments) = self.segments {
            mass.extend(vec![Range::Positive.check("segments.mass", segments.mass)?; n]);
        }
        let total = mass.len();
        let own = self.foot_stiffness()?;
        let damping = Range::NonNegative.check("damping", self.damping)?;
        let mut builder = ChainBuilder::new(mass);
        for (j, &own) in own.iter().enumerate() {
            builder = match self.segments {
                None => builder.ground_spring(j, own).ground_damper(j, damping),
                Some(segments) => builder
                    .coupling_spring(j, n + j, own)
                    .coupling_damper(j, n + j, damping)
                    .ground_spring(n + j, segments.stiffness),
            };
            if let Some(next) = self.topology.neighbour(j, 1, n) {
                builder = builder.coupling_spring(total - n + j, total - n + next, self.coupling);
            }
        }
        let blades = self.influence_coefficients()?.matrices(n, self.topology);
        let [stiffness, aerodynamic_damping] = blades.map(|matrix| matrix.resize(total, total, 0.0));
        builder = builder.add_stiffness(&stiffness).add_self_excitation(&aerodynamic_damping);
        for contacts in &self.friction {
            builder = contacts.elements(self)?.into_iter().fold(builder, ChainBuilder::jenkins);
        }
        builder.build()
    }

    fn check_sectors(&self) -> Result<(), ParameterError> {
        let (least, allowed) = match self.topology {
            Topology::Ring => (3, "from 3 to 4096 in a ring; for fewer take topology = \"chain\""),
            Topology::Chain => (1, "from 1 to 4096 in a chain"),
        };
        if (least..=MOST_SECTORS).contains(&self.sectors) {
            return Ok(());
        }
        Err(ParameterError::OutOfRange { field: "sectors".to_owned(), found: self.sectors as f64, allowed })
    }

    /// Linear stiffness of each blade against its foot: `1 + delta_j` less the contacts there.
    fn foot_stiffness(&self) -> Result<Vec<f64>, ParameterError> {
        let mut own: Vec<f64> = self.deviations()?.iter().map(|delta| 1.0 + delta).collect();
        for contacts in self.friction.iter().filter(|contacts| contacts.place == ContactPlace::Foot) {
            for (j, own) in own.iter_mut().enumerate() {
                let times = contacts.sectors.as_ref().map_or(1, |chosen| chosen.iter().filter(|c| **c == j).count());
                *own -= times as f64 * contacts.stiffness;
            }
        }
        let range = "not negative: mistuning and foot contacts must not take more than the stiffness 1 of a blade";
        match own.iter().position(|own| own.is_nan() || *own < 0.0) {
            Some(j) => Err(ParameterError::OutOfRange {
                field: format!("stiffness of blade {j} without its contacts"),
                found: own[j],
                allowed: range,
            }),
            None => Ok(own),
        }
    }

    /// `B(sigma) = sum_j B_(0,j) exp(-i j sigma)` in blocks of one sector, for a matrix of a cyclic chain and an interblade phase angle.
    #[must_use]
    pub fn wave_block(&self, matrix: &DMatrix<f64>, wave: super::NodalDiameter) -> DMatrix<nalgebra::Complex<f64>> {
        let (n, size) = (self.sectors, self.oscillators_per_sector());
        DMatrix::from_fn(size, size, |a, b| {
            (0..n).map(|j| nalgebra::Complex::from_polar(matrix[(a * n, b * n + j)], -wave.multiple(j as i64))).sum()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::influence::InfluenceCoefficient;
    use super::*;
    use crate::model::{RigParameters, TwoMassRig};

    /// The two-mass rig as an open chain of two blades.
    fn two(p: RigParameters) -> BladedDisk {
        let l = |offset, damping| InfluenceCoefficient { offset, real: 0.0, imaginary: damping };
        let [d1, d2] = [0.5 * (p.xi1 + p.xi2), 0.5 * (p.xi1 - p.xi2)];
        BladedDisk {
            topology: Topology::Chain,
            friction: vec![FrictionContacts {
                sectors: Some(vec![0]),
                ..FrictionContacts::everywhere(ContactPlace::Foot, p.gamma)
            }],
            aerodynamics: Some(Aerodynamics::Coefficients {
                coefficients: vec![l(0, d1), l(1, d2), l(-1, d2)],
                reference_frequency: 1.0,
            }),
            ..BladedDisk::ring(2, p.kappa)
        }
    }

    #[test]
    fn two_blades_in_a_chain_are_the_two_mass_rig() {
        let p = RigParameters::default();
        let (found, expected) = (two(p).chain().unwrap(), TwoMassRig::new(p).unwrap());
        assert_eq!(found.stiffness(), expected.chain().stiffness());
        assert_eq!(found.jenkins(), expected.chain().jenkins());
        // One rounding: the rig adds a damper to a self-excitation.
        assert!((found.total_damping() - expected.chain().total_damping()).amax() < 1e-17);
    }

    #[test]
    fn rings_of_two_negative_blades_and_missing_sectors_are_refused() {
        assert!(BladedDisk::ring(2, 0.1).chain().is_err());
        let heavy = |stiffness, sectors| BladedDisk {
            friction: vec![FrictionContacts { sectors, ..FrictionContacts::everywhere(ContactPlace::Foot, stiffness) }],
            ..BladedDisk::ring(4, 0.1)
        };
        assert!(heavy(0.5, None).chain().is_ok());
        assert!(heavy(1.1, None).chain().unwrap_err().to_string().contains("blade 0"));
        assert!(heavy(f64::NAN, None).chain().is_err());
        assert!(heavy(0.5, Some(vec![4])).chain().unwrap_err().to_string().contains("oscillator 4"));
        let waves = Aerodynamics::Waves { damping: vec![0.0; 4], stiffness: None, reference_frequency: 1.0 };
        let open = BladedDisk { topology: Topology::Chain, aerodynamics: Some(waves), ..BladedDisk::ring(4, 0.1) };
        assert!(open.chain().unwrap_err().to_string().contains("give influence coefficients"));
        assert!(heavy(0.6, Some(vec![1, 1])).chain().unwrap_err().to_string().contains("blade 1"));
    }

    #[test]
    fn a_shroud_contact_joins_neighbours_and_the_ends_of_a_chain_are_open() {
        let shroud = |topology| {
            let friction = vec![FrictionContacts::everywhere(ContactPlace::NextBlade, 0.2)];
            BladedDisk { topology, friction, ..BladedDisk::ring(4, 0.1) }.chain().unwrap().sliders()
        };
        assert_eq!([shroud(Topology::Ring), shroud(Topology::Chain)], [4, 3]);
    }
}
