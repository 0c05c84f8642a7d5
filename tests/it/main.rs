//! Integration tests: one binary, a file per concern.

#[cfg(feature = "engine")]
mod scratch;
