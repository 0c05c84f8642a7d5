//! Atomic files, output directories and tables.

mod atomic;
mod output_dir;
#[cfg(feature = "tables")]
mod tables;
