//! A disk set in motion for a film: by the engine and by the exact solution, from the same start and sampled at the same times.

use super::motion::start;
use crate::dynamics::{Flow, Sampling, State, Trajectory};
use crate::engine::{BladeMotion, DiskFlow, DiskGeometry, EngineSettings, Recording};
use crate::exact::SparseFlow;
use crate::model::OscillatorChain;
use crate::scene::{Case, DiskCase};
use crate::store::{Column, ColumnData, Table};
use anyhow::ensure;

/// The state at time 0.
pub fn initial(disk: &DiskCase, amplitude_bound: f64) -> anyhow::Result<State> {
    start(disk, &disk.disk.chain()?, amplitude_bound)
}

/// The motion in Rapier.
pub fn in_engine(
    case: &Case,
    disk: &DiskCase,
    settings: EngineSettings,
    (initial, sampling): (&State, Sampling),
) -> anyhow::Result<Recording> {
    let chain = disk.disk.chain()?;
    let limit = 2.0 / fastest(&chain);
    let step = settings.step;
    ensure!(
        step < limit,
        "engine.dt = {step:e} is not allowed: it must be below {limit:e}, where the engine's integrator becomes unstable"
    );
    // Along the axis, as they are drawn.
    let geometry = DiskGeometry { motion: BladeMotion::Axial, ..DiskGeometry::default() };
    let flow =
        DiskFlow::new(&disk.disk, settings)?.with_geometry(geometry)?.with_amplitude_bound(case.amplitude_bound)?;
    Ok(flow.record(initial, sampling)?)
}

/// The exact motion.
pub fn exactly(case: &Case, disk: &DiskCase, initial: &State, sampling: Sampling) -> anyhow::Result<Trajectory> {
    let flow = SparseFlow::new(&disk.disk.chain()?).with_amplitude_bound(case.amplitude_bound)?;
    Ok(flow.trajectory(initial, sampling)?)
}

/// An upper bound of the angular frequencies: the largest row sum of the stiffness with all contacts stuck.
fn fastest(chain: &OscillatorChain) -> f64 {
    let stiffness = chain.stiffness_with(&vec![true; chain.sliders()]);
    let row = |i: usize| stiffness.row(i).iter().map(|k| k.abs()).sum::<f64>() / chain.mass()[i];
    (0..chain.oscillators()).map(row).fold(0.0, f64::max).sqrt()
}

/// Rate at which small differences grow at most: that of the fastest growing mode, contacts stuck. Friction only slows them.
pub fn growth_rate(disk: &DiskCase) -> anyhow::Result<f64> {
    let chain = disk.disk.chain()?;
    let modes = chain.linear_modes(&vec![true; chain.sliders()])?;
    Ok(modes.iter().map(|mode| -0.5 * mode.damping).fold(0.0, f64::max))
}

/// The samples as rows; `metadata` says where they come from.
pub fn table(disk: &DiskCase, trajectory: &Trajectory, metadata: Vec<(String, String)>) -> Table {
    let samples = &trajectory.samples;
    let column = |name: String, of: &dyn Fn(usize) -> f64| Column {
        name,
        unit: "1".to_owned(),
        values: ColumnData::F64((0..samples.len()).map(of).collect()),
    };
    let (blades, first) = (disk.disk.sectors, samples.first());
    let oscillator = |i: usize| if i < blades { format!("{i}") } else { format!("_segment{}", i - blades) };
    let mut columns = vec![column("t".to_owned(), &|row| samples[row].time)];
    for i in 0..first.map_or(0, |sample| sample.state.positions.len()) {
        columns.push(column(format!("x{}", oscillator(i)), &|row| samples[row].state.positions[i]));
        columns.push(column(format!("v{}", oscillator(i)), &|row| samples[row].state.velocities[i]));
    }
    for k in 0..first.map_or(0, |sample| sample.state.slider_forces.len()) {
        columns.push(column(format!("f{k}"), &|row| samples[row].state.slider_forces[k]));
        let words = samples.iter().map(|sample| sample.contacts[k].word().to_owned()).collect();
        let (name, unit) = (format!("contact{k}"), String::new());
        columns.push(Column { name, unit, values: ColumnData::Text(words) });
    }
    columns.push(column("energy".to_owned(), &|row| samples[row].ledger.stored));
    columns.push(column("work_damping".to_owned(), &|row| samples[row].ledger.works.damping));
    columns.push(column("work_self_excitation".to_owned(), &|row| samples[row].ledger.works.self_excitation));
    columns.push(column("work_circulatory".to_owned(), &|row| samples[row].ledger.works.circulatory));
    columns.push(column("work_friction".to_owned(), &|row| samples[row].ledger.works.friction));
    columns.push(column("energy_residual".to_owned(), &|row| samples[row].ledger.residual()));
    Table { metadata, columns }
}
