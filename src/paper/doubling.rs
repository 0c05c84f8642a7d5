//! Beyond the paper: does the torus of the exact system double as that of the slow flow (Table 1)?
//!
//! The torus is cut twice: by the reversals of both masses (envelopes), then where the envelope of mass 2 passes its mean upwards. A
//! torus leaves one point there (resolved to some 2e-4 by the cubic interpolation of the envelopes), a doubled one two, and so on. With
//! p_n the n-th point,
//!
//! ```text
//! S_i = rms |p_(n + 2^(i-1)) - p_n|
//! ```
//!
//! leaves that floor at the i-th doubling. Splitting grows as the square root of the distance, so S_i^2 is linear in xi1, and the
//! doubling is where the line through two points just beyond meets zero.

use super::check::Check;
use super::error::PaperError;
use super::exact::{beside_the_cycle, spectrum, values};
use super::item::{Case, Findings, Origin, PaperItem, numbers};
use crate::chaos::{PoincareSection, Window, poincare_map};
use crate::report::{Figure, Mark, Panel, Series, Style, Tint};
use rayon::prelude::*;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "doubling",
    origin: Origin::Beyond,
    title: "doublings of the exact torus",
    caption: "Exact counterpart of Table 1. Left: points of the doubly cut torus (reversals, then the mean of the envelope of mass 2 passed upwards) over ξ₁. One point per torus, two after its first doubling, four after the second. \
        Right: split of the points that the i-th doubling separates, with the level taken for resolved; the envelopes are interpolated, which leaves the floor near 2·10⁻⁴. Doublings are extrapolated from the growth of the split as the square root of the distance.",
    revision: 1,
    compute,
};

/// A split above this is resolved: ten times the floor measured where the torus is single.
const RESOLVED: f64 = 2e-3;
const FROM: f64 = -0.12;
const TO: f64 = -0.155;
/// Doublings looked for: the third split is some 1e-3 wide in xi1, the fourth would need a longer section than resolves it.
const MOST: usize = 3;
const HALVINGS: usize = 16;

type Points = Vec<(f64, f64)>;

/// A doubling with the place where its split was first resolved, the bracket of the extrapolation.
struct Doubling {
    xi1: f64,
    resolved: f64,
}

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let xi1 = values(FROM, TO, case.choose(281, 29));
    let sections: Vec<Result<Option<Points>, PaperError>> = xi1.par_iter().map(|&xi1| section(case, xi1)).collect();
    let sections = sections.into_iter().collect::<Result<Vec<_>, _>>()?;
    let rows: Vec<(f64, &Points)> =
        xi1.iter().zip(&sections).filter_map(|(xi1, s)| Some((*xi1, s.as_ref()?))).collect();
    let found = doublings(case, &rows)?;
    let mut findings = Findings { checks: checks(case, &rows, &found)?, ..Findings::default() };
    let mut previous: Option<&[Doubling]> = None;
    for (n, doubling) in found.iter().enumerate() {
        let bracket = (doubling.xi1 - doubling.resolved).abs();
        findings.number(
            &format!("doubling {}", n + 1),
            format!("ξ₁ = {:.5} (split resolved {bracket:.0e} beyond)", doubling.xi1),
        );
        previous = Some(&found[..=n]);
    }
    if let Some([.., a, b, c]) = previous {
        findings.number("ratio of successive gaps", format!("{:.2}", (a.xi1 - b.xi1) / (b.xi1 - c.xi1)));
    }
    findings.number("Table 1, slow flow of the paper", "−0.105575, −0.126635, −0.132058, …");
    let places: Vec<String> = found.iter().map(|doubling| format!("{:.4}", doubling.xi1)).collect();
    findings.verdict = if places.is_empty() {
        "No doubling of the exact torus was resolved.".to_owned()
    } else {
        format!("The exact torus doubles too, at ξ₁ = {}: later than the slow flow's.", places.join(", "))
    };
    let split = |i: u32| rows.iter().map(|row| split(row.1, i)).collect::<Vec<_>>();
    findings.table(
        "splits",
        numbers(vec![
            ("xi1", rows.iter().map(|row| row.0).collect()),
            ("points", rows.iter().map(|row| row.1.len() as f64).collect()),
            ("split_1", split(1)),
            ("split_2", split(2)),
            ("split_3", split(3)),
        ]),
    );
    findings.figure = (!rows.is_empty()).then(|| figure(&rows, &found));
    Ok(findings)
}

/// Points (a1~, rate of a2~) after a long transient: near a doubling motions settle slowly. `None` where the motion diverges.
fn section(case: &Case, xi1: f64) -> Result<Option<Points>, PaperError> {
    let (flow, start) = beside_the_cycle(case.at(xi1))?;
    let window =
        case.choose(Window { transient: 20_000.0, length: 16_000.0 }, Window { transient: 5000.0, length: 5000.0 });
    let map = poincare_map(&flow, &start, window, PoincareSection::Slow)?;
    let bounded = map.outcome == crate::dynamics::Outcome::Completed;
    Ok(bounded.then(|| map.points.iter().map(|point| (point[1], point[2])).collect()))
}

