//! A trajectory as a table of numbers with named columns.

use crate::conformance::ConformanceError;
use crate::conformance::theory::bare_sample;
use crate::dynamics::{Outcome, State, Trajectory};
use crate::store::read_whole;
use std::path::{Path, PathBuf};

/// States at times; velocities and slider forces are empty where the table has none.
#[derive(Debug)]
pub(super) struct Table {
    pub path: PathBuf,
    pub points: Vec<(f64, State)>,
}

impl Table {
    /// Of `oscillators` oscillators and `sliders` Jenkins elements.
    ///
    /// # Errors
    /// [`ConformanceError::File`] if it is no table of finite numbers, has no times or positions, or has velocities or slider forces of some
    /// but not of all.
    pub fn read(path: &Path, oscillators: usize, sliders: usize) -> Result<Self, ConformanceError> {
        let bad = |reason: String| ConformanceError::File { path: path.to_owned(), reason };
        let text = String::from_utf8(read_whole(path)?).map_err(|_| bad("is no text".to_owned()))?;
        let mut lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
        let heading: Vec<&str> = lines.next().unwrap_or_default().split(',').map(str::trim).collect();
        let column = |name: &str| heading.iter().position(|h| *h == name);
        let needed = |name: String| {
            column(&name).ok_or_else(|| bad(format!("has no column {name:?}; found {}", heading.join(", "))))
        };
        let all_or_none = |letter: &str, count: usize| {
            let names: Vec<String> = (1..=count).map(|i| format!("{letter}{i}")).collect();
            let found: Vec<usize> = names.iter().filter_map(|name| column(name)).collect();
            if found.is_empty() || found.len() == count {
                return Ok(found);
            }
            let missing: Vec<&str> = names.iter().map(String::as_str).filter(|name| column(name).is_none()).collect();
            Err(bad(format!(
                "has {} of the {count} columns {letter}1 to {letter}{count}, {} missing: give all of them or none",
                found.len(),
                missing.join(", ")
            )))
        };
        let time = needed("t".to_owned())?;
        let positions = (1..=oscillators).map(|i| needed(format!("x{i}"))).collect::<Result<Vec<_>, _>>()?;
        let (velocities, forces) = (all_or_none("v", oscillators)?, all_or_none("f", sliders)?);
        let mut points = Vec::new();
        for (index, line) in lines.enumerate() {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.trim().parse().unwrap_or(f64::NAN)).collect();
            let value = |i: &usize| {
                let found = cells.get(*i).copied().filter(|value| value.is_finite());
                found.ok_or_else(|| bad(format!("row {}: no finite number in column {:?}", index + 1, heading[*i])))
            };
            let values = |columns: &[usize]| columns.iter().map(value).collect::<Result<Vec<_>, _>>();
            let state = State {
                positions: values(&positions)?,
                velocities: values(&velocities)?,
                slider_forces: values(&forces)?,
            };
            points.push((value(&time)?, state));
        }
        Ok(Self { path: path.to_owned(), points })
    }

    /// An error about this file.
    pub fn bad(&self, reason: String) -> ConformanceError {
        ConformanceError::File { path: self.path.clone(), reason }
    }
}

pub(super) fn motion_of(points: &[(f64, State)]) -> Trajectory {
    Trajectory {
        samples: points.iter().map(|(t, state)| bare_sample(*t, state.clone())).collect(),
        events: vec![],
        outcome: Outcome::Completed,
    }
}
