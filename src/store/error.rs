use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why something could not be stored or read back.
#[derive(Debug, Error)]
pub enum StoreError {
    #[error("cannot create the directory {path}: {source}. {advice}", path = .path.display(), advice = advice(.source))]
    CreateDirectory { path: PathBuf, source: io::Error },
    #[error("cannot write {path}: {source}. {advice}", path = .path.display(), advice = advice(.source))]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot remove {path}: {source}. {advice}", path = .path.display(), advice = advice(.source))]
    Remove { path: PathBuf, source: io::Error },
    #[error("cannot read {path}: {source}", path = .path.display())]
    Read { path: PathBuf, source: io::Error },
    #[error("{path} is larger than {mebibytes} MiB, more than can be read: give a shorter one", path = .path.display())]
    TooLarge { path: PathBuf, mebibytes: u64 },
    #[error("{path} is damaged: {reason}. {remedy}", path = .path.display())]
    Damaged { path: PathBuf, reason: String, remedy: &'static str },
    #[error(
        "{path} holds output made with other parameters: {differences}. Choose another directory, or replace the old output with --force",
        path = .path.display()
    )]
    OtherParameters { path: PathBuf, differences: String },
    #[error(
        "{path} exists and was not made by this program. Move it away, choose another place, or overwrite it with --force",
        path = .path.display()
    )]
    Foreign { path: PathBuf },
    #[error("{path} is being written by another run. Wait for it to end, or choose another directory", path = .path.display())]
    InUse { path: PathBuf },
    #[error("`{name}` is no place inside an output directory: it must be a relative path without `..`")]
    OutsideDirectory { name: String },
    #[error("{path} has no known table format: the name must end in .csv or .parquet", path = .path.display())]
    UnknownFormat { path: PathBuf },
    #[error("the table for {path} cannot be stored: {reason}", path = .path.display())]
    BadTable { path: PathBuf, reason: String },
}

impl StoreError {
    pub(super) fn write(path: &Path, source: io::Error) -> Self {
        Self::Write { path: path.to_owned(), source }
    }

    pub(super) fn read(path: &Path, source: io::Error) -> Self {
        Self::Read { path: path.to_owned(), source }
    }
}

/// What the reader of the message can do about it.
fn advice(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "Free some space and run again: finished files are kept"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "Choose a place you may write to, or change its permissions"
        }
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => "A file is in the way: choose another place",
        io::ErrorKind::IsADirectory => "A directory has that name: choose another name",
        _ => "Choose another place, or look into the cause and run again",
    }
}
