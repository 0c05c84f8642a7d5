//! The world in f64: `world.rs` compiled against `rapier3d-f64`.

use rapier3d_f64 as rapier;

const PRECISION: &str = "f64";

#[path = "world.rs"]
pub(super) mod world;

#[path = "mechanism/world.rs"]
pub(super) mod mechanism_world;
