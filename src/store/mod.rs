//! Files that are whole or absent, and output directories that know what was put in them.
//!
//! Assumptions: renaming within one directory is atomic, and `sync_all` makes a file's content durable (both hold on the
//! usual local file systems). A file therefore appears under its name with all its bytes or not at all; a killed run leaves at most
//! temporaries named `.stickslip-partial-*`, which the next run removes. What a directory holds is decided by a manifest
//! (the parameters) and a journal (one line per file, with its SHA-256): a file is trusted only if its bytes still have the
//! recorded sum.

mod atomic;
mod error;
mod journal;
mod origin;
mod output_dir;
#[cfg(feature = "tables")]
mod table;

pub use atomic::{read_whole, remove_leftovers, write_atomically};
pub use error::StoreError;
pub use journal::Record;
pub use origin::Origin;
pub use output_dir::{Existing, OutputDir};
#[cfg(feature = "tables")]
pub use table::{Column, ColumnData, Table, TableFormat, read_table, write_table};

use sha2::{Digest, Sha256};

/// Lower-case hexadecimal SHA-256 of some bytes.
#[must_use]
pub fn sha256_hex(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// Lower-case hexadecimal digits of a finished sum.
fn hex(digest: &[u8]) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}
