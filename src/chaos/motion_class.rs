//! What a motion settles to, and by which criteria.
//!
//! In this order, on the turning points of mass 1 in the window (mirrored so that all are maxima; half = half of the window):
//!
//! | class | criterion |
//! |---|---|
//! | diverged | some \|x\| exceeds the amplitude bound of the flow |
//! | equilibrium | no slip in the window, and x1 swings less in the second half than in the first, or below [`Criteria::rest`] |
//! | not settled | no slip in the window, and x1 swings more in the second half: the motion still grows towards its slip limit |
//! | neutral | no slip in the window, and x1 swings as before: nothing attracts |
//! | limit cycle | a cycle solved for is stable by its multipliers, and the turning points are near it and come nearer |
//! | limit cycle | the turning points repeat after some k <= [`Criteria::longest_cycle`] returns within [`Criteria::recurrence`] |
//! | torus | the turning points spread more in the second half by the inverse of [`Criteria::shrinkage`]: still leaving an unstable limit cycle |
//! | chaos | two motions [`Criteria::separation`] apart separate by more than e^[`Criteria::growth`] in the second half |
//! | limit cycle | the turning points spread less in the second half by the factor [`Criteria::shrinkage`]: still settling |
//! | torus | otherwise |
//!
//! While a motion leaves an unstable cycle, neighbours separate at that cycle's rate, which is no chaos of what it settles to: between the
//! secondary Hopf point and xi1 = -0.05 the nominal rig spreads 2.7 to 8 times as far in the second half of 3500 time units; where it is chaotic
//! the ratio was 0.88 to 1.11.
//!
//! A motion whose spread still changes can be followed further ([`DiagramPlan::extensions`](super::DiagramPlan)): the transient is then as long as all
//! that was looked at before, and so is the window, until the spread is the same in both halves; where it never is, the motion has not settled.
//!
//! The numbers they were decided by are kept as [`Evidence`]. Linear growth of the separation, the fastest that a torus allows, is a
//! factor 2 in the second half; tori of the nominal rig were measured to reach e^1.7 (Lyapunov exponents zero to 1e-8), the threshold
//! is e^2.5. So an exponent counts as positive from about `2 growth / length` on. Weaker chaos counts as a torus, and so
//! does a limit cycle that attracts so slowly (next to the secondary Hopf point) that the spread hardly shrinks in the window:
//! the remedy for both is a longer window. [`super::lyapunov_spectrum`] decides with an error bar.

use super::envelope::{TurningPoint, turning_points};
use super::error::ChaosError;
use super::window::Window;
use crate::dynamics::{DenseFlow, EventKind, Motion, Outcome, State};
use serde::{Deserialize, Serialize};

/// Times at which the separation is measured and scaled back, over the window.
const RESCALINGS: usize = 40;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionClass {
    Equilibrium,
    LimitCycle,
    Torus,
    Chaos,
    Diverged,
    /// Neither decays nor grows, without slip.
    Neutral,
    /// Still changing when the longest motion allowed was over.
    NotSettled,
}

/// A limit cycle solved for at the parameters of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownCycle {
    /// The state at its reversal, v1 = 0 and f = +1.
    pub reversal: State,
    /// Modulus of its leading multiplier over one return.
    pub leading_multiplier: f64,
}

/// Distance of a turning point from a stable cycle, relative to its amplitude, within which the cycle may be what the motion settles to.
const NEAR_CYCLE: f64 = 0.05;
/// Relative difference of the spreads of both halves below which a motion is taken to have settled.
const SAME_SPREAD: f64 = 0.05;
/// Relative change of a swing without slip that counts as growth or decay.
const STEADY_SWING: f64 = 1e-3;

/// Thresholds of the classification; see the module.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Criteria {
    pub rest: f64,
    pub longest_cycle: usize,
    pub recurrence: f64,
    pub separation: f64,
    pub growth: f64,
    pub shrinkage: f64,
}

impl Default for Criteria {
    fn default() -> Self {
        Self { rest: 1e-9, longest_cycle: 16, recurrence: 1e-6, separation: 1e-7, growth: 2.5, shrinkage: 0.8 }
    }
}

/// What the class was decided by; `None` where it was not needed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Evidence {
    /// Time at which the motion exceeded the amplitude bound.
    pub life_time: Option<f64>,
    /// Slips in the window.
    pub slips: Option<usize>,
    /// Largest distance between a turning point and the one k returns later, for the least k within the tolerance, or the best.
    pub recurrence: Option<f64>,
    /// That k.
    pub cycle: Option<usize>,
    /// Logarithm of the growth of a small separation in the second half of the window.
    pub separation_growth: Option<f64>,
    /// Spread of the turning points in the second half over that in the first.
    pub spread_ratio: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub decided_by: Option<Decision>,
}

