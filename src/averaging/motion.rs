//! Motions of the slow flow with the fast oscillation restored, equations (4)-(5):
//!
//! ```text
//! x_j = Re Z_j,   v_j = Re(i w Z_j),   Z_j = A_j e^(i phi),   phi = int w dt
//! ```
//!
//! Integrated are A1, A2 and phi, regular at zero amplitudes too. Between steps, motions are quintics that agree with the slow flow in value and two
//! derivatives at both ends; with steps of at most [`LONGEST_STEP`] they are good to about 1e-8. The slider force is that of the steady
//! hysteresis at the momentary amplitude,
//!
//! ```text
//! f = max(-1, 1 - (a1 - x1)) where v1 < 0,   min(1, -1 + (x1 + a1)) where v1 > 0     (a1 > 1),      f = x1     (a1 <= 1),
//! ```
//!
//! so a state of the slow flow fixes it: of an initial state only x and v are used. Events are those of this hysteresis.

use super::describing::DescribingFunction;
use super::error::AveragingError;
use super::integration::{Ending, Field, Tolerance, integrate};
use super::limit_cycles::Coefficients;
use super::slow_flow::SlowFlow;
use crate::dynamics::{Event, EventKind, Motion, Outcome, State};
use crate::model::{ContactState, Direction, sticking_angle};
use nalgebra::{Complex, Vector3};
use std::f64::consts::PI;

/// Short against the slow period near 90.
const LONGEST_STEP: f64 = 2.0;
/// Small against the separations of 1e-7 by which chaos is told from a torus.
const TOLERANCE: Tolerance = Tolerance { relative: 1e-12, absolute: 1e-13, longest_step: LONGEST_STEP };
/// Time between two looks for a reversal, a twelfth of a cycle.
/// Velocities below this are rounding.
const AT_REST: f64 = 1e-12;
const SCAN_STEP: f64 = 0.5;
const I: Complex<f64> = Complex::new(0.0, 1.0);

/// Complex amplitudes and the phase integral.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlowState {
    pub amplitudes: [Complex<f64>; 2],
    /// Integral of w over time, rad.
    pub phase: f64,
}

impl SlowState {
    fn from_components(y: &[f64; 5]) -> Self {
        Self { amplitudes: [Complex::new(y[0], y[1]), Complex::new(y[2], y[3])], phase: y[4] }
    }

    /// `|A1|` and `A2 e^(-i theta1)`.
    #[must_use]
    pub fn reduced(&self) -> Vector3<f64> {
        let [a1, a2] = self.amplitudes;
        let modulus = a1.norm();
        let turned = if modulus > 0.0 { a2 * a1.conj() / modulus } else { a2 };
        Vector3::new(modulus, turned.re, turned.im)
    }

    fn rotating(&self, mass: usize) -> Complex<f64> {
        self.amplitudes[mass] * Complex::from_polar(1.0, self.phase)
    }
}

/// First and second time derivatives of `(A1, A2, phi)`.
fn rates(flow: &SlowFlow, y: &[f64; 5]) -> ([f64; 5], [f64; 5]) {
    let p = flow.parameters();
    let slow = SlowState::from_components(y);
    let ([a1, a2], reduced) = (slow.amplitudes, slow.reduced());
    let modulus = reduced[0];
    let d = DescribingFunction::at(modulus);
    let energy = flow.energy(&d, [reduced[1], reduced[2]]);
    let (w, gain) = flow.frequency().implicit(&energy);
    let c = Coefficients::new(&p, &d, w);
    let scale = -I / (2.0 * w);
    let (n1, n2) = (c.first * a1 + c.coupling * a2, c.second * a2 + c.coupling * a1);
    let (g1, g2) = (scale * n1, scale * n2);

    let turned_rate = |g: Complex<f64>| if modulus > 0.0 { g * a1.conj() / modulus } else { g };
    let (along, across) = (turned_rate(g1).re, if modulus > 0.0 { turned_rate(g1).im / modulus } else { 0.0 });
    let b_rate = turned_rate(g2) - I * across * Complex::new(reduced[1], reduced[2]);
    let reduced_rate = [along, b_rate.re, b_rate.im];
    let slope = |i: usize| energy.potential_gradient[i] + w * w * energy.inertia_gradient[i];
    let w_rate = gain * (0..3).map(|i| slope(i) * reduced_rate[i]).sum::<f64>();

    let (d1, d2) = (0.5 * (p.xi1 + p.xi2), 0.5 * (p.xi1 - p.xi2));
    let diagonal_rate = Complex::new(2.0 * w, -d1) * w_rate;
    let coupling_rate = Complex::new(0.0, -d2) * w_rate;
    let first_rate = diagonal_rate - p.gamma * along * Complex::new(d.stiffness_slope, d.damping_slope);
    let n1_rate = first_rate * a1 + c.first * g1 + coupling_rate * a2 + c.coupling * g2;
    let n2_rate = diagonal_rate * a2 + c.second * g2 + coupling_rate * a1 + c.coupling * g1;
    let (h1, h2) = (scale * n1_rate - g1 * (w_rate / w), scale * n2_rate - g2 * (w_rate / w));
    ([g1.re, g1.im, g2.re, g2.im, w], [h1.re, h1.im, h2.re, h2.im, w_rate])
}

