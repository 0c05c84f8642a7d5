//! Integration tests: one binary, a file per concern.

mod asymmetric;
mod averaging;
mod averaging_flow;
mod averaging_perturbation;
mod averaging_tori;
#[cfg(feature = "render")]
mod back_ends;
mod branches;
#[cfg(feature = "cli")]
mod browser;
mod chain;
#[cfg(feature = "cli")]
mod cli;
#[cfg(feature = "engine")]
mod compare;
#[cfg(feature = "cli")]
mod conformance;
#[cfg(feature = "cli")]
mod conformance_controls;
#[cfg(feature = "cli")]
mod conformance_exchange;
#[cfg(feature = "engine")]
mod convergence;
#[cfg(feature = "render")]
mod demonstration;
mod derivatives;
mod diagram;
#[cfg(feature = "cli")]
mod disk_cli;
mod disk_cycles;
#[cfg(feature = "engine")]
mod disk_engine;
mod disk_exact;
#[cfg(feature = "cli")]
mod disk_faults;
#[cfg(feature = "render")]
mod disk_film;
mod disk_flutter;
mod disk_linear;
#[cfg(feature = "cli")]
mod disk_run;
mod disk_slow_flow;
mod disk_waves;
mod doubling;
#[cfg(feature = "cli")]
mod engine_map;
#[cfg(feature = "engine")]
mod engine_rig;
mod events;
mod exact_energy;
#[cfg(feature = "render")]
mod film;
#[cfg(all(feature = "cli", target_os = "linux"))]
mod fuzz;
mod general_solver;
#[cfg(feature = "render")]
mod golden;
#[cfg(feature = "render")]
mod golden_disk;
mod harmonic_balance;
mod hopf;
#[cfg(feature = "engine")]
mod hysteresis;
mod independent;
mod layering;
#[cfg(feature = "cli")]
mod licences;
mod lyapunov;
#[cfg(feature = "cli")]
mod mechanisms;
#[cfg(feature = "cli")]
mod modified_hopf;
#[cfg(feature = "cli")]
mod motor_rounding;
#[cfg(feature = "engine")]
mod numerical_damping;
mod orbits;
#[cfg(feature = "render")]
mod overlays;
#[cfg(feature = "cli")]
mod paper;
#[cfg(feature = "render")]
mod pictures;
mod poincare;
mod prescribed;
mod reference_trajectory;
mod scenes;
#[cfg(feature = "render")]
mod shaders;
#[cfg(feature = "cli")]
mod shared_model;
mod slip_limit;
mod small_disk;
#[cfg(feature = "render")]
mod small_scene;
mod special_curves;
#[cfg(feature = "render")]
mod stage;
mod store;
#[cfg(all(feature = "cli", target_os = "linux"))]
mod streams;
mod symmetry;
mod tangent;
#[cfg(feature = "render")]
mod transparent;
