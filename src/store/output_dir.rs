//! A directory that belongs to one command with one set of parameters.
//!
//! `manifest.json` says what made the directory, `outputs.jsonl` which files are in it. The directory is locked while open, so
//! that two runs cannot mix their files; the lock dies with the process.

use super::atomic::{create_directory, create_temporary, read_whole, remove_leftovers, write_atomically};
use super::error::StoreError;
use super::journal::{self, Journal, Record, check_name};
use super::origin::Origin;
use super::{hex, sha256_hex};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::NamedTempFile;

const MANIFEST: &str = "manifest.json";
const JOURNAL: &str = "outputs.jsonl";
const REMEDY: &str = "Choose another directory, or replace the old output with --force";

/// What to do with output that is already there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// Go on with output of the same parameters; refuse any other.
    Resume,
    /// Remove the old output this program made, and overwrite files in the way (`--force`).
    Replace,
}

#[derive(Debug, Serialize, Deserialize)]
struct Manifest {
    #[serde(flatten)]
    origin: Origin,
    sha256: String,
}

/// An output directory, open and locked for this run.
#[derive(Debug)]
pub struct OutputDir {
    root: PathBuf,
    sha256: String,
    existing: Existing,
    journal: Mutex<Journal>,
    /// `None` where the file system has none.
    _lock: Option<Lock>,
}

impl OutputDir {
    /// Opens `root`, creating it if missing, and removes what a killed run left unfinished.
    ///
    /// Output of the same origin is resumed. With [`Existing::Replace`] the files the old run recorded are removed first; files it
    /// did not make are never removed.
    ///
    /// # Errors
    /// [`StoreError::OtherParameters`] if other parameters made the output and it may not be replaced; [`StoreError::InUse`]
    /// if another run has it open; [`StoreError::Damaged`] for an unreadable manifest or journal; and when the directory cannot be
    /// created, read or written.
    pub fn open(root: &Path, origin: &Origin, existing: Existing) -> Result<Self, StoreError> {
        Self::open_for(root, origin, existing, &[])
    }

    /// The same for files whose names are known beforehand: if one of them is in the way, nothing is written at all.
    ///
    /// # Errors
    /// Those of [`OutputDir::open`] and [`OutputDir::refuse_foreign`].
    pub fn open_for(root: &Path, origin: &Origin, existing: Existing, names: &[String]) -> Result<Self, StoreError> {
        create_directory(root)?;
        let lock = lock_directory(root)?;
        let journal_path = root.join(JOURNAL);
        match existing {
            Existing::Replace => remove_recorded(root, &journal_path)?,
            Existing::Resume => {
                refuse_other_parameters(root, origin)?;
                let known = recorded(&journal_path)?;
                refuse_foreign(root, names, |name| known.contains(name))?;
            }
        }
        let manifest = Manifest { origin: origin.clone(), sha256: origin.sha256() };
        write_atomically(&root.join(MANIFEST), |writer| {
            serde_json::to_writer_pretty(&mut *writer, &manifest)?;
            writeln!(writer)
        })?;
        let journal = Journal::open(journal_path)?;
        remove_all_leftovers(root, &journal)?;
        Ok(Self { root: root.to_owned(), sha256: origin.sha256(), existing, journal: Mutex::new(journal), _lock: lock })
    }

    #[must_use]
    pub fn path(&self) -> &Path {
        &self.root
    }

    /// SHA-256 of the origin, see [`Origin::sha256`].
    #[must_use]
    pub fn parameters_sha256(&self) -> &str {
        &self.sha256
    }

    /// Refuses files that [`OutputDir::write`] would refuse, to be asked before they are made.
    ///
    /// # Errors
    /// [`StoreError::Foreign`] if a file this program did not make has one of the names, or that of the directory it belongs in, and may
    /// not be replaced.
    pub fn refuse_foreign(&self, names: &[impl AsRef<str>]) -> Result<(), StoreError> {
        match self.existing {
            Existing::Replace => Ok(()),
            Existing::Resume => {
                let journal = self.journal();
                refuse_foreign(&self.root, names, |name| journal.knows(name))
            }
        }
    }

    /// Writes the file `name` (relative, with `/`) atomically and records it under `key`: what decided its content besides the
    /// parameters of the directory, or nothing.
    ///
    /// # Errors
    /// [`StoreError::Foreign`] if a file this program did not make is in the way and may not be replaced;
    /// [`StoreError::OutsideDirectory`] for a bad name; [`StoreError::Write`] and [`StoreError::CreateDirectory`] as in
    /// [`write_atomically`].
    pub fn write(
        &self,
        name: &str,
        key: &str,
        content: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>,
    ) -> Result<Record, StoreError> {
        check_name(name)?;
        self.refuse_foreign(&[name])?;
        let path = self.root.join(name);
        self.journal().begin(name)?;
        let mut sum = (Sha256::new(), 0);
        write_atomically(&path, |file| {
            let mut summing = Summing { file, sum: &mut sum };
            content(&mut summing)
        })?;
        let (digest, bytes) = sum;
        let record = Record { path: name.to_owned(), key: key.to_owned(), sha256: hex(&digest.finalize()), bytes };
        self.journal().finish(&record)?;
        Ok(record)
    }

