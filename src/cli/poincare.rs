//! `poincare`: points of the exact motion on a section.

use super::analysis::{RigInput, Transient, beside_the_cycle, exact_flow, window};
use super::common::{Common, Document, print};
use super::plot::PlotArgs;
use super::{Verdict, case_args::parse_initial, motions};
use crate::chaos::{ChaosError, PoincareMap, PoincareSection, Rotation, poincare_map, torus_rotation, zero_one_test};
use crate::dynamics::Outcome;
use crate::report::{Chart, Series, Style, Tint};
use crate::scene::Initial;
use crate::store::{Column, ColumnData, Table, write_table};
use anyhow::Context;
use clap::{Args, ValueEnum};
use serde_json::json;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SectionName {
    /// x2 = 0, x2' > 0.
    Fast,
    /// The mean-free envelope of mass 2 passes zero upwards.
    Slow,
    /// Every period of the limit cycle.
    Stroboscopic,
}

const SHORTEST_TRANSIENT: f64 = 5000.0;
/// Time shown unless told otherwise.
const SHOWN: f64 = 5000.0;

/// Poincare section of the exact motion.
///
/// Beside the points: the rotation number of the torus, where the motion winds round one, and on the slow section, from 200 points on, the 0-1
/// test for chaos (near 0: regular, near 1: chaotic).
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip poincare --xi1 -0.06 --section fast -o torus.csv")]
pub struct PoincareArgs {
    #[arg(long, value_enum, default_value_t = SectionName::Fast)]
    section: SectionName,
    /// End of the motion; 5000 time units after the transient by default.
    #[arg(long, allow_hyphen_values = true)]
    t_end: Option<f64>,
    /// Length of its beginning that is left out; by default what the multipliers of the limit cycle say it takes to settle, at least 5000.
    #[arg(long, allow_hyphen_values = true)]
    transient: Option<f64>,
    /// Start here instead of beside the limit cycle.
    #[arg(long, value_name = "x1,x2,v1,v2,f", allow_hyphen_values = true, value_parser = parse_initial)]
    initial: Option<Initial>,
    #[command(flatten)]
    rig: RigInput,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &PoincareArgs) -> anyhow::Result<Verdict> {
    args.plot.check(args.common.force)?;
    let p = args.rig.parameters()?;
    let start = beside_the_cycle(p, args.initial, 0)?;
    let (name, section) = match args.section {
        SectionName::Fast => ("fast", PoincareSection::Fast),
        SectionName::Slow => ("slow", PoincareSection::Slow),
        SectionName::Stroboscopic => {
            ("stroboscopic", PoincareSection::Stroboscopic { period: motions::exact_limit_cycle(p)?.period })
        }
    };
    let transient = Transient::of(p, args.transient, args.initial, SHORTEST_TRANSIENT);
    let t_end = args.t_end.unwrap_or(transient.length + SHOWN);
    let parameters = json!({
        "xi1": p.xi1, "xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma, "section": section, "t_end": t_end,
        "transient": transient.length, "initial": start,
    });
    if let Some(path) = &args.common.output {
        super::simulate::refuse_to_overwrite(path, &parameters, args.common.force)?;
    }
    let (flow, window) = (exact_flow(p)?, window(transient.length, t_end)?);
    let map = poincare_map(&flow, &start, window, section)?;
    let rotation = where_defined(torus_rotation(&flow, &start, window))?;
    let zero_one = match map.column("a1_deviation") {
        Some(series) => where_defined(zero_one_test(&series))?,
        None => None,
    };
    if let Some(path) = &args.common.output {
        let columns = map.columns.iter().map(|name| Column {
            name: name.clone(),
            unit: "1".to_owned(),
            values: ColumnData::F64(map.column(name).unwrap_or_default()),
        });
        let metadata = vec![
            ("stickslip".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("parameters".to_owned(), parameters.to_string()),
        ];
        write_table(path, &Table { metadata, columns: columns.collect() })?;
    }
    args.plot.draw(|| section_chart(&map, name, p.xi1))?;
    if args.common.json {
        let document = Document::new("poincare", parameters)
            .with("columns", json!(map.columns))
            .with("points", json!(map.points))
            .with("rotation", json!(rotation))
            .with("zero_one", json!(zero_one))
            .with("settled", json!(transient.settled()))
            .with("settling_time", json!(transient.needed))
            .with("diverged", json!(matches!(map.outcome, Outcome::Diverged { .. })));
        return print(&document.text()?).map(|()| Verdict::Done);
    }
    print(&format!("{} points on the {name} section", map.points.len()))?;
    if let Some(Rotation { rotation_number, rotation_error, slow_period, .. }) = rotation {
        print(&format!(
            "rotation {rotation_number:.9} +- {rotation_error:.1e} rad per half period, slow period {slow_period:.6}"
        ))?;
    }
    if let Some(indicator) = zero_one {
        print(&format!("0-1 test: {indicator:.3}"))?;
    }
    transient.remark().map_or(Ok(()), |remark| print(&remark))?;
    Ok(Verdict::Done)
}

/// `None` where the motion has no such thing: it diverged, is too short, or does not wind round a torus.
fn where_defined<T>(found: Result<T, ChaosError>) -> Result<Option<T>, ChaosError> {
    match found {
        Err(ChaosError::Diverged { .. } | ChaosError::TooShort { .. } | ChaosError::NotWinding { .. }) => Ok(None),
        found => found.map(Some),
    }
}

fn section_chart(map: &PoincareMap, name: &str, xi1: f64) -> anyhow::Result<Chart> {
    let [across, up] = if name == "slow" { ["a1_deviation", "a2_deviation_rate"] } else { ["x1", "v1"] };
    let column = |name: &str| map.column(name).with_context(|| format!("the section has no column {name}"));
    let points = column(across)?.into_iter().zip(column(up)?).collect();
    Ok(Chart {
        title: format!("Poincare map on the {name} section at ξ₁ = {xi1}"),
        x_label: across.to_owned(),
        y_label: up.to_owned(),
        series: vec![Series { label: String::new(), points, style: Style::Dots, tint: Tint::Blue }],
    })
}
