//! Beyond the paper: how the torus turns, its rotation number per half period of the fast oscillation over xi1.
//!
//! At the secondary Hopf point it must start with the argument of the half-period multiplier on the unit circle: an independent
//! number, from the derivative of the return map of the limit cycle.

use super::check::Check;
use super::error::PaperError;
use super::exact::{beside_the_cycle, branch_to_fold, secondary_hopf, settled, values};
use super::item::{Case, Effort, Findings, Origin, PaperItem, numbers};
use crate::chaos::{ChaosError, Rotation, torus_rotation};
use crate::report::{Figure, Panel, Series, Style, Tint};
use rayon::prelude::*;
use std::f64::consts::TAU;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "rotation",
    origin: Origin::Beyond,
    title: "rotation number of the torus over ξ₁",
    caption: "Mean angle by which the torus turns from one reversal of mass 1 to the next, in turns, and the period of the modulation that follows from it, for the exact motion started beside the limit cycle. \
        Ring: argument of the half-period Floquet multiplier at the secondary Hopf point. After the torus has doubled, the angle counts turns around the mean and the period is that of a single turn.",
    revision: 2,
    compute,
};

/// Where the nominal motion turns chaotic: there is no torus beyond.
const LOWEST: f64 = -0.148;
/// Between the rows from which the limit at the secondary Hopf point is taken: motions nearer to it settle too slowly.
const STEP: f64 = 0.001;

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let branch = branch_to_fold(case.parameters)?;
    let hopf = secondary_hopf(&branch).first().copied().copied();
    let hopf = hopf.ok_or_else(|| PaperError::missing("secondary Hopf point", case.parameters))?;
    let angle = hopf.rotation_angle().ok_or_else(|| PaperError::missing("secondary Hopf point", case.parameters))?;
    let start = hopf.parameters.xi1;
    let near = [1.0, 2.0, 3.0].map(|n| start - n * STEP);
    let mut xi1 = near.to_vec();
    xi1.extend(values(start - 4.0 * STEP, LOWEST.min(1.5 * start), case.choose(110, 8)));
    // Next to the Hopf point motions settle slowly: the rows of the limit are long in quick runs too.
    let long = Case { effort: Effort::Full, ..*case };
    let found: Vec<_> =
        xi1.par_iter().map(|xi1| rotation(if near.contains(xi1) { &long } else { case }, *xi1)).collect::<Vec<_>>();
    let mut rows = Vec::new();
    for (xi1, found) in xi1.iter().zip(found) {
        rows.extend(found?.map(|rotation| (*xi1, rotation)));
    }
    let mut findings = Findings::default();
    let limit = near_limit(&rows, near).unwrap_or(Limit { value: f64::NAN, uncertainty: 0.0 });
    findings.checks.push(case.nominal_only(Check::near(
        "rotation number at the secondary Hopf point, rad",
        angle,
        limit.value,
        limit.uncertainty,
        "argument of the Floquet multiplier there; extrapolated by a parabola through the three rows nearest by; what that leaves out is taken as no more than its own difference from a straight line, the measured curvature, and the errors of the three rows are added",
    )));
    findings.number(
        "extrapolated to the secondary Hopf point",
        format!("{:.7} ± {:.0e} rad; Floquet multiplier: {angle:.7} rad", limit.value, limit.uncertainty),
    );
    let worst = rows.iter().map(|row| row.1.rotation_error).fold(0.0, f64::max);
    findings.checks.push(case.nominal_only(Check::at_most("difference between halves of a window, worst row, rad", case.choose(1e-3, 1e-2), worst, "the average converges fast on a smooth torus; a thousandth of a radian is 0.4 % of the smallest angle (quick: shorter windows)")));
    let slow = |row: &(f64, Rotation)| row.1.slow_period;
    findings.verdict = verdict(&rows);
    findings.table(
        "rotation",
        numbers(vec![
            ("xi1", rows.iter().map(|row| row.0).collect()),
            ("rotation_number_rad", rows.iter().map(|row| row.1.rotation_number).collect()),
            ("rotation_error_rad", rows.iter().map(|row| row.1.rotation_error).collect()),
            ("slow_period", rows.iter().map(slow).collect()),
        ]),
    );
    if rows.is_empty() {
        return Ok(findings);
    }
    let number = rows.iter().map(|row| (row.0, row.1.rotation_number / TAU)).collect();
    let at_hopf = vec![(start, angle / TAU)];
    let panels = vec![
        Panel::new("ξ₁", "turns per half period").series(Series::new("torus", number, Style::Dots, Tint::Blue)).series(
            Series::new("Floquet multiplier at the secondary Hopf point", at_hopf, Style::Rings, Tint::Vermillion),
        ),
        Panel::new("ξ₁", "period of the modulation").series(Series::new(
            "",
            rows.iter().map(|row| (row.0, slow(row))).collect(),
            Style::Dots,
            Tint::Blue,
        )),
    ];
    findings.figure = Some(Figure::grid(2, (1160, 500), panels));
    Ok(findings)
}

/// A value at the secondary Hopf point; the uncertainty counts what the extrapolation leaves out.
struct Limit {
    value: f64,
    uncertainty: f64,
}

/// Extrapolates from the three rows nearest by, one, two and three steps beyond; `None` if one of them is missing.
fn near_limit(rows: &[(f64, Rotation)], near: [f64; 3]) -> Option<Limit> {
    let at = |xi1: f64| rows.iter().find(|row| row.0 == xi1).map(|row| row.1);
    let [one, two, three] = [at(near[0])?, at(near[1])?, at(near[2])?];
    let curvature = one.rotation_number - 2.0 * two.rotation_number + three.rotation_number;
    let value = 2.0 * one.rotation_number - two.rotation_number + curvature;
    // The weights of the errors are 3, 3 and 1.
    let errors = 3.0 * (one.rotation_error + two.rotation_error) + three.rotation_error;
    Some(Limit { value, uncertainty: curvature.abs() + errors })
}

fn verdict(rows: &[(f64, Rotation)]) -> String {
    let slow = |row: &(f64, Rotation)| format!("{:.2} at ξ₁ = {:.4}", row.1.slow_period, row.0);
    let largest = rows.iter().max_by(|a, b| a.1.slow_period.total_cmp(&b.1.slow_period));
    match (rows.first(), largest, rows.last()) {
        (Some(first), Some(largest), Some(last)) => format!(
            "The modulation's period goes from {} to {}; the longest in between is {}.",
            slow(first),
            slow(last),
            slow(largest)
        ),
        _ => "No torus was found.".to_owned(),
    }
}

/// `None` where the motion is no torus around the cycle.
fn rotation(case: &Case, xi1: f64) -> Result<Option<Rotation>, PaperError> {
    let parameters = case.at(xi1);
    let (flow, start) = beside_the_cycle(parameters)?;
    match torus_rotation(&flow, &start, settled(case, parameters, case.choose(8000.0, 1500.0))) {
        Ok(rotation) => Ok(Some(rotation)),
        Err(ChaosError::NotWinding { .. } | ChaosError::Diverged { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}
