//! Beyond the paper: which starts stay bounded, in the plane of initial positions.
//!
//! Motions start at rest with the slider force relaxed (v = 0, f = 0) from (x1, x2) on a grid, and are watched for a stated time. The
//! motion from the mirrored start is the mirrored motion, so the picture must be symmetric about the origin.

use super::check::Check;
use super::error::PaperError;
use super::exact::{flow, values};
use super::item::{Case, Findings, Origin, PaperItem, numbers};
use crate::dynamics::{Outcome, State};
use crate::report::{Figure, Mark, Panel, Tint};
use rayon::prelude::*;

pub(super) const ITEM: PaperItem = PaperItem {
    id: "basin",
    origin: Origin::Beyond,
    title: "which starts stay bounded",
    caption: "Initial positions (x₁, x₂), at rest with a relaxed slider, from which the exact motion stays bounded for 3000 time units (blue; grey: for at least 300), at three values of ξ₁. White: diverges sooner. \
        Beyond some distance friction cannot hold the self-excitation; the bounded region shrinks as the self-excitation grows. Where it reaches the edge of the square it goes on outside: the area is then a lower bound.",
    revision: 4,
    compute,
};

const XI1: [f64; 3] = [-0.06, -0.12, -0.155];
/// Half the side of the square.
const EXTENT: f64 = 20.0;
/// A motion watched for the longer time is called bounded.
const WATCHED: [f64; 2] = [300.0, 3000.0];

/// Life time of the motion from each start, at most [`WATCHED`]`[1]`, rows of x2.
struct Basin {
    xi1: f64,
    side: usize,
    lives: Vec<f64>,
}

impl Basin {
    fn at(&self, column: usize, row: usize) -> f64 {
        self.lives[row * self.side + column]
    }

    /// Whether the bounded region reaches the edge of the square.
    fn cut_off(&self) -> bool {
        let last = self.side - 1;
        let bounded = |column: usize, row: usize| self.at(column, row) >= WATCHED[1];
        (0..self.side).any(|n| bounded(n, 0) || bounded(n, last) || bounded(0, n) || bounded(last, n))
    }

    /// Share of the square that stays bounded.
    fn share(&self) -> f64 {
        self.lives.iter().filter(|life| **life >= WATCHED[1]).count() as f64 / self.lives.len() as f64
    }
}

fn compute(case: &Case) -> Result<Findings, PaperError> {
    let side = case.choose(161, 21);
    let basins = XI1.iter().map(|&xi1| basin(case, xi1, side)).collect::<Result<Vec<_>, _>>()?;
    let mut findings = Findings::default();
    for basin in &basins {
        findings.checks.extend(checks(case, basin));
        let area = basin.share() * (2.0 * EXTENT).powi(2);
        let bound = if basin.cut_off() { " (cut off by the square: a lower bound)" } else { "" };
        findings.number(&format!("ξ₁ = {}", basin.xi1), format!("area of bounded starts: {area:.1}{bound}"));
    }
    let shares: Vec<String> = basins.iter().map(|basin| format!("{:.0} %", 100.0 * basin.share())).collect();
    let shrinks = basins.windows(2).all(|pair| pair[1].share() < pair[0].share());
    findings.checks.push(case.nominal_only(Check::holds(
        "bounded share at ξ₁ = −0.06, −0.12, −0.155",
        "falls",
        shares.join(", "),
        shrinks,
        "stronger self-excitation meets the same friction; the unstable upper limit cycle comes closer (Fig. 1), which suggests the same of the edge of the region but does not prove it",
    )));
    findings.verdict = format!("Bounded for 3000 time units: {} of the square |x| ≤ 20.", shares.join(", "));
    let grid = values(-EXTENT, EXTENT, side);
    let cells = || basins.iter().flat_map(|basin| (0..side * side).map(move |n| (basin, n)));
    findings.table(
        "life times",
        numbers(vec![
            ("xi1", cells().map(|(basin, _)| basin.xi1).collect()),
            ("x1", cells().map(|(_, n)| grid[n % side]).collect()),
            ("x2", cells().map(|(_, n)| grid[n / side]).collect()),
            ("life_time_at_most_3000", cells().map(|(basin, n)| basin.lives[n]).collect()),
        ]),
    );
    findings.figure = Some(Figure::grid(3, (1200, 436), basins.iter().map(panel).collect()));
    Ok(findings)
}

fn basin(case: &Case, xi1: f64, side: usize) -> Result<Basin, PaperError> {
    let flow = flow(case.at(xi1))?;
    let grid = values(-EXTENT, EXTENT, side);
    let life = |n: usize| {
        let start = State::two_mass([grid[n % side], grid[n / side], 0.0, 0.0, 0.0]);
        Ok(match flow.advance(&start, WATCHED[1])?.outcome {
            Outcome::Completed => WATCHED[1],
            Outcome::Diverged { time, .. } => time,
        })
    };
    let lives: Vec<Result<f64, PaperError>> = (0..side * side).into_par_iter().map(life).collect();
    Ok(Basin { xi1, side, lives: lives.into_iter().collect::<Result<_, _>>()? })
}

fn checks(case: &Case, basin: &Basin) -> Vec<Check> {
    let side = basin.side;
    let differing = (0..side * side)
        .filter(|n| (basin.lives[*n] >= WATCHED[1]) != (basin.lives[side * side - 1 - n] >= WATCHED[1]))
        .count();
    let near = basin.at(side / 2 + 1, side / 2 + 1);
    let name = |text: &str| format!("ξ₁ = {}: {text}", basin.xi1);
    vec![
        Check::near(
            &name("starts whose mirror image fares otherwise"),
            0.0,
            differing as f64,
            0.0,
            "y → −y maps motions to motions, in floating point too",
        ),
        case.nominal_only(Check::near(
            &name("life time next to the origin"),
            WATCHED[1],
            near,
            0.0,
            "motions from the next point of the grid grow until friction holds them: the steady motions of Fig. 5",
        )),
    ]
}

/// Cells of each row that belong together are drawn as one rectangle.
fn panel(basin: &Basin) -> Panel {
    let width = 2.0 * EXTENT / (basin.side - 1) as f64;
    let title = format!("ξ₁ = −{}", basin.xi1.abs());
    let reach = EXTENT + 0.5 * width;
    let mut panel =
        Panel::new("x₁(0)", "x₂(0)").titled(&title).equal_aspect().x_range(-reach, reach).y_range(-reach, reach);
    let levels = [
        (WATCHED[0], Tint::Grey, "bounded for 300 time units"),
        (WATCHED[1], Tint::Blue, "bounded for 3000 time units"),
    ];
    for (level, tint, label) in levels {
        for row in 0..basin.side {
            let y = -EXTENT + (row as f64 - 0.5) * width;
            // A little overlap, so that rounding to pixels leaves no gap between rows.
            let above = y + 1.05 * width;
            let mut column = 0;
            while column < basin.side {
                let first = column;
                while column < basin.side && basin.at(column, row) >= level {
                    column += 1;
                }
                if column > first {
                    let (left, right) =
                        (-EXTENT + (first as f64 - 0.5) * width, -EXTENT + (column as f64 - 0.5) * width);
                    let outline = vec![(left, y), (right, y), (right, above), (left, above)];
                    panel = panel.with(Mark::Region { label: label.to_owned(), outline, tint });
                }
                column += 1;
            }
        }
    }
    panel
}
