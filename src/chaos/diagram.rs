//! Amplitude diagrams over a parameter (Figs. 1, 5 and 10 of the paper): largest and smallest maximum of x1, class of the
//! motion, edge of divergence.
//!
//! Rows are independent of each other: they are computed in parallel, come out the same on any number of threads, and rows
//! that are there already are taken over.

use super::error::ChaosError;
use super::motion_class::{Criteria, Evidence, KnownCycle, MotionClass, classify_settled};
use super::window::Window;
use crate::dynamics::{DenseFlow, State};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicUsize, Ordering};

/// What decides a row besides its parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DiagramPlan {
    pub window: Window,
    pub criteria: Criteria,
    /// How often a motion that has not settled is followed further, each time twice as long.
    pub extensions: usize,
}

impl Default for DiagramPlan {
    /// 5000 time units, the first 1500 of them transient.
    fn default() -> Self {
        Self { window: Window { transient: 1500.0, length: 3500.0 }, criteria: Criteria::default(), extensions: 0 }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DiagramRow {
    /// The parameter.
    pub value: f64,
    /// Largest and smallest maximum of x1 in the window; `None` where the motion diverged.
    pub a1_max: Option<f64>,
    pub a1_min: Option<f64>,
    pub outcome: MotionClass,
    pub evidence: Evidence,
}

/// Where motions begin to diverge, along increasing or decreasing parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DivergenceEdge {
    /// First value, in the order of the rows, at which the motion diverged within the time observed.
    pub first_diverged: f64,
    /// Last value at which it stayed bounded. Beyond `first_diverged` where the edge is not sharp: chaotic transients of random
    /// length end in divergence.
    pub last_bounded: Option<f64>,
    /// Shortest and longest life of the motions that diverged.
    pub life_times: (f64, f64),
}

/// One row per value, in their order. `prepare` gives flow and initial state for a value, `finished` holds rows of the same plan that
/// need not be computed again (values must agree to the bit), and `progress` hears of each new row, in any order and from
/// any thread: row, rows done, rows in all.
///
/// # Errors
/// The first error in the order of the values: [`ChaosError::Preparation`] from `prepare`, otherwise as [`super::classify`].
pub fn amplitude_diagram<F, E>(
    values: &[f64],
    plan: &DiagramPlan,
    finished: &[DiagramRow],
    prepare: impl Fn(f64) -> Result<(F, State), E> + Sync,
    progress: impl Fn(&DiagramRow, usize, usize) + Sync,
) -> Result<Vec<DiagramRow>, ChaosError>
where
    F: DenseFlow,
    E: std::error::Error + Send + Sync + 'static,
{
    // Collected first, so that which error is returned does not depend on which thread was faster.
    every_row(values, plan, finished, prepare, |_| None, progress).into_iter().collect()
}

/// The same with every row, those that failed among them; `cycle` gives the limit cycle solved for at a value, whose multipliers decide
/// where the motion approaches it.
pub fn every_row<F, E>(
    values: &[f64],
    plan: &DiagramPlan,
    finished: &[DiagramRow],
    prepare: impl Fn(f64) -> Result<(F, State), E> + Sync,
    cycle: impl Fn(f64) -> Option<KnownCycle> + Sync,
    progress: impl Fn(&DiagramRow, usize, usize) + Sync,
) -> Vec<Result<DiagramRow, ChaosError>>
where
    F: DenseFlow,
    E: std::error::Error + Send + Sync + 'static,
{
    let known = |value: f64| finished.iter().find(|row| row.value.to_bits() == value.to_bits()).copied();
    let done = AtomicUsize::new(values.iter().filter(|value| known(**value).is_some()).count());
    values
        .par_iter()
        .map(|&value| {
            if let Some(row) = known(value) {
                return Ok(row);
            }
            let row = diagram_row(value, plan, &prepare, cycle(value).as_ref())?;
            progress(&row, done.fetch_add(1, Ordering::Relaxed) + 1, values.len());
            Ok(row)
        })
        .collect()
}

fn diagram_row<F, E>(
    value: f64,
    plan: &DiagramPlan,
    prepare: impl Fn(f64) -> Result<(F, State), E>,
    cycle: Option<&KnownCycle>,
) -> Result<DiagramRow, ChaosError>
where
    F: DenseFlow,
    E: std::error::Error + Send + Sync + 'static,
{
    let (flow, initial) =
        prepare(value).map_err(|source| ChaosError::Preparation { value, source: Box::new(source) })?;
    let found = classify_settled(&flow, &initial, plan.window, &plan.criteria, cycle, plan.extensions)?;
    Ok(DiagramRow {
        value,
        a1_max: found.amplitude_range.map(|(largest, _)| largest),
        a1_min: found.amplitude_range.map(|(_, smallest)| smallest),
        outcome: found.class,
        evidence: found.evidence,
    })
}

/// Edge of divergence along rows in their order, from bounded to diverged motions; `None` if none diverged.
#[must_use]
pub fn divergence_edge(rows: &[DiagramRow]) -> Option<DivergenceEdge> {
    let lives = || rows.iter().filter_map(|row| Some((row.value, row.evidence.life_time?)));
    let (first_diverged, first_life) = lives().next()?;
    let life_times = lives().fold((first_life, first_life), |(low, high), (_, t)| (low.min(t), high.max(t)));
    let last_bounded = rows.iter().rfind(|row| row.outcome != MotionClass::Diverged).map(|row| row.value);
    Some(DivergenceEdge { first_diverged, last_bounded, life_times })
}
