//! Fig. 4: frequency of the slow flow's limit cycles over their averaged mechanical energy.

use super::check::Check;
use super::error::PaperError;
use super::item::{Case, Findings, Origin, PaperItem, numbers};
use super::slow::{frequency, orders_of_29_and_30};
use crate::averaging::{
    AveragingError, DescribingFunction, EnergyDefinition, EnergyFrequency, Interpolation, LARGEST_ENERGY, NodeSpacing,
    SlowLimitCycle, folds,
};
use crate::model::RigParameters;
use crate::report::{Figure, Panel, Series, Style, Tint};
use nalgebra::Complex;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "fig4",
    origin: Origin::Paper("Fig. 4"),
    title: "frequency over energy",
    caption: "Angular frequency of the limit cycles of the slow flow over their averaged mechanical energy up to 500, from a₁ = 1 along the lower branch (blue) through the fold (circle) along the upper one (green): (a) all energies, (b) the small ones on a logarithmic axis. \
        Lines: converged; crosses: nodes of a PCHIP through 400 of them, every tenth. Dashed: limits of sticking, ω = 1, and of frictionless sliding, a natural frequency of the rig without the Jenkins spring.",
    revision: 3,
    compute,
};

/// Natural frequencies without the Jenkins spring: stiffness `[[1-g+k, -k], [-k, 1+k]]`.
fn sliding_frequencies(case: &Case) -> [f64; 2] {
    let (g, k) = (case.parameters.gamma, case.parameters.kappa);
    let (mean, half) = (1.0 - 0.5 * g + k, (0.25 * g * g + k * k).sqrt());
    [(mean - half).sqrt(), (mean + half).sqrt()]
}

/// Eigenvalue of the rig with a spring and a damper for the Jenkins element, `K + i w C`, that belongs to the mode (0: the lower). On a limit cycle
/// it is `w^2`, without an imaginary part: what friction takes, the negative damping gives.
fn equivalent_eigenvalue(case: &Case, cycle: &SlowLimitCycle, mode: usize) -> Complex<f64> {
    let RigParameters { xi1, xi2, kappa, gamma } = case.at(cycle.xi1);
    let (d, w) = (DescribingFunction::at(cycle.amplitude), cycle.angular_frequency);
    let damping = 0.5 * w * (xi1 + xi2);
    let first = Complex::new(1.0 - gamma + gamma * d.stiffness + kappa, gamma * d.damping + damping);
    let second = Complex::new(1.0 + kappa, damping);
    let coupling = Complex::new(-kappa, 0.5 * w * (xi1 - xi2));
    let half = (0.25 * (first - second).powi(2) + coupling.powi(2)).sqrt();
    let mean = 0.5 * (first + second);
    // The root has a positive real part.
    if mode == 0 { mean - half } else { mean + half }
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
    let end = converged.branch().take_while(|(energy, _)| *energy <= LARGEST_ENERGY).last().map(|(_, cycle)| *cycle);
    let end = end.ok_or_else(|| PaperError::missing("branch of limit cycles", case.parameters))?;
    // In phase the masses swing with the lower natural frequency, in antiphase with the upper one.
    let mode = usize::from(end.ratio.re < 0.0);
    let eigenvalue = equivalent_eigenvalue(case, &end, mode);
    let fold = folds(case.parameters, end.amplitude)?.first().map(|fold| fold.cycle);
    let fold_energy = fold.and_then(|fold| energy_at(&converged, fold.amplitude));
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
            "frequency at the last limit cycle",
            eigenvalue.re.sqrt(),
            end.angular_frequency,
            1e-10,
            "root of its eigenvalue of the rig with the equivalent spring and damper; limit cycles are solved to 1e-14 and amplitudes are some 40",
        ),
        Check::near(
            "damping of its mode there",
            0.0,
            eigenvalue.im,
            1e-10,
            "a limit cycle neither grows nor shrinks; as above",
        ),
        case.nominal_only(Check::near(
            "its mode, counted from the lower frequency",
            1.0,
            (mode + 1) as f64,
            0.0,
            "in phase for nominal parameters; the upper one for κ = 0.074 and for γ = 0.7",
        )),
        case.nominal_only(Check::at_most(
            "400 nodes against converged",
            1e-6,
            difference,
            "error of the PCHIP between nodes, of third order in their distance, the largest being 0.007 in arclength: 3e-7 times a factor of order 1",
        )),
    ];
    let mut findings = Findings { checks, ..Findings::default() };
    findings.checks.extend(fold_checks(fold.as_ref()).into_iter().map(|check| case.nominal_only(check)));
    if let (Some(fold), Some(energy)) = (fold, fold_energy) {
        let SlowLimitCycle { amplitude, angular_frequency, xi1, .. } = fold;
        findings
            .number("fold", format!("ξ₁ = {xi1:.8}, a₁ = {amplitude:.6}, ω = {angular_frequency:.6}, E = {energy:.4}"));
    }
    if case.is_nominal() {
        for (equation, found) in ["(29)", "(30), real part"].iter().zip(orders_of_29_and_30()?) {
            findings.checks.push(Check::near(
                &format!("order of the error of {equation} with corrected signs"),
                3.0,
                found,
                0.1,
                "stated with the expansion; at e = 1/64 the next order, a factor e smaller, changes it by some hundredths. As printed: 2",
            ));
        }
    }
    findings.number("frictionless sliding", format!("ω = {:.6}, {:.6}", sliding[0], sliding[1]));
    findings.number("400 nodes against converged", format!("{difference:.1e}"));
    findings.verdict = format!(
        "From 1 at the sticking limit to {last:.4} at energy 500, towards {:.4} of frictionless sliding.",
        sliding[mode]
    );
    let drawn = Drawn {
        line: energies.iter().copied().zip(smooth.iter().copied()).collect(),
        nodes: pchip.nodes().step_by(10).collect(),
        fold: fold_energy.zip(fold.map(|fold| fold.angular_frequency)),
        sliding: sliding[mode],
    };
    let panels = vec![
        drawn.panel().titled("(a) all energies").x_range(0.0, LARGEST_ENERGY),
        drawn.panel().titled("(b) small energies").log_x().x_range(SMALLEST, 100.0),
    ];
    findings.figure = Some(Figure::grid(2, (1200, 560), panels));
    findings.table(
        "frequency",
        numbers(vec![("energy", energies), ("angular_frequency", smooth), ("pchip_400", interpolated)]),
    );
    Ok(findings)
}

