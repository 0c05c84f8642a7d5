//! Bladed disks: N equal sectors in a ring (or an open chain), coupled to their neighbours, with dry friction, aerodynamic influence
//! coefficients and mistuning. Non-dimensional: blade mass 1, stiffness of a blade with its friction element stuck 1.
//!
//! # Conventions
//!
//! ```text
//!        blade:    0      1      2            N-1    0
//!                  |      |      |            |      |             blade j moves by x_j, ring: j = 0 again after N-1
//!   wall ~~~~~~~~~~#~~~~~~#~~~~~~#~~ ... ~~~~~#~~~~~~#~~           a forward wave (n > 0) runs to the right,
//!                  --------------> forward                        to higher blade numbers, a backward one to the left
//!
//!   x_j(t) = Re q exp i(w t - j sigma),   w > 0,   sigma = 2 pi n/N  interblade phase angle
//!   x_(j+1)(t) = x_j(t - sigma/w):        for 0 < sigma < pi blade j+1 does later what blade j does now
//! ```
//!
//! The nodal diameter is signed, `-N/2 < n <= N/2`; `n = 0` and `n = N/2` are standing. Much of the literature takes the opposite sign
//! of sigma: compare the direction of travel, not the sign.
//!
#![doc = include_str!("../../../assets/disk_conventions.svg")]
//!
//! # Aerodynamic forces
//!
//! The motion of blade j+k acts on blade j through the complex influence coefficient `L_k`, on the left of the equation of motion:
//! `x_j'' + ... + sum_k L_k x_(j+k) = 0`. In a wave this is `L(sigma) x_j` with
//!
//! ```text
//! L(sigma) = sum_k L_k exp(-i k sigma),   L_k = 1/N sum_n L(sigma_n) exp(+i k sigma_n)
//! ```
//!
//! whose real part is a stiffness and whose imaginary part is `w` times a damping, positive where it takes energy out. With `i x = x'/w`,
//! right for a harmonic motion at the reference frequency `w_ref` and taken for all, the coefficients become real matrices
//!
//! ```text
//! K_(j,j+k) = Re L_k,   D_(j,j+k) = Im L_k / w_ref,   both in general non-symmetric.
//! ```
//!
//! A wave sees `k(sigma) = sum_k K_k exp(-i k sigma)` and `d(sigma)` likewise, and its eigenvalue solves `s^2 + d s + k = 0`. At `s = i w_ref`
//!
//! ```text
//! damping(sigma) = Im L(sigma)/w_ref = sum_k D_k cos(k sigma) - 1/w_ref sum_k K_k sin(k sigma).
//! ```
//!
//! The first sum is even in sigma and comes from the symmetric part of D. The second is odd and comes from `K_k - K_(-k)`, the
//! antisymmetric part of the stiffness: **a damping that differs between forward and backward waves is a circulatory force**. Likewise the antisymmetric
//! part of D splits frequencies, not dampings. The energy ledger counts the work of the antisymmetric stiffness as `circulatory`.
//!
//! With two blades in an open chain, `L_0 = i (xi1 + xi2)/2`, `L_1 = L_-1 = i (xi1 - xi2)/2` and friction on blade 0 alone, this is the two-mass
//! rig of Woiwode, Vakakis & Krack, Nonlinear Dynamics 106 (2021) 1659-1673.

mod bladed_disk;
mod friction;
mod influence;
mod mistuning;
mod mode_shape;
mod spectrum;
mod tuned;
mod wave;

pub use bladed_disk::{BladedDisk, DiskSegments, Topology};
pub use friction::{ContactPlace, FrictionContacts};
pub use influence::{Aerodynamics, InfluenceCoefficient, InfluenceCoefficients};
pub use mistuning::{Harmonic, Mistuning};
pub use mode_shape::ModeShape;
pub use spectrum::Spectrum;
pub use tuned::TunedMode;
pub(crate) use tuned::sector_eigenvalues;
pub use wave::{NodalDiameter, TravelDirection};
