use std::fs;
use std::path::{Path, PathBuf};
use stickslip::store::{Column, ColumnData, StoreError, Table, TableFormat, read_table, write_table};

const EXTENSIONS: [&str; 2] = ["csv", "parquet"];

fn column(name: &str, unit: &str, values: ColumnData) -> Column {
    Column { name: name.to_owned(), unit: unit.to_owned(), values }
}

/// Everything that is hard to store.
fn awkward() -> Table {
    let numbers = vec![0.1 + 0.2, -0.0, 5e-324, f64::MAX, -1.0 / 3.0, 1e21];
    let optional = vec![None, Some(1.0), None, Some(-2.5e-300), Some(0.0), None];
    let words = ["", "stick", "a, \"b\"", "# end: 6 rows", "two\nlines\r\n", "1.5"];
    let text = words.map(str::to_owned).to_vec();
    Table {
        metadata: [("source", "eq. (1): x \\ y\nsecond # line\r"), ("note", ""), ("xi1", " -0.02 ")]
            .map(|(k, v)| (k.to_owned(), v.to_owned()))
            .to_vec(),
        columns: vec![
            column("#contact", "", ColumnData::Text(text)),
            column("t", "1/omega0", ColumnData::F64(numbers)),
            column("leading, exponent", "1", ColumnData::OptionalF64(optional)),
        ],
    }
}

fn bits(table: &Table) -> Vec<u64> {
    let numbers = |column: &Column| match &column.values {
        ColumnData::F64(values) => values.iter().map(|v| v.to_bits()).collect(),
        ColumnData::OptionalF64(values) => values.iter().map(|v| v.map_or(1, f64::to_bits)).collect(),
        ColumnData::Text(_) => Vec::new(),
    };
    table.columns.iter().flat_map(numbers).collect()
}

fn stored(place: &Path, table: &Table, extension: &str) -> PathBuf {
    let path = place.join(format!("table.{extension}"));
    write_table(&path, table).unwrap();
    path
}

fn is_damaged(path: &Path) -> bool {
    matches!(read_table(path), Err(StoreError::Damaged { .. }))
}

#[test]
fn tables_come_back_to_the_last_bit() {
    let place = tempfile::tempdir().unwrap();
    let empty = Table { metadata: vec![], columns: vec![column("t", "s", ColumnData::F64(vec![]))] };
    for table in [awkward(), empty] {
        for extension in EXTENSIONS {
            let back = read_table(&stored(place.path(), &table, extension)).unwrap();
            assert_eq!(back, table, "{extension}");
            // Equality takes -0 for 0.
            assert_eq!(bits(&back), bits(&table), "{extension}");
        }
    }
}

#[test]
fn a_csv_file_is_what_the_format_says() {
    let place = tempfile::tempdir().unwrap();
    let table = Table {
        metadata: vec![("command".to_owned(), "simulate".to_owned())],
        columns: vec![
            column("t", "1/omega0", ColumnData::F64(vec![0.0, 0.1])),
            column("contact", "", ColumnData::Text(vec!["stick".to_owned(), "slip +".to_owned()])),
        ],
    };
    let text = fs::read_to_string(stored(place.path(), &table, "csv")).unwrap();
    let lines: Vec<_> = text.lines().collect();
    let head = ["# command: simulate", "# types: number,text", "t [1/omega0],contact", "0.0,stick", "0.1,slip +"];
    assert_eq!(lines[..5], head);
    assert!(lines[5].starts_with("# sha256: "));
    assert_eq!(lines[6..], ["# end: 2 rows"]);
}

#[test]
fn a_parquet_file_can_be_read_by_its_own_schema() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;
    let place = tempfile::tempdir().unwrap();
    let file = fs::File::open(stored(place.path(), &awkward(), "parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 6);
    assert_eq!(rows[1].get_string(0).unwrap(), "stick");
    assert_eq!(rows[0].get_double(1).unwrap(), 0.1 + 0.2);
    assert_eq!(rows[3].get_double(2).unwrap(), -2.5e-300);
    assert!(rows[0].get_double(2).is_err());
}

#[test]
fn the_same_table_gives_the_same_bytes() {
    let place = tempfile::tempdir().unwrap();
    for extension in EXTENSIONS {
        let first = fs::read(stored(place.path(), &awkward(), extension)).unwrap();
        let second = fs::read(stored(place.path(), &awkward(), extension)).unwrap();
        assert_eq!(first, second, "{extension}");
    }
}

#[test]
fn a_table_truncated_anywhere_is_an_error() {
    let place = tempfile::tempdir().unwrap();
    for extension in EXTENSIONS {
        let path = stored(place.path(), &awkward(), extension);
        let whole = fs::read(&path).unwrap();
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            assert!(is_damaged(&path), "{extension} cut to {length} of {} bytes", whole.len());
        }
    }
}