/// Energy of the limit cycle of an amplitude, linear between points of the branch, some thousand in number: to four digits.
fn energy_at(frequency: &EnergyFrequency, amplitude: f64) -> Option<f64> {
    let branch: Vec<(f64, f64)> = frequency.branch().map(|(energy, cycle)| (cycle.amplitude, energy)).collect();
    let pair = branch.windows(2).find(|pair| pair[0].0 <= amplitude && amplitude <= pair[1].0)?;
    let part = (amplitude - pair[0].0) / (pair[1].0 - pair[0].0);
    Some(pair[0].1 + part * (pair[1].1 - pair[0].1))
}

fn fold_checks(fold: Option<&SlowLimitCycle>) -> [Check; 3] {
    let of = |value: fn(&SlowLimitCycle) -> f64| fold.map_or(f64::NAN, value);
    let reason = "computed outside this project; a unit of the last digit given";
    [
        Check::near("fold: ξ₁", -0.213_986_24, of(|fold| fold.xi1), 1e-8, reason),
        Check::near("fold: a₁", 2.726_382, of(|fold| fold.amplitude), 1e-6, reason),
        Check::near("fold: ω", 0.884_481, of(|fold| fold.angular_frequency), 1e-6, reason),
    ]
}

/// What both panels show.
struct Drawn {
    line: Vec<(f64, f64)>,
    nodes: Vec<(f64, f64)>,
    fold: Option<(f64, f64)>,
    sliding: f64,
}

/// Lower end of the logarithmic axis: just beneath the sticking limit.
const SMALLEST: f64 = 0.8;

impl Drawn {
    fn panel(&self) -> Panel {
        let level = |w: f64| vec![(SMALLEST, w), (LARGEST_ENERGY, w)];
        let turn = self.fold.map_or(LARGEST_ENERGY, |fold| fold.0);
        let branch = |lower: bool| self.line.iter().copied().filter(|p| (p.0 <= turn) == lower).collect();
        Panel::new("averaged mechanical energy", "angular frequency ω")
            .series(Series::new("sticking limit", level(1.0), Style::Dashed, Tint::Grey))
            .series(Series::new("frictionless sliding", level(self.sliding), Style::Dashed, Tint::Orange))
            .series(Series::new("lower branch", branch(true), Style::Line, Tint::Blue))
            .series(Series::new("upper branch", branch(false), Style::Line, Tint::Green))
            .series(Series::new("PCHIP nodes", self.nodes.clone(), Style::Crosses, Tint::Black))
            .series(Series::new("fold", self.fold.into_iter().collect(), Style::Rings, Tint::Vermillion))
    }
}
