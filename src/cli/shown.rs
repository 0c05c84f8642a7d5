//! The motion that a film shows, and what stands beside it.

use super::motions;
use super::progress::Progress;
use crate::dynamics::Trajectory;
use crate::engine::{BodyPose, BodyRole, EngineInfo, Recording, RigGeometry};
use crate::scene::Case;
use crate::stage::{Beside, Body, DiskMotion, DiskStage, Motion, Solution, Stage, Take};
use anyhow::Context;

/// The motion to film, what computed it, and the exact one beside it.
pub struct Shown {
    motion: ShownMotion,
    solution: Solution,
}

enum ShownMotion {
    Rig { motion: Motion, reference: Option<Motion> },
    Disk { motion: DiskMotion, reference: Option<DiskMotion> },
}

const NOT_THE_RIG: &str = "the motion is not one of two masses and one slider";
const NOT_THE_DISK: &str = "the motion is not one of the scene's disk";

impl ShownMotion {
    fn of(case: &Case, trajectory: &Trajectory) -> anyhow::Result<Self> {
        if let Some(disk) = &case.disk {
            let motion = DiskMotion::new(&disk.disk, trajectory)?.context(NOT_THE_DISK)?;
            return Ok(Self::Disk { motion, reference: None });
        }
        Ok(Self::Rig { motion: Motion::new(trajectory).context(NOT_THE_RIG)?, reference: None })
    }

    /// With the rig's own bodies.
    fn of_engine(case: &Case, recording: &Recording) -> anyhow::Result<Self> {
        if case.disk.is_some() {
            return Self::of(case, &recording.trajectory);
        }
        let bodies: Option<Vec<_>> = recording.poses.iter().map(|poses| carriages(poses)).collect();
        let motion = Motion::new(&recording.trajectory).zip(bodies).and_then(|(motion, b)| motion.with_bodies(&b));
        Ok(Self::Rig { motion: motion.context(NOT_THE_RIG)?, reference: None })
    }

    fn beside(self, exact: Self) -> Self {
        match (self, exact) {
            (Self::Rig { motion, .. }, Self::Rig { motion: exact, .. }) => Self::Rig { motion, reference: Some(exact) },
            (Self::Disk { motion, .. }, Self::Disk { motion: exact, .. }) => {
                Self::Disk { motion, reference: Some(exact) }
            }
            (shown, _) => shown,
        }
    }
}

impl Shown {
    /// A motion without bodies.
    pub fn of(case: &Case, trajectory: &Trajectory, solution: Solution) -> anyhow::Result<Self> {
        Ok(Self { motion: ShownMotion::of(case, trajectory)?, solution })
    }

    /// The engine's motion, that of the rig with its own bodies.
    pub fn of_engine(case: &Case, recording: &Recording) -> anyhow::Result<Self> {
        let solution = Solution::Engine(EngineInfo::of(motions::precision(case)).to_string());
        Ok(Self { motion: ShownMotion::of_engine(case, recording)?, solution })
    }

    pub fn beside(self, case: &Case, exact: &Trajectory) -> anyhow::Result<Self> {
        Ok(Self { motion: self.motion.beside(ShownMotion::of(case, exact)?), ..self })
    }

    /// Ready to be drawn `supersample` times as large as its film.
    pub fn stage(self, case: &Case, supersample: u32, progress: &Progress) -> anyhow::Result<Take> {
        let mut case = case.clone();
        case.film.width *= supersample;
        case.film.height *= supersample;
        let solution = self.solution;
        match self.motion {
            ShownMotion::Rig { motion, reference } => {
                let map = super::damping_map::of(&case, progress)?;
                let beside = Beside { exact: reference, map, solution: Some(solution) };
                Ok(Take::Rig(Box::new(Stage::new(case, motion, beside))))
            }
            ShownMotion::Disk { motion, reference } => {
                let stage = DiskStage::new(case, motion, reference).context("the scene has no disk")?;
                Ok(Take::Disk(Box::new(stage.computed_by(solution))))
            }
        }
    }
}

/// The two carriages of the engine's world, seen from their rest poses.
fn carriages(poses: &[BodyPose]) -> Option<[Body; 2]> {
    let geometry = RigGeometry::default();
    let carriage = |index: usize| {
        let pose = poses.iter().find(|pose| pose.role == BodyRole::Carriage(index))?;
        let rest = geometry.rest_position(index);
        Some(Body {
            displacement: std::array::from_fn(|axis| pose.translation[axis] - rest[axis]),
            rotation: pose.rotation,
            half_extents: pose.half_extents,
        })
    };
    Some([carriage(0)?, carriage(1)?])
}
