//! A motion that another engine can be asked for, as files.

use super::table::Table;
use crate::conformance::ConformanceError;
use crate::conformance::experiment::Experiment;
use crate::dynamics::State;
use crate::model::OscillatorChain;
use crate::store::{read_whole, write_atomically};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Samples per period of a short reference.
const SAMPLES: f64 = 64.0;

/// A motion that another engine can be asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Setup {
    pub name: String,
    pub scenario: String,
    /// The equation of motion in words and symbols.
    pub equation: String,
    pub mass: Vec<f64>,
    /// Rows of K, without the springs of Jenkins elements.
    pub stiffness: Vec<Vec<f64>>,
    /// Rows of the whole damping matrix, negative where it excites.
    pub damping: Vec<Vec<f64>>,
    /// Constant forces on the oscillators; none if left out.
    #[serde(default)]
    pub force: Vec<f64>,
    /// The oscillator that is moved by hand, if one is.
    #[serde(default)]
    pub prescribed: Option<Prescribed>,
    pub jenkins: Vec<Element>,
    pub start: Start,
    pub interval: f64,
    pub t_end: f64,
    pub judged: Judged,
    #[serde(skip)]
    pub reference: Vec<(f64, State)>,
}

/// A Jenkins element between oscillator 1 and ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Element {
    pub stiffness: f64,
    pub slip_force: f64,
}

/// `x = amplitude sin(angular_frequency t)` of an oscillator, counted from 1, instead of its equation of motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Prescribed {
    pub oscillator: usize,
    pub amplitude: f64,
    pub angular_frequency: f64,
}

/// State at time 0; slider forces in units of the slip force.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Start {
    pub positions: Vec<f64>,
    pub velocities: Vec<f64>,
    pub slider_forces: Vec<f64>,
}

/// What a motion is judged by.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Judged {
    /// The state is compared up to this time; later, motions part whatever computes them. None: nowhere.
    pub state_until: Option<f64>,
    /// Quantities are taken from this time on.
    pub from: f64,
    pub quantities: Vec<Quantity>,
}

/// A number of a whole motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Maxima of x1, one by one.
    Maxima,
    /// Mean of the maxima of x1.
    MeanMaximum,
    LargestMaximum,
    SmallestMaximum,
    AngularFrequency,
    /// Of the rise and fall of the maxima of x1.
    ModulationFrequency,
    /// Area of the last loop of f1 over x1.
    LoopArea,
}

const EQUATION: &str = "M x'' + D x' + K x + sum_j R_j f_j b_j = F with b_j the unit vector of oscillator 1, f_j' = (k_j/R_j) x_1' while |f_j| < 1 or \
                        f_j x_1' < 0 (stick), else 0 (slip); M = diag(mass), D = damping, K = stiffness, F = force (0 if empty), k_j = stiffness and \
                        R_j = slip_force of element j; an oscillator that is prescribed moves as x = amplitude sin(angular_frequency t)";

impl Setup {
    /// Of an experiment, with the exact state at any time; judged by the state, and by maxima and frequency where it has them.
    ///
    /// # Errors
    /// What `exact` returns.
    pub fn of(
        experiment: &Experiment,
        name: &str,
        exact: impl Fn(f64) -> Result<State, ConformanceError>,
    ) -> Result<Self, ConformanceError> {
        let Experiment { scenario, chain, start, period, periods, .. } = experiment;
        let count = (SAMPLES * f64::from(*periods)).round() as u32;
        let interval = period / SAMPLES;
        let at = |n: u32| {
            let t = f64::from(n) * interval;
            exact(t).map(|state| (t, state))
        };
        let reference = (0..=count).map(at).collect::<Result<_, _>>()?;
        let setup = Self::from_parts(scenario, name, chain, start, reference);
        let quantities = vec![Quantity::Maxima, Quantity::AngularFrequency];
        let judged = Judged { state_until: Some(setup.t_end), from: 0.0, quantities };
        Ok(Self { judged, ..setup })
    }

    /// From the reference at equal intervals; judged by the state alone.
    pub(super) fn from_parts(
        scenario: &str,
        name: &str,
        chain: &OscillatorChain,
        start: &State,
        reference: Vec<(f64, State)>,
    ) -> Self {
        let rows =
            |matrix: &nalgebra::DMatrix<f64>| matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
        let elements = chain.jenkins().iter().map(|j| Element { stiffness: j.stiffness, slip_force: j.slip_force });
        let t_end = reference.last().map_or(0.0, |(t, _)| *t);
        Self {
            name: name.to_owned(),
            scenario: scenario.to_owned(),
            equation: EQUATION.to_owned(),
            mass: chain.mass().iter().copied().collect(),
            stiffness: rows(chain.stiffness()),
            damping: rows(&chain.total_damping()),
            force: Vec::new(),
            prescribed: None,
            jenkins: elements.collect(),
            start: Start {
                positions: start.positions.clone(),
                velocities: start.velocities.clone(),
                slider_forces: start.slider_forces.clone(),
            },
            interval: reference.get(1).map_or(0.0, |(t, _)| *t),
            t_end,
            judged: Judged { state_until: Some(t_end), from: 0.0, quantities: Vec::new() },
            reference,
        }
    }

    /// Writes `NAME.json` and `NAME.csv` into a directory and returns their paths.
    ///
    /// # Errors
    /// [`ConformanceError::Store`] if a file cannot be written.
    pub fn write(&self, directory: &Path) -> Result<[PathBuf; 2], ConformanceError> {
        let [json, csv] = files(directory, &self.name);
        write_atomically(&json, |writer| Ok(serde_json::to_writer_pretty(writer, self)?))?;
        let text = self.csv();
        write_atomically(&csv, |writer| writer.write_all(text.as_bytes()))?;
        Ok([json, csv])
    }

    /// The set-up of that name with its reference, from the two files in a directory.
    ///
    /// # Errors
    /// [`ConformanceError::Store`] if one cannot be read, [`ConformanceError::File`] if it is not what [`Self::write`] makes.
    pub fn read(directory: &Path, name: &str) -> Result<Self, ConformanceError> {
        let [json, csv] = files(directory, name);
        let bad = |error: serde_json::Error| ConformanceError::File {
            path: json.clone(),
            reason: format!("is no set-up ({error}): make one with `stickslip conformance export`"),
        };
        let setup: Self = serde_json::from_slice(&read_whole(&json)?).map_err(bad)?;
        let reference = Table::read(&csv, setup.mass.len(), setup.jenkins.len())?.points;
        if reference.len() < 2 {
            let reason = "is no reference: expected at least two samples".to_owned();
            return Err(ConformanceError::File { path: csv, reason });
        }
        Ok(Self { reference, ..setup })
    }

    /// The reference as a table: `t`, positions, velocities, slider forces in units of the slip force.
    #[must_use]
    pub fn csv(&self) -> String {
        let numbered =
            |letter: &str, count: usize| (1..=count).map(move |i| format!(",{letter}{i}")).collect::<String>();
        let (n, m) = (self.mass.len(), self.jenkins.len());
        let mut text = format!("t{}{}{}\n", numbered("x", n), numbered("v", n), numbered("f", m));
        for (t, state) in &self.reference {
            // Writing to a string cannot fail.
            let _ = write!(text, "{t}");
            state.components().for_each(|value| {
                let _ = write!(text, ",{value}");
            });
            text.push('\n');
        }
        text
    }
}

fn files(directory: &Path, name: &str) -> [PathBuf; 2] {
    ["json", "csv"].map(|extension| directory.join(format!("{name}.{extension}")))
}
