//! Tables of numbers and words with units, as CSV or Parquet.
//!
//! Both formats give back exactly what was written: numbers to the last bit, types, units and metadata. Both carry a SHA-256 of
//! the content, so that a truncated or changed file is an error and never a shorter or different table.

mod csv;
mod parquet;

use super::atomic::{read_whole, remove_leftovers, write_atomically};
use super::error::StoreError;
use super::hex;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

/// Names of metadata the formats use themselves.
const RESERVED: [&str; 3] = ["types", "end", "sha256"];

/// Columns of equal length and what is to be known about them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Keys and values in order; keys are unique and without `:` and line breaks.
    pub metadata: Vec<(String, String)>,
    pub columns: Vec<Column>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Unique, without `[`, `]` and line breaks.
    pub name: String,
    /// Unit as in a column heading, `1` for a plain number, empty for none (text).
    pub unit: String,
    pub values: ColumnData,
}

#[derive(Debug, Clone, PartialEq)]
pub enum ColumnData {
    /// Finite numbers.
    F64(Vec<f64>),
    /// Finite numbers, missing where the row has none.
    OptionalF64(Vec<Option<f64>>),
    Text(Vec<String>),
}

/// How a table is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableFormat {
    Csv,
    Parquet,
}

impl TableFormat {
    /// The format a file name asks for by its extension, `csv` or `parquet` in any case.
    ///
    /// # Errors
    /// [`StoreError::UnknownFormat`] for any other.
    pub fn from_path(path: &Path) -> Result<Self, StoreError> {
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        match extension.as_deref() {
            Some("csv") => Ok(Self::Csv),
            Some("parquet") => Ok(Self::Parquet),
            _ => Err(StoreError::UnknownFormat { path: path.to_owned() }),
        }
    }
}

impl ColumnData {
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::F64(values) => values.len(),
            Self::OptionalF64(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Name of the type in the files.
    fn type_name(&self) -> &'static str {
        match self {
            Self::F64(_) => "number",
            Self::OptionalF64(_) => "optional",
            Self::Text(_) => "text",
        }
    }

    fn empty(type_name: &str) -> Option<Self> {
        match type_name {
            "number" => Some(Self::F64(Vec::new())),
            "optional" => Some(Self::OptionalF64(Vec::new())),
            "text" => Some(Self::Text(Vec::new())),
            _ => None,
        }
    }

    /// First row that is not a finite number.
    fn first_not_finite(&self) -> Option<usize> {
        match self {
            Self::F64(values) => values.iter().position(|value| !value.is_finite()),
            Self::OptionalF64(values) => values.iter().position(|value| value.is_some_and(|v| !v.is_finite())),
            Self::Text(_) => None,
        }
    }
}

impl Table {
    /// Number of rows: the length of the first column.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// Column of that name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// Value of a metadata key.
    #[must_use]
    pub fn metadata(&self, key: &str) -> Option<&str> {
        self.metadata.iter().find(|(k, _)| k == key).map(|(_, value)| value.as_str())
    }

    /// Writes the table in one format. Give the writer of [`write_atomically`] or of an output directory.
    ///
    /// # Errors
    /// `InvalidInput` if the table cannot be stored (see [`Table::check`]), and whatever the writer returns.
    pub fn write_to(&self, format: TableFormat, writer: &mut (dyn Write + Send)) -> io::Result<()> {
        self.check().map_err(|reason| io::Error::new(io::ErrorKind::InvalidInput, reason))?;
        match format {
            TableFormat::Csv => csv::write(self, writer),
            TableFormat::Parquet => parquet::write(self, writer),
        }
    }

