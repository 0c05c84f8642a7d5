//! A table as CSV (RFC 4180) with comment lines:
//!
//! ```text
//! # key: value            metadata, `\`, line feed and carriage return written as \\, \n, \r
//! # types: number,text    one of number, optional, text per column
//! t [1/omega0],contact
//! 0.1,stick
//! # sha256: ...           of the content, see Table::sha256
//! # end: 1 rows
//! ```

use super::{Column, ColumnData, Table};
use ::csv::{Error, ErrorKind, ReaderBuilder, StringRecord, WriterBuilder};
use std::io::{self, Write};

pub(super) fn write(table: &Table, writer: &mut dyn Write) -> io::Result<()> {
    for (key, value) in &table.metadata {
        writeln!(writer, "# {key}: {}", escape(value))?;
    }
    let types: Vec<_> = table.columns.iter().map(|column| column.values.type_name()).collect();
    writeln!(writer, "# types: {}", types.join(","))?;
    write_rows(table, writer).map_err(io_error)?;
    writeln!(writer, "# sha256: {}", table.sha256())?;
    writeln!(writer, "# end: {} rows", table.rows())
}

fn write_rows(table: &Table, writer: &mut dyn Write) -> Result<(), Error> {
    // With a comment character the writer quotes texts that begin with it.
    let mut rows = WriterBuilder::new().comment(Some(b'#')).from_writer(writer);
    rows.write_record(table.columns.iter().map(heading))?;
    for row in 0..table.rows() {
        rows.write_record(table.columns.iter().map(|column| field(&column.values, row)))?;
    }
    Ok(rows.flush()?)
}

/// A full disk has to stay recognisable as one.
fn io_error(error: Error) -> io::Error {
    let message = error.to_string();
    match error.into_kind() {
        ErrorKind::Io(error) => error,
        _ => io::Error::other(message),
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<Table, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "it is not UTF-8 text".to_owned())?;
    let (content, rows, sum) = split_end(text)?;
    let (metadata, types, body) = split_head(content)?;
    let mut reader = ReaderBuilder::new().from_reader(body.as_bytes());
    let headings = reader.headers().map_err(|error| error.to_string())?.clone();
    if headings.len() != types.len() {
        return Err(format!("it has {} columns but types for {}", headings.len(), types.len()));
    }
    let mut columns = headings.iter().zip(&types).map(|(h, t)| column(h, t)).collect::<Result<Vec<_>, _>>()?;
    for (number, record) in reader.records().enumerate() {
        let record = record.map_err(|error| error.to_string())?;
        push(&mut columns, &record).map_err(|reason| format!("row {number}: {reason}"))?;
    }
    let table = Table { metadata, columns };
    if table.rows() != rows {
        return Err(format!("it has {} of {rows} rows", table.rows()));
    }
    if table.sha256() == sum { Ok(table) } else { Err("its content does not match its checksum".to_owned()) }
}

/// Splits off the last two lines; without them the file is not whole.
fn split_end(text: &str) -> Result<(&str, usize, &str), String> {
    let truncated = || "it is truncated: the last line `# end: N rows` is missing".to_owned();
    let whole = text.strip_suffix('\n').ok_or_else(truncated)?;
    let whole = whole.strip_suffix('\r').unwrap_or(whole);
    let (rest, end) = whole.rsplit_once('\n').ok_or_else(truncated)?;
    let rows = end.strip_prefix("# end: ").and_then(|end| end.strip_suffix(" rows")).ok_or_else(truncated)?;
    let rows = rows.parse().map_err(|_| truncated())?;
    let start = rest.rfind('\n').map_or(0, |at| at + 1);
    let sum = rest[start..].trim_end_matches('\r').strip_prefix("# sha256: ").ok_or_else(truncated)?;
    Ok((&rest[..start], rows, sum))
}

type Head<'a> = (Vec<(String, String)>, Vec<&'a str>, &'a str);

/// Splits off the comment lines at the top.
fn split_head(mut text: &str) -> Result<Head<'_>, String> {
    let mut metadata = Vec::new();
    loop {
        let (line, rest) = text.split_once('\n').ok_or("it has no line of types")?;
        let line = line.strip_suffix('\r').unwrap_or(line);
        let entry =
            line.strip_prefix("# ").and_then(|line| line.split_once(": ").or(line.strip_suffix(':').map(|k| (k, ""))));
        let (key, value) = entry.ok_or_else(|| format!("line {line:?} is not `# key: value`"))?;
        text = rest;
        if key == "types" {
            return Ok((metadata, value.split(',').collect(), text));
        }
        metadata.push((key.to_owned(), unescape(value)));
    }
}

fn heading(column: &Column) -> String {
    if column.unit.is_empty() { column.name.clone() } else { format!("{} [{}]", column.name, column.unit) }
}

fn column(heading: &str, type_name: &str) -> Result<Column, String> {
    let with_unit = heading.strip_suffix(']').and_then(|heading| heading.rsplit_once(" ["));
    let (name, unit) = with_unit.unwrap_or((heading, ""));
    let values =
        ColumnData::empty(type_name).ok_or_else(|| format!("column {name} has the unknown type {type_name:?}"))?;
    Ok(Column { name: name.to_owned(), unit: unit.to_owned(), values })
}

/// Shortest decimal that reads back as the same number.
fn number(value: f64) -> String {
    format!("{value:?}")
}

fn field(values: &ColumnData, row: usize) -> String {
    match values {
        ColumnData::F64(values) => number(values[row]),
        ColumnData::OptionalF64(values) => values[row].map_or_else(String::new, number),
        ColumnData::Text(values) => values[row].clone(),
    }
}

fn push(columns: &mut [Column], record: &StringRecord) -> Result<(), String> {
    for (column, field) in columns.iter_mut().zip(record) {
        let parse = || field.parse::<f64>().map_err(|_| format!("{field:?} in column {} is no number", column.name));
        match &mut column.values {
            ColumnData::F64(values) => values.push(parse()?),
            ColumnData::OptionalF64(values) if field.is_empty() => values.push(None),
            ColumnData::OptionalF64(values) => values.push(Some(parse()?)),
            ColumnData::Text(values) => values.push(field.to_owned()),
        }
    }
    Ok(())
}

fn escape(value: &str) -> String {
    value.replace('\\', "\\\\").replace('\n', "\\n").replace('\r', "\\r")
}

fn unescape(value: &str) -> String {
    let mut plain = String::with_capacity(value.len());
    let mut characters = value.chars();
    while let Some(character) = characters.next() {
        plain.push(match character {
            '\\' => match characters.next() {
                Some('n') => '\n',
                Some('r') => '\r',
                other => other.unwrap_or('\\'),
            },
            plain => plain,
        });
    }
    plain
}
