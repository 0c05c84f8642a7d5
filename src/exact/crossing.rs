//! The first time at which an excess function `e` becomes positive in a cell, with proof.
//!
//! On `[a, b]` of width w, with `|e''| <= M2` and `|e'''| <= M3`:
//!
//! ```text
//! e <= max(e(a), e(b)) + M2 w^2/8                       no crossing if that is negative
//! |e' - (e'(a) + e'(b))/2| <= M2 w/2                    one sign of e': at most one crossing
//! e <= e(a) + e'(a) w + (t - a)^2 (e''(a) + M3 w/3)/2   no crossing right after a phase that starts at e = e' = 0
//! ```
//!
//! A cell for which none of them decides is halved. Rules where rounding decides (`tolerance`, 16 roundings of the terms of e):
//!
//! - A crossing needs `e > tolerance`.
//! - A function that starts at exactly zero is searched as `e / t^n`, n the order of its first derivative that is not zero: a phase that starts
//!   on its own guard is decided by that derivative, never by the rounding of those before it.
//! - A maximum with `|e| <= tolerance` is a touch (grazing), not a crossing. It counts only once `e < -tolerance` has been seen
//!   since the guard was set.

use super::series::{Jet, Series};

/// Halvings after which a width is below any rounding of the cell.
const DEEPEST: usize = 60;

/// What a guard is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Watch {
    Crossings,
    /// Touches too; `armed` once the function has been seen below zero.
    Touches {
        armed: bool,
    },
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Verdict {
    Clear,
    Crosses(f64),
    Touches(f64),
}

impl Verdict {
    pub(super) fn time(self) -> Option<f64> {
        match self {
            Self::Clear => None,
            Self::Crosses(t) | Self::Touches(t) => Some(t),
        }
    }
}

/// First crossing of `excess` from below in `[0, to]`. A function that is not finite has none: whoever calls keeps the motion
/// bounded.
pub(super) fn first_crossing(excess: &Series, to: f64, watch: Watch) -> Verdict {
    if !(excess.at(0.0).value.is_finite() && excess.curvature_bound.is_finite()) {
        return Verdict::Clear;
    }
    let deflated = excess.deflated();
    let excess = deflated.as_ref().unwrap_or(excess);
    let mut search = Search { excess, watch };
    search.within((0.0, excess.at(0.0)), (to, excess.at(to)), 0)
}

struct Search<'a> {
    excess: &'a Series,
    watch: Watch,
}

type End = (f64, Jet);

impl Search<'_> {
    fn within(&mut self, left: End, right: End, depth: usize) -> Verdict {
        self.arm(left.1.value);
        let verdict = self.decide(left, right, depth).unwrap_or_else(|| {
            let middle = 0.5 * (left.0 + right.0);
            let middle = (middle, self.excess.at(middle));
            match self.within(left, middle, depth + 1) {
                Verdict::Clear => self.within(middle, right, depth + 1),
                found => found,
            }
        });
        self.arm(right.1.value);
        verdict
    }

    /// `None`: neither bound decides, halve the interval.
    fn decide(&self, (a, at_a): End, (b, at_b): End, depth: usize) -> Option<Verdict> {
        let (m2, m3, tolerance) = (self.excess.curvature_bound, self.excess.jerk_bound, self.excess.tolerance);
        let width = b - a;
        let bulge = m2 * width * width / 8.0;
        let mean_slope = 0.5 * (at_a.slope + at_b.slope);
        let rising = mean_slope - 0.5 * m2 * width > 0.0;
        let falling = mean_slope + 0.5 * m2 * width < 0.0;
        // Before a maximum that may be a touch this bound is not asked: it tells a touch from nothing no better.
        let may_touch = self.watch == (Watch::Touches { armed: true }) && at_a.slope > 0.0;
        let leaves_downwards = !may_touch
            && at_a.value + at_a.slope.max(0.0) * width <= tolerance
            && at_a.curvature + m3 * width / 3.0 < 0.0;
        if at_a.value.max(at_b.value) + bulge < 0.0 || (falling && at_a.value <= tolerance) || leaves_downwards {
            return Some(Verdict::Clear);
        }
        if rising {
            let crosses = at_b.value > tolerance;
            return Some(if crosses { Verdict::Crosses(self.root(a, b)) } else { Verdict::Clear });
        }
        if bulge <= 0.5 * tolerance || depth >= DEEPEST {
            return Some(self.decide_by_rounding((a, at_a), (b, at_b)));
        }
        None
    }

    fn decide_by_rounding(&self, (a, at_a): End, (b, at_b): End) -> Verdict {
        let tolerance = self.excess.tolerance;
        let peak = at_a.slope >= 0.0 && at_b.slope <= 0.0 && at_a.value.max(at_b.value) >= -tolerance;
        if at_b.value > tolerance {
            Verdict::Crosses(self.root(a, b))
        } else if peak && self.watch == (Watch::Touches { armed: true }) {
            let weight = at_a.slope / (at_a.slope - at_b.slope);
            Verdict::Touches(if weight.is_finite() { a + weight * (b - a) } else { a })
        } else {
            Verdict::Clear
        }
    }

    fn arm(&mut self, value: f64) {
        if let Watch::Touches { armed } = &mut self.watch {
            *armed |= value < -self.excess.tolerance;
        }
    }

    /// Root in `[a, b]` with `e(a) <= tolerance < e(b)`: Newton's method, halving where it leaves the bracket.
    fn root(&self, a: f64, b: f64) -> f64 {
        let (mut low, mut high) = (a, b);
        if self.excess.at(a).value >= 0.0 {
            return a;
        }
        let mut t = 0.5 * (a + b);
        for _ in 0..DEEPEST {
            let jet = self.excess.at(t);
            if jet.value < 0.0 {
                low = t
            } else {
                high = t
            }
            let newton = t - jet.value / jet.slope;
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            let step = (next - t).abs();
            t = next;
            // Below a rounding of the cell the value no longer changes.
            if step <= 0.5 * f64::EPSILON * self.excess.span {
                break;
            }
        }
        t
    }
}

