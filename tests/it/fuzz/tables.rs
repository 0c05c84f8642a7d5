//! Stored trajectories that are nearly right: damaged as files, and as tables that are stored faultlessly with
//! something wrong in them.

use super::dice::Dice;
use std::path::Path;
use stickslip::store::{ColumnData, Table, read_table, sha256_hex, write_table};

/// Writes a changed trajectory to `path`, as its extension says.
pub fn write_changed(dice: &mut Dice, table: &Table, path: &Path) {
    if dice.once_in(2) {
        let mut table = table.clone();
        (0..=dice.below(2)).for_each(|_| change(dice, &mut table));
        if write_table(path, &table).is_ok() {
            return;
        }
    }
    write_table(path, table).unwrap();
    let mut bytes = std::fs::read(path).unwrap();
    for _ in 0..=dice.below(3) {
        let at = dice.below(bytes.len());
        match dice.below(4) {
            0 => bytes.truncate(at.max(1)),
            1 => bytes[at] ^= 1 << dice.below(8),
            2 => drop(bytes.splice(at..(at + 8).min(bytes.len()), [0xff; 8])),
            _ => bytes.insert(at, dice.below(256) as u8),
        }
    }
    if dice.once_in(2) {
        seal(&mut bytes);
    }
    std::fs::write(path, bytes).unwrap();
}

/// Gives a damaged Parquet file the sum that belongs to it, so that it is decoded.
fn seal(bytes: &mut [u8]) {
    const MARK: &[u8] = b"of the file with zeros here: ";
    let Some(mark) = bytes.windows(MARK.len()).rposition(|window| window == MARK) else { return };
    let place = mark + MARK.len()..mark + MARK.len() + 64;
    if place.end > bytes.len() {
        return;
    }
    bytes[place.clone()].fill(b'0');
    let sum = sha256_hex(bytes);
    bytes[place].copy_from_slice(sum.as_bytes());
}

fn change(dice: &mut Dice, table: &mut Table) {
    let column = dice.below(table.columns.len());
    match dice.below(8) {
        0 if table.columns.len() > 1 => drop(table.columns.remove(column)),
        1 => table.columns[column].name = (*dice.pick(&["t", "x1", "contact", "f", "", "q"])).to_owned(),
        2 => table.columns[column].unit = (*dice.pick(&["", "1", "m", "furlong"])).to_owned(),
        3 => {
            if let ColumnData::F64(values) = &mut table.columns[column].values
                && !values.is_empty()
            {
                let at = dice.below(values.len());
                values[at] = dice.number().parse().ok().filter(|value: &f64| value.is_finite()).unwrap_or(1e300);
            }
        }
        4 => {
            if let ColumnData::Text(values) = &mut table.columns[column].values
                && !values.is_empty()
            {
                let at = dice.below(values.len());
                values[at] = (*dice.pick(&["stick", "slip", "", "slip+", "neither"])).to_owned();
            }
        }
        5 if !table.metadata.is_empty() => {
            let at = dice.below(table.metadata.len());
            table.metadata.remove(at);
        }
        6 => {
            // Parameters and scenes stand there as JSON.
            let others: Vec<String> = table.metadata.iter().map(|(_, value)| value.clone()).collect();
            if !others.is_empty() {
                let at = dice.below(table.metadata.len());
                table.metadata[at].1 = super::texts::changed(dice, &others[at], &others);
            }
        }
        _ => {
            let length = dice.below(3);
            for column in &mut table.columns {
                match &mut column.values {
                    ColumnData::F64(values) => values.truncate(length),
                    ColumnData::OptionalF64(values) => values.truncate(length),
                    ColumnData::Text(values) => values.truncate(length),
                }
            }
        }
    }
}

/// Reads it in this process: a refusal must name the file.
pub fn read(path: &Path) -> Result<(), String> {
    match read_table(path) {
        Ok(_) => Ok(()),
        Err(error) => Err(error.to_string()),
    }
}
