//! Frequency over averaged mechanical energy along the branch of limit cycles, equations (15)-(16) and Fig. 4 of the paper.
//!
//! Nodes lie on the branch from a1 = 1 up to an energy, [`LARGEST_ENERGY`] unless another is asked for; between them w(E) is interpolated
//! by PCHIP. Below the energy of a1 = 1 nothing slips and w = 1; above the last node w is not known.

use super::describing::DescribingFunction;
use super::energy::{EnergyDefinition, MechanicalEnergy};
use super::error::AveragingError;
use super::limit_cycles::{LimitCycleCurve, SlowLimitCycle};
use super::pchip::Pchip;
use crate::model::RigParameters;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Energy up to which the branch is followed, as in the paper.
pub const LARGEST_ENERGY: f64 = 500.0;
/// Nodes of the converged relation: the fifth period doubling moves by less than 1e-7 when their number is doubled.
pub const CONVERGED_NODES: usize = 25_000;
/// Steps along the branch, of which nodes are a selection: arclength in `(tau, w, xi1)`.
const STEP: f64 = 1.5e-5;
/// The branch has length 3 for the nominal set.
const MOST_STEPS: usize = 4_000_000;

/// How nodes are spread along the branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NodeSpacing {
    /// Uniform in the arclength in `(tau, w, xi1)`: dense near a1 = 1, where w(E) bends most.
    #[default]
    Arclength,
    /// Uniform in the amplitude a1.
    Amplitude,
    /// Uniform in the square root of the energy above the sticking limit.
    RootEnergy,
}

/// Number of nodes and where they lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Nodes {
    pub count: usize,
    pub spacing: NodeSpacing,
}

impl Default for Nodes {
    fn default() -> Self {
        Self { count: CONVERGED_NODES, spacing: NodeSpacing::Arclength }
    }
}

/// `w(E)` for given xi2, kappa, gamma; it does not depend on xi1, which varies along the branch.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyFrequency {
    definition: EnergyDefinition,
    interpolation: Pchip,
    cycles: Vec<SlowLimitCycle>,
    range: (f64, f64),
}

impl EnergyFrequency {
    /// Follows the branch up to [`LARGEST_ENERGY`].
    ///
    /// # Errors
    /// [`AveragingError::Parameter`], [`AveragingError::NoCoupling`], [`AveragingError::OutOfRange`] for fewer than 4 nodes,
    /// [`AveragingError::BranchLost`], and [`AveragingError::EnergyNotMonotone`] where w is no function of the energy.
    pub fn new(parameters: RigParameters, definition: EnergyDefinition, nodes: Nodes) -> Result<Self, AveragingError> {
        if !(4..=200_000).contains(&nodes.count) {
            let found = nodes.count as f64;
            return Err(AveragingError::OutOfRange { field: "nodes", found, allowed: "from 4 to 200000" });
        }
        let points = followed(parameters, definition)?;
        let chosen = selected(&points, nodes);
        let cycles: Vec<SlowLimitCycle> = chosen.iter().map(|index| points[*index].cycle).collect();
        let energies = chosen.iter().map(|index| points[*index].energy).collect();
        let frequencies: Vec<f64> = cycles.iter().map(|cycle| cycle.angular_frequency).collect();
        let range = frequencies.iter().fold((1.0_f64, 1.0_f64), |(low, high), w| (low.min(*w), high.max(*w)));
        Ok(Self { definition, interpolation: Pchip::through(energies, frequencies), cycles, range })
    }

    #[must_use]
    pub fn definition(&self) -> EnergyDefinition {
        self.definition
    }

    /// Energy at which slip begins, below which w = 1.
    #[must_use]
    pub fn sticking_energy(&self) -> f64 {
        self.interpolation.first()
    }

    #[must_use]
    pub fn largest_energy(&self) -> f64 {
        self.interpolation.last()
    }

    /// Smallest and largest frequency on the branch.
    #[must_use]
    pub fn frequency_range(&self) -> (f64, f64) {
        self.range
    }

    /// The limit cycles at the nodes with their energies.
    pub fn branch(&self) -> impl Iterator<Item = (f64, &SlowLimitCycle)> {
        self.interpolation.nodes().iter().copied().zip(&self.cycles)
    }

    /// `w` and `dw/dE`.
    ///
    /// # Errors
    /// [`AveragingError::BeyondEnergy`] above the last node.
    pub fn at(&self, energy: f64) -> Result<(f64, f64), AveragingError> {
        if energy > self.largest_energy() || energy.is_nan() {
            return Err(AveragingError::BeyondEnergy { found: energy, end: self.largest_energy() });
        }
        Ok(self.held(energy))
    }

