//! Beyond the paper: the Lyapunov spectrum over xi1, with exact tangents.
//!
//! The paper takes earlier estimates, made by a method for smooth systems, "with caution". Here the tangent of the piecewise linear flow
//! with its saltation at the switches is exact. One direction is wiped out by slip; four exponents remain, one of them 0 along the flow.

use super::check::Check;
use super::error::PaperError;
use super::exact::{flow, spectrum, values};
use super::item::{Case, Findings, Origin, PaperItem, numbers};
use crate::chaos::LyapunovSpectrum;
use crate::model::RigParameters;
use crate::orbit::limit_cycle;
use crate::report::{Figure, Panel, Series, Style, Tint};
use rayon::prelude::*;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "lyapunov",
    origin: Origin::Beyond,
    title: "Lyapunov exponents over ξ₁",
    caption: "The four finite Lyapunov exponents of the exact motion started beside the limit cycle, from exact tangents over 30 000 time units (upper panel), and the three largest enlarged (lower). \
        Limit cycle: l₁ = 0 alone; torus: l₁ = l₂ = 0; chaos: l₁ > 0. Where l₁ falls back to 0 beyond the first chaos and l₃ < 0, the motion is regular; where l₁, l₂, l₃ are all 0 within their errors it is left undecided. The fifth exponent is −∞: slip wipes out one direction.",
    revision: 4,
    compute,
};

/// Where the nominal motion diverges, nearly.
const LOWEST: f64 = -0.164;
/// An exponent counts as positive above this many standard errors and above [`ZERO`].
const SIGNIFICANT: f64 = 5.0;
/// Largest exponent taken for zero. A mean over T = 30 000 has a remainder ln(c)/T, with c by how much the stretch between two states differs
/// over the attractor: speeds differ by a factor of 10 at most, ln(10)/30 000 = 8e-5; rounded up.
pub(super) const ZERO: f64 = 1e-4;

/// What an exponent and its standard error tell of its sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sign {
    /// Not told from 0.
    Zero,
    /// More than three standard errors above, but not [`SIGNIFICANT`] many.
    Likely,
    Positive,
}

fn sign(s: &LyapunovSpectrum) -> Sign {
    let above = |errors: f64| s.exponents[0] > ZERO.max(errors * s.standard_errors[0]);
    if above(SIGNIFICANT) {
        Sign::Positive
    } else if above(3.0) {
        Sign::Likely
    } else {
        Sign::Zero
    }
}

/// Beyond doubt.
pub(super) fn positive(s: &LyapunovSpectrum) -> bool {
    sign(s) == Sign::Positive
}

/// Neither chaos nor, with l3 < 0, a torus or a cycle.
fn undecided(s: &LyapunovSpectrum) -> bool {
    s.exponents.iter().zip(&s.standard_errors).take(3).all(|(l, error)| l.abs() <= ZERO.max(2.0 * error))
}

/// Where the largest exponent leaves zero, with every row between its last zero and its first positive value.
fn onset(rows: &[(f64, &LyapunovSpectrum)]) -> String {
    let first = |sought: Sign| rows.iter().position(|row| sign(row.1) == sought);
    let value = |s: &LyapunovSpectrum| format!("{:.4} ± {:.4}", s.exponents[0], s.standard_errors[0]);
    let Some(positive) = first(Sign::Positive) else { return "No positive exponent was found".to_owned() };
    let left = first(Sign::Likely).map_or(positive, |likely| likely.min(positive));
    let zero = left.checked_sub(1).map(|last| format!("l₁ = 0 within its error down to ξ₁ = {:.4}", rows[last].0));
    let between = rows[left..positive].iter().map(|row| format!("{} at {:.4}", value(row.1), row.0));
    let (xi1, found) = rows[positive];
    let beyond = format!("beyond {SIGNIFICANT} standard errors first at {xi1:.4} ({})", value(found));
    zero.into_iter().chain(between).chain([beyond]).collect::<Vec<_>>().join("; ")
}

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let xi1 = values(-0.02, LOWEST, case.choose(145, 13));
    let found: Vec<Result<_, PaperError>> =
        xi1.par_iter().map(|&xi1| Ok((xi1, spectrum(case, case.at(xi1))?))).collect();
    let found: Vec<(f64, Option<LyapunovSpectrum>)> = found.into_iter().collect::<Result<_, _>>()?;
    let rows: Vec<(f64, &LyapunovSpectrum)> = found.iter().filter_map(|(xi1, s)| Some((*xi1, s.as_ref()?))).collect();
    if rows.is_empty() {
        return Err(PaperError::missing("bounded motion beside the limit cycle", case.parameters));
    }
    let mut findings = Findings { checks: checks(case, &rows)?, ..Findings::default() };
    let changes: Vec<String> = rows
        .windows(2)
        .filter(|pair| positive(pair[0].1) != positive(pair[1].1))
        .map(|pair| format!("{:.4} ({})", 0.5 * (pair[0].0 + pair[1].0), if positive(pair[1].1) { "+" } else { "0" }))
        .collect();
    let spacing = (xi1[1] - xi1[0]).abs();
    findings.number("sign of l₁ changes at ξ₁ =", format!("{} (to {spacing:.4})", changes.join(", ")));
    let beyond = rows.iter().skip_while(|row| !positive(row.1)).filter(|row| undecided(row.1));
    let beyond: Vec<String> = beyond.map(|row| format!("{:.4}", row.0)).collect();
    let beyond = if beyond.is_empty() { "none".to_owned() } else { beyond.join(", ") };
    findings
        .number("beyond the first chaos, l₁, l₂ and l₃ all 0 within two standard errors (undecided) at ξ₁ =", beyond);
    findings.verdict = format!("{}.", onset(&rows));
    let column = |n: usize| rows.iter().map(|row| row.1.exponents.get(n).copied().unwrap_or(f64::NAN)).collect();
    let error = |n: usize| rows.iter().map(|row| row.1.standard_errors.get(n).copied().unwrap_or(f64::NAN)).collect();
    findings.table(
        "exponents",
        numbers(vec![
            ("xi1", rows.iter().map(|row| row.0).collect()),
            ("l1", column(0)),
            ("l2", column(1)),
            ("l3", column(2)),
            ("l4", column(3)),
            ("l1_error", error(0)),
            ("l2_error", error(1)),
            ("l3_error", error(2)),
            ("l4_error", error(3)),
        ]),
    );
    findings.figure = Some(figure(&rows));
    Ok(findings)
}