struct Amplitudes<'a> {
    flow: &'a SlowFlow,
    bound: f64,
}

impl Field<5> for Amplitudes<'_> {
    fn rate(&self, y: &[f64; 5], rate: &mut [f64; 5]) {
        *rate = rates(self.flow, y).0;
    }

    fn guards(&self, y: &[f64; 5]) -> [f64; 2] {
        self.flow.kinks(&SlowState::from_components(y).reduced())
    }

    fn has_left(&self, y: &[f64; 5]) -> bool {
        SlowState::from_components(y).amplitudes.iter().any(|a| a.norm() > self.bound)
    }
}

/// A step's end with two derivatives.
#[derive(Debug, Clone, Copy)]
struct Knot {
    time: f64,
    y: [f64; 5],
    rate: [f64; 5],
    second: [f64; 5],
}

/// A motion of the slow flow, known at every time from 0 to [`Motion::end`].
#[derive(Debug, Clone)]
pub struct SlowMotion {
    flow: SlowFlow,
    knots: Vec<Knot>,
    events: Vec<Event>,
    outcome: Outcome,
    end: f64,
}

impl SlowMotion {
    /// From amplitudes at time 0 to `t_end`, or to where one of them exceeds `bound`.
    pub(super) fn follow(flow: &SlowFlow, start: SlowState, t_end: f64, bound: f64) -> Result<Self, AveragingError> {
        let mut knots = Vec::new();
        let [a1, a2] = start.amplitudes;
        let y = [a1.re, a1.im, a2.re, a2.im, start.phase];
        let ending = integrate(&Amplitudes { flow, bound }, y, t_end, TOLERANCE, |time, y| {
            let (rate, second) = rates(flow, y);
            knots.push(Knot { time, y: *y, rate, second });
        })?;
        let mut motion =
            Self { flow: flow.clone(), knots, events: Vec::new(), outcome: Outcome::Completed, end: t_end };
        if let Ending::Left { time } = ending {
            motion.end = time;
            motion.end = motion.time_of_leaving(bound);
            motion.outcome = Outcome::Diverged { time: motion.end, bound };
        }
        motion.events = motion.hysteresis_events();
        Ok(motion)
    }

    /// Complex amplitudes and phase.
    ///
    /// # Errors
    /// [`AveragingError::OutsideSpan`] for times outside `[0, end]`.
    pub fn slow_state(&self, time: f64) -> Result<SlowState, AveragingError> {
        if !(0.0..=self.end).contains(&time) {
            return Err(AveragingError::OutsideSpan { found: time, end: self.end });
        }
        Ok(self.slow_at(time))
    }

    /// Contact state of the hysteresis.
    ///
    /// # Errors
    /// [`AveragingError::OutsideSpan`] for times outside `[0, end]`.
    pub fn contact(&self, time: f64) -> Result<ContactState, AveragingError> {
        let z = self.slow_state(time)?.rotating(0);
        let since_reversal = z.arg().rem_euclid(PI);
        let slips = z.norm() > 1.0 && since_reversal > sticking_angle(z.norm());
        // v1 has the sign of -Im z.
        let direction = if z.im > 0.0 { Direction::Negative } else { Direction::Positive };
        Ok(if slips { ContactState::Slip(direction) } else { ContactState::Stick })
    }

    /// Averaged power put into the system by passive damping, self-excitation and friction.
    pub(super) fn power(&self, time: f64) -> [f64; 3] {
        let (p, slow) = (self.flow.parameters(), self.slow_at(time));
        let [a1, a2] = slow.amplitudes;
        let w = self.flow.energy_and_frequency(&slow.reduced()).1;
        let sliding = (a1.norm() - 1.0).max(0.0);
        [
            -0.25 * (p.xi2 - p.xi1) * w * w * (a1 - a2).norm_sqr(),
            -0.5 * p.xi1 * w * w * (a1.norm_sqr() + a2.norm_sqr()),
            -2.0 * p.gamma * sliding * w / PI,
        ]
    }

    fn slow_at(&self, time: f64) -> SlowState {
        let right = self.knots.partition_point(|knot| knot.time <= time);
        let (Some(left), Some(knot)) = (self.knots.get(right.saturating_sub(1)), self.knots.get(right)) else {
            // The end, or a motion of no length.
            return self
                .knots
                .last()
                .map_or(SlowState { amplitudes: [Complex::new(0.0, 0.0); 2], phase: 0.0 }, |last| {
                    SlowState::from_components(&last.y)
                });
        };
        SlowState::from_components(&quintic(left, knot, time))
    }

    fn state_at(&self, time: f64) -> State {
        restored(&self.flow, &self.slow_at(time))
    }

