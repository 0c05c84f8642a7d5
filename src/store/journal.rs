//! One line of JSON per file of an output directory: first that it is begun, then that it is finished.
//!
//! While a run lasts lines are only appended, each by one write. A run that is killed can tear the last line at most;
//! it is cut off on opening, and its file counts as unfinished. When a run ends the journal is put in order: one line
//! per file, by name. What it then says depends neither on the order in which threads came to an end nor on whether
//! earlier runs were killed.

use super::atomic::{read_whole, write_atomically};
use super::error::StoreError;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Component, Path, PathBuf};

/// A finished file of an output directory.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Record {
    /// Path from the output directory, with `/`.
    pub path: String,
    /// What decided the content besides the parameters of the directory; compared, never read.
    pub key: String,
    /// Lower-case hexadecimal SHA-256 of the content.
    pub sha256: String,
    pub bytes: u64,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Line {
    /// Written before the file is, so that a file nobody finished is still known as ours.
    Begun {
        path: String,
    },
    Finished(Record),
}

/// Files by name; `None` for one that is begun only.
type Known = BTreeMap<String, Option<Record>>;

#[derive(Debug)]
pub(super) struct Journal {
    path: PathBuf,
    file: File,
    /// Length up to the last whole line.
    length: u64,
    known: Known,
}

impl Journal {
    /// Opens or creates the journal.
    pub fn open(path: PathBuf) -> Result<Self, StoreError> {
        let (known, length) = if path.exists() { read(&path)? } else { (Known::new(), 0) };
        let open = || {
            let file = OpenOptions::new().create(true).truncate(false).write(true).open(&path)?;
            file.set_len(length)?;
            Ok(file)
        };
        match open() {
            Ok(file) => Ok(Self { file, path, length, known }),
            Err(source) => Err(StoreError::write(&path, source)),
        }
    }

    pub fn record(&self, name: &str) -> Option<&Record> {
        self.known.get(name)?.as_ref()
    }

    pub fn knows(&self, name: &str) -> bool {
        self.known.contains_key(name)
    }

    pub fn finished(&self) -> impl Iterator<Item = &Record> {
        self.known.values().flatten()
    }

    /// Names of all files, begun or finished.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.known.keys().map(String::as_str)
    }

    pub fn begin(&mut self, name: &str) -> Result<(), StoreError> {
        self.append(&Line::Begun { path: name.to_owned() })?;
        self.known.insert(name.to_owned(), None);
        Ok(())
    }

    pub fn finish(&mut self, record: &Record) -> Result<(), StoreError> {
        self.append(&Line::Finished(record.clone()))?;
        self.known.insert(record.path.clone(), Some(record.clone()));
        Ok(())
    }

    /// One line per file, by name.
    fn in_order(&self) -> serde_json::Result<String> {
        let line = |(name, record): (&String, &Option<Record>)| {
            let line = record.clone().map_or_else(|| Line::Begun { path: name.clone() }, Line::Finished);
            serde_json::to_string(&line).map(|line| line + "\n")
        };
        self.known.iter().map(line).collect()
    }

    /// Replaces the lines by those in order, unless another process has appended since: its lines are not known here.
    fn put_in_order(&self) -> Result<(), StoreError> {
        let text = self.in_order().map_err(|error| StoreError::write(&self.path, error.into()))?;
        let found = read_whole(&self.path)?;
        if found.len() as u64 != self.length || found == text.as_bytes() {
            return Ok(());
        }
        write_atomically(&self.path, |writer| writer.write_all(text.as_bytes()))
    }

    fn append(&mut self, line: &Line) -> Result<(), StoreError> {
        let mut append = || -> io::Result<u64> {
            let mut text = serde_json::to_string(line).map_err(io::Error::other)?;
            text.push('\n');
            self.file.seek(SeekFrom::Start(self.length))?;
            self.file.write_all(text.as_bytes())?;
            Ok(text.len() as u64)
        };
        match append() {
            Ok(written) => {
                self.length += written;
                Ok(())
            }
            Err(source) => {
                // Best effort: a torn line that stays is overwritten by the next one, or cut off on the next opening.
                let _ = self.file.set_len(self.length);
                Err(StoreError::write(&self.path, source))
            }
        }
    }
}

impl Drop for Journal {
    /// Best effort: lines in another order say the same.
    fn drop(&mut self) {
        if let Err(error) = self.put_in_order() {
            tracing::debug!("the journal stays as it was written: {error}");
        }
    }
}

/// The files a journal names and the length of its whole lines.
fn read(path: &Path) -> Result<(Known, u64), StoreError> {
    let bytes = read_whole(path)?;
    let length = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1);
    let mut known = Known::new();
    for (number, line) in bytes[..length].split_inclusive(|&byte| byte == b'\n').enumerate() {
        let damaged = |reason: String| StoreError::Damaged {
            path: path.to_owned(),
            reason: format!("line {}: {reason}", number + 1),
            remedy: "Remove the output directory, or choose another one",
        };
        let line: Line = serde_json::from_slice(line).map_err(|error| damaged(error.to_string()))?;
        let (name, record) = match line {
            Line::Begun { path } => (path, None),
            Line::Finished(record) => (record.path.clone(), Some(record)),
        };
        check_name(&name).map_err(|error| damaged(error.to_string()))?;
        known.insert(name, record);
    }
    Ok((known, length as u64))
}

/// Names of all files a journal lists, begun or finished.
pub(super) fn names(path: &Path) -> Result<BTreeSet<String>, StoreError> {
    Ok(read(path)?.0.into_keys().collect())
}

/// Refuses names that could lead out of the directory.
pub(super) fn check_name(name: &str) -> Result<(), StoreError> {
    let mut parts = Path::new(name).components().peekable();
    if parts.peek().is_some() && parts.all(|part| matches!(part, Component::Normal(_))) {
        return Ok(());
    }
    Err(StoreError::OutsideDirectory { name: name.to_owned() })
}
