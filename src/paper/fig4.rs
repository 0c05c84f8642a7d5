//! Fig. 4: frequency of the slow flow's limit cycles over their averaged mechanical energy.

use super::check::Check;
use super::error::PaperError;
use super::item::{Case, Findings, Origin, PaperItem, numbers};
use super::slow::frequency;
use crate::averaging::{AveragingError, EnergyDefinition, EnergyFrequency, Interpolation, LARGEST_ENERGY, NodeSpacing};
use crate::report::{Figure, Panel, Series, Style, Tint};

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig4",
    origin: Origin::Paper("Fig. 4"),
    title: "frequency over energy",
    caption: "Angular frequency of the limit cycles of the slow flow over their averaged mechanical energy up to 500, from a₁ = 1 through the fold (circle) along the upper branch. \
        Line: converged; crosses: nodes of a PCHIP through 400 of them, every tenth. Dashed: limits of sticking, ω = 1, and of frictionless sliding, a natural frequency of the rig without the Jenkins spring.",
    revision: 1,
    compute,
};

/// Natural frequencies without the Jenkins spring: stiffness `[[1-g+k, -k], [-k, 1+k]]`.
fn sliding_frequencies(case: &Case) -> [f64; 2] {
    let (g, k) = (case.parameters.gamma, case.parameters.kappa);
    let (mean, half) = (1.0 - 0.5 * g + k, (0.25 * g * g + k * k).sqrt());
    [(mean - half).sqrt(), (mean + half).sqrt()]
}

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let converged = frequency(case.parameters)?;
    let nodes = Interpolation::Pchip { nodes: 400, spacing: NodeSpacing::Arclength };
    let pchip = EnergyFrequency::new(case.parameters, EnergyDefinition::MeanPotential, nodes)?;
    let energies: Vec<f64> = (0..=2000).map(|n| LARGEST_ENERGY * (f64::from(n) / 2000.0).powi(3)).collect();
    let at = |law: &EnergyFrequency| {
        energies.iter().map(|e| Ok(law.at(*e)?.0)).collect::<Result<Vec<f64>, AveragingError>>()
    };
    let (smooth, interpolated) = (at(&converged)?, at(&pchip)?);
    let difference = smooth.iter().zip(&interpolated).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let last = smooth[smooth.len() - 1];
    let sliding = sliding_frequencies(case);
    let nearest = if (last - sliding[0]).abs() < (last - sliding[1]).abs() { sliding[0] } else { sliding[1] };
    let fold = converged.branch().min_by(|a, b| a.1.xi1.total_cmp(&b.1.xi1)).map(|(e, cycle)| (e, *cycle));
    let checks = vec![
        Check::near(
            "frequency at the sticking limit",
            1.0,
            converged.at(converged.sticking_energy())?.0,
            1e-12,
            "in-phase mode, nothing slips",
        ),
        Check::near(
            "energy of the sticking limit",
            1.0,
            converged.sticking_energy(),
            1e-12,
            "a₁ = a₂ = ω = 1: ½ kinetic and ½ potential",
        ),
        Check::near(
            "frequency at the largest energy",
            nearest,
            last,
            0.01,
            "a natural frequency without the Jenkins spring, which at a₁ ≈ 30 still adds γ·k_eq of some 0.005",
        ),
        case.nominal_only(Check::near(
            "it is the lower one",
            sliding[0],
            nearest,
            1e-12,
            "nominal parameters; the upper one for κ = 0.074 and for γ = 0.7",
        )),
        Check::at_most(
            "400 nodes against converged",
            1e-4,
            difference,
            "error of the PCHIP between nodes, of third order in their distance, the largest being 0.007 in arclength",
        ),
    ];
    let mut findings = Findings { checks, ..Findings::default() };
    if let Some((energy, cycle)) = fold {
        let found = cycle.xi1;
        findings.checks.push(case.nominal_only(Check::near(
            "fold of the limit cycles",
            -0.213_986_24,
            found,
            1e-7,
            "computed outside this project; the nearest of some thousand points, quadratic in their distance of 0.0005",
        )));
        findings.number(
            "fold",
            format!(
                "ξ₁ = {found:.7}, a₁ = {:.4}, ω = {:.6}, E = {energy:.4}",
                cycle.amplitude, cycle.angular_frequency
            ),
        );
    }
    findings.number("frictionless sliding", format!("ω = {:.6}, {:.6}", sliding[0], sliding[1]));
    findings.number("400 nodes against converged", format!("{difference:.1e}"));
    findings.verdict = format!(
        "From 1 at the sticking limit to {last:.4} at energy 500, towards {nearest:.4} of frictionless sliding."
    );
    let line = energies.iter().copied().zip(smooth.iter().copied()).collect();
    let level = |w: f64| vec![(0.0, w), (LARGEST_ENERGY, w)];
    let marks = pchip.nodes().step_by(10).collect();
    let panel = Panel::new("averaged mechanical energy", "angular frequency ω")
        .x_range(0.0, LARGEST_ENERGY)
        .series(Series::new("sticking limit", level(1.0), Style::Dashed, Tint::Grey))
        .series(Series::new("frictionless sliding", level(nearest), Style::Dashed, Tint::Orange))
        .series(Series::new("limit cycles", line, Style::Line, Tint::Blue))
        .series(Series::new("PCHIP nodes", marks, Style::Crosses, Tint::Black))
        .series(Series::new(
            "fold",
            fold.map(|(e, c)| (e, c.angular_frequency)).into_iter().collect(),
            Style::Rings,
            Tint::Vermillion,
        ));
    findings.figure = Some(Figure::single(panel));
    findings.table(
        "frequency",
        numbers(vec![("energy", energies), ("angular_frequency", smooth), ("pchip_400", interpolated)]),
    );
    Ok(findings)
}