    /// A temporary file in the directory for a program that writes by itself. It is removed when dropped, or when the directory is
    /// opened after a crash.
    ///
    /// # Errors
    /// [`StoreError::Write`] as in [`write_atomically`].
    pub fn temporary(&self) -> Result<NamedTempFile, StoreError> {
        create_temporary(&self.root).map_err(|source| StoreError::write(&self.root, source))
    }

    /// The record of a finished file, if it was made under the same `key` and its bytes are still the recorded ones.
    /// Whatever is missing, changed, damaged or unreadable is `None`: it has to be made again.
    #[must_use]
    pub fn trusted(&self, name: &str, key: &str) -> Option<Record> {
        let record = self.journal().record(name).filter(|record| record.key == key).cloned()?;
        let bytes = fs::read(self.root.join(name)).ok()?;
        (sha256_hex(&bytes) == record.sha256).then_some(record)
    }

    /// All finished files, in order of name.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        self.journal().finished().map(|record| self.root.join(&record.path)).collect()
    }

    /// The journal stays consistent if a thread panics while holding it: lines are appended whole.
    fn journal(&self) -> MutexGuard<'_, Journal> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Passes bytes on and sums them up.
struct Summing<'a> {
    file: &'a mut (dyn Write + Send),
    sum: &'a mut (Sha256, u64),
}

impl Write for Summing<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.sum.0.update(&bytes[..written]);
        self.sum.1 += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// The directory itself, locked, which leaves no lock file behind.
#[derive(Debug)]
struct Lock(File);

impl Drop for Lock {
    /// Closing alone does not end it: a process that another thread is just starting has a copy of the handle until it becomes another
    /// program.
    fn drop(&mut self) {
        if let Err(error) = self.0.unlock() {
            tracing::debug!("a directory stays locked until its handle is closed: {error}");
        }
    }
}

fn lock_directory(root: &Path) -> Result<Option<Lock>, StoreError> {
    // Directories cannot be opened everywhere, nor locked: then the user has to keep runs apart.
    let Ok(directory) = File::open(root) else { return Ok(None) };
    match directory.try_lock() {
        Ok(()) => Ok(Some(Lock(directory))),
        Err(fs::TryLockError::WouldBlock) => Err(StoreError::InUse { path: root.to_owned() }),
        Err(fs::TryLockError::Error(error)) => {
            tracing::debug!("no lock on {}: {error}", root.display());
            Ok(None)
        }
    }
}

fn read_manifest(path: &Path) -> Result<Option<Manifest>, StoreError> {
    if !path.exists() {
        return Ok(None);
    }
    let damaged = |reason: String| StoreError::Damaged { path: path.to_owned(), reason, remedy: REMEDY };
    let manifest: Manifest = serde_json::from_slice(&read_whole(path)?)
        .map_err(|error| damaged(format!("no manifest of ours ({error})")))?;
    if manifest.sha256 != manifest.origin.sha256() {
        return Err(damaged("its parameters do not match their sum".to_owned()));
    }
    Ok(Some(manifest))
}

fn refuse_other_parameters(root: &Path, origin: &Origin) -> Result<(), StoreError> {
    match read_manifest(&root.join(MANIFEST))? {
        Some(old) if old.origin.sha256() != origin.sha256() => {
            let differences = origin.differences(&old.origin);
            Err(StoreError::OtherParameters { path: root.to_owned(), differences })
        }
        _ => Ok(()),
    }
}

fn refuse_foreign(root: &Path, names: &[impl AsRef<str>], is_known: impl Fn(&str) -> bool) -> Result<(), StoreError> {
    for name in names.iter().map(AsRef::as_ref).filter(|name| !is_known(name)) {
        let path = root.join(name);
        let folder = path.parent().filter(|folder| folder.is_file()).map(Path::to_owned);
        if let Some(path) = folder.or_else(|| path.exists().then_some(path)) {
            return Err(StoreError::Foreign { path });
        }
    }
    Ok(())
}

/// Names of the files in the journal, if there is one.
fn recorded(journal_path: &Path) -> Result<BTreeSet<String>, StoreError> {
    if journal_path.exists() { journal::names(journal_path) } else { Ok(BTreeSet::new()) }
}

/// Removes the files an old journal lists, then the journal.
fn remove_recorded(root: &Path, journal_path: &Path) -> Result<(), StoreError> {
    let names = recorded(journal_path)?;
    for path in names.iter().map(|name| root.join(name)).chain([journal_path.to_owned()]) {
        match fs::remove_file(&path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                return Err(StoreError::Remove { path, source });
            }
            _ => {}
        }
    }
    Ok(())
}

/// Removes temporaries from every directory files were recorded in.
fn remove_all_leftovers(root: &Path, journal: &Journal) -> Result<(), StoreError> {
    let mut directories = BTreeSet::from([root.to_owned()]);
    directories.extend(journal.names().filter_map(|name| root.join(name).parent().map(Path::to_owned)));
    directories.iter().try_for_each(|directory| remove_leftovers(directory).map(|_| ()))
}