/// S_i of the module.
fn split(points: &Points, doubling: u32) -> f64 {
    let later = 2_usize.pow(doubling - 1);
    let squares: Vec<f64> =
        points.iter().zip(points.iter().skip(later)).map(|(p, q)| (q.0 - p.0).powi(2) + (q.1 - p.1).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

fn doublings(case: &Case, rows: &[(f64, &Points)]) -> Result<Vec<Doubling>, PaperError> {
    let mut found: Vec<Doubling> = Vec::new();
    for i in 1..=MOST as u32 {
        // Split by this doubling and not yet by the next: neither single nor chaotic.
        let regular = |points: &Points| split(points, i + 1) < 0.5 * split(points, i);
        let Some(n) = rows.iter().position(|row| split(row.1, i) > RESOLVED) else { break };
        if n == 0 || !regular(rows[n].1) {
            break;
        }
        let split_at = |xi1: f64| Ok::<_, PaperError>(section(case, xi1)?.map_or(f64::NAN, |points| split(&points, i)));
        let (mut single, mut split_there) = (rows[n - 1].0, rows[n].0);
        for _ in 0..case.choose(HALVINGS, 5) {
            let middle = 0.5 * (single + split_there);
            if split_at(middle)? > RESOLVED { split_there = middle } else { single = middle }
        }
        // A second point on the square-root law, where the split is about twice as large.
        let resolved = split_there;
        let first = split_at(resolved)?;
        let mut step = 1e-6;
        let mut second = split_at(resolved - step)?;
        while second < 2.0 * first && step < 1e-3 {
            step *= 2.0;
            second = split_at(resolved - step)?;
        }
        let rate = (second * second - first * first) / step;
        found.push(Doubling { xi1: resolved + first * first / rate, resolved });
    }
    Ok(found)
}

fn checks(case: &Case, rows: &[(f64, &Points)], found: &[Doubling]) -> Result<Vec<Check>, PaperError> {
    let floor = rows.iter().take_while(|row| row.0 > -0.128).map(|row| split(row.1, 1)).fold(0.0, f64::max);
    let exponents = spectrum(case, case.at(-0.14))?.map_or(vec![f64::NAN; 2], |spectrum| spectrum.exponents);
    let zero = exponents.iter().take(2).map(|l| l.abs()).fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) });
    let (first, last) = (found.first().map_or(f64::NAN, |d| d.xi1), found.last().map_or(f64::NAN, |d| d.xi1));
    Ok(vec![
        case.nominal_only(Check::at_most("split where the torus is single (the resolution)", 0.5 * RESOLVED, floor, "half the level taken for resolved: what counts as split is no interpolation error")),
        case.nominal_only(Check::at_least("doublings resolved", 2.0, found.len() as f64, "a cascade is claimed only if at least two doublings follow each other")),
        case.nominal_only(Check::holds("first doubling lies beyond the slow flow's", "ξ₁ below −0.105575", first, first < -0.105_575, "the paper: consistent with the original system but shifted below −0.12")),
        case.nominal_only(Check::at_least("last doubling lies before chaos", -0.1525, last, "the paper finds chaos from about −0.15 on; half a unit of its last digit, halved")),
        case.nominal_only(Check::near("doubled torus at ξ₁ = −0.14: larger of |l₁|, |l₂|", 0.0, zero, case.choose(2.5e-4, 2.5e-3), "a doubled torus is a torus: two zero exponents (a twentieth of the exponent 0.005 in chaos; quick: a half)")),
    ])
}

fn figure(rows: &[(f64, &Points)], found: &[Doubling]) -> Figure {
    let points = rows.iter().flat_map(|row| row.1.iter().map(|point| (row.0, point.0))).collect();
    let split = |i: u32| rows.iter().map(|row| (row.0, split(row.1, i))).collect();
    let at = |y: f64| found.iter().map(|doubling| (doubling.xi1, y)).collect::<Vec<_>>();
    let level = vec![(FROM, RESOLVED), (TO, RESOLVED)];
    let left = Panel::new("ξ₁", "mean-free a₁ on the section").x_range(TO, FROM).series(Series::new(
        "",
        points,
        Style::Cloud,
        Tint::Black,
    ));
    let right = Panel::new("ξ₁", "split of the points")
        .log_y()
        .x_range(TO, FROM)
        .with(Mark::BandY { label: "not resolved".to_owned(), from: None, to: Some(RESOLVED), tint: Tint::LightGrey })
        .series(Series::new("", level, Style::Thin, Tint::Grey))
        .series(Series::new("first doubling", split(1), Style::Dots, Tint::Blue))
        .series(Series::new("second", split(2), Style::Dots, Tint::Orange))
        .series(Series::new("third", split(3), Style::Dots, Tint::Green))
        .series(Series::new("extrapolated to zero", at(RESOLVED), Style::Rings, Tint::Vermillion));
    Figure::grid(2, (1160, 540), vec![left, right])
}
