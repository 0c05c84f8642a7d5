//! Integration tests: one binary, a file per concern.

#[cfg(feature = "render")]
mod film;
mod small_disk;
mod store;
