//! A trajectory of the two-mass rig as a table, and back.

use crate::dynamics::{Event, EventKind, Outcome, Sample, State, Trajectory};
use crate::model::{ContactState, Direction, EnergyLedger, Scales, Works};
use crate::scene::Case;
use crate::store::{Column, ColumnData, Table};
use anyhow::{Context, bail, ensure};
use serde_json::{Value, json};

/// Quantities of a sample: name, unit in SI, scale, value.
type Quantity = (&'static str, &'static str, fn(&Scales) -> f64, fn(&Sample) -> f64);

const QUANTITIES: [Quantity; 12] = [
    ("t", "s", |s| s.time, |y| y.time),
    ("x1", "m", |s| s.length, |y| y.state.positions[0]),
    ("x2", "m", |s| s.length, |y| y.state.positions[1]),
    ("v1", "m/s", |s| s.velocity, |y| y.state.velocities[0]),
    ("v2", "m/s", |s| s.velocity, |y| y.state.velocities[1]),
    ("f", "N", |s| s.slip_force, |y| y.state.slider_forces[0]),
    ("energy", "J", |s| s.energy, |y| y.ledger.stored),
    ("work_damping", "J", |s| s.energy, |y| y.ledger.works.damping),
    ("work_self_excitation", "J", |s| s.energy, |y| y.ledger.works.self_excitation),
    ("work_friction", "J", |s| s.energy, |y| y.ledger.works.friction),
    ("work_drive", "J", |s| s.energy, |y| y.ledger.works.drive),
    ("energy_residual", "J", |s| s.energy, |y| y.ledger.residual()),
];

/// What made a trajectory.
pub struct Provenance<'a> {
    pub case: &'a Case,
    pub solver: &'a str,
    pub parameters: Value,
}

impl Provenance<'_> {
    /// What stands above a table.
    pub fn metadata(&self, trajectory: &Trajectory, scales: &Scales) -> anyhow::Result<Vec<(String, String)>> {
        let Self { case, solver, parameters } = self;
        let metadata = [
            ("stickslip", env!("CARGO_PKG_VERSION").to_owned()),
            ("solver", (*solver).to_owned()),
            ("parameters", parameters.to_string()),
            ("case", serde_json::to_string(case)?),
            ("scales", serde_json::to_string(scales)?),
            ("outcome", serde_json::to_string(&trajectory.outcome)?),
            ("switches", trajectory.switches().to_string()),
        ];
        Ok(metadata.map(|(key, value)| (key.to_owned(), value)).to_vec())
    }
}

/// The samples as rows, in the units of `scales`.
pub fn to_table(trajectory: &Trajectory, provenance: &Provenance<'_>, scales: &Scales) -> anyhow::Result<Table> {
    let si = *scales != Scales::UNITY;
    let mut columns: Vec<Column> = QUANTITIES
        .iter()
        .map(|(name, unit, scale, value)| Column {
            name: (*name).to_owned(),
            unit: if si { (*unit).to_owned() } else { "1".to_owned() },
            values: ColumnData::F64(trajectory.samples.iter().map(|y| value(y) * scale(scales)).collect()),
        })
        .collect();
    let contacts = trajectory.samples.iter().map(|y| y.contacts[0].word().to_owned()).collect();
    columns.push(Column { name: "contact".to_owned(), unit: String::new(), values: ColumnData::Text(contacts) });
    Ok(Table { metadata: provenance.metadata(trajectory, scales)?, columns })
}

/// The case and trajectory a table holds, non-dimensional; events are not stored.
pub fn from_table(table: &Table) -> anyhow::Result<(Case, Trajectory)> {
    let text = |key: &str| {
        table.metadata(key).with_context(|| format!("the table has no {key}: was it written by `stickslip simulate`?"))
    };
    let case: Case = serde_json::from_str(text("case")?).context("case of the table")?;
    ensure!(
        case.disk.is_none(),
        "the table is of a bladed disk, whose stored motions cannot be filmed: give its scene"
    );
    let scales: Scales = serde_json::from_str(text("scales")?).context("scales of the table")?;
    let outcome: Outcome = serde_json::from_str(text("outcome")?).context("outcome of the table")?;
    let number = |index: usize| -> anyhow::Result<Vec<f64>> {
        let (name, _, scale, _) = QUANTITIES[index];
        match table.column(name).map(|column| &column.values) {
            Some(ColumnData::F64(values)) => Ok(values.iter().map(|value| value / scale(&scales)).collect()),
            _ => bail!("the table has no column {name} of numbers"),
        }
    };
    let columns: Vec<Vec<f64>> = (0..11).map(number).collect::<anyhow::Result<_>>()?;
    let Some(ColumnData::Text(contacts)) = table.column("contact").map(|column| &column.values) else {
        bail!("the table has no column contact of words");
    };
    ensure!(!contacts.is_empty(), "the table has no rows");
    let samples = contacts
        .iter()
        .enumerate()
        .map(|(row, word)| {
            let at = |column: usize| columns[column][row];
            let works =
                Works { damping: at(7), self_excitation: at(8), friction: at(9), drive: at(10), ..Works::default() };
            Ok(Sample {
                time: at(0),
                state: State::two_mass(std::array::from_fn(|i| at(i + 1))),
                contacts: vec![contact_from(word)?],
                ledger: EnergyLedger { stored: at(6), stored_at_start: columns[6][0], works },
            })
        })
        .collect::<anyhow::Result<Vec<_>>>()?;
    Ok((case, Trajectory { samples, events: Vec::new(), outcome }))
}

fn contact_from(word: &str) -> anyhow::Result<ContactState> {
    [ContactState::Stick, ContactState::Slip(Direction::Positive), ContactState::Slip(Direction::Negative)]
        .into_iter()
        .find(|contact| contact.word() == word)
        .with_context(|| format!("contact state {word:?} is unknown: expected stick, slip+ or slip-"))
}

/// Events as a table: time, element, kind, state.
pub fn events_table(events: &[Event], parameters: &Value) -> Table {
    let state = |index: usize| ColumnData::F64(events.iter().filter_map(|e| e.state.components().nth(index)).collect());
    let column = |name: &str, unit: &str, values| Column { name: name.to_owned(), unit: unit.to_owned(), values };
    let kind = |event: &Event| match event.kind {
        EventKind::StickToSlip => "stick_to_slip",
        EventKind::SlipToStick => "slip_to_stick",
        EventKind::Grazing => "grazing",
    };
    let mut columns = vec![
        column("t", "1", ColumnData::F64(events.iter().map(|event| event.time).collect())),
        column("kind", "", ColumnData::Text(events.iter().map(|event| kind(event).to_owned()).collect())),
    ];
    columns.extend(["x1", "x2", "v1", "v2", "f"].iter().enumerate().map(|(i, name)| column(name, "1", state(i))));
    let metadata = vec![
        ("stickslip".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("parameters".to_owned(), json!(parameters).to_string()),
    ];
    Table { metadata, columns }
}
