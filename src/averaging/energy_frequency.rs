//! Frequency over averaged mechanical energy along the branch of limit cycles, equations (15)-(16) and Fig. 4 of the paper.
//!
//! The branch is followed from a1 = 1, where slip begins at energy E0, up to [`LARGEST_ENERGY`]. In `s = sqrt(E - E0)` the frequency is a
//! smooth function; [`Interpolation::Converged`] interpolates it there to rounding. The paper interpolates w(E) between some 400 nodes by
//! PCHIP, whose error moves the period doublings: [`Interpolation::Pchip`] does that, with as many nodes as asked for, and tends
//! to the converged relation as their number grows. Below E0 nothing slips and w = 1; above the last energy w is not known.

use super::describing::DescribingFunction;
use super::energy::{EnergyDefinition, MechanicalEnergy};
use super::error::AveragingError;
use super::limit_cycles::{LimitCycleCurve, SlowLimitCycle};
use super::panels::Panels;
use super::pchip::Pchip;
use crate::model::RigParameters;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Energy up to which the branch is followed, as in the paper.
pub const LARGEST_ENERGY: f64 = 500.0;
/// Steps along the branch (arclength in `(tau, w, xi1)`, which has length 3 for the nominal set): coarse ones between which points are
/// solved for, fine ones of which nodes are a selection.
const COARSE_STEP: f64 = 5e-4;
const FINE_STEP: f64 = 1.5e-5;
const LONGEST_BRANCH: f64 = 60.0;
/// Panels of the converged relation: twice as many change w by rounding.
const PANELS: usize = 300;

/// How the nodes of a PCHIP are spread along the branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NodeSpacing {
    /// Uniform in the arclength in `(tau, w, xi1)`: dense near a1 = 1, where w(E) bends most.
    Arclength,
    /// Uniform in the amplitude a1.
    Amplitude,
    /// Uniform in the square root of the energy above the sticking limit.
    RootEnergy,
    /// Uniform in the energy.
    Energy,
}

impl NodeSpacing {
    pub const ALL: [Self; 4] = [Self::Arclength, Self::Amplitude, Self::RootEnergy, Self::Energy];
}

/// How w(E) is interpolated between limit cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// To rounding.
    #[default]
    Converged,
    /// Monotone piecewise cubic through a number of nodes, 4 to 200000.
    Pchip { nodes: usize, spacing: NodeSpacing },
}

/// `w(E)` for given xi2, kappa, gamma; it does not depend on xi1, which varies along the branch.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyFrequency {
    definition: EnergyDefinition,
    relation: Relation,
    energies: Vec<f64>,
    cycles: Vec<SlowLimitCycle>,
    range: (f64, f64),
}

#[derive(Debug, Clone, PartialEq)]
enum Relation {
    Smooth(Panels),
    Pchip(Pchip),
}

impl EnergyFrequency {
    /// Follows the branch up to [`LARGEST_ENERGY`].
    ///
    /// # Errors
    /// [`AveragingError::Parameter`], [`AveragingError::NoCoupling`], [`AveragingError::OutOfRange`] for a number of nodes that is not
    /// allowed, [`AveragingError::BranchLost`], and [`AveragingError::EnergyNotMonotone`] where w is no function of the energy.
    pub fn new(
        parameters: RigParameters,
        definition: EnergyDefinition,
        interpolation: Interpolation,
    ) -> Result<Self, AveragingError> {
        let (points, relation) = match interpolation {
            Interpolation::Converged => {
                let branch = Followed::new(parameters, definition, COARSE_STEP)?;
                let relation = Relation::Smooth(branch.panels()?);
                (branch.points, relation)
            }
            Interpolation::Pchip { nodes, spacing } => {
                if !(4..=200_000).contains(&nodes) {
                    let found = nodes as f64;
                    return Err(AveragingError::OutOfRange { field: "nodes", found, allowed: "from 4 to 200000" });
                }
                let mut points = Followed::new(parameters, definition, FINE_STEP)?;
                let chosen = points.selected(nodes, spacing);
                let energies = chosen.iter().map(|point| point.energy).collect();
                let frequencies = chosen.iter().map(|point| point.cycle.angular_frequency).collect();
                points.thin_out((COARSE_STEP / FINE_STEP) as usize);
                (points.points, Relation::Pchip(Pchip::through(energies, frequencies)))
            }
        };
        let frequencies = points.iter().map(|point| point.cycle.angular_frequency);
        let range = frequencies.fold((1.0_f64, 1.0_f64), |(low, high), w| (low.min(w), high.max(w)));
        let energies = points.iter().map(|point| point.energy).collect();
        let cycles = points.iter().map(|point| point.cycle).collect();
        Ok(Self { definition, relation, energies, cycles, range })
    }