/// What decided a class in place of the turning points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Decision {
    /// Those of a cycle solved for, which the motion approaches.
    Multipliers,
}

/// Class of a motion, with the range of its maxima.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Classification {
    pub class: MotionClass,
    /// Largest and smallest maximum of x1 in the window, minima counting by their mirror image; `None` for diverged
    /// motions. The constant `|x1|` where nothing turns.
    pub amplitude_range: Option<(f64, f64)>,
    pub evidence: Evidence,
}

/// Class of the motion from `initial` in the window.
///
/// # Errors
/// [`ChaosError::OutOfRange`] for windows that cannot be used, and [`ChaosError::Flow`] if the flow fails.
pub fn classify<F: DenseFlow>(
    flow: &F,
    initial: &State,
    window: Window,
    criteria: &Criteria,
) -> Result<Classification, ChaosError> {
    classify_beside(flow, initial, window, criteria, None)
}

/// The same, followed further while the spread of the turning points changes, at most `extensions` times.
pub(super) fn classify_settled<F: DenseFlow>(
    flow: &F,
    initial: &State,
    window: Window,
    criteria: &Criteria,
    known: Option<&KnownCycle>,
    extensions: usize,
) -> Result<Classification, ChaosError> {
    let mut window = window;
    let mut found = classify_beside(flow, initial, window, criteria, known)?;
    for _ in 0..extensions {
        if !found.still_changes(criteria) {
            return Ok(found);
        }
        window = Window { transient: window.end(), length: window.end() };
        found = classify_beside(flow, initial, window, criteria, known)?;
    }
    if extensions > 0 && found.still_changes(criteria) {
        found.class = MotionClass::NotSettled;
    }
    Ok(found)
}

impl Classification {
    fn still_changes(&self, criteria: &Criteria) -> bool {
        let spread = self.evidence.spread_ratio;
        let changes = match self.class {
            // In chaos the extremes of two halves differ by chance.
            MotionClass::Chaos => spread.is_some_and(|ratio| ratio > 1.0 / criteria.shrinkage),
            _ => spread.is_some_and(|ratio| (ratio - 1.0).abs() > SAME_SPREAD),
        };
        self.class == MotionClass::NotSettled || changes
    }
}

fn classify_beside<F: DenseFlow>(
    flow: &F,
    initial: &State,
    window: Window,
    criteria: &Criteria,
    known: Option<&KnownCycle>,
) -> Result<Classification, ChaosError> {
    let window = window.validated()?;
    let failed = |source| ChaosError::flow(flow.name(), source);
    let motion = flow.motion(initial, window.end()).map_err(failed)?;
    let mut evidence = Evidence::default();
    if let Outcome::Diverged { time, .. } = motion.outcome() {
        evidence.life_time = Some(time);
        return Ok(Classification { class: MotionClass::Diverged, amplitude_range: None, evidence });
    }
    let turns = turning_points(&motion, window.transient).map_err(failed)?;
    let amplitudes = turns.iter().map(|turn| turn.state.positions[0]);
    let range = amplitudes.fold((f64::NEG_INFINITY, f64::INFINITY), |(max, min), a| (max.max(a), min.min(a)));
    let amplitude_range = if turns.is_empty() {
        let rest = motion.state(motion.end()).map_err(failed)?.positions[0].abs();
        Some((rest, rest))
    } else {
        Some(range)
    };
    let slips =
        motion.events().iter().filter(|e| e.time >= window.transient && e.kind == EventKind::StickToSlip).count();
    evidence.slips = Some(slips);
    let half = turns.partition_point(|turn| turn.time < window.transient + 0.5 * window.length);
    let (early, late) = turns.split_at(half);
    if slips == 0 {
        let class = without_slip(early, late, criteria.rest);
        return Ok(Classification { class, amplitude_range, evidence });
    }
    if known.is_some_and(|cycle| approaches(cycle, early, late)) {
        evidence.decided_by = Some(Decision::Multipliers);
        return Ok(Classification { class: MotionClass::LimitCycle, amplitude_range, evidence });
    }
    if let Some((cycle, distance)) = recurrence(late, criteria.longest_cycle, criteria.recurrence) {
        (evidence.cycle, evidence.recurrence) = (Some(cycle), Some(distance));
        if distance <= criteria.recurrence {
            return Ok(Classification { class: MotionClass::LimitCycle, amplitude_range, evidence });
        }
    }
    let growth = separation_growth(flow, &motion, window, criteria.separation).map_err(failed)?;
    let ratio = spread(late) / spread(early);
    (evidence.separation_growth, evidence.spread_ratio) = (Some(growth), ratio.is_finite().then_some(ratio));
    let class = if ratio > 1.0 / criteria.shrinkage {
        MotionClass::Torus
    } else if growth > criteria.growth {
        MotionClass::Chaos
    } else if ratio < criteria.shrinkage {
        MotionClass::LimitCycle
    } else {
        MotionClass::Torus
    };
    Ok(Classification { class, amplitude_range, evidence })
}