#[test]
fn a_changed_byte_is_an_error_or_changes_nothing() {
    let place = tempfile::tempdir().unwrap();
    for extension in EXTENSIONS {
        let path = stored(place.path(), &awkward(), extension);
        let whole = fs::read(&path).unwrap();
        let mut noticed = 0;
        for at in 0..whole.len() {
            for flip in [1, 0x80] {
                let mut changed = whole.clone();
                changed[at] ^= flip;
                fs::write(&path, &changed).unwrap();
                match read_table(&path) {
                    // In CSV `1.0` may become `1.00`-like spellings of the same number.
                    Ok(table) => assert_eq!((bits(&table), table), (bits(&awkward()), awkward()), "{extension} {at}"),
                    Err(error) => {
                        assert!(matches!(error, StoreError::Damaged { .. }), "{extension} {at}: {error}");
                        noticed += 1;
                    }
                }
            }
        }
        // The sum of a Parquet file is over its bytes. The one of a CSV file is over what they say, of which little is idle.
        let least = if extension == "parquet" { 2 * whole.len() } else { 2 * whole.len() - 20 };
        assert!(noticed >= least, "{extension}: {noticed} of {}", 2 * whole.len());
    }
}

#[test]
fn a_row_taken_out_of_a_csv_file_is_noticed() {
    let place = tempfile::tempdir().unwrap();
    let path = stored(place.path(), &awkward(), "csv");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.lines().filter(|line| !line.starts_with("stick")).collect::<Vec<_>>().join("\n") + "\n")
        .unwrap();
    let message = read_table(&path).unwrap_err().to_string();
    assert!(message.contains("5 of 6 rows"), "{message}");
}

#[test]
fn line_ends_of_other_systems_do_not_matter() {
    let place = tempfile::tempdir().unwrap();
    let table = Table {
        metadata: vec![("a".to_owned(), "b".to_owned())],
        columns: vec![column("t", "s", ColumnData::F64(vec![1.0, 2.0]))],
    };
    let path = stored(place.path(), &table, "csv");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace('\n', "\r\n")).unwrap();
    assert_eq!(read_table(&path).unwrap(), table);
}

#[test]
fn tables_that_could_not_come_back_are_refused() {
    let place = tempfile::tempdir().unwrap();
    let numbers = |values: &[f64]| ColumnData::F64(values.to_vec());
    let table = |columns| Table { metadata: vec![], columns };
    let with_key = |key: &str| Table {
        metadata: vec![(key.to_owned(), String::new())],
        columns: vec![column("t", "", numbers(&[1.0]))],
    };
    let bad = [
        table(vec![]),
        table(vec![column("t", "", numbers(&[1.0])), column("x", "", numbers(&[]))]),
        table(vec![column("t", "", numbers(&[])), column("t", "", numbers(&[]))]),
        table(vec![column("x [m]", "", numbers(&[]))]),
        table(vec![column("x", "m]", numbers(&[]))]),
        table(vec![column("", "", numbers(&[]))]),
        table(vec![column("x", "", numbers(&[1.0, f64::NAN]))]),
        table(vec![column("x", "", ColumnData::OptionalF64(vec![Some(f64::INFINITY)]))]),
        with_key("a:b"),
        with_key("types"),
        with_key("unit of t"),
        with_key(""),
    ];
    for (number, table) in bad.iter().enumerate() {
        for extension in EXTENSIONS {
            let path = place.path().join(format!("bad.{extension}"));
            let error = write_table(&path, table).unwrap_err();
            assert!(matches!(error, StoreError::BadTable { .. }), "{number}: {error}");
            assert!(!path.exists());
        }
    }
}

#[test]
fn the_extension_decides_the_format() {
    assert_eq!(TableFormat::from_path("a/B.CSV".as_ref()).unwrap(), TableFormat::Csv);
    assert_eq!(TableFormat::from_path("b.parquet".as_ref()).unwrap(), TableFormat::Parquet);
    for name in ["a.txt", "csv", ""] {
        let error = TableFormat::from_path(name.as_ref()).unwrap_err();
        assert!(error.to_string().contains(".csv or .parquet"), "{error}");
    }
    let missing = read_table("/nowhere/a.csv".as_ref()).unwrap_err();
    assert!(matches!(missing, StoreError::Read { .. }) && missing.to_string().contains("/nowhere/a.csv"));
}

#[test]
fn a_full_disk_is_named_for_both_formats() {
    let Some(disk) = crate::small_disk::SmallDisk::mount(64) else { return };
    // Not compressible: the multiples of an irrational number.
    let values = (0..30_000).map(|n| f64::from(n) * std::f64::consts::PI).collect();
    let table = Table { metadata: vec![], columns: vec![column("x", "", ColumnData::F64(values))] };
    for extension in EXTENSIONS {
        let error = write_table(&disk.path().join(format!("t.{extension}")), &table).unwrap_err();
        assert!(error.to_string().contains("Free some space"), "{error}");
    }
    assert!(crate::small_disk::names_in(disk.path()).is_empty());
}
