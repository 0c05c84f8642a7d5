//! Complexification-averaging: describing function and slow flow, equations (4)-(16) of the paper.
//!
//! The fast oscillation `x_j ~ a_j cos(phi + theta_j)`, `phi' = w`, is averaged out; what remains is the slow change of amplitudes and
//! phases. Assumed: one harmonic carries the motion, amplitudes and phases change little within a cycle, and the frequency is
//! that of the limit cycle with the same averaged mechanical energy.
//!
//! | file | equations |
//! |---|---|
//! | `describing` | (13)-(14) |
//! | `limit_cycles` | fixed points of (10)-(12) with free frequency |
//! | `energy`, `energy_frequency`, `panels`, `pchip` | (15)-(16) |
//! | `slow_flow` | (10)-(12) |
//! | `fixed_points` | stability, secondary Hopf points, fold |
//! | `integration` | the slow flow in time |
//! | `perturbation` | (25)-(30) |
//! | `motion`, `restored_flow` | the fast oscillation restored, (4)-(5) |
//! | `chain_flow`, `chain_integration` | the slow flow of N oscillators and any number of elements |
//! | `torus`, `torus_branch`, `doublings` | its limit cycles and their period doublings (Table 1) |

mod chain_flow;
mod chain_integration;
mod describing;
mod doublings;
mod energy;
mod energy_frequency;
mod error;
mod fixed_points;
mod integration;
mod limit_cycles;
mod motion;
mod panels;
mod pchip;
mod perturbation;
mod restored_flow;
mod slow_flow;
mod torus;
mod torus_branch;

pub use chain_flow::{Carrier, ChainSlowArrival, ChainSlowFlow, ChainSlowState};
pub use describing::DescribingFunction;
pub use doublings::{DoublingCascade, PeriodDoubling, doubling_cascade, period_doublings};
pub use energy::EnergyDefinition;
pub use energy_frequency::{EnergyFrequency, Interpolation, LARGEST_ENERGY, NodeSpacing};
pub use error::AveragingError;
pub use fixed_points::{SlowFixedPoint, SlowFold, SlowHopf, fixed_point, folds, hopf_points};
pub use limit_cycles::SlowLimitCycle;
pub use motion::{SlowMotion, SlowState};
pub use perturbation::PerturbedLimitCycle;
pub use restored_flow::RestoredSlowFlow;
pub use slow_flow::{SlowFlow, SlowRate};
pub use torus::SlowTorus;
