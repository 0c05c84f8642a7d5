//! The amplitude-damping diagram that a film shows its scene in: limit cycles, and the steady motions of a coarse diagram.

use super::analysis::lower_branch;
use super::diagram::prepare;
use super::progress::Progress;
use crate::chaos::{DiagramPlan, Window, amplitude_diagram, divergence_edge};
use crate::model::RigParameters;
use crate::orbit::{Branch, Heading};
use crate::scene::{Case, Panel};
use crate::stage::DampingMap;

/// Weakest and strongest self-excitation of the diagram, and the number of motions in it.
const RANGE: [f64; 2] = [0.0, -0.2];
const MOTIONS: usize = 80;
/// Short motions: the picture is small, and a tenth of a second is all it may take.
const WINDOW: Window = Window { transient: 500.0, length: 400.0 };
/// Largest amplitude of a limit cycle.
const HIGHEST: f64 = 3.5;

/// The diagram around a case, where its film shows one. Where it cannot be computed the panel stays without it, and a line says why.
pub fn of(case: &Case, progress: &Progress) -> anyhow::Result<Option<DampingMap>> {
    if case.prescribed.is_some() || !case.panels().contains(&Panel::Map) {
        return Ok(None);
    }
    match compute(case.parameters, case.excitation().strongest()) {
        Ok(map) => Ok(Some(map)),
        Err(error) => {
            progress.say(&format!("the panel of the amplitude-damping diagram stays empty: {error:#}"));
            Ok(None)
        }
    }
}

fn compute(p: RigParameters, excitation: f64) -> anyhow::Result<DampingMap> {
    let [weakest, strongest] = [RANGE[0], RANGE[1].min(1.15 * excitation)];
    let part = |n: usize| n as f64 / MOTIONS as f64;
    // Without self-excitation every small motion goes on for ever: none is steady.
    let values: Vec<f64> = (1..=MOTIONS).map(|n| weakest + (strongest - weakest) * part(n)).collect();
    let plan = DiagramPlan { window: WINDOW, ..DiagramPlan::default() };
    let rows = amplitude_diagram(&values, &plan, &[], |xi1| prepare(RigParameters { xi1, ..p }), |_, _, _| {})?;
    let branch = Branch::follow(lower_branch(p, Heading::Decreasing)?.up_to_amplitude(HIGHEST), |_| false)?;
    // At a reversal of mass 1 its position is its amplitude.
    let cycle = |point: &crate::orbit::BranchPoint| {
        (point.parameters.xi1, point.orbit.reversal().positions[0].abs(), point.orbit.stable())
    };
    let divergence = divergence_edge(&rows).map(|edge| edge.first_diverged);
    // Beyond the edge a motion may last longer than the window, but it is not a steady one.
    let steady = rows.iter().filter(|row| divergence.is_none_or(|edge| row.value > edge));
    Ok(DampingMap {
        limit_cycles: branch.points.iter().map(cycle).collect(),
        motions: steady.filter_map(|row| Some((row.value, [row.a1_min?, row.a1_max?]))).collect(),
        divergence,
    })
}
