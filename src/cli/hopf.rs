//! `hopf`: secondary Hopf points and fold of the limit cycle, for one parameter set or over a range of one parameter.

use super::Verdict;
use super::analysis::{RigInput, end_of, exact_flow, lower_branch, searched, special_json};
use super::common::{Common, Document, print};
use super::plot::PlotArgs;
use crate::model::{RigParameter, RigParameters};
use crate::orbit::{
    Bifurcation, Branch, BranchEnd, Criticality, Heading, NormalForm, OrbitError, Passage, SpecialPoint,
};
use crate::report::{Chart, Series, Style, Tint};
use clap::Args;
use rayon::prelude::*;
use serde_json::{Map, Value, json};

/// Amplitude of mass 1 up to which points beyond the fold are looked for.
const LARGEST_AMPLITUDE: f64 = 50.0;
const MOST_VALUES: usize = 100_000;
/// Amplitude up to which the picture of one parameter set shows the branch.
const CHART_AMPLITUDE: f64 = 6.0;

/// Secondary Hopf points and the fold of the limit cycle, located by Newton's method on the extended system.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  stickslip hopf --json\n  stickslip hopf --vary kappa=0.06:0.25:39 --json")]
pub struct HopfArgs {
    /// One row per value of xi2, kappa or gamma, COUNT values from FROM to TO.
    #[arg(long, value_name = "NAME=FROM:TO:COUNT", value_parser = parse_vary)]
    vary: Option<Vary>,
    #[command(flatten)]
    rig: RigInput,
    #[command(flatten)]
    plot: PlotArgs,
    #[command(flatten)]
    common: Common,
}

#[derive(Debug, Clone, Copy)]
struct Vary {
    parameter: RigParameter,
    from: f64,
    to: f64,
    count: usize,
}

fn parse_vary(text: &str) -> Result<Vary, String> {
    let wrong = || "give NAME=FROM:TO:COUNT with NAME one of xi2, kappa, gamma, such as kappa=0.06:0.25:39".to_owned();
    let (name, range) = text.split_once('=').ok_or_else(wrong)?;
    let parameter = match name {
        "xi2" => RigParameter::Xi2,
        "kappa" => RigParameter::Kappa,
        "gamma" => RigParameter::Gamma,
        _ => return Err(wrong()),
    };
    let parts: Vec<&str> = range.split(':').collect();
    let [from, to, count] = parts.as_slice() else { return Err(wrong()) };
    match (from.parse(), to.parse(), count.parse()) {
        (Ok(from), Ok(to), Ok(count)) if (2..=MOST_VALUES).contains(&count) => Ok(Vary { parameter, from, to, count }),
        _ => Err(wrong()),
    }
}

pub fn run(args: &HopfArgs) -> anyhow::Result<Verdict> {
    args.common.no_files("hopf")?;
    args.plot.check(args.common.force)?;
    let p = args.rig.parameters_but_xi1("hopf")?;
    let mut parameters = json!({"xi2": p.xi2, "kappa": p.kappa, "gamma": p.gamma});
    let (document, rows) = match args.vary {
        None => {
            args.plot.draw(|| branch_chart(p))?;
            let fields = points(p)?;
            let document = Document::new("hopf", parameters);
            let document = fields.iter().fold(document, |d, (key, value)| d.with(key, value.clone()));
            (document, vec![Value::Object(fields)])
        }
        Some(vary) => {
            let name = vary.parameter.name();
            parameters["vary"] = json!({"name": name, "from": vary.from, "to": vary.to, "count": vary.count});
            let rows: Vec<Value> = (0..vary.count).into_par_iter().map(|n| row(p, vary, n)).collect();
            args.plot.draw(|| Ok(curve_chart(name, &rows)))?;
            (Document::new("hopf", parameters).with("rows", json!(rows)), rows)
        }
    };
    if args.common.json {
        print(&document.text()?)?;
    } else {
        let name = args.vary.map(|vary| vary.parameter.name());
        rows.iter().try_for_each(|row| print(&text(row, name)))?;
    }
    let failed = rows.iter().any(|row| row.get("error").is_some());
    Ok(if failed { Verdict::Failed } else { Verdict::Done })
}

/// What was found at one parameter set, a line each.
fn text(row: &Value, varied: Option<&str>) -> String {
    let mut lines: Vec<String> = varied.map(|name| format!("{name} = {}", row[name])).into_iter().collect();
    if let Some(error) = row.get("error").and_then(Value::as_str) {
        lines.push(format!("  not computed: {error}"));
    }
    for (list, remark) in [("secondary_hopf", ""), ("beyond_fold", ", beyond the fold")] {
        for point in row[list].as_array().into_iter().flatten() {
            let kind = point["criticality"].as_str().map_or(String::new(), |kind| format!(", {kind}"));
            let side = point["side"].as_str().unwrap_or_default();
            lines.push(format!(
                "  secondary Hopf point, {side}: xi1 = {}, a1 = {}{kind}{remark}",
                point["xi1"], point["a1"]
            ));
        }
    }
    if row["secondary_hopf"].as_array().is_some_and(Vec::is_empty) {
        lines.push("  no secondary Hopf point before the fold".to_owned());
    }
    match &row["fold"] {
        Value::Object(fold) => lines.push(format!("  fold: xi1 = {}, a1 = {}", fold["xi1"], fold["a1"])),
        _ => lines.push("  no fold".to_owned()),
    }
    let searched = &row["searched"];
    if let Some(end) = searched["end"].as_str() {
        lines.push(format!("  searched up to xi1 = {}, a1 = {}: {end}", searched["xi1"], searched["a1"]));
        lines.extend(searched["pairs"].as_str().map(|how| format!("  {how}")));
    }
    lines.join("\n")
}

