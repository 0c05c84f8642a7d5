//! Beyond the paper: how the torus turns, its rotation number per half period of the fast oscillation over xi1.
//!
//! At the secondary Hopf point it must start with the argument of the half-period multiplier on the unit circle: an independent
//! number, from the derivative of the return map of the limit cycle.

use super::check::Check;
use super::error::PaperError;
use super::exact::{beside_the_cycle, branch_to_fold, secondary_hopf, settled, values};
use super::item::{Case, Findings, Origin, PaperItem, numbers};
use crate::chaos::{ChaosError, Rotation, torus_rotation};
use crate::report::{Figure, Panel, Series, Style, Tint};
use rayon::prelude::*;
use std::f64::consts::TAU;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "rotation",
    origin: Origin::Beyond,
    title: "rotation number of the torus over ξ₁",
    caption: "Mean angle by which the torus turns from one reversal of mass 1 to the next, over 2π, and the period of the modulation that follows from it, for the exact motion started beside the limit cycle. \
        Ring: argument of the half-period Floquet multiplier at the secondary Hopf point. After the torus has doubled, the angle counts turns around the mean and the period is that of a single turn.",
    revision: 1,
    compute,
};

/// Where the nominal motion turns chaotic: there is no torus beyond.
const LOWEST: f64 = -0.148;

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let branch = branch_to_fold(case.parameters)?;
    let hopf = secondary_hopf(&branch).first().copied().copied();
    let hopf = hopf.ok_or_else(|| PaperError::missing("secondary Hopf point", case.parameters))?;
    let angle = hopf.rotation_angle().ok_or_else(|| PaperError::missing("secondary Hopf point", case.parameters))?;
    let start = hopf.parameters.xi1;
    let (near, far) = (0.002, 0.004);
    let mut xi1 = vec![start - near, start - far];
    xi1.extend(values(start - 0.006, LOWEST.min(1.5 * start), case.choose(110, 8)));
    let found: Vec<_> = xi1.par_iter().map(|&xi1| rotation(case, xi1)).collect::<Vec<_>>();
    let mut rows = Vec::new();
    for (xi1, found) in xi1.iter().zip(found) {
        rows.extend(found?.map(|rotation| (*xi1, rotation)));
    }
    let mut findings = Findings::default();
    if let [(_, one), (_, two), ..] = rows.as_slice() {
        let extrapolated = 2.0 * one.rotation_number - two.rotation_number;
        let first_order = (two.rotation_number - one.rotation_number).abs();
        findings.checks.push(case.nominal_only(Check::near(
            "rotation number at the secondary Hopf point, rad",
            angle,
            extrapolated,
            0.25 * first_order + one.rotation_error + two.rotation_error,
            "argument of the Floquet multiplier there; extrapolated linearly from 0.002 and 0.004 beyond, the second-order term taken as at most a quarter of the first",
        )));
        findings.number(
            "extrapolated to the secondary Hopf point",
            format!("{extrapolated:.7} rad; Floquet multiplier: {angle:.7} rad"),
        );
    }
    let worst = rows.iter().map(|row| row.1.rotation_error).fold(0.0, f64::max);
    findings.checks.push(case.nominal_only(Check::at_most("difference between halves of a window, worst row, rad", case.choose(1e-3, 1e-2), worst, "the average converges fast on a smooth torus; a thousandth of a radian is 0.4 % of the smallest angle (quick: shorter windows)")));
    let slow = |row: &(f64, Rotation)| row.1.slow_period;
    findings.verdict = match (rows.first(), rows.last()) {
        (Some(first), Some(last)) => format!(
            "The modulation's period goes from {:.2} at ξ₁ = {:.4} to {:.2} at {:.4}.",
            slow(first),
            first.0,
            slow(last),
            last.0
        ),
        _ => "No torus was found.".to_owned(),
    };
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
        Panel::new("ξ₁", "rotation number / 2π").series(Series::new("torus", number, Style::Dots, Tint::Blue)).series(
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
