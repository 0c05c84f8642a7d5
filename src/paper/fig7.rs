//! Fig. 7: phase plane (x1, x1') and section S of the slow flow with its fast motion restored, at the values of Fig. 6.
//!
//! What kind of motion a panel shows is decided by the period doublings of the slow flow, known from the multipliers of its limit cycles.

use super::check::Check;
use super::error::PaperError;
use super::exact::settled;
use super::fig6::XI1;
use super::item::{Case, Findings, Origin, PaperItem, numbers};
use super::slow::{beside_the_cycle, frequency};
use crate::averaging::EnergyFrequency;
use crate::chaos::{PoincareMap, PoincareSection, poincare_map};
use crate::dynamics::{DenseFlow, Motion};
use crate::report::{Figure, Panel, Series, Style, Tint};
use rayon::prelude::*;
use std::sync::Arc;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig7",
    origin: Origin::Paper("Fig. 7"),
    title: "Poincaré maps of the slow flow on S",
    caption: "As Fig. 6, from the slow flow with the fast oscillation restored by (4)-(5), started beside its own limit cycle, at the same values of ξ₁. \
        The averaged motion doubles earlier than the exact one: from ξ₁ = −0.106 on where the exact torus is simple up to −0.130, so the panels agree in shape with a shift in ξ₁.",
    revision: 1,
    compute,
};

const NAMES: [&str; 5] = ["(a)", "(b)", "(c)", "(d)", "(e)"];

struct Portrait {
    xi1: f64,
    phase: Vec<(f64, f64)>,
    map: PoincareMap,
    exact: PoincareMap,
}

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let frequency = frequency(case.parameters)?;
    let portraits: Vec<Result<Portrait, PaperError>> =
        XI1.par_iter().map(|&xi1| portrait(case, xi1, &frequency)).collect();
    let portraits = portraits.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut findings = Findings { checks: checks(case, &portraits), ..Findings::default() };
    for portrait in &portraits {
        let found = format!("{} points, largest x₁ {:.4}", portrait.map.points.len(), largest(&portrait.map));
        findings.number(&format!("ξ₁ = {}", portrait.xi1), found);
    }
    findings.verdict = "The sections have the shapes of the exact ones, shifted in ξ₁.".to_owned();
    let rows = || portraits.iter().flat_map(|p| p.map.points.iter().map(move |point| (p.xi1, point)));
    findings.table(
        "section",
        numbers(vec![
            ("xi1", rows().map(|row| row.0).collect()),
            ("t", rows().map(|row| row.1[0]).collect()),
            ("x1", rows().map(|row| row.1[1]).collect()),
            ("v1", rows().map(|row| row.1[3]).collect()),
            ("v2", rows().map(|row| row.1[4]).collect()),
        ]),
    );
    findings.figure = Some(Figure::grid(3, (1200, 830), portraits.into_iter().zip(NAMES).map(panel).collect()));
    Ok(findings)
}

fn portrait(case: &Case, xi1: f64, frequency: &Arc<EnergyFrequency>) -> Result<Portrait, PaperError> {
    let parameters = case.at(xi1);
    let (flow, start) = beside_the_cycle(parameters, frequency)?;
    let window = settled(case, parameters, case.choose(20_000.0, 2000.0));
    let map = poincare_map(&flow, &start, window, PoincareSection::Fast)?;
    let (exact_flow, exact_start) = super::exact::beside_the_cycle(parameters)?;
    let exact = poincare_map(&exact_flow, &exact_start, window, PoincareSection::Fast)?;
    let motion = flow.motion(&start, window.transient + 400.0)?;
    // A diverged motion ends earlier.
    let times = (0..8000).map(|n| window.transient + 0.05 * f64::from(n)).take_while(|time| *time <= motion.end());
    let phase = times
        .map(|time| motion.state(time).map(|state| (state.positions[0], state.velocities[0])))
        .collect::<Result<_, _>>()?;
    Ok(Portrait { xi1, phase, map, exact })
}

/// Largest |x1| on the section.
fn largest(map: &PoincareMap) -> f64 {
    map.points.iter().map(|point| point[1].abs()).fold(0.0, f64::max)
}

fn checks(case: &Case, portraits: &[Portrait]) -> Vec<Check> {
    let off = portraits.iter().flat_map(|p| &p.map.points).map(|point| point[2].abs()).fold(0.0, f64::max);
    let mut checks = vec![Check::at_most(
        "all points: |x₂| on S",
        1e-9,
        off,
        "crossings are closed in to rounding of times up to 1e5",
    )];
    for (portrait, name) in portraits.iter().zip(NAMES).take(2) {
        checks.push(case.nominal_only(Check::near(
            &format!("{name}: largest |x₁| on S against the exact motion, ratio"),
            1.0,
            largest(&portrait.map) / largest(&portrait.exact),
            0.1,
            "higher harmonics and the change of amplitude within a cycle are left out: of the order of kappa, 0.1",
        )));
    }
    checks
}

fn panel((portrait, name): (Portrait, &str)) -> Panel {
    let Portrait { xi1, phase, map, .. } = portrait;
    let points = map.points.iter().map(|point| (point[1], point[3])).collect();
    Panel::new("x₁", "x₁′")
        .titled(&format!("{name} ξ₁ = −{}", xi1.abs()))
        .x_range(-3.3, 3.3)
        .y_range(-3.3, 3.3)
        .series(Series::new("phase plane", phase, Style::Thin, Tint::LightGrey))
        .series(Series::new("points on S", points, Style::Cloud, Tint::Black))
}
