//! Set-ups and references as plain files for any other engine, and the scoring of what it made of them.
//!
//! `NAME.json` holds the equation of motion in matrices, the start and the sample times; `NAME.csv` the exact motion at these times.
//! An engine writes its own motion with the columns `t, x1, ..., v1, ...` (velocities may be left out) and is scored by
//!
//! ```text
//! state error      max over t_n, i of |x_i(t_n) - exact|, and of |v_i(t_n) - exact| where given; right within 1 % of the motion
//! amplitude error  of the maxima of x1;   frequency error of the upward zeros of x1;   both right within 1 %
//! ```

use super::ConformanceError;
use super::experiment::{Experiment, RIGHT};
use super::theory::bare_sample;
use crate::compare::Cycles;
use crate::dynamics::{Outcome, State, Trajectory};
use crate::store::{read_whole, write_atomically};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Samples per period of a reference.
const SAMPLES: f64 = 64.0;
/// Sample times may be off by the rounding of another program's output.
const SAME_TIME: f64 = 1e-6;

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
    pub jenkins: Vec<Element>,
    pub start: Start,
    pub interval: f64,
    pub t_end: f64,
    #[serde(skip)]
    pub reference: Vec<(f64, Point)>,
}

/// A Jenkins element between oscillator 1 and ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Element {
    pub stiffness: f64,
    pub slip_force: f64,
}

/// State at time 0; slider forces in units of the slip force.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Start {
    pub positions: Vec<f64>,
    pub velocities: Vec<f64>,
    pub slider_forces: Vec<f64>,
}

type Point = State;

const EQUATION: &str = "M x'' + D x' + K x + sum_j R_j f_j b_j = 0 with b_j the unit vector of oscillator 1, f_j' = (k_j/R_j) x_1' while |f_j| < 1 or \
                        f_j x_1' < 0 (stick), else 0 (slip); M = diag(mass), D = damping, K = stiffness, k_j = stiffness and R_j = slip_force of element j";

/// How well a motion of another engine meets the reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Score {
    pub file: String,
    pub setup: String,
    pub checks: Vec<ScoreCheck>,
    pub right: bool,
}

/// One measure of a score.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScoreCheck {
    pub quantity: String,
    /// None where the motion has no such quantity, which is wrong if the reference has it.
    pub found: Option<f64>,
    pub limit: f64,
    pub right: bool,
}

impl Setup {
    /// Of an experiment, with the exact state at any time.
    ///
    /// # Errors
    /// What `exact` returns.
    pub fn of(
        experiment: &Experiment,
        name: &str,
        exact: impl Fn(f64) -> Result<State, ConformanceError>,
    ) -> Result<Self, ConformanceError> {
        let Experiment { scenario, chain, start, period, periods, .. } = experiment;
        let (interval, t_end) = (period / SAMPLES, period * f64::from(*periods));
        let rows =
            |matrix: &nalgebra::DMatrix<f64>| matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
        let count = (SAMPLES * f64::from(*periods)).round() as u32;
        let at = |n: u32| {
            let t = f64::from(n) * interval;
            exact(t).map(|state| (t, state))
        };
        let elements = chain.jenkins().iter().map(|j| Element { stiffness: j.stiffness, slip_force: j.slip_force });
        Ok(Self {
            name: name.to_owned(),
            scenario: (*scenario).to_owned(),
            equation: EQUATION.to_owned(),
            mass: chain.mass().iter().copied().collect(),
            stiffness: rows(chain.stiffness()),
            damping: rows(&chain.total_damping()),
            jenkins: elements.collect(),
            start: Start {
                positions: start.positions.clone(),
                velocities: start.velocities.clone(),
                slider_forces: start.slider_forces.clone(),
            },
            interval,
            t_end,
            reference: (0..=count).map(at).collect::<Result<_, _>>()?,
        })
    }

