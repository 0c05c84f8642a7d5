//! Time per step of each configuration, on the two-mass rig beside its limit cycle, one thread.

use super::ConformanceError;
use super::configuration::{Configuration, Mechanism};
use super::document::Cost;
use super::row::Row;
use super::scenario::Bench;
use crate::dynamics::{Flow, Sampling, State};
use crate::model::{RigParameters, TwoMassRig};
use std::time::Instant;

const STEPS: u32 = 4000;
const STEP: f64 = 0.006;
/// The fastest counts: everything else on the machine only adds.
const REPEATS: usize = 3;

/// Costs of the configurations that have rows with numbers, in their order. Rapier's own mechanisms, which are tried on one oscillator, have none.
///
/// # Errors
/// [`ConformanceError`] if a configuration cannot be run.
pub fn costs(rows: &[Row], bench: &dyn Bench) -> Result<Vec<Cost>, ConformanceError> {
    let mut configurations: Vec<Configuration> = Vec::new();
    for row in rows.iter().filter(|row| row.found.is_some() && row.configuration.mechanism == Mechanism::Hook) {
        if !configurations.contains(&row.configuration) {
            configurations.push(row.configuration);
        }
    }
    let rig = TwoMassRig::new(RigParameters::default())?;
    let start = State::two_mass([1.22, 0.905, 0.0, -0.538, 1.0]);
    let t_end = f64::from(STEPS) * STEP;
    let mut costs = Vec::new();
    for configuration in configurations {
        let flow = bench.free(rig.chain(), configuration, STEP)?;
        let mut fastest = f64::INFINITY;
        for _ in 0..REPEATS {
            let begun = Instant::now();
            flow.trajectory(&start, Sampling { interval: t_end, t_end })?;
            fastest = fastest.min(begun.elapsed().as_secs_f64());
        }
        costs.push(Cost { configuration, microseconds_per_step: 1e6 * fastest / f64::from(STEPS) });
    }
    Ok(costs)
}
