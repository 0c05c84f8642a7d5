//! Friction contacts of a bladed disk: which Jenkins elements sit where.

use super::bladed_disk::{BladedDisk, Topology};
use crate::model::{Attachment, JenkinsElement, ParameterError, Range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a blade rubs against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ContactPlace {
    /// The foot of the blade: ground, or its own disk segment where there are segments. The stiffness is taken out of the blade's own, so
    /// that a blade with stuck contact has stiffness 1.
    Foot,
    /// The next blade (underplatform damper, shroud): elongation `x_j - x_(j+1)`. The stiffness adds to the coupling.
    NextBlade,
}

/// Equal Jenkins elements at one place of all or chosen sectors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionContacts {
    pub place: ContactPlace,
    /// Stiffness while sticking; at the foot the share gamma of the blade's stiffness 1.
    pub stiffness: f64,
    /// Elongation at which a fresh contact slips: the slip force is the stiffness times it.
    #[serde(default = "FrictionContacts::unit_elongation")]
    pub slip_elongation: f64,
    /// Sectors that have one, numbered from 0; all without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sectors: Option<Vec<usize>>,
}

impl FrictionContacts {
    fn unit_elongation() -> f64 {
        1.0
    }

    /// On all sectors, slipping at elongation 1.
    #[must_use]
    pub fn everywhere(place: ContactPlace, stiffness: f64) -> Self {
        Self { place, stiffness, slip_elongation: Self::unit_elongation(), sectors: None }
    }

    /// The elements, in order of sector. In an open chain the last blade has no next one.
    pub(super) fn elements(&self, disk: &BladedDisk) -> Result<Vec<JenkinsElement>, ParameterError> {
        let stiffness = Range::Positive.check("friction.stiffness", self.stiffness)?;
        let slip_elongation = Range::Positive.check("friction.slip_elongation", self.slip_elongation)?;
        let count = disk.sectors;
        let all: Vec<usize>;
        let sectors = match &self.sectors {
            Some(chosen) => chosen,
            None => {
                let last_is_open = self.place == ContactPlace::NextBlade && disk.topology == Topology::Chain;
                all = (0..count - usize::from(last_is_open)).collect();
                &all
            }
        };
        let attachment = |&j: &usize| {
            let missing =
                |found| ParameterError::NoSuchOscillator { field: "friction.sectors".to_owned(), found, count };
            if j >= count {
                return Err(missing(j));
            }
            match self.place {
                ContactPlace::Foot if disk.segments.is_some() => Ok(Attachment::Between(j, count + j)),
                ContactPlace::Foot => Ok(Attachment::Ground(j)),
                ContactPlace::NextBlade => {
                    let next = disk.topology.neighbour(j, 1, count).ok_or_else(|| missing(j + 1))?;
                    Ok(Attachment::Between(j, next))
                }
            }
        };
        let element = |attachment| JenkinsElement { attachment, stiffness, slip_force: stiffness * slip_elongation };
        sectors.iter().map(|j| attachment(j).map(element)).collect()
    }
}
