//! Scene files: TOML, checked field by field, with a JSON Schema.

mod case;
mod description;
mod direction;
mod disk;
mod error;
mod load;
mod ramp;
mod story;

pub use case::Case;
pub use description::{
    Backdrop, Check, DEFAULT_PERTURBATION, Engine, Film, Initial, Joints, MotionKind, Precision, Scene, Scheme,
    Simulation, Theme,
};
pub use direction::{CameraMove, Caption, Direction, Easing, Key, Panel, SlowMotion, View};
pub use disk::{DiskCase, DiskStart, WaveStart};
pub use error::{Fault, Place, SceneError};
pub use load::{BUILT_IN, BUILT_IN_DISKS};
pub use ramp::{Excitation, Ramp};
pub use story::Story;

impl Scene {
    /// JSON Schema of scene files.
    #[must_use]
    pub fn json_schema() -> serde_json::Value {
        schemars::schema_for!(Self).to_value()
    }
}
