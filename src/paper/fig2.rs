//! Fig. 2: the rig, the Jenkins element, and its hysteresis cycle under prescribed motion, from the simulated rig.
//!
//! With `x1 = a sin(w t)`, a > 1, started with the spring relaxed: the force follows x1 until it slips at 1, and from the first
//! reversal on runs round a loop of area `4 (a - 1)`.

use super::check::Check;
use super::error::PaperError;
use super::item::{Case, Findings, Origin, PaperItem, numbers};
use super::schematic;
use crate::dynamics::{Flow, Sampling, State, Trajectory};
use crate::engine::{self, EngineSettings};
use crate::exact;
use crate::model::{PrescribedMotion, TwoMassRig};
use crate::report::{Figure, Panel, Series, Side, Style, Tint};

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig2",
    origin: Origin::Paper("Fig. 2"),
    title: "rig, Jenkins element and hysteresis",
    caption: "(a) The rig: two unit masses on the ground springs 1 − γ and 1, coupled by κ; dampers with the damping ξ₁ of the in-phase and ξ₂ of the out-of-phase mode. \
        (b) The Jenkins element: a spring of stiffness γ in series with a slider that holds up to the force γ. \
        (c) Its force over the elongation, in units of γ, as Rapier simulates the rig with mass 1 moved as x₁ = 2 sin t, from the relaxed state (initial loading) through two cycles; the closed form lies beneath.",
    revision: 3,
    compute,
};

const AMPLITUDE: f64 = 2.0;
const PERIODS: f64 = 2.0;
/// Steps of the engine in a period; the reversals fall on steps.
const STEPS: u32 = 400;

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let rig = TwoMassRig::new(case.at(-0.06))?;
    let motion = PrescribedMotion { amplitude: AMPLITUDE, angular_frequency: 1.0 };
    let period = std::f64::consts::TAU;
    let interval = period / f64::from(STEPS);
    let sampling = Sampling { interval, t_end: PERIODS * period };
    let start = State::two_mass([0.0, 0.0, motion.velocity(0.0), 0.0, 0.0]);
    let settings = EngineSettings::dividing(interval, interval);
    let simulated = engine::PrescribedFlow::new(rig.chain(), motion, settings)?.trajectory(&start, sampling)?;
    let exact = exact::PrescribedFlow::new(rig.chain(), motion)?.trajectory(&start, sampling)?;
    let (ours, reference) = (loop_of(&simulated), loop_of(&exact));
    let cycle = &ours[ours.len() - 1 - STEPS as usize..];
    let mut findings = Findings { checks: checks(&ours, &reference, cycle), ..Findings::default() };
    let area = area(cycle);
    findings.number("area of the cycle (Rapier)", format!("{area:.6}"));
    findings.verdict =
        format!("Simulated cycle and closed form agree; a cycle dissipates {area:.4}γ, expected 4(2 − 1)γ.");
    let column = |t: &[(f64, f64)], second: bool| t.iter().map(|p| if second { p.1 } else { p.0 }).collect::<Vec<_>>();
    findings.table(
        "hysteresis",
        numbers(vec![
            ("t", simulated.samples.iter().map(|sample| sample.time).collect()),
            ("x1", column(&ours, false)),
            ("f_rapier", column(&ours, true)),
            ("f_exact", column(&reference, true)),
        ]),
    );
    findings.figure = Some(Figure {
        panels: vec![schematic::rig(), schematic::jenkins_element(), hysteresis(ours, reference)],
        columns: 3,
        size: (1320, 440),
        ..Figure::single(Panel::new("", ""))
    });
    Ok(findings)
}

fn loop_of(trajectory: &Trajectory) -> Vec<(f64, f64)> {
    trajectory.samples.iter().map(|sample| (sample.state.positions[0], sample.state.slider_forces[0])).collect()
}

/// Area inside a closed cycle, by trapezoids: exact for pieces of straight lines whose corners are sampled.
fn area(cycle: &[(f64, f64)]) -> f64 {
    cycle.windows(2).map(|pair| 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0)).sum()
}

fn checks(ours: &[(f64, f64)], reference: &[(f64, f64)], cycle: &[(f64, f64)]) -> Vec<Check> {
    let difference = ours.iter().zip(reference).map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, f64::max);
    let loading = ours.iter().take_while(|p| p.0 < 1.0).map(|p| (p.1 - p.0).abs()).fold(0.0, f64::max);
    vec![
        Check::near(
            "area of the cycle, Rapier",
            4.0 * (AMPLITUDE - 1.0),
            area(cycle),
            1e-9,
            "work of a Coulomb slider, 4 (a − 1); for a = 2 slip begins as x₁ passes 0, on a step, so trapezoids cut no corner: rounding only",
        ),
        Check::at_most(
            "largest force difference, Rapier − closed form",
            1e-9,
            difference,
            "reversals fall on steps, so return mapping is exact at the samples; positions read back from the engine carry rounding only",
        ),
        Check::at_most(
            "initial loading: |f − x1| until x1 = 1",
            1e-9,
            loading,
            "from the relaxed state the stuck spring has stiffness 1; rounding only",
        ),
    ]
}

fn hysteresis(ours: Vec<(f64, f64)>, reference: Vec<(f64, f64)>) -> Panel {
    Panel::new("elongation x₁", "force / γ")
        .titled("(c) hysteresis cycle")
        .x_range(-2.3, 2.3)
        .y_range(-1.3, 1.3)
        .series(Series::new("closed form", reference, Style::Line, Tint::LightGrey))
        .series(Series::new("Rapier", ours.into_iter().step_by(5).collect(), Style::Dots, Tint::Blue))
        .text((-0.45, -0.45), "initial loading", Side::Centre)
        .arrow((-0.15, -0.3), (0.22, 0.12))
        .arrow((0.2, 0.87), (1.0, 0.87))
        .arrow((-0.2, -0.87), (-1.0, -0.87))
}
