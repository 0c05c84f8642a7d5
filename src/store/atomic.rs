//! Files written under a temporary name and renamed.

use super::error::StoreError;
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;
use tempfile::{Builder, NamedTempFile};

/// How the name of every temporary begins.
const TEMPORARY_PREFIX: &str = ".stickslip-partial-";

/// Writes a file that appears under `path` whole or not at all.
///
/// The content goes to a temporary in the same directory (created if missing), is made durable and then renamed over `path`.
/// On any failure the temporary is removed and an older file at `path` stays as it was.
///
/// # Errors
/// [`StoreError::CreateDirectory`] or [`StoreError::Write`], naming the path, the cause (a full disk, no permission) and what
/// to do; also whatever `content` returns.
pub fn write_atomically(
    path: &Path,
    content: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>,
) -> Result<(), StoreError> {
    let directory = parent(path);
    create_directory(directory)?;
    let written = (|| {
        let temporary = create_temporary(directory)?;
        let mut writer = BufWriter::new(temporary.as_file());
        content(&mut writer)?;
        writer.flush()?;
        drop(writer);
        temporary.as_file().sync_all()?;
        temporary.persist(path).map_err(|failed| failed.error)?;
        Ok(())
    })();
    written.map_err(|source| StoreError::write(path, source))
}

/// The directory a file lies in, `.` for a bare name.
fn parent(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

pub(super) fn create_directory(directory: &Path) -> Result<(), StoreError> {
    fs::create_dir_all(directory).map_err(|source| StoreError::CreateDirectory { path: directory.to_owned(), source })
}

/// A temporary with the permissions of an ordinary new file, locked so that another run does not take it for a leftover.
pub(super) fn create_temporary(directory: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(TEMPORARY_PREFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let temporary = builder.tempfile_in(directory)?;
    // Some network file systems have no locks: then only the guard on output directories protects it.
    if let Err(error) = temporary.as_file().try_lock() {
        tracing::debug!("no lock on {}: {error}", temporary.path().display());
    }
    Ok(temporary)
}

/// Removes the temporaries a killed run left in `directory` and returns their number. Those a live run holds are left alone, and
/// so is everything else. A directory that does not exist has none.
///
/// # Errors
/// [`StoreError::Read`] if the directory cannot be listed, [`StoreError::Remove`] if a leftover cannot be removed.
pub fn remove_leftovers(directory: &Path) -> Result<usize, StoreError> {
    let entries = match fs::read_dir(directory) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(0),
        Err(source) => return Err(StoreError::read(directory, source)),
    };
    let mut removed = 0;
    for entry in entries {
        let entry = entry.map_err(|source| StoreError::read(directory, source))?;
        if !entry.file_name().to_string_lossy().starts_with(TEMPORARY_PREFIX) || !is_abandoned(&entry.path()) {
            continue;
        }
        fs::remove_file(entry.path()).map_err(|source| StoreError::Remove { path: entry.path(), source })?;
        removed += 1;
    }
    if removed > 0 {
        tracing::info!("removed {removed} unfinished files of an earlier run from {}", directory.display());
    }
    Ok(removed)
}

/// Whether no living process holds the lock of a temporary.
fn is_abandoned(temporary: &Path) -> bool {
    File::open(temporary).is_ok_and(|file| !matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock)))
}

/// Largest file that is read whole, in bytes: what is made of it takes about as much memory once more.
const LARGEST: u64 = 512 << 20;
/// The same of what has no length, such as a pipe or a device, which may be endless.
const LARGEST_STREAM: u64 = 64 << 20;

/// Reads a whole file.
///
/// # Errors
/// [`StoreError::Read`] naming the path, [`StoreError::TooLarge`] beyond 512 MiB, and beyond 64 MiB of what is no
/// ordinary file.
pub fn read_whole(path: &Path) -> Result<Vec<u8>, StoreError> {
    let read = |limit: Option<u64>| -> io::Result<Vec<u8>> {
        let mut file = File::open(path)?;
        let mut bytes = Vec::new();
        match limit {
            Some(limit) => file.take(limit + 1).read_to_end(&mut bytes)?,
            None => file.read_to_end(&mut bytes)?,
        };
        Ok(bytes)
    };
    let found = fs::metadata(path).map_err(|source| StoreError::read(path, source))?;
    let too_large = |limit: u64| StoreError::TooLarge { path: path.to_owned(), mebibytes: limit >> 20 };
    if found.is_file() {
        return match found.len() {
            length if length > LARGEST => Err(too_large(LARGEST)),
            _ => read(None).map_err(|source| StoreError::read(path, source)),
        };
    }
    let bytes = read(Some(LARGEST_STREAM)).map_err(|source| StoreError::read(path, source))?;
    if bytes.len() as u64 > LARGEST_STREAM { Err(too_large(LARGEST_STREAM)) } else { Ok(bytes) }
}