    #[must_use]
    pub fn definition(&self) -> EnergyDefinition {
        self.definition
    }

    /// Whether derivatives of all orders are continuous above the sticking limit, as those of a PCHIP are not.
    pub(super) fn is_smooth(&self) -> bool {
        matches!(self.relation, Relation::Smooth(_))
    }

    /// Energy at which slip begins, below which w = 1.
    #[must_use]
    pub fn sticking_energy(&self) -> f64 {
        self.energies[0]
    }

    #[must_use]
    pub fn largest_energy(&self) -> f64 {
        self.energies[self.energies.len() - 1]
    }

    /// Smallest and largest frequency on the branch.
    #[must_use]
    pub fn frequency_range(&self) -> (f64, f64) {
        self.range
    }

    /// Some thousands of limit cycles along the branch with their energies.
    pub fn branch(&self) -> impl Iterator<Item = (f64, &SlowLimitCycle)> {
        self.energies.iter().copied().zip(&self.cycles)
    }

    /// Energies and frequencies of the nodes of a PCHIP.
    pub fn nodes(&self) -> impl Iterator<Item = (f64, f64)> {
        let pchip = match &self.relation {
            Relation::Pchip(pchip) => Some(pchip),
            Relation::Smooth(_) => None,
        };
        pchip.into_iter().flat_map(Pchip::nodes)
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
        let start = self.sticking_energy();
        if energy <= start {
            return (1.0, 0.0);
        }
        let last = self.cycles.len() - 1;
        if energy >= self.energies[last] {
            return (self.cycles[last].angular_frequency, 0.0);
        }
        match &self.relation {
            Relation::Pchip(pchip) => pchip.evaluate(energy),
            Relation::Smooth(panels) => {
                let root = (energy - start).sqrt();
                let (w, slope) = panels.evaluate(root);
                (w, 0.5 * slope / root)
            }
        }
    }