#[cfg(test)]
mod tests {
    use super::super::series::ORDER;
    use super::*;

    /// `e = c0 + c1 t + c2 t^2` on [0, 1], with rounding scale 1.
    fn parabola(c0: f64, c1: f64, c2: f64) -> Series {
        let mut coefficients = [0.0; ORDER + 1];
        coefficients[..3].copy_from_slice(&[c0, c1, c2]);
        Series::new(coefficients, 1.0, 1.0)
    }

    const ARMED: Watch = Watch::Touches { armed: true };

    #[test]
    fn a_double_crossing_between_equal_ends_is_found() {
        // Both ends at -0.25 + 1e-9, maximum 1e-9 at t = 1/2: roots 1/2 -+ sqrt(1e-9).
        let verdict = first_crossing(&parabola(-0.25 + 1e-9, 1.0, -1.0), 1.0, ARMED);
        let Verdict::Crosses(t) = verdict else { panic!("{verdict:?}") };
        // The root is conditioned as rounding / slope = 1e-16 / 6e-5.
        assert!((t - (0.5 - 1e-9_f64.sqrt())).abs() < 1e-11);
    }

    #[test]
    fn a_maximum_just_below_zero_is_no_crossing() {
        assert_eq!(first_crossing(&parabola(-0.25 - 1e-13, 1.0, -1.0), 1.0, ARMED), Verdict::Clear);
    }

    #[test]
    fn a_maximum_at_zero_is_a_touch_and_only_where_touches_are_watched() {
        let touching = parabola(-0.25, 1.0, -1.0);
        let Verdict::Touches(t) = first_crossing(&touching, 1.0, ARMED) else { panic!("no touch") };
        // Resolved to the width at which the bulge is a rounding: sqrt(tolerance) = 6e-8; the vertex formula does better.
        assert!((t - 0.5).abs() < 1e-7);
        assert_eq!(first_crossing(&touching, 1.0, Watch::Crossings), Verdict::Clear);
    }

    #[test]
    fn a_phase_that_starts_on_its_guard_is_not_triggered_again() {
        assert_eq!(first_crossing(&parabola(0.0, 0.0, -1.0), 1.0, Watch::Touches { armed: false }), Verdict::Clear);
        assert_eq!(first_crossing(&parabola(1e-16, 1e-17, -1.0), 1.0, Watch::Touches { armed: false }), Verdict::Clear);
        assert_eq!(first_crossing(&parabola(0.0, -1e-9, 0.0), 1.0, Watch::Touches { armed: false }), Verdict::Clear);
    }

    /// `e = t^2 (t - 1e-9)`: no rounding of a constant or a slope can hide so early a root.
    #[test]
    fn a_phase_that_starts_on_its_guard_leaves_it_by_its_first_derivative_that_is_not_zero() {
        let cubic = |c2: f64| {
            let mut coefficients = [0.0; ORDER + 1];
            coefficients[2..4].copy_from_slice(&[c2, 1.0]);
            first_crossing(&Series::new(coefficients, 1.0, 1.0), 1.0, Watch::Touches { armed: false })
        };
        let Verdict::Crosses(t) = cubic(-1e-9) else { panic!("missed") };
        // The root is conditioned as rounding of the terms / slope.
        assert!((t - 1e-9).abs() < 1e-15, "{t}");
        assert_eq!(cubic(0.0), Verdict::Crosses(0.0));
        assert_eq!(cubic(-2.0), Verdict::Clear);
        // Below rounding the second derivative says nothing and the third decides.
        assert_eq!(cubic(-1e-17), Verdict::Crosses(0.0));
    }

    #[test]
    fn a_guard_already_reached_and_rising_is_crossed_at_once() {
        assert_eq!(first_crossing(&parabola(1e-16, 1.0, 0.0), 1.0, Watch::Crossings), Verdict::Crosses(0.0));
    }

    #[test]
    fn numbers_that_are_not_finite_end_the_search() {
        let verdict = first_crossing(&parabola(f64::NAN, 1.0, 1.0), 1.0, Watch::Crossings);
        assert_eq!(verdict, Verdict::Clear);
    }
}
