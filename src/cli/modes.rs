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
use nalgebra::Complex;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Linear modes of a chain or ring, its contacts stuck: every eigenvalue, stability, damping by nodal diameter, localisation.
///
/// All 2N eigenvalues are looked at, those that do not oscillate too; they are modes of angular frequency 0, and `overdamped` counts them. The
/// one with the largest real part decides: stable, flutter (a growing pair), divergence (a growing real one), or neutral within 1e-12 of the largest
/// eigenvalue, which is rounding. The flutter margin is minus twice that real part: the least damping.
///
/// Of a tuned ring the modes are waves. Otherwise the nodal diameter is that of the wave with the largest share in the mode, and null for open
/// chains; where the opposite wave has the same share, the mode stands and its nodal diameter has no sign. Damping is minus twice the real part of
/// the eigenvalue.
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
    let spectrum = Spectrum::of(rows.iter().map(|row| row.mode).collect());
    args.plot.draw(|| chart(&case, &rows))?;
    if args.common.json {
        let document = Document::new("modes", parameters(&case, args))
            .with("modes", json!(rows.iter().map(json_of).collect::<Vec<_>>()))
            .with("eigenvalues", json!(spectrum.eigenvalues.iter().map(complex).collect::<Vec<_>>()))
            .with("flutter_margin", json!(spectrum.margin()))
            .with("flutter", json!(spectrum.stability == Stability::Flutter))
            .with("stability", json!(spectrum.stability))
            .with("overdamped", json!(spectrum.overdamped));
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
    print(&format!(
        "largest real part of {} eigenvalues {:+.9}; {} of them do not oscillate",
        spectrum.eigenvalues.len(),
        spectrum.largest(),
        spectrum.overdamped
    ))?;
    print(&format!("flutter margin {:+.9}: {}", spectrum.margin(), spectrum.stability.word()))?;
    Ok(Verdict::Done)
}

/// All eigenvalues by their real parts, and what they say.
struct Spectrum {
    eigenvalues: Vec<Complex<f64>>,
    overdamped: usize,
    stability: Stability,
}

impl Spectrum {
    fn of(modes: Vec<LinearMode>) -> Self {
        let mut eigenvalues: Vec<Complex<f64>> = modes.iter().flat_map(LinearMode::eigenvalues).collect();
        eigenvalues.sort_by(|a, b| a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im)));
        let overdamped = modes.iter().filter(|mode| !mode.oscillates()).count();
        Self { eigenvalues, overdamped, stability: Stability::of(&modes) }
    }

    /// A system has at least one oscillator, so that there is a last one.
    fn largest(&self) -> f64 {
        self.eigenvalues.last().map_or(0.0, |s| s.re)
    }

    fn margin(&self) -> f64 {
        // Plus zero: of a neutral system not -0.
        -2.0 * self.largest() + 0.0
    }
}

fn complex(s: &Complex<f64>) -> Value {
    json!({"re": s.re, "im": s.im})
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
