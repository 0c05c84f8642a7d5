//! Fig. 7: phase plane (x1, x1') and section S of the slow flow with its fast motion restored, at the values of Fig. 6.
//!
//! Each section is held against the exact one: by the largest |x1|, and by the largest distance of its points from the nearest exact point. The kind
//! of motion is classified by the separation of neighbours (`chaos`), of the slow and of the exact motion alike.

use super::check::Check;
use super::error::PaperError;
use super::exact::settled;
use super::fig6::XI1;
use super::item::{Case, Effort, Findings, Origin, PaperItem, numbers};
use super::slow::{beside_the_cycle, frequency};
use crate::averaging::EnergyFrequency;
use crate::chaos::{Criteria, MotionClass, PoincareMap, PoincareSection, classify, poincare_map};
use crate::dynamics::{DenseFlow, Motion};
use crate::report::{Figure, Panel, Series, Style, Tint};
use rayon::prelude::*;
use std::sync::Arc;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig7",
    origin: Origin::Paper("Fig. 7"),
    title: "Poincaré maps of the slow flow on S",
    caption: "As Fig. 6, from the slow flow with the fast oscillation restored by (4)-(5), started beside its own limit cycle, at the same values of ξ₁. \
        Whether they are the same motions is said below, panel by panel; kinds of motion are told by the separation of neighbours over the motion shown, where chaos with an exponent below some 3·10⁻⁴ counts as a torus, and so does a window of periodic slow motion.",
    revision: 3,
    compute,
};

const NAMES: [&str; 5] = ["(a)", "(b)", "(c)", "(d)", "(e)"];

struct Portrait {
    xi1: f64,
    phase: Vec<(f64, f64)>,
    map: PoincareMap,
    exact: PoincareMap,
    class: MotionClass,
    exact_class: MotionClass,
}

impl Portrait {
    /// Largest |x1| against that of the exact motion.
    fn ratio(&self) -> f64 {
        largest(&self.map) / largest(&self.exact)
    }

    /// Largest distance in (x1, x1') from a point of the slow flow's section to the nearest exact one.
    fn distance(&self) -> f64 {
        let squared = |a: &[f64], b: &[f64]| (a[1] - b[1]).powi(2) + (a[3] - b[3]).powi(2);
        let nearest = |point: &Vec<f64>| {
            self.exact.points.iter().map(|other| squared(point, other)).fold(f64::INFINITY, f64::min).sqrt()
        };
        self.map.points.iter().map(nearest).fold(0.0, f64::max)
    }

    /// The same kind of motion, nowhere farther off than the terms that averaging leaves out.
    fn agrees(&self, kappa: f64) -> bool {
        self.class == self.exact_class && self.distance() <= kappa * reach(&self.exact)
    }
}

/// Largest distance of a section from the origin of (x1, x1').
fn reach(map: &PoincareMap) -> f64 {
    map.points.iter().map(|point| point[1].hypot(point[3])).fold(0.0, f64::max)
}

fn class_name(class: MotionClass) -> &'static str {
    match class {
        MotionClass::Equilibrium => "equilibrium",
        MotionClass::LimitCycle => "limit cycle",
        MotionClass::Torus => "torus",
        MotionClass::Chaos => "chaos",
        MotionClass::Diverged => "diverged",
        MotionClass::Neutral => "neutral",
        MotionClass::NotSettled => "not settled",
    }
}

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let frequency = frequency(case.parameters)?;
    let portraits: Vec<Result<Portrait, PaperError>> =
        XI1.par_iter().map(|&xi1| portrait(case, xi1, &frequency)).collect();
    let portraits = portraits.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut findings = Findings { checks: checks(case, &portraits), ..Findings::default() };
    for portrait in &portraits {
        let found = format!(
            "{} (exact: {}), {} points, largest |x₁| {:.4} (exact: {:.4}), largest distance from the exact section {:.2}",
            class_name(portrait.class),
            class_name(portrait.exact_class),
            portrait.map.points.len(),
            largest(&portrait.map),
            largest(&portrait.exact),
            portrait.distance()
        );
        findings.number(&format!("ξ₁ = {}", portrait.xi1), found);
    }
    findings.verdict = match case.effort {
        Effort::Full => verdict(&portraits, case.parameters.kappa),
        Effort::Quick => {
            "Quick motions are too short to be told apart: a full run compares them with the exact ones.".to_owned()
        }
    };
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
    let criteria = Criteria::default();
    let class = classify(&flow, &start, window, &criteria)?.class;
    let exact_class = classify(&exact_flow, &exact_start, window, &criteria)?.class;
    Ok(Portrait { xi1, phase, map, exact, class, exact_class })
}

fn verdict(portraits: &[Portrait], kappa: f64) -> String {
    let of = |agree: bool| portraits.iter().zip(NAMES).filter(move |(p, _)| p.agrees(kappa) == agree);
    let names = |agree: bool| of(agree).map(|(_, name)| name).collect::<Vec<_>>().join(", ");
    let mut said = Vec::new();
    if of(true).next().is_some() {
        let off: Vec<String> = of(true).map(|(p, _)| format!("{:+.0} %", 100.0 * (p.ratio() - 1.0))).collect();
        said.push(format!("{}: as the exact section, largest |x₁| off by {}.", names(true), off.join(", ")));
    }
    if of(false).next().is_some() {
        let kinds: Vec<String> = of(false)
            .map(|(p, _)| format!("{} against {} (exact)", class_name(p.class), class_name(p.exact_class)))
            .collect();
        said.push(format!("{}: the sections differ at the same ξ₁; {}.", names(false), kinds.join(", ")));
    }
    said.join(" ")
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
        let reason =
            "averaging leaves out higher harmonics and the change of amplitude within a cycle: of the order of kappa";
        let kappa = case.parameters.kappa;
        let bound = kappa * reach(&portrait.exact);
        checks.push(Check::near(
            &format!("{name}: largest |x₁| on S against the exact motion, ratio"),
            1.0,
            portrait.ratio(),
            kappa,
            reason,
        ));
        checks.push(Check::at_most(
            &format!("{name}: distance from the exact section"),
            bound,
            portrait.distance(),
            reason,
        ));
        checks.push(Check::holds(
            &format!("{name}: kind of motion of the slow flow"),
            "torus",
            class_name(portrait.class),
            portrait.class == MotionClass::Torus,
            "between the secondary Hopf point and the first doubling of the slow flow's torus (Table 1)",
        ));
    }
    for (portrait, name) in portraits.iter().zip(NAMES).skip(2) {
        checks.push(Check::at_least(
            &format!("{name}: distance from the exact section"),
            case.parameters.kappa * reach(&portrait.exact),
            portrait.distance(),
            "the slow flow is past its cascade of doublings (Table 1), by more than the exact one in every panel: more lies between than the terms that averaging leaves out",
        ));
    }
    let (everywhere, bound_to_nominal) = checks.split_at(1);
    let mut checks = everywhere.to_vec();
    checks.extend(bound_to_nominal.iter().cloned().map(|check| decided_by_long_motions(case, check)));
    checks
}

/// Sections of quick motions have gaps, and neighbours have no time to separate.
fn decided_by_long_motions(case: &Case, check: Check) -> Check {
    match case.effort {
        Effort::Full => case.nominal_only(check),
        Effort::Quick => Check { passed: None, ..check },
    }
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
