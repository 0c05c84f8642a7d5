//! Integration tests: one binary, a file per concern.

mod chain;
mod derivatives;
mod events;
mod exact_energy;
mod general_solver;
mod independent;
mod prescribed;
mod reference_trajectory;
mod symmetry;
