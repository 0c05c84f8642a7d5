//! What the physics engine gets wrong, measured against references that share no code with it.

pub mod linear_mechanisms;
pub mod oscillation;
