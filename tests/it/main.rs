//! Integration tests: one binary, a file per concern.

mod derivatives;
mod exact_energy;
mod reference_trajectory;
mod symmetry;