    /// `w = w(E(w))` at one slow amplitude and its derivative over the energy at fixed w, `W'/(1 - 2 w W' inertia)`.
    ///
    /// Newton's method inside a bracket: `w - w(E)` changes its sign between the smallest and the largest frequency.
    pub(super) fn implicit(&self, energy: &MechanicalEnergy) -> (f64, f64) {
        if energy.at_frequency(1.0) <= self.sticking_energy() {
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

#[derive(Debug, Clone, Copy)]
struct Point {
    u: Vector3<f64>,
    cycle: SlowLimitCycle,
    energy: f64,
}

/// The branch in equal steps from a1 = 1 to the first point beyond [`LARGEST_ENERGY`].
struct Followed {
    curve: LimitCycleCurve,
    parameters: RigParameters,
    definition: EnergyDefinition,
    points: Vec<Point>,
}

impl Followed {
    /// The energy is checked to grow from one point to the next.
    fn new(parameters: RigParameters, definition: EnergyDefinition, step: f64) -> Result<Self, AveragingError> {
        let curve = LimitCycleCurve::new(parameters)?;
        let mut branch = Self { curve, parameters, definition, points: Vec::new() };
        branch.points.push(branch.point(LimitCycleCurve::START.into()));
        let most_steps = (LONGEST_BRANCH / step) as usize;
        for next in curve.walk(step).take(most_steps) {
            let last = branch.points[branch.points.len() - 1];
            let next = branch.point(next.ok_or_else(|| lost(&last))?);
            if next.energy.is_nan() || next.energy <= last.energy {
                let (from, to, amplitude) = (last.energy, next.energy, next.cycle.amplitude);
                return Err(AveragingError::EnergyNotMonotone { definition, from, to, amplitude });
            }
            branch.points.push(next);
            if next.energy >= LARGEST_ENERGY {
                return Ok(branch);
            }
        }
        Err(lost(&branch.points[branch.points.len() - 1]))
    }

    fn point(&self, u: Vector3<f64>) -> Point {
        let cycle = self.curve.cycle(&u);
        let [a, re, im] = cycle.slow_state().into();
        let energy = MechanicalEnergy::of(self.definition, &self.parameters, &DescribingFunction::at(a), [re, im]);
        Point { u, cycle, energy: energy.at_frequency(cycle.angular_frequency) }
    }

    /// The frequency over `sqrt(E - E0)`.
    fn panels(&self) -> Result<Panels, AveragingError> {
        let (start, end) = (self.points[0].energy, self.points[self.points.len() - 1].energy);
        Panels::through((end - start).sqrt(), PANELS, |root| {
            Ok(self.at_energy(start + root * root)?.cycle.angular_frequency)
        })
    }

    /// The point of the branch with an energy between its ends, by the secant method along the chord of its neighbours.
    fn at_energy(&self, energy: f64) -> Result<Point, AveragingError> {
        let above = self.points.partition_point(|point| point.energy <= energy).clamp(1, self.points.len() - 1);
        let (low, high) = (self.points[above - 1], self.points[above]);
        let chord = high.u - low.u;
        let normal = chord.normalize();
        let at = |part: f64| {
            let u = self.curve.corrected(low.u + chord * part, &normal).ok_or_else(|| lost(&low))?;
            Ok::<_, AveragingError>(self.point(u))
        };
        let mut ends = [(0.0, low.energy - energy), (1.0, high.energy - energy)];
        let mut found = low;
        // Five or six steps; the energy is a smooth function along the chord.
        for _ in 0..50 {
            let part = ends[0].0 + (ends[1].0 - ends[0].0) * ends[0].1 / (ends[0].1 - ends[1].1);
            found = at(part)?;
            let residual = found.energy - energy;
            // Rounding of the energy.
            if residual.abs() <= 4e-16 * energy {
                break;
            }
            let side = usize::from((residual < 0.0) != (ends[0].1 < 0.0));
            if (part - ends[side].0).abs() <= 1e-15 {
                break;
            }
            ends[side] = (part, residual);
            ends[1 - side].1 *= 0.5;
        }
        Ok(found)
    }

    /// Keeps every `stride`-th point, and the last.
    fn thin_out(&mut self, stride: usize) {
        let last = self.points.len() - 1;
        let mut index = 0;
        self.points.retain(|_| {
            index += 1;
            (index - 1) % stride == 0 || index - 1 == last
        });
    }

    /// Nodes spread as asked, ends included, of the points followed. Where the coordinate falls (an amplitude that turns), points are passed
    /// over.
    fn selected(&self, nodes: usize, spacing: NodeSpacing) -> Vec<Point> {
        let points = &self.points;
        let coordinate = |index: usize| match spacing {
            NodeSpacing::Arclength => index as f64,
            NodeSpacing::Amplitude => points[index].cycle.amplitude,
            NodeSpacing::RootEnergy => (points[index].energy - points[0].energy).max(0.0).sqrt(),
            NodeSpacing::Energy => points[index].energy,
        };
        let last = points.len() - 1;
        let (from, to) = (coordinate(0), coordinate(last));
        let mut chosen = vec![0];
        for n in 1..nodes - 1 {
            let wanted = from + (to - from) * (n as f64 / (nodes - 1) as f64);
            let start = chosen[chosen.len() - 1] + 1;
            let Some(index) = (start..last).find(|index| coordinate(*index) >= wanted) else { break };
            chosen.push(index);
        }
        chosen.push(last);
        chosen.into_iter().map(|index| points[index]).collect()
    }
}

fn lost(last: &Point) -> AveragingError {
    AveragingError::BranchLost {
        amplitude: last.cycle.amplitude,
        angular_frequency: last.cycle.angular_frequency,
        xi1: last.cycle.xi1,
        energy: last.energy,
        wanted: LARGEST_ENERGY,
    }
}