    /// Writes `NAME.json` and `NAME.csv` into a directory and returns their paths.
    ///
    /// # Errors
    /// [`ConformanceError::Store`] if a file cannot be written.
    pub fn write(&self, directory: &Path) -> Result<[PathBuf; 2], ConformanceError> {
        let (json, csv) = (directory.join(format!("{}.json", self.name)), directory.join(format!("{}.csv", self.name)));
        write_atomically(&json, |writer| Ok(serde_json::to_writer_pretty(writer, self)?))?;
        let text = self.csv();
        write_atomically(&csv, |writer| writer.write_all(text.as_bytes()))?;
        Ok([json, csv])
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

    /// Scores the trajectory in a CSV file.
    ///
    /// # Errors
    /// [`ConformanceError::File`] if the file is not a table of numbers with the columns and times of this set-up.
    pub fn judge(&self, path: &Path) -> Result<Score, ConformanceError> {
        let motion = self.read(path)?;
        let exact = motion_of(self.reference.iter().cloned());
        let scale = exact.samples.iter().flat_map(|s| s.state.positions.clone()).fold(0.0, |a: f64, x| a.max(x.abs()));
        let pairs = motion.samples.iter().zip(&exact.samples);
        let given = motion.samples.iter().all(|sample| !sample.state.velocities.is_empty());
        let error = pairs.fold(0.0, |error: f64, (a, b)| {
            let x = a.state.positions.iter().zip(&b.state.positions);
            let v = a.state.velocities.iter().zip(&b.state.velocities);
            x.chain(v).fold(error, |error, (a, b)| error.max((a - b).abs()))
        });
        let mut checks = vec![check("state_error", Some(error), RIGHT * scale)];
        let reference = Cycles::of(&exact, 0);
        if given && reference.maxima.len() > 2 {
            let cycles = Cycles::of(&motion, 0);
            let inner = reference.inner(&exact);
            checks.push(check("amplitude_error", inner.amplitude_error(&cycles), RIGHT * scale));
            let frequency = inner.angular_frequency().unwrap_or_default();
            checks.push(check("frequency_error", inner.frequency_error(&cycles), RIGHT * frequency));
        }
        let right = checks.iter().all(|check| check.right);
        Ok(Score { file: path.display().to_string(), setup: self.name.clone(), checks, right })
    }

    fn read(&self, path: &Path) -> Result<Trajectory, ConformanceError> {
        let bad = |reason: String| ConformanceError::File { path: path.to_owned(), reason };
        let text = String::from_utf8(read_whole(path)?).map_err(|_| bad("is no text".to_owned()))?;
        let mut lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
        let heading: Vec<&str> = lines.next().unwrap_or_default().split(',').map(str::trim).collect();
        let column = |name: String| heading.iter().position(|h| *h == name);
        let needed = |name: String| {
            column(name.clone())
                .ok_or_else(|| bad(format!("has no column {name:?}, expected the columns of {}.csv", self.name)))
        };
        let n = self.mass.len();
        let time = needed("t".to_owned())?;
        let positions = (1..=n).map(|i| needed(format!("x{i}"))).collect::<Result<Vec<_>, _>>()?;
        let velocities = (1..=n).map(|i| column(format!("v{i}"))).collect::<Option<Vec<_>>>().unwrap_or_default();
        let mut points = Vec::new();
        for (index, line) in lines.enumerate() {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.trim().parse().unwrap_or(f64::NAN)).collect();
            let value = |i: &usize| {
                let found = cells.get(*i).copied().filter(|value| value.is_finite());
                found.ok_or_else(|| bad(format!("row {}: no finite number in column {:?}", index + 1, heading[*i])))
            };
            let values = |columns: &[usize]| columns.iter().map(value).collect::<Result<Vec<_>, _>>();
            let state =
                State { positions: values(&positions)?, velocities: values(&velocities)?, slider_forces: vec![] };
            points.push((value(&time)?, state));
        }
        if points.len() != self.reference.len() {
            return Err(bad(format!(
                "has {} samples, expected the {} of {}.csv",
                points.len(),
                self.reference.len(),
                self.name
            )));
        }
        let off = points.iter().zip(&self.reference).position(|((a, _), (b, _))| (a - b).abs() > SAME_TIME);
        if let Some(i) = off {
            return Err(bad(format!("row {}: t = {}, expected {}", i + 1, points[i].0, self.reference[i].0)));
        }
        Ok(motion_of(points.into_iter()))
    }
}

fn motion_of(points: impl Iterator<Item = (f64, State)>) -> Trajectory {
    Trajectory {
        samples: points.map(|(t, state)| bare_sample(t, state)).collect(),
        events: vec![],
        outcome: Outcome::Completed,
    }
}

fn check(quantity: &str, found: Option<f64>, limit: f64) -> ScoreCheck {
    let right = found.is_some_and(|found| found <= limit);
    ScoreCheck { quantity: quantity.to_owned(), found, limit, right }
}