    /// As [`Self::at`], the last value held beyond the last node: for stages of an integration step that is then refused.
    pub(super) fn held(&self, energy: f64) -> (f64, f64) {
        if energy <= self.interpolation.first() {
            (1.0, 0.0)
        } else if energy >= self.interpolation.last() {
            (self.interpolation.values()[self.interpolation.values().len() - 1], 0.0)
        } else {
            self.interpolation.evaluate(energy)
        }
    }

    /// `w = w(E(w))` at one slow amplitude and its derivative over the energy at fixed w, `W'/(1 - 2 w W' inertia)`.
    ///
    /// Newton's method inside a bracket: `w - w(E)` changes its sign between the smallest and the largest frequency.
    pub(super) fn implicit(&self, energy: &MechanicalEnergy) -> (f64, f64) {
        if energy.at_frequency(1.0) <= self.interpolation.first() {
            return (1.0, 0.0);
        }
        self.solve(|w| (energy.at_frequency(w), 2.0 * w * energy.inertia))
    }

    /// The root of `w - w(E)` for an energy and its slope over w; also `W'/(1 - W' dE/dw)`.
    pub(super) fn solve(&self, energy: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
        let (mut low, mut high) = self.range;
        let mut w = self.held(energy(1.0).0).0;
        let mut gain = 0.0;
        // Three or four steps; halving alone would take 50.
        for _ in 0..60 {
            let (e, slope) = energy(w);
            let (target, rate) = self.held(e);
            let residual = w - target;
            let derivative = 1.0 - rate * slope;
            gain = rate / derivative;
            if residual > 0.0 {
                high = w
            } else {
                low = w
            }
            let step = residual / derivative;
            // Rounding of w near 1.
            if step.abs() <= 4e-16 || high - low <= 4e-16 {
                break;
            }
            let next = w - step;
            w = if derivative > 0.0 && next > low && next < high { next } else { 0.5 * (low + high) };
        }
        (w, gain)
    }
}

struct Point {
    cycle: SlowLimitCycle,
    energy: f64,
    arclength: f64,
}

fn energy_of(p: &RigParameters, definition: EnergyDefinition, cycle: &SlowLimitCycle) -> f64 {
    let [a, re, im] = cycle.slow_state().into();
    MechanicalEnergy::of(definition, p, &DescribingFunction::at(a), [re, im]).at_frequency(cycle.angular_frequency)
}

/// All points from a1 = 1 to the first beyond [`LARGEST_ENERGY`], with the energy checked to grow from one to the next.
fn followed(parameters: RigParameters, definition: EnergyDefinition) -> Result<Vec<Point>, AveragingError> {
    let curve = LimitCycleCurve::new(parameters)?;
    let point = |u: &Vector3<f64>, arclength: f64| {
        let cycle = curve.cycle(u);
        Point { energy: energy_of(&parameters, definition, &cycle), cycle, arclength }
    };
    let mut points = vec![point(&LimitCycleCurve::START.into(), 0.0)];
    for (n, next) in curve.walk(STEP).enumerate() {
        let last = &points[points.len() - 1];
        let lost = || AveragingError::BranchLost {
            amplitude: last.cycle.amplitude,
            angular_frequency: last.cycle.angular_frequency,
            xi1: last.cycle.xi1,
            energy: last.energy,
            wanted: LARGEST_ENERGY,
        };
        let next = point(&next.filter(|_| n < MOST_STEPS).ok_or_else(lost)?, (n + 1) as f64 * STEP);
        if next.energy.is_nan() || next.energy <= last.energy {
            let (from, to, amplitude) = (last.energy, next.energy, next.cycle.amplitude);
            return Err(AveragingError::EnergyNotMonotone { definition, from, to, amplitude });
        }
        let done = next.energy >= LARGEST_ENERGY;
        points.push(next);
        if done {
            return Ok(points);
        }
    }
    Ok(points)
}

/// Indices of `nodes` points spread as asked, ends included. The coordinate must not fall; where it does (an amplitude that turns), points
/// there are passed over.
fn selected(points: &[Point], nodes: Nodes) -> Vec<usize> {
    let first_energy = points[0].energy;
    let coordinate = |point: &Point| match nodes.spacing {
        NodeSpacing::Arclength => point.arclength,
        NodeSpacing::Amplitude => point.cycle.amplitude,
        NodeSpacing::RootEnergy => (point.energy - first_energy).max(0.0).sqrt(),
    };
    let last = points.len() - 1;
    let (from, to) = (coordinate(&points[0]), coordinate(&points[last]));
    let mut chosen = vec![0];
    for n in 1..nodes.count - 1 {
        let wanted = from + (to - from) * (n as f64 / (nodes.count - 1) as f64);
        let start = chosen[chosen.len() - 1] + 1;
        let Some(offset) = points[start..last].iter().position(|point| coordinate(point) >= wanted) else { break };
        chosen.push(start + offset);
    }
    chosen.push(last);
    chosen
}
