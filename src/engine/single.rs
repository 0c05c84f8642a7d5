//! The world in f32: `world.rs` compiled against `rapier3d`.

use rapier3d as rapier;

const PRECISION: &str = "f32";

#[path = "world.rs"]
pub(super) mod world;

#[path = "mechanism/world.rs"]
pub(super) mod mechanism_world;