/// Whether the cycle attracts, and the motion comes nearer to it in the second half.
fn approaches(cycle: &KnownCycle, early: &[TurningPoint], late: &[TurningPoint]) -> bool {
    let farthest = |turns: &[TurningPoint]| {
        turns.iter().map(|turn| turn.state.max_difference(&cycle.reversal)).fold(0.0, f64::max)
    };
    let near = NEAR_CYCLE * cycle.reversal.positions[0].abs();
    let (before, after) = (farthest(early), farthest(late));
    // At a distance of rounding it comes no nearer.
    cycle.leading_multiplier < 1.0 && !late.is_empty() && after < near && (after < before || after < 1e-9)
}

/// Without slip the rest position need not be 0, so the swing is that between neighbouring turning points of either side.
fn without_slip(early: &[TurningPoint], late: &[TurningPoint], rest: f64) -> MotionClass {
    let swing = |turns: &[TurningPoint]| {
        let sum = |pair: &[TurningPoint]| pair.iter().map(|turn| turn.state.positions[0]).sum::<f64>().abs();
        turns.windows(2).map(sum).fold(0.0, f64::max)
    };
    match (swing(early), swing(late)) {
        (_, late) if late < rest => MotionClass::Equilibrium,
        (early, late) if late < (1.0 - STEADY_SWING) * early => MotionClass::Equilibrium,
        (early, late) if late > (1.0 + STEADY_SWING) * early => MotionClass::NotSettled,
        _ => MotionClass::Neutral,
    }
}

/// The least number of returns after which the turning points repeat within `tolerance`, or else the one after which they
/// repeat best, and how well. Two returns to a period.
fn recurrence(turns: &[TurningPoint], longest: usize, tolerance: f64) -> Option<(usize, f64)> {
    let distance = |k: usize| {
        let pairs = turns.iter().zip(turns.iter().skip(k));
        pairs.map(|(a, b)| a.state.max_difference(&b.state)).fold(0.0, f64::max)
    };
    let found: Vec<_> = (1..=longest.min(turns.len() / 2)).map(|k| (k, distance(k))).collect();
    let within = found.iter().find(|(_, distance)| *distance <= tolerance);
    within.or_else(|| found.iter().min_by(|a, b| a.1.total_cmp(&b.1))).copied()
}

/// Largest extent of the turning points in any coordinate.
fn spread(turns: &[TurningPoint]) -> f64 {
    let coordinates = turns.first().map_or(0, |turn| turn.state.components().count());
    let extent = |i: usize| {
        let values = turns.iter().filter_map(|turn| turn.state.components().nth(i));
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        high - low
    };
    (0..coordinates).map(extent).fold(0.0, f64::max)
}

/// Growth of a separation in mass 2 in the second half of the window, scaled back after each stretch.
fn separation_growth<F: DenseFlow>(
    flow: &F,
    motion: &F::Motion,
    window: Window,
    separation: f64,
) -> Result<f64, F::Error> {
    let stretch = window.length / RESCALINGS as f64;
    let time = |n: usize| (window.transient + n as f64 * stretch).min(motion.end());
    let after_stretch = |from: &State| {
        let onwards = flow.motion(from, stretch)?;
        onwards.state(onwards.end())
    };
    let mut base = motion.state(window.transient)?;
    let mut neighbour = base.clone();
    neighbour.positions[1] += separation;
    let mut growth = 0.0;
    for n in 0..RESCALINGS {
        let mut there = after_stretch(&neighbour)?;
        // Where a fresh start is itself a small change, both motions must have it, or it would count as separation.
        let here = if flow.restarts_exactly() { motion.state(time(n + 1))? } else { after_stretch(&base)? };
        let distance = there.max_difference(&here);
        // Neighbours that meet to rounding separate no further.
        let scale = if distance > 0.0 { separation / distance } else { 0.0 };
        if n >= RESCALINGS / 2 {
            growth -= scale.max(f64::MIN_POSITIVE).ln();
        }
        draw_in(&mut there, &here, scale);
        (base, neighbour) = (here, there);
    }
    Ok(growth)
}

/// Moves a state towards another until a fraction `scale` of their difference is left.
fn draw_in(state: &mut State, towards: &State, scale: f64) {
    let parts = [
        (&mut state.positions, &towards.positions),
        (&mut state.velocities, &towards.velocities),
        (&mut state.slider_forces, &towards.slider_forces),
    ];
    for (values, targets) in parts {
        values.iter_mut().zip(targets).for_each(|(value, target)| *value = target + scale * (*value - target));
    }
    // Both lie within the slip force, but scaling rounds.
    state.slider_forces.iter_mut().for_each(|f| *f = f.clamp(-1.0, 1.0));
}
