//! A table as one Parquet row group: numbers as DOUBLE, text as UTF-8 BYTE_ARRAY, Snappy pages. Metadata, units (`unit of NAME`) and the
//! checksum are key-value metadata of the file.

use super::csv::Checked;
use super::{Column, ColumnData, RESERVED, Table};
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
use std::sync::Arc;

const UNIT: &str = "unit of ";
const SUM: &str = RESERVED[2];

pub(super) fn write(table: &Table, writer: &mut (dyn Write + Send)) -> io::Result<()> {
    write_parquet(table, writer).map_err(|error| match error {
        // A full disk has to stay recognisable as one.
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    })
}

fn write_parquet(table: &Table, writer: &mut (dyn Write + Send)) -> Result<()> {
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
    let sum = (SUM.to_owned(), table.sha256());
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

pub(super) fn read(file: File) -> Checked {
    read_parquet(file).map_err(|error| format!("it is truncated or changed ({error})"))
}

fn read_parquet(file: File) -> Result<(Table, String)> {
    let reader = SerializedFileReader::new(file)?;
    let file = reader.metadata().file_metadata();
    let (mut metadata, mut units, mut sum) = (Vec::new(), Vec::new(), None);
    for KeyValue { key, value } in file.key_value_metadata().into_iter().flatten() {
        let value = value.clone().unwrap_or_default();
        if key == SUM {
            sum = Some(value);
        } else if let Some(name) = key.strip_prefix(UNIT) {
            units.push((name.to_owned(), value));
        } else {
            metadata.push((key.clone(), value));
        }
    }
    let sum = sum.ok_or_else(|| damaged("it has no checksum"))?;
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
    Ok((Table { metadata, columns }, sum))
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