/// The branch up to twice the amplitude of a fold near the nominal one.
fn branch_chart(p: RigParameters) -> anyhow::Result<Chart> {
    let branch = Branch::follow(lower_branch(p, Heading::Decreasing)?.up_to_amplitude(CHART_AMPLITUDE), |_| false)?;
    let rows: Vec<Value> = branch.points.iter().map(super::branch::row).collect::<anyhow::Result<_>>()?;
    let special: Vec<Value> = branch.special.iter().map(special_json).collect();
    Ok(super::branch::chart(&rows, &special))
}

/// Critical damping over the parameter varied (Fig. 9 b-d): exact points, fold, and equation (31).
fn curve_chart(name: &str, rows: &[Value]) -> Chart {
    let at = |row: &Value| row[name].as_f64().unwrap_or(f64::NAN);
    let points = |list: &'static str, side: &'static str| {
        let of = move |row: &Value| {
            row[list]
                .as_array()
                .into_iter()
                .flatten()
                .filter(move |p| p["side"] == side)
                .map(|p| p["xi1"].as_f64().unwrap_or(f64::NAN))
                .collect::<Vec<_>>()
        };
        rows.iter().flat_map(|row| of(row).into_iter().map(move |xi1| (at(row), xi1))).collect::<Vec<_>>()
    };
    let folds = rows.iter().map(|row| (at(row), row["fold"]["xi1"].as_f64().unwrap_or(f64::NAN))).collect();
    let series = |label: &str, points, style, tint| Series { label: label.to_owned(), points, style, tint };
    Chart {
        title: format!("Secondary Hopf points of the limit cycle over {name}"),
        x_label: name.to_owned(),
        y_label: "ξ₁".to_owned(),
        series: vec![
            series("fold", folds, Style::Line, Tint::Grey),
            series("equation (31), start", points("analytic", "start"), Style::Line, Tint::Blue),
            series("equation (31), end", points("analytic", "end"), Style::Line, Tint::Orange),
            series("exact, start", points("secondary_hopf", "start"), Style::Markers, Tint::Blue),
            series("exact, end", points("secondary_hopf", "end"), Style::Markers, Tint::Orange),
        ],
    }
}

fn row(p: RigParameters, vary: Vary, n: usize) -> Value {
    let value = vary.from + (vary.to - vary.from) * (n as f64 / (vary.count - 1) as f64);
    let at = p.with(vary.parameter, value).validated().map_err(anyhow::Error::from);
    let mut row = at.and_then(points).unwrap_or_else(|error| {
        let mut row = Map::new();
        row.insert("error".to_owned(), json!(super::message(&error)));
        row
    });
    row.insert(vary.parameter.name().to_owned(), json!(value));
    Value::Object(row)
}

/// The fields of one parameter set; `error` says where the branch was lost.
fn points(p: RigParameters) -> anyhow::Result<Map<String, Value>> {
    let branch = Branch::explore(lower_branch(p, Heading::Decreasing)?.up_to_amplitude(LARGEST_AMPLITUDE), |_| false);
    let fold = branch.special_of(Bifurcation::Fold).next();
    let fold_at =
        branch.special.iter().position(|point| point.kind == Bifurcation::Fold).unwrap_or(branch.special.len());
    let crossings: Vec<(usize, Value)> = branch
        .special
        .iter()
        .enumerate()
        .filter(|(_, point)| point.kind == Bifurcation::NeimarkSacker)
        .map(|(index, point)| {
            let mut fields = crossing(point);
            // Beyond the fold another multiplier is unstable as well, and no torus is born that could be seen.
            if index < fold_at {
                fields["criticality"] = criticality(point)?;
            }
            Ok((index, fields))
        })
        .collect::<anyhow::Result<_>>()?;
    let part = |beyond: bool| {
        crossings.iter().filter(|(index, _)| (*index > fold_at) == beyond).map(|(_, v)| v.clone()).collect::<Vec<_>>()
    };
    let analytic = p
        .analytic_hopf()
        .map_or(json!([]), |hopf| json!([{"xi1": hopf.start, "side": "start"}, {"xi1": hopf.end, "side": "end"}]));
    let mut fields = Map::new();
    fields.insert("secondary_hopf".to_owned(), json!(part(false)));
    fields.insert("beyond_fold".to_owned(), json!(part(true)));
    fields.insert(
        "fold".to_owned(),
        fold.map_or(Value::Null, |f| json!({"xi1": f.parameters.xi1, "a1": f.orbit.amplitude()})),
    );
    fields.insert("analytic".to_owned(), analytic);
    fields.insert("searched".to_owned(), searched(&branch));
    if let BranchEnd::Lost { .. } = branch.end {
        fields.insert("error".to_owned(), json!(end_of(&branch)));
    }
    Ok(fields)
}

/// Criticality by the normal form on the section; null where it is not decided: next to a resonance or a change of criticality, or where
/// the motion leaves the neighbourhood of the orbit.
fn criticality(point: &SpecialPoint) -> anyhow::Result<Value> {
    match NormalForm::of(&exact_flow(point.parameters)?, point) {
        Ok(form) => Ok(json!(match form.criticality() {
            Criticality::Supercritical => "supercritical",
            Criticality::Subcritical => "subcritical",
        })),
        Err(OrbitError::Undecided { .. } | OrbitError::Map { .. }) => Ok(Value::Null),
        Err(error) => Err(error.into()),
    }
}

fn crossing(point: &SpecialPoint) -> Value {
    let side = if point.passage == Passage::Upwards { "start" } else { "end" };
    let frequency = point.rotation_angle().map(|angle| angle / (0.5 * point.orbit.period));
    json!({
        "xi1": point.parameters.xi1, "side": side, "torus_angular_frequency": frequency, "a1": point.orbit.amplitude(),
    })
}
