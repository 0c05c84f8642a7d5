//! A film of the rig or of a disk: what the making of films needs to know of either.

use super::{DiskStage, Stage};
use crate::render::DrawList;

/// One scene, ready to be filmed.
#[derive(Debug, Clone)]
pub enum Take {
    Rig(Box<Stage>),
    Disk(Box<DiskStage>),
}

impl Take {
    #[must_use]
    pub fn frame_count(&self) -> u64 {
        match self {
            Self::Rig(stage) => stage.frame_count(),
            Self::Disk(stage) => stage.frame_count(),
        }
    }

    /// Time at which the motion ends.
    #[must_use]
    pub fn end(&self) -> f64 {
        match self {
            Self::Rig(stage) => stage.end(),
            Self::Disk(stage) => stage.end(),
        }
    }

    #[must_use]
    pub fn frame(&self, index: u64) -> DrawList {
        match self {
            Self::Rig(stage) => stage.frame(index),
            Self::Disk(stage) => stage.frame(index),
        }
    }

    /// The frame that would show the motion at exactly `time`.
    #[must_use]
    pub fn frame_at(&self, time: f64) -> DrawList {
        match self {
            Self::Rig(stage) => stage.frame_at(time),
            Self::Disk(stage) => stage.frame_at(time),
        }
    }

    /// Time, positions, velocities and slider forces that a frame shows.
    #[must_use]
    pub fn numbers(&self, index: u64) -> Vec<f64> {
        match self {
            Self::Rig(stage) => {
                let now = stage.instant(index);
                let [[x1, x2], [v1, v2]] = [now.positions, now.velocities];
                vec![now.time, x1, x2, v1, v2, now.slider_force]
            }
            Self::Disk(stage) => {
                let now = stage.instant(index);
                let numbers = [now.positions, now.velocities, now.slider_forces];
                std::iter::once(now.time).chain(numbers.into_iter().flatten()).collect()
            }
        }
    }
}