fn checks(case: &Case, rows: &[(f64, &LyapunovSpectrum)]) -> Result<Vec<Check>, PaperError> {
    let (cycle_at, chaos_at) = (case.at(-0.03), case.at(-0.155));
    let orbit = limit_cycle(cycle_at, flow)?;
    let multipliers = orbit.section_multipliers();
    let expected = multipliers[0].norm().ln() / (0.5 * orbit.period);
    let nearest = |xi1: f64| spectrum(case, RigParameters { xi1, ..case.parameters });
    let cycle = nearest(cycle_at.xi1)?;
    let chaos = nearest(chaos_at.xi1)?;
    let exponent = |s: &Option<LyapunovSpectrum>, n: usize| {
        s.as_ref().and_then(|s| s.exponents.get(n).copied()).unwrap_or(f64::NAN)
    };
    let significance = chaos.as_ref().map_or(f64::NAN, |s| s.exponents[0] / s.standard_errors[0]);
    let flat = |s: &LyapunovSpectrum| s.exponents.iter().map(|l| l.abs()).fold(f64::INFINITY, f64::min);
    let worst = rows.iter().map(|row| flat(row.1)).fold(0.0, f64::max);
    let vanished = rows.iter().all(|row| row.1.vanished == 1);
    Ok(vec![
        Check::near("exponent nearest to 0, worst of all rows", 0.0, worst, ZERO, "the direction along the flow neither grows nor shrinks; its mean over 30 000 time units keeps a remainder of at most ln(10)/30 000 = 8e-5 if speeds differ by a factor of 10, rounded up"),
        Check::holds("directions wiped out", "one everywhere", if vanished { "one everywhere" } else { "another number" }, vanished, "saltation I − e_f e_fᵀ at each stick-to-slip event"),
        case.nominal_only(Check::near("l₂ on the limit cycle, ξ₁ = −0.03", expected, exponent(&cycle, 1), 2e-5, "the leading Floquet multiplier of the orbit found by shooting, ln|m|/(T/2): another method; the frame turns with the complex pair, which leaves a bounded remainder divided by 30 000 time units")),
        case.nominal_only(Check::at_least("l₁ in chaos, ξ₁ = −0.155, in standard errors", SIGNIFICANT, significance, "the paper finds chaos from about −0.15 on; five standard errors by chance: 3e-7")),
    ])
}

fn figure(rows: &[(f64, &LyapunovSpectrum)]) -> Figure {
    let series =
        |n: usize| rows.iter().map(|row| (row.0, row.1.exponents.get(n).copied().unwrap_or(f64::NAN))).collect();
    let looks = [("l₁", Tint::Vermillion), ("l₂", Tint::Blue), ("l₃", Tint::Green), ("l₄", Tint::Grey)];
    let panel = |shown: usize| {
        // The legend names them in order; the largest is drawn last, on top.
        let base = looks
            .iter()
            .fold(Panel::new("damping of the in-phase mode ξ₁", "Lyapunov exponent"), |panel, (name, tint)| {
                panel.series(Series::new(name, Vec::new(), Style::Dots, *tint))
            });
        looks.iter().take(shown).enumerate().rev().fold(base, |panel, (n, (_, tint))| {
            panel.series(Series::new("", series(n), Style::Thin, *tint)).series(Series::new(
                "",
                series(n),
                Style::Dots,
                *tint,
            ))
        })
    };
    let low = rows.last().map_or(LOWEST, |row| row.0);
    let close = panel(3).titled("the three largest, enlarged").x_range(low - 0.002, -0.018).y_range(-0.012, 0.012);
    Figure::grid(1, (1000, 860), vec![panel(4).x_range(low - 0.002, -0.018), close])
}
