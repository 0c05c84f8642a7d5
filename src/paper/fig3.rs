//! Fig. 3: describing function of the Jenkins element over the sticking angle.

use super::check::Check;
use super::error::PaperError;
use super::exact::divergence;
use super::item::{Case, Findings, Origin, PaperItem, numbers};
use crate::averaging::{DescribingFunction, PerturbedLimitCycle};
use crate::report::{Figure, Mark, Panel, Series, Style, Tint};
use std::f64::consts::{PI, TAU};

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig3",
    origin: Origin::Paper("Fig. 3"),
    title: "describing function of the Jenkins element",
    caption: "Equivalent stiffness and equivalent damping (times ω) of the Jenkins element over the sticking angle τ: π at the sticking limit, towards 0 for large amplitudes. \
        Shaded: angles that limit cycles have, by (25), beyond the self-excitation at which the exact motion diverges.",
    revision: 2,
    compute,
};

const POINTS: usize = 400;

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let angles: Vec<f64> = (1..=POINTS).map(|n| PI * n as f64 / POINTS as f64).collect();
    let values: Vec<DescribingFunction> = angles.iter().map(|tau| DescribingFunction::at_angle(*tau)).collect();
    let (stiffness, damping): (Vec<f64>, Vec<f64>) = values.iter().map(|d| (d.stiffness, d.damping)).unzip();
    let top = (0..POINTS).max_by(|a, b| damping[*a].total_cmp(&damping[*b])).unwrap_or(0);
    let diverges = divergence(case.parameters, case.choose(0.001, 0.005), -0.4)?;
    let edge = diverges.and_then(|xi1| PerturbedLimitCycle::of(&case.at(xi1))).map(|cycle| cycle.sticking_angle);
    let checks = vec![
        Check::near("largest ω·d_eq", 1.0 / PI, damping[top], 1e-12, "sin²τ/π, rounding; τ = π/2 is one of the points"),
        Check::near("at the angle", 0.5 * PI, angles[top], 1e-12, "where sin τ = 1"),
        Check::near("k_eq there", 0.5, stiffness[top], 1e-12, "(2τ − sin 2τ)/(2π) at π/2"),
        Check::near("k_eq at the sticking limit", 1.0, stiffness[POINTS - 1], 1e-12, "nothing slips at τ = π"),
    ];
    let mut findings = Findings { checks, ..Findings::default() };
    for amplitude in [1.05, 2.0, 7.0] {
        findings.checks.extend(quadrature_checks(amplitude));
    }
    if let (Some(xi1), Some(edge)) = (diverges, edge) {
        findings.number("divergence of the exact motion", format!("ξ₁ = {xi1:.3}, τ = {edge:.4} by (25)"));
    }
    findings.verdict =
        format!("Damping is largest, {:.6} = 1/π, at τ = π/2, where the stiffness is 1/2.", damping[top]);
    let line = |values: &[f64]| angles.iter().copied().zip(values.iter().copied()).collect();
    let mut panel = Panel::new("sticking angle τ, rad", "k_eq, ω·d_eq").x_range(0.0, PI).y_range(0.0, 1.05);
    if let Some(edge) = edge {
        let label = "diverges".to_owned();
        panel = panel.with(Mark::BandX { label, from: None, to: Some(edge), tint: Tint::LightGrey });
    }
    panel = panel
        .series(Series::new("equivalent stiffness k_eq", line(&stiffness), Style::Line, Tint::Blue))
        .series(Series::new("equivalent damping ω·d_eq", line(&damping), Style::Line, Tint::Vermillion));
    findings.figure = Some(Figure::single(panel));
    let amplitudes = values.iter().map(|d| d.amplitude).collect();
    findings
        .table("describing", numbers(vec![("tau", angles), ("a", amplitudes), ("keq", stiffness), ("w_deq", damping)]));
    Ok(findings)
}

/// Steps of the quadrature over a period.
const STEPS: u32 = 20_000;

/// First harmonic of the force for `x = a cos psi`: the force follows each step of x and is cut off at 1, the law itself.
/// Returns `keq` and `w deq`, the parts in phase with x and with its rate.
fn harmonic(a: f64) -> [f64; 2] {
    let step = TAU / f64::from(STEPS);
    let (mut x, mut force) = (a, 1.0_f64);
    let mut sums = [0.0, 0.0];
    // The first period brings the force to its steady cycle.
    for n in 1..=2 * STEPS {
        let (sine, cosine) = (step * f64::from(n)).sin_cos();
        force = (force + a * cosine - x).clamp(-1.0, 1.0);
        x = a * cosine;
        if n > STEPS {
            sums = [sums[0] + force * cosine, sums[1] - force * sine];
        }
    }
    sums.map(|sum| 2.0 * sum / (f64::from(STEPS) * a))
}

fn quadrature_checks(a: f64) -> [Check; 2] {
    let (of, [stiffness, damping]) = (DescribingFunction::at(a), harmonic(a));
    // Trapezoids err by h^2/12 times the jumps of slope, a sin tau at each of two kinks a period, divided by pi a.
    let tolerance = (TAU / f64::from(STEPS)).powi(2);
    let reason = "quadrature of the hysteresis cycle, traced by the friction law itself; trapezoids across two kinks err by less than the square of the step";
    [
        Check::near(&format!("k_eq at a = {a}"), stiffness, of.stiffness, tolerance, reason),
        Check::near(&format!("ω·d_eq at a = {a}"), damping, of.damping, tolerance, reason),
    ]
}
