//! Fig. 8: mean-free slow amplitudes and their section D = {a2~ = 0, a2~' > 0}.
//!
//! The slow amplitudes are those of the slow flow itself, not of an envelope, so that the points of a cycle coincide to the accuracy of integration.

use super::check::Check;
use super::error::PaperError;
use super::exact::settled;
use super::item::{Case, Effort, Findings, Origin, PaperItem, numbers};
use super::slow::{beside_the_cycle, frequency};
use crate::averaging::{AveragingError, EnergyFrequency, SlowMotion};
use crate::dynamics::{DenseFlow, Motion};
use crate::report::{Figure, Panel, Series, Style, Tint};
use rayon::prelude::*;
use std::sync::Arc;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig8",
    origin: Origin::Paper("Fig. 8"),
    title: "slow amplitudes and their doublings",
    caption: "Slow amplitudes of both masses about their means (grey) and the points at which ã₂ passes 0 upwards (black), slow flow started beside its limit cycle. \
        A torus that is a limit cycle of the slow flow leaves one point, doubled once two, and so on; how many there are in each panel, and that (e) repeats after no number of passages, is said below. \
        Points nearer than 10⁻³ in ã₁ count as one, so the number for a motion that never repeats depends on how long it is watched and has no meaning of its own.",
    revision: 2,
    compute,
};

/// Between the secondary Hopf point and the first doubling, between doublings, and beyond the fifth at -0.13495 (mean potential).
const XI1: [f64; 5] = [-0.055, -0.115, -0.13, -0.134, -0.1365];
const POINTS: [usize; 4] = [1, 2, 4, 8];
const NAMES: [&str; 5] = ["(a)", "(b)", "(c)", "(d)", "(e)"];
const STEP: f64 = 0.25;
/// Points nearer than this are one: far above the accuracy of a settled cycle, far below the distances after the third doubling, 0.01.
const TOGETHER: f64 = 1e-3;

struct Portrait {
    xi1: f64,
    path: Vec<(f64, f64)>,
    section: Vec<(f64, f64)>,
}

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let frequency = frequency(case.parameters)?;
    let portraits: Vec<Result<Portrait, PaperError>> =
        XI1.par_iter().map(|&xi1| portrait(case, xi1, &frequency)).collect();
    let portraits = portraits.into_iter().collect::<Result<Vec<_>, _>>()?;
    let counts: Vec<usize> = portraits.iter().map(|p| distinct(&p.section)).collect();
    let mut findings = Findings { checks: checks(case, &portraits, &counts), ..Findings::default() };
    for (portrait, count) in portraits.iter().zip(&counts) {
        let (passages, (longest, off)) = (portrait.section.len(), recurrence(&portrait.section));
        let found = match repeats(&portrait.section) {
            Some(cycle) => format!("{count} points on D in {passages} passages, repeats after {cycle}"),
            None => format!(
                "{count} groups of points on D in {passages} passages; after no number up to {longest} does it repeat nearer than {off:.1e}"
            ),
        };
        findings.number(&format!("ξ₁ = {}", portrait.xi1), found);
    }
    let shown: Vec<String> = portraits
        .iter()
        .zip(NAMES)
        .map(|(p, name)| match (repeats(&p.section), recurrence(&p.section).0) {
            (Some(cycle), _) => format!("{name} {cycle}"),
            (None, longest) => format!("{name} more than {longest}"),
        })
        .collect();
    findings.verdict = format!("Passages of D after which the slow amplitudes repeat: {}.", shown.join(", "));
    let rows = || portraits.iter().flat_map(|p| p.section.iter().map(move |point| (p.xi1, point)));
    findings.table(
        "section",
        numbers(vec![
            ("xi1", rows().map(|row| row.0).collect()),
            ("a1_deviation", rows().map(|row| row.1.0).collect()),
            ("a2_rate", rows().map(|row| row.1.1).collect()),
        ]),
    );
    findings.figure = Some(Figure::grid(3, (1200, 830), portraits.into_iter().zip(NAMES).map(panel).collect()));
    Ok(findings)
}

fn portrait(case: &Case, xi1: f64, frequency: &Arc<EnergyFrequency>) -> Result<Portrait, PaperError> {
    let (flow, start) = beside_the_cycle(case.at(xi1), frequency)?;
    let window = settled(case, case.at(xi1), case.choose(12_000.0, 6000.0));
    let motion = flow.motion(&start, window.end())?;
    let steps = ((motion.end() - window.transient) / STEP).max(0.0) as usize;
    let times: Vec<f64> = (0..=steps).map(|n| window.transient + n as f64 * STEP).collect();
    let amplitudes = times.iter().map(|time| moduli(&motion, *time)).collect::<Result<Vec<_>, _>>()?;
    let mean = |mass: usize| amplitudes.iter().map(|a| a[mass]).sum::<f64>() / amplitudes.len() as f64;
    let means = [mean(0), mean(1)];
    let mut section = Vec::new();
    for (pair, time) in amplitudes.windows(2).zip(&times) {
        if pair[0][1] < means[1] && pair[1][1] >= means[1] {
            section.push(passage(&motion, means, *time)?);
        }
    }
    // The last cycles are enough to be seen.
    let shown = amplitudes.len().saturating_sub((3000.0 / STEP) as usize);
    let path = amplitudes[shown..].iter().map(|a| (a[0] - means[0], a[1] - means[1])).collect();
    Ok(Portrait { xi1, path, section })
}

