//! `modes`: linear modes of the chain or ring of a scene.

use super::Verdict;
use super::common::{Common, Document, print};
use super::plot::PlotArgs;
use crate::model::{
    BladedDisk, LinearMode, ModesError, NodalDiameter, OscillatorChain, Stability, TravelDirection, TwoMassRig,
};
use crate::report::{Chart, Series, Style, Tint};
use crate::scene::{Case, Scene};
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Linear modes of a chain or ring, its contacts stuck: damping by nodal diameter, localisation, flutter margin.
///
/// Of a tuned ring the modes are waves. Otherwise the nodal diameter is that of the wave with the largest share in the mode, and null for open
/// chains; where the opposite wave has the same share, the mode stands and its nodal diameter has no sign. Damping is minus twice the real part of the eigenvalue; the flutter margin is the least of all: negative where the disk flutters,
/// neutral within 1e-12 of the largest frequency, which is rounding.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip modes scenes/disk_forward_wave.toml --plot s-curve.svg")]
pub struct ModesArgs {
    scene: PathBuf,
    /// Contacts slipping freely in place of stuck.
    #[arg(long)]
    slipping: bool,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

/// One mode as it is shown.
struct Row {
    wave: Option<NodalDiameter>,
    direction: Option<TravelDirection>,
    mode: LinearMode,
    participation: f64,
    share: Option<f64>,
}

pub fn run(args: &ModesArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("modes")?;
    args.plot.check(args.common.force)?;
    let (_, case) = Scene::load(&args.scene)?;
    let rows = match &case.disk {
        Some(disk) => rows_of_disk(&disk.disk, !args.slipping)?,
        None => rows_of_chain(TwoMassRig::new(case.parameters)?.chain(), !args.slipping, None)?,
    };
    let margin = rows.iter().map(|row| row.mode.damping).fold(f64::INFINITY, f64::min);
    let stability = Stability::of(&rows.iter().map(|row| row.mode).collect::<Vec<_>>());
    args.plot.draw(|| chart(&case, &rows))?;
    if args.common.json {
        let document = Document::new("modes", parameters(&case, args))
            .with("modes", json!(rows.iter().map(json_of).collect::<Vec<_>>()))
            .with("flutter_margin", json!(margin))
            .with("flutter", json!(stability == Stability::Flutter))
            .with("stability", json!(stability));
        print(&document.text()?)?;
        return Ok(Verdict::Done);
    }
    print("nodal diameter  direction  angular frequency   damping          participation")?;
    for row in &rows {
        let wave = row.wave.map_or_else(|| "-".to_owned(), |wave| wave.signed().to_string());
        let LinearMode { angular_frequency, damping } = row.mode;
        print(&format!(
            "{wave:>14}  {:9}  {angular_frequency:<18.12}  {damping:<+15.9}  {:.4}",
            direction(row),
            row.participation
        ))?;
    }
    let word = match stability {
        Stability::Stable => "stable",
        Stability::Neutral => "neutral",
        Stability::Flutter => "flutter",
    };
    print(&format!("flutter margin {margin:+.9}: {word}"))?;
    Ok(Verdict::Done)
}

fn direction(row: &Row) -> String {
    row.direction.map_or_else(|| "-".to_owned(), |way| json!(way).as_str().unwrap_or_default().to_owned())
}

fn parameters(case: &Case, args: &ModesArgs) -> Value {
    let system = case.disk.as_ref().map_or_else(|| json!(case.parameters), |disk| json!(disk.disk));
    json!({"system": system, "contacts": if args.slipping { "slipping" } else { "stuck" }})
}

fn json_of(row: &Row) -> Value {
    json!({
        "nodal_diameter": row.wave.map(NodalDiameter::signed),
        "direction": row.direction,
        "angular_frequency": row.mode.angular_frequency,
        "damping": row.mode.damping,
        "participation": row.participation,
        "wave_share": row.share,
    })
}

fn rows_of_disk(disk: &BladedDisk, stuck: bool) -> Result<Vec<Row>, ModesError> {
    if disk.is_cyclic()? && disk.deviations()?.iter().all(|d| *d == 0.0) {
        let row = |found: crate::model::TunedMode| Row {
            wave: Some(found.wave),
            direction: Some(found.wave.direction()),
            mode: found.mode,
            participation: 1.0,
            share: Some(1.0),
        };
        return Ok(disk.tuned_modes(stuck)?.into_iter().map(row).collect());
    }
    let ring = disk.topology == crate::model::Topology::Ring;
    let mut rows = rows_of_chain(&disk.chain()?, stuck, Some((disk.sectors, ring)))?;
    rows.sort_by(|a, b| a.mode.angular_frequency.total_cmp(&b.mode.angular_frequency));
    Ok(rows)
}

/// `blades`: number of blades and whether they stand in a ring; all oscillators of an open chain without it.
fn rows_of_chain(chain: &OscillatorChain, stuck: bool, blades: Option<(usize, bool)>) -> Result<Vec<Row>, ModesError> {
    let (blades, ring) = blades.unwrap_or((chain.oscillators(), false));
    let shapes = chain.mode_shapes(&vec![stuck; chain.sliders()])?;
    let row = |shape: &crate::model::ModeShape| {
        let direction = ring.then(|| shape.direction(blades));
        let standing = direction == Some(TravelDirection::Standing);
        let dominant = ring.then(|| shape.dominant_wave(blades));
        // Of a standing mode, rounding alone decides between n and -n.
        let wave = dominant.map(|n| if standing { NodalDiameter::new(n.signed().abs(), blades) } else { n });
        Row {
            wave,
            direction,
            mode: shape.mode,
            participation: shape.participation(blades),
            share: wave.map(|wave| shape.wave_shares(blades)[wave.index()]),
        }
    };
    Ok(shapes.iter().map(row).collect())
}

fn chart(case: &Case, rows: &[Row]) -> anyhow::Result<Chart> {
    let by_wave = rows.iter().all(|row| row.wave.is_some());
    let place = |(i, row): (usize, &Row)| match row.wave {
        Some(wave) if by_wave => wave.signed() as f64,
        _ => i as f64,
    };
    let mut points: Vec<(f64, f64)> = rows.iter().enumerate().map(|at| (place(at), at.1.mode.damping)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ends = [points.first().map_or(0.0, |p| p.0), points.last().map_or(1.0, |p| p.0)];
    Ok(Chart {
        title: case.title.clone(),
        x_label: if by_wave { "nodal diameter (positive: forward wave)" } else { "mode" }.to_owned(),
        y_label: "damping".to_owned(),
        series: vec![
            Series {
                label: "stability limit".to_owned(),
                points: ends.map(|x| (x, 0.0)).to_vec(),
                style: Style::Line,
                tint: Tint::Grey,
            },
            Series { label: "modes".to_owned(), points, style: Style::Markers, tint: Tint::Blue },
        ],
    })
}
