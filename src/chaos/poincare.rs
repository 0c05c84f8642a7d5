//! Poincare maps of the two-mass rig on the sections of the paper (Figs. 6-8).
//!
//! - [`PoincareSection::Fast`]: `S = {x2 = 0, x2' > 0}`.
//! - [`PoincareSection::Slow`]: `D = {a2~ = 0, a2~' > 0}`, the mean-free envelope of mass 2 passes through zero upwards. The
//!   envelopes are those of the turning points of each mass, interpolated by cubics; the mean is that over the window. With some
//!   25 turning points per slow oscillation the interpolation errs by about 1e-3 of the modulation.
//! - [`PoincareSection::Stroboscopic`]: every period, at `transient + n period`.

use super::crossing::{Sense, crossings};
use super::envelope::Envelope;
use super::error::ChaosError;
use super::window::Window;
use crate::dynamics::{DenseFlow, Motion, Outcome, State};
use serde::{Deserialize, Serialize};

/// Fewest turning points of each mass that make an envelope.
const FEWEST_TURNS: usize = 8;

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PoincareSection {
    Fast,
    Slow,
    Stroboscopic { period: f64 },
}

/// Points of a motion on a section, in order of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PoincareMap {
    /// Meaning of the entries of a point: `t, x1, x2, v1, v2, f`, or on the slow section
    /// `t, a1_deviation, a2_deviation_rate, a1_mean, a2_mean`.
    pub columns: Vec<String>,
    pub points: Vec<Vec<f64>>,
    /// Points of a diverged motion end before the time of divergence.
    pub outcome: Outcome,
}

impl PoincareMap {
    /// All entries of one column; `None` if there is no such column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let index = self.columns.iter().position(|column| column == name)?;
        self.points.iter().map(|point| point.get(index).copied()).collect()
    }
}

/// Points in the window of the motion from `initial`.
///
/// # Errors
/// [`ChaosError::OutOfRange`] for windows and periods that cannot be used, [`ChaosError::Flow`] if the flow fails, and on the slow
/// section [`ChaosError::TooShort`] for fewer than eight turning points.
pub fn poincare_map<F: DenseFlow>(
    flow: &F,
    initial: &State,
    window: Window,
    section: PoincareSection,
) -> Result<PoincareMap, ChaosError> {
    let window = window.validated()?;
    if let PoincareSection::Stroboscopic { period } = section {
        ChaosError::require_positive("period", period)?;
    }
    let failed = |source| ChaosError::flow(flow.name(), source);
    let motion = flow.motion(initial, window.end()).map_err(failed)?;
    let (columns, points) = match section {
        PoincareSection::Fast => (STATE_COLUMNS.as_slice(), fast(&motion, window).map_err(failed)?),
        PoincareSection::Stroboscopic { period } => {
            (STATE_COLUMNS.as_slice(), stroboscopic(&motion, window, period).map_err(failed)?)
        }
        PoincareSection::Slow => {
            let envelopes = [0, 1].map(|mass| Envelope::of_mass(&motion, window.transient, mass).map_err(failed));
            let [first, second] = envelopes;
            (SLOW_COLUMNS.as_slice(), slow(&first?, &second?)?)
        }
    };
    let columns = columns.iter().map(|&name| name.to_owned()).collect();
    Ok(PoincareMap { columns, points, outcome: motion.outcome() })
}

const STATE_COLUMNS: [&str; 6] = ["t", "x1", "x2", "v1", "v2", "f"];
const SLOW_COLUMNS: [&str; 5] = ["t", "a1_deviation", "a2_deviation_rate", "a1_mean", "a2_mean"];

fn point(time: f64, state: &State) -> Vec<f64> {
    std::iter::once(time).chain(state.components()).collect()
}

fn fast<M: Motion>(motion: &M, window: Window) -> Result<Vec<Vec<f64>>, M::Error> {
    let found = crossings(motion, window.transient, Sense::Upwards, |state| state.positions[1])?;
    Ok(found.iter().map(|crossing| point(crossing.time, &crossing.state)).collect())
}

fn stroboscopic<M: Motion>(motion: &M, window: Window, period: f64) -> Result<Vec<Vec<f64>>, M::Error> {
    (0_u64..)
        .map(|n| window.transient + n as f64 * period)
        .take_while(|time| *time <= motion.end())
        .map(|time| motion.state(time).map(|state| point(time, &state)))
        .collect()
}

fn slow(first: &Envelope, second: &Envelope) -> Result<Vec<Vec<f64>>, ChaosError> {
    let found = first.len().min(second.len());
    if found < FEWEST_TURNS {
        let (quantity, of) = ("the slow section", "turning points of each mass");
        return Err(ChaosError::TooShort { quantity, of, needed: FEWEST_TURNS, found });
    }
    let (mean1, mean2) = (first.mean(), second.mean());
    let samples: Vec<_> = second.samples().collect();
    let upwards = samples.windows(2).filter(|pair| pair[0].1 < mean2 && pair[1].1 >= mean2);
    Ok(upwards
        .filter_map(|pair| {
            let time = passage(second, mean2, pair[0].0, pair[1].0)?;
            let (amplitude1, (_, rate2)) = (first.at(time)?.0, second.at(time)?);
            Some(vec![time, amplitude1 - mean1, rate2, mean1, mean2])
        })
        .collect())
}

/// Time at which the envelope passes `level` between two samples, by halving; `None` near its ends.
fn passage(envelope: &Envelope, level: f64, mut below: f64, mut above: f64) -> Option<f64> {
    for _ in 0..50 {
        let middle = 0.5 * (below + above);
        if envelope.at(middle)?.0 < level {
            below = middle;
        } else {
            above = middle;
        }
    }
    Some(above)
}