fn moduli(motion: &SlowMotion, time: f64) -> Result<[f64; 2], AveragingError> {
    Ok(motion.slow_state(time)?.amplitudes.map(|a| a.norm()))
}

/// `(a1~, a2~')` where a2 passes its mean within a step after `time`, by halving.
fn passage(motion: &SlowMotion, means: [f64; 2], time: f64) -> Result<(f64, f64), AveragingError> {
    let (mut low, mut high) = (time, time + STEP);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if moduli(motion, middle)?[1] < means[1] { low = middle } else { high = middle }
    }
    let (before, after) = (moduli(motion, time)?, moduli(motion, time + STEP)?);
    Ok((moduli(motion, high)?[0] - means[0], (after[1] - before[1]) / STEP))
}

/// Number of groups of points whose first coordinates lie together.
fn distinct(section: &[(f64, f64)]) -> usize {
    let mut values: Vec<f64> = section.iter().map(|point| point.0).collect();
    values.sort_by(f64::total_cmp);
    let gaps = values.windows(2).filter(|pair| pair[1] - pair[0] > TOGETHER).count();
    if values.is_empty() { 0 } else { gaps + 1 }
}

/// Largest distance in a1 between passages that lie `cycle` apart.
fn distance_after(section: &[(f64, f64)], cycle: usize) -> f64 {
    section.iter().zip(&section[cycle..]).map(|(a, b)| (a.0 - b.0).abs()).fold(0.0, f64::max)
}

/// The least number of passages, up to half of all, after which the motion repeats.
fn repeats(section: &[(f64, f64)]) -> Option<usize> {
    (1..=section.len() / 2).find(|cycle| distance_after(section, *cycle) < TOGETHER)
}

/// The largest number of passages tried, and the distance of the best repeat; not a number without passages.
fn recurrence(section: &[(f64, f64)]) -> (usize, f64) {
    let longest = section.len() / 2;
    (longest, (1..=longest).map(|cycle| distance_after(section, cycle)).fold(f64::NAN, f64::min))
}

fn checks(case: &Case, portraits: &[Portrait], counts: &[usize]) -> Vec<Check> {
    let mut checks: Vec<Check> = counts
        .iter()
        .zip(POINTS)
        .zip(NAMES)
        .map(|((found, expected), name)| {
            let reason = "a cycle of period 2ⁿ passes D that often; doublings are known from multipliers (Table 1)";
            Check::near(&format!("{name}: points on D"), expected as f64, *found as f64, 0.0, reason)
        })
        .collect();
    for ((portrait, expected), name) in portraits.iter().zip(POINTS).zip(NAMES) {
        let found = repeats(&portrait.section).map_or(f64::NAN, |cycle| cycle as f64);
        let reason = "a cycle of period 2ⁿ is the same after 2ⁿ passages and not before";
        checks.push(Check::near(&format!("{name}: repeats after"), expected as f64, found, 0.0, reason));
    }
    if let Some(last) = portraits.get(POINTS.len()) {
        let (longest, off) = recurrence(&last.section);
        let reason = "the repeats of (a) to (d) are found by the same measure; half of the passages can be held against later ones";
        checks.push(Check::at_least("(e): nearest repeat after any number of passages", TOGETHER, off, reason));
        let reason = "more than the 32 of a cycle of the fifth doubling, the last that is known (Table 1)";
        let tried = Check::at_least("(e): numbers of passages tried", 33.0, longest as f64, reason);
        // A quick motion is too short for that.
        checks.push(if case.effort == Effort::Full { tried } else { Check { passed: None, ..tried } });
    }
    checks.into_iter().map(|check| case.nominal_only(check)).collect()
}

fn panel((portrait, name): (Portrait, &str)) -> Panel {
    let Portrait { xi1, path, section } = portrait;
    let points = section.into_iter().map(|point| (point.0, 0.0)).collect();
    Panel::new("ã₁", "ã₂")
        .titled(&format!("{name} ξ₁ = −{}", xi1.abs()))
        .series(Series::new("slow amplitudes", path, Style::Thin, Tint::LightGrey))
        .series(Series::new("points on D", points, Style::Dots, Tint::Black))
}
