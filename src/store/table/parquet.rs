//! A table as one Parquet row group: numbers as DOUBLE, text as UTF-8 BYTE_ARRAY, Snappy pages. Metadata and units
//! (`unit of NAME`) are key-value metadata of the file.
//!
//! So is a SHA-256 of the whole file with zeros in the place of the sum itself. It is checked before anything is decoded: pages have
//! no sums of their own, and the Parquet reader panics on some damaged files.

use super::{Column, ColumnData, RESERVED, Table};
use crate::store::sha256_hex;
use ::parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, Type as Physical};
use ::parquet::column::reader::ColumnReader;
use ::parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use ::parquet::errors::{ParquetError, Result};
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use ::parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use ::parquet::schema::types::{ColumnPath, Type, TypePtr};
use std::fs::File;
use std::io::{self, Write};
use std::ops::Range;
use std::sync::Arc;

const UNIT: &str = "unit of ";
const SUM: &str = RESERVED[2];
/// Stands before the sum in the file, to find it there.
const SUM_MARK: &str = "of the file with zeros here: ";
const NO_SUM: [u8; 64] = [b'0'; 64];

pub(super) fn write(table: &Table, writer: &mut (dyn Write + Send)) -> io::Result<()> {
    let mut file = Vec::new();
    write_parquet(table, &mut file).map_err(io::Error::other)?;
    let place = sum_place(&file).ok_or_else(|| io::Error::other("the checksum has no place in the Parquet file"))?;
    let sum = sha256_hex(&file);
    file[place].copy_from_slice(sum.as_bytes());
    writer.write_all(&file)
}

/// Where the sum stands: after the last mark, as it is the last entry of the metadata at the end of the file.
fn sum_place(file: &[u8]) -> Option<Range<usize>> {
    let mark = file.windows(SUM_MARK.len()).rposition(|window| window == SUM_MARK.as_bytes())?;
    let place = mark + SUM_MARK.len()..mark + SUM_MARK.len() + NO_SUM.len();
    (place.end <= file.len()).then_some(place)
}

fn write_parquet(table: &Table, writer: &mut Vec<u8>) -> Result<()> {
    let fields = table.columns.iter().map(field).collect::<Result<Vec<_>>>()?;
    let schema = Arc::new(Type::group_type_builder("table").with_fields(fields).build()?);
    let mut file = SerializedFileWriter::new(writer, schema, Arc::new(properties(table)))?;
    let mut group = file.next_row_group()?;
    for column in &table.columns {
        let Some(mut writer) = group.next_column()? else { break };
        write_column(&mut writer, &column.values)?;
        writer.close()?;
    }
    group.close()?;
    file.close()?;
    Ok(())
}

fn field(column: &Column) -> Result<TypePtr> {
    let builder = match column.values {
        ColumnData::F64(_) => Type::primitive_type_builder(&column.name, Physical::DOUBLE),
        ColumnData::OptionalF64(_) => Type::primitive_type_builder(&column.name, Physical::DOUBLE),
        ColumnData::Text(_) => Type::primitive_type_builder(&column.name, Physical::BYTE_ARRAY)
            .with_logical_type(Some(LogicalType::String))
            .with_converted_type(ConvertedType::UTF8),
    };
    let repetition = match column.values {
        ColumnData::OptionalF64(_) => Repetition::OPTIONAL,
        _ => Repetition::REQUIRED,
    };
    Ok(Arc::new(builder.with_repetition(repetition).build()?))
}

fn properties(table: &Table) -> WriterProperties {
    let units = table.columns.iter().map(|column| (format!("{UNIT}{}", column.name), column.unit.clone()));
    let sum = (SUM.to_owned(), format!("{SUM_MARK}{}", String::from_utf8_lossy(&NO_SUM)));
    let entries = table.metadata.iter().cloned().chain(units).chain([sum]);
    let mut builder = WriterProperties::builder()
        .set_created_by(format!("stickslip {}", env!("CARGO_PKG_VERSION")))
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(entries.map(|(key, value)| KeyValue::new(key, value)).collect()));
    for column in table.columns.iter().filter(|column| !matches!(column.values, ColumnData::Text(_))) {
        // Samples of a motion hardly repeat: a dictionary only costs.
        builder = builder.set_column_dictionary_enabled(ColumnPath::new(vec![column.name.clone()]), false);
    }
    builder.build()
}

