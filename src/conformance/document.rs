//! `report.json`: everything the report says, for programs. Timings stand apart: all else repeats bit by bit on one machine.

use super::ConformanceError;
use super::advice::{Advice, advice};
use super::configuration::Configuration;
use super::experiment::{Tally, tally};
use super::row::Row;
use super::scenario::{Depth, Scenario};
use crate::engine::{EngineInfo, Precision};
use crate::store::{read_whole, sha256_hex};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The whole report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Report {
    /// Version of this program.
    pub stickslip: String,
    /// `conformance`.
    pub command: String,
    pub parameters: Parameters,
    /// Names, versions and features of the engine's two builds.
    pub engines: Vec<String>,
    pub machine: Machine,
    pub scenarios: Vec<ScenarioNote>,
    pub tally: Tally,
    pub advice: Vec<Advice>,
    pub rows: Vec<Row>,
    /// SHA-256 of the rows, trajectories' hashes included: equal for equal numbers.
    pub rows_sha256: String,
    /// How long things took. Differs from run to run.
    pub timing: Option<Timing>,
}

/// What decided the numbers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Parameters {
    pub depth: Depth,
}

/// Where the numbers were computed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Machine {
    pub cpu: String,
    pub cores: usize,
    pub system: String,
}

/// What a scenario is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ScenarioNote {
    pub id: String,
    pub title: String,
    pub description: String,
    pub reference: String,
}

/// Wall-clock times.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Timing {
    /// For all rows; shorter when some were there already.
    pub seconds: f64,
    pub costs: Vec<Cost>,
}

/// Cost of a configuration on the two-mass rig.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cost {
    pub configuration: Configuration,
    pub microseconds_per_step: f64,
}

impl Report {
    #[must_use]
    pub fn new(scenarios: &[Box<dyn Scenario>], depth: Depth, rows: Vec<Row>, timing: Option<Timing>) -> Self {
        let note = |scenario: &dyn Scenario| ScenarioNote {
            id: scenario.id().to_owned(),
            title: scenario.title().to_owned(),
            description: scenario.description().to_owned(),
            reference: scenario.reference().to_owned(),
        };
        // Rows of plain numbers and strings have no way not to be JSON.
        let text = serde_json::to_string(&rows).unwrap_or_default();
        Self {
            stickslip: env!("CARGO_PKG_VERSION").to_owned(),
            command: "conformance".to_owned(),
            parameters: Parameters { depth },
            engines: [Precision::Single, Precision::Double].map(engine).to_vec(),
            machine: Machine::here(),
            scenarios: scenarios.iter().map(|scenario| note(scenario.as_ref())).collect(),
            tally: tally(&rows),
            advice: advice(&rows),
            rows_sha256: sha256_hex(text.as_bytes()),
            rows,
            timing,
        }
    }

    /// A report from its file.
    ///
    /// # Errors
    /// [`ConformanceError::File`] if it is no such report, [`ConformanceError::Store`] if it cannot be read.
    pub fn read(path: &Path) -> Result<Self, ConformanceError> {
        let bytes = read_whole(path)?;
        let bad = |error: serde_json::Error| ConformanceError::File {
            path: path.to_owned(),
            reason: format!("is no conformance report ({error}): give a report.json of this program"),
        };
        serde_json::from_slice(&bytes).map_err(bad)
    }

    /// The JSON Schema of `report.json`.
    #[must_use]
    pub fn json_schema() -> serde_json::Value {
        schemars::schema_for!(Self).to_value()
    }

    /// Microseconds per step of a configuration.
    #[must_use]
    pub fn cost(&self, configuration: Configuration) -> Option<f64> {
        let costs = &self.timing.as_ref()?.costs;
        costs.iter().find(|cost| cost.configuration == configuration).map(|cost| cost.microseconds_per_step)
    }
}

fn engine(precision: Precision) -> String {
    format!("{} (default features)", EngineInfo::of(precision))
}

impl Machine {
    fn here() -> Self {
        // There is no portable name of a processor; without this file it stays unknown.
        let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
        let cpu = model.map_or_else(|| "unknown".to_owned(), |(_, name)| name.trim().to_owned());
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        Self { cpu, cores, system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH) }
    }
}
