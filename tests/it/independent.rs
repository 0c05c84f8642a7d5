//! The two-mass rig solved slowly and without any code of `exact`: Taylor steps straight from equations (1)-(3), and switches
//! by halving with a bound on the second derivative that follows from the right-hand side alone.
//!
//! While sticking the event function is `s f - 1` with second derivative `s x1''`; while slipping `-s v1` with second derivative
//! `-s x1'''`. Over a step of length w, every component is at most `max |y| e^(L w)`, L the largest row sum of the system.

use stickslip::dynamics::EventKind;
use stickslip::model::RigParameters;

const ORDER: usize = 16;
/// Length of a Taylor step: rates here are below 8, so the first term left out is below 0.25^17/17! = 2e-25.
const STEP: f64 = 1.0 / 32.0;
/// Shortest interval on which the search insists; the function changes there by less than rounding.
const FINEST: f64 = 1e-13;

/// `(x1, x2, v1, v2, f)`.
pub type Y = [f64; 5];

#[derive(Debug, Clone, Copy, PartialEq)]
enum Contact {
    Stick,
    Slip(f64),
}

/// A switch: time, kind, and the rate at which its guard is crossed (its conditioning).
#[derive(Debug, Clone, Copy)]
pub struct Switch {
    pub time: f64,
    pub kind: EventKind,
    pub rate: f64,
}

/// How crossings are looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Search {
    /// No crossing is missed.
    Certified,
    /// Signs at samples this far apart: the negative control.
    Sampled(f64),
}

#[derive(Debug, Clone, Copy)]
pub struct SlowRig {
    pub p: RigParameters,
}

impl SlowRig {
    fn accelerations(&self, [x1, x2, v1, v2, f]: Y) -> [f64; 2] {
        let RigParameters { xi1, xi2, kappa: k, gamma: g } = self.p;
        let (d1, d2) = ((xi1 + xi2) / 2.0, (xi1 - xi2) / 2.0);
        [-(d1 * v1 + d2 * v2 + (1.0 - g) * x1 + k * (x1 - x2) + g * f), -(d1 * v2 + d2 * v1 + x2 + k * (x2 - x1))]
    }

    fn derivative(&self, y: Y, contact: Contact) -> Y {
        let [a1, a2] = self.accelerations(y);
        let rate = if contact == Contact::Stick { y[2] } else { 0.0 };
        [y[2], y[3], a1, a2, rate]
    }

    fn row_sum(&self) -> f64 {
        let RigParameters { xi1, xi2, kappa, .. } = self.p;
        1.0 + 2.0 * kappa + xi1.abs() + xi2.abs()
    }

    /// Taylor coefficients of all components.
    fn expand(&self, y: Y, contact: Contact) -> [Y; ORDER + 1] {
        let mut terms = [y; ORDER + 1];
        for k in 1..=ORDER {
            terms[k] = self.derivative(terms[k - 1], contact).map(|c| c / k as f64);
        }
        terms
    }

    /// The force and its first four derivatives in time while sticking.
    pub fn force_derivatives(&self, y: Y) -> Y {
        let terms = self.expand(y, Contact::Stick);
        let mut factorial = 1.0;
        std::array::from_fn(|k| {
            factorial *= k.max(1) as f64;
            terms[k][4] * factorial
        })
    }

    fn curvature_bound(&self, y: Y, width: f64) -> f64 {
        let l = self.row_sum();
        let largest = y.iter().fold(0.0_f64, |m, c| m.max(c.abs())) * (l * width).exp();
        // |x1''| <= L max|y|, |x1'''| <= L^2 max|y|.
        l.max(l * l) * largest
    }

    /// All switches up to `t_end`.
    pub fn switches(&self, start: Y, t_end: f64, search: Search) -> Vec<Switch> {
        let (mut y, mut phase_start, mut switches) = (start, 0.0, Vec::new());
        let mut contact = self.initial_contact(start);
        while phase_start < t_end && switches.len() < 10_000 {
            let Some((duration, end, side)) = self.phase(y, contact, t_end - phase_start, search) else { break };
            phase_start += duration;
            y = end;
            let kind = if contact == Contact::Stick { EventKind::StickToSlip } else { EventKind::SlipToStick };
            contact = match contact {
                Contact::Stick => {
                    y[4] = side;
                    Contact::Slip(side)
                }
                Contact::Slip(_) => {
                    y[2] = 0.0;
                    Contact::Stick
                }
            };
            let rate = if kind == EventKind::StickToSlip { y[2] } else { self.accelerations(y)[0] };
            switches.push(Switch { time: phase_start, kind, rate: rate.abs() });
        }
        switches
    }

    fn initial_contact(&self, y: Y) -> Contact {
        if y[4].abs() == 1.0 && y[4] * y[2] > 0.0 { Contact::Slip(y[4]) } else { Contact::Stick }
    }

    /// Duration of a phase, its end, and the side on which it is left.
    fn phase(&self, start: Y, contact: Contact, limit: f64, search: Search) -> Option<(f64, Y, f64)> {
        let sides: &[f64] = match &contact {
            Contact::Stick => &[1.0, -1.0],
            Contact::Slip(side) => std::slice::from_ref(side),
        };
        let step = if let Search::Sampled(interval) = search { interval } else { STEP };
        let mut y = start;
        for n in 0.. {
            let base = f64::from(n) * step;
            if base > limit {
                return None;
            }
            let terms = self.expand(y, contact);
            let m2 = self.curvature_bound(y, step);
            let found = sides
                .iter()
                .filter_map(|&side| {
                    let excess = |t: f64| excess(at(&terms, t), contact, side);
                    let time = match search {
                        Search::Certified => crossing(&excess, 0.0, step, m2, n == 0),
                        Search::Sampled(_) => (excess(step) > 0.0).then(|| bisect(&excess, 0.0, step)),
                    };
                    time.map(|time| (time, side))
                })
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((time, side)) = found {
                return (base + time <= limit).then(|| (base + time, at(&terms, time), side));
            }
            y = at(&terms, step);
        }
        None
    }
}

fn at(terms: &[Y; ORDER + 1], t: f64) -> Y {
    terms.iter().rev().fold([0.0; 5], |sum, term| std::array::from_fn(|i| sum[i] * t + term[i]))
}

fn excess(y: Y, contact: Contact, side: f64) -> f64 {
    match contact {
        Contact::Stick => side * y[4] - 1.0,
        Contact::Slip(side) => -side * y[2],
    }
}

/// First time in `(a, b]` with positive excess. At the very start of a phase, where the excess is zero to rounding, values below
/// 1e-14 do not count.
fn crossing(excess: &impl Fn(f64) -> f64, a: f64, b: f64, m2: f64, first: bool) -> Option<f64> {
    let (at_a, at_b) = (excess(a), excess(b));
    let width = b - a;
    if at_a.max(at_b) + m2 * width * width / 8.0 < 0.0 {
        return None;
    }
    if width < FINEST || (first && m2 * width * width < 1e-14) {
        let noise = if first { 1e-14 } else { 0.0 };
        return (at_b > noise).then_some(b);
    }
    // Entering positive ground from clearly negative, too short to turn twice: slope between the ends beyond what M2 allows.
    if at_a < 0.0 && at_b > 0.0 && (at_b - at_a) / width > m2 * width {
        return Some(bisect(excess, a, b));
    }
    let middle = 0.5 * (a + b);
    crossing(excess, a, middle, m2, first).or_else(|| crossing(excess, middle, b, m2, first && middle == 0.0))
}

fn bisect(excess: &impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if excess(middle) > 0.0 { b = middle } else { a = middle }
    }
    b
}