fn write_column(writer: &mut SerializedColumnWriter<'_>, values: &ColumnData) -> Result<()> {
    match values {
        ColumnData::F64(values) => writer.typed::<DoubleType>().write_batch(values, None, None)?,
        ColumnData::OptionalF64(values) => {
            let present: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
            let values: Vec<f64> = values.iter().flatten().copied().collect();
            writer.typed::<DoubleType>().write_batch(&values, Some(&present), None)?
        }
        ColumnData::Text(values) => {
            let values: Vec<ByteArray> = values.iter().map(|value| value.as_str().into()).collect();
            writer.typed::<ByteArrayType>().write_batch(&values, None, None)?
        }
    };
    Ok(())
}

pub(super) fn read(mut bytes: Vec<u8>, file: File) -> std::result::Result<Table, String> {
    let place = sum_place(&bytes).ok_or("it is truncated or not one of this program: it has no checksum")?;
    let sum = bytes[place.clone()].to_vec();
    bytes[place].copy_from_slice(&NO_SUM);
    if sha256_hex(&bytes).as_bytes() != sum {
        return Err("its content does not match its checksum".to_owned());
    }
    decode(file).map_err(|error| error.to_string())
}

fn decode(file: File) -> Result<Table> {
    let reader = SerializedFileReader::new(file)?;
    let file = reader.metadata().file_metadata();
    let (mut metadata, mut units) = (Vec::new(), Vec::new());
    for KeyValue { key, value } in file.key_value_metadata().into_iter().flatten() {
        let value = value.clone().unwrap_or_default();
        if let Some(name) = key.strip_prefix(UNIT) {
            units.push((name.to_owned(), value));
        } else if key != SUM {
            metadata.push((key.clone(), value));
        }
    }
    if reader.num_row_groups() != 1 {
        return Err(damaged("it has not one row group"));
    }
    let group = reader.get_row_group(0)?;
    let rows = usize::try_from(group.metadata().num_rows()).map_err(|_| damaged("its number of rows is negative"))?;
    let mut columns = Vec::new();
    for (index, descriptor) in file.schema_descr().columns().iter().enumerate() {
        let name = descriptor.name().to_owned();
        let unit = units.iter().find(|(of, _)| *of == name).map_or_else(String::new, |(_, unit)| unit.clone());
        let optional = descriptor.max_def_level() > 0;
        columns.push(Column { name, unit, values: read_column(&*group, index, rows, optional)? });
    }
    Ok(Table { metadata, columns })
}

fn read_column(group: &dyn RowGroupReader, index: usize, rows: usize, optional: bool) -> Result<ColumnData> {
    match group.get_column_reader(index)? {
        ColumnReader::DoubleColumnReader(mut reader) => {
            let (mut values, mut present) = (Vec::new(), Vec::new());
            let levels = optional.then_some(&mut present);
            let (read, ..) = reader.read_records(rows, levels, None, &mut values)?;
            expect(rows, read)?;
            if !optional {
                return Ok(ColumnData::F64(values));
            }
            let mut values = values.into_iter();
            Ok(ColumnData::OptionalF64(
                present.iter().map(|&level| if level > 0 { values.next() } else { None }).collect(),
            ))
        }
        ColumnReader::ByteArrayColumnReader(mut reader) if !optional => {
            let mut values = Vec::new();
            let (read, ..) = reader.read_records(rows, None, None, &mut values)?;
            expect(rows, read)?;
            let text = values.iter().map(|value| value.as_utf8().map(str::to_owned)).collect::<Result<_>>()?;
            Ok(ColumnData::Text(text))
        }
        _ => Err(damaged("a column has another type than numbers or text")),
    }
}

fn expect(rows: usize, read: usize) -> Result<()> {
    if rows == read { Ok(()) } else { Err(damaged(&format!("a column has {read} of {rows} rows"))) }
}

fn damaged(reason: &str) -> ParquetError {
    ParquetError::General(reason.to_owned())
}