    /// Where the larger amplitude passes the bound in the last step, by halving.
    fn time_of_leaving(&self, bound: f64) -> f64 {
        let beyond = |time: f64| self.slow_at(time).amplitudes.iter().any(|a| a.norm() > bound);
        let [.., before, last] = self.knots.as_slice() else { return self.end };
        let (mut low, mut high) = (before.time, last.time);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if beyond(middle) { high = middle } else { low = middle }
        }
        low
    }

    /// Reversals of mass 1, and the slips between them, in order. A slip under way at the end has begun.
    fn hysteresis_events(&self) -> Vec<Event> {
        let im = |time: f64| self.slow_at(time).rotating(0).im;
        let event = |time: f64, kind| Event { time, element: 0, kind, state: self.state_at(time) };
        // Angle since the reversal at `start`, less the one at which slip begins; `stop` is the reversal after it, where it is known.
        let past = |t: f64, start: f64, stop: f64| {
            let z = self.slow_at(t).rotating(0);
            let angle = if t <= start {
                0.0
            } else if t >= stop {
                PI
            } else {
                z.arg().rem_euclid(PI)
            };
            angle - sticking_angle(z.norm())
        };
        let mut events = Vec::new();
        let steps = (self.end / SCAN_STEP).ceil() as usize;
        let at = |n: usize| (n as f64 * SCAN_STEP).min(self.end);
        let (mut reversal, mut before) = (None::<f64>, im(0.0));
        if before.abs() < AT_REST {
            // The motion starts at a reversal.
            (reversal, before) = (Some(0.0), im(at(1)));
        }
        for n in 0..steps {
            let after = im(at(n + 1));
            if (before < 0.0) == (after < 0.0) {
                continue;
            }
            before = after;
            let time = root(im, at(n), at(n + 1));
            let turned = self.slow_at(time).rotating(0).norm() > 1.0;
            if let (true, Some(start)) = (turned, reversal) {
                events.push(event(root(|t| past(t, start, time), start, time), EventKind::StickToSlip));
                events.push(event(time, EventKind::SlipToStick));
            }
            reversal = Some(time);
        }
        let slips = |start: &f64| self.end > *start && past(self.end, *start, f64::INFINITY) > 0.0;
        if let Some(start) = reversal.filter(slips) {
            let begun = root(|t| past(t, start, f64::INFINITY), start, self.end);
            events.push(event(begun, EventKind::StickToSlip));
        }
        events
    }
}

/// Positions, velocities and slider force of a slow state.
fn restored(flow: &SlowFlow, slow: &SlowState) -> State {
    let w = flow.energy_and_frequency(&slow.reduced()).1;
    let (z1, z2) = (slow.rotating(0), slow.rotating(1));
    let (a, x) = (z1.norm(), z1.re);
    let force = match (a > 1.0, z1.im >= 0.0) {
        (false, _) => x,
        (true, true) => (1.0 - (a - x)).max(-1.0),
        (true, false) => (x + a - 1.0).min(1.0),
    };
    State::two_mass([x, z2.re, -w * z1.im, -w * z2.im, force.clamp(-1.0, 1.0)])
}

/// The quintic with value and two derivatives of both knots.
fn quintic(left: &Knot, right: &Knot, time: f64) -> [f64; 5] {
    let h = right.time - left.time;
    let t = (time - left.time) / h;
    let s = 1.0 - t;
    // Hermite's basis: value, rate and second derivative at the left end; those at the right end by t -> 1 - t.
    let basis = |t: f64| {
        let t3 = t * t * t;
        let fall = 1.0 - t3 * (10.0 - 15.0 * t + 6.0 * t * t);
        let rate = t - t3 * (6.0 - 8.0 * t + 3.0 * t * t);
        let bend = 0.5 * t * t * (1.0 - t).powi(3);
        [fall, rate, bend]
    };
    let ([l0, l1, l2], [r0, r1, r2]) = (basis(t), basis(s));
    std::array::from_fn(|i| {
        l0 * left.y[i]
            + r0 * right.y[i]
            + h * (l1 * left.rate[i] - r1 * right.rate[i])
            + h * h * (l2 * left.second[i] + r2 * right.second[i])
    })
}

/// A root between `low` and `high`, where the function has different signs (Illinois).
fn root(function: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let mut ends = [(low, function(low)), (high, function(high))];
    let mut found = high;
    for _ in 0..60 {
        if ends[0].1 == ends[1].1 {
            break;
        }
        let next = ends[0].0 + (ends[1].0 - ends[0].0) * ends[0].1 / (ends[0].1 - ends[1].1);
        let moved = (next - found).abs();
        found = next;
        let value = function(found);
        // Roundings of the time.
        if value == 0.0 || moved <= 1e-14 * (1.0 + found.abs()) {
            break;
        }
        let side = usize::from((value < 0.0) != (ends[0].1 < 0.0));
        ends[side] = (found, value);
        ends[1 - side].1 *= 0.5;
    }
    found
}

impl Motion for SlowMotion {
    type Error = AveragingError;

    fn end(&self) -> f64 {
        self.end
    }

    fn outcome(&self) -> Outcome {
        self.outcome
    }

    fn events(&self) -> &[Event] {
        &self.events
    }

    fn state(&self, time: f64) -> Result<State, AveragingError> {
        self.slow_state(time).map(|slow| restored(&self.flow, &slow))
    }
}