    /// Whether the table can be stored and read back the same.
    ///
    /// # Errors
    /// A sentence that says what is wrong: no columns, columns of different lengths, numbers that are not finite, names that are
    /// repeated, empty, reserved or contain forbidden characters.
    pub fn check(&self) -> Result<(), String> {
        if self.columns.is_empty() {
            return Err("it has no columns".to_owned());
        }
        let mut names = BTreeSet::new();
        for Column { name, unit, values } in &self.columns {
            let forbidden = ['[', ']', '\n', '\r'];
            if name.trim() != name || name.is_empty() || name.contains(forbidden) || !names.insert(name) {
                return Err(format!(
                    "column name {name:?} is empty, repeated or contains brackets, line breaks or outer spaces"
                ));
            }
            if unit.contains(forbidden) {
                return Err(format!("unit {unit:?} of column {name} contains brackets or line breaks"));
            }
            if values.len() != self.rows() {
                return Err(format!("column {name} has {} values, the first column {}", values.len(), self.rows()));
            }
            if let Some(row) = values.first_not_finite() {
                return Err(format!(
                    "column {name}, row {row} is not a finite number: store a missing value as an optional one"
                ));
            }
        }
        let mut keys = BTreeSet::new();
        for (key, _) in &self.metadata {
            let forbidden = key.is_empty() || key.trim() != key || key.contains([':', '\n', '\r']);
            if forbidden || RESERVED.contains(&key.as_str()) || key.starts_with("unit of ") || !keys.insert(key) {
                return Err(format!(
                    "metadata key {key:?} is empty, repeated, reserved or contains `:`, line breaks or outer spaces"
                ));
            }
        }
        Ok(())
    }

    /// Lower-case hexadecimal SHA-256 of everything the table says, however it is spelled in a file.
    fn sha256(&self) -> String {
        let mut sum = Sha256::new();
        // Lengths go first, so that no two tables give the same bytes.
        let text = |sum: &mut Sha256, text: &str| {
            sum.update((text.len() as u64).to_le_bytes());
            sum.update(text);
        };
        sum.update((self.metadata.len() as u64).to_le_bytes());
        for (key, value) in &self.metadata {
            text(&mut sum, key);
            text(&mut sum, value);
        }
        for Column { name, unit, values } in &self.columns {
            text(&mut sum, name);
            text(&mut sum, unit);
            text(&mut sum, values.type_name());
            sum.update((values.len() as u64).to_le_bytes());
            match values {
                ColumnData::F64(values) => values.iter().for_each(|value| sum.update(value.to_le_bytes())),
                ColumnData::OptionalF64(values) => values.iter().for_each(|value| {
                    sum.update([u8::from(value.is_some())]);
                    sum.update(value.unwrap_or(0.0).to_le_bytes());
                }),
                ColumnData::Text(values) => values.iter().for_each(|value| text(&mut sum, value)),
            }
        }
        hex(&sum.finalize())
    }
}

/// Writes a table atomically, as CSV or Parquet by the extension of `path`.
///
/// # Errors
/// [`StoreError::UnknownFormat`], [`StoreError::BadTable`] (see [`Table::check`]), [`StoreError::Write`].
pub fn write_table(path: &Path, table: &Table) -> Result<(), StoreError> {
    let format = TableFormat::from_path(path)?;
    table.check().map_err(|reason| StoreError::BadTable { path: path.to_owned(), reason })?;
    if let Some(directory) = path.parent().filter(|parent| !parent.as_os_str().is_empty()) {
        remove_leftovers(directory)?;
    }
    write_atomically(path, |writer| table.write_to(format, writer))
}

/// Reads a table this program wrote, as CSV or Parquet by the extension of `path`.
///
/// # Errors
/// [`StoreError::UnknownFormat`], [`StoreError::Read`], and [`StoreError::Damaged`] if the file is truncated, changed or not one
/// of ours.
pub fn read_table(path: &Path) -> Result<Table, StoreError> {
    let format = TableFormat::from_path(path)?;
    let bytes = read_whole(path)?;
    let read = match format {
        TableFormat::Csv => csv::read(&bytes),
        TableFormat::Parquet => {
            parquet::read(bytes, File::open(path).map_err(|source| StoreError::read(path, source))?)
        }
    };
    read.map_err(|reason| StoreError::Damaged {
        path: path.to_owned(),
        reason,
        remedy: "Make it again; tables from elsewhere cannot be read",
    })
}
