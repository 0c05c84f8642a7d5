//! Where a phase of the two-mass rig ends: a scan of the event function on the tabulated grid, every cell certified.
//!
//! With `q` at the grid nodes and `|q''| <= M2` over the block, a cell of width h holds no crossing if `q` keeps at least
//! `M2 h^2/8` from both guards at both ends. A doubtful cell is examined by itself, the scan then goes on behind it:
//!
//! - if `q'` has one sign throughout (`|q'(0) + q'(h)|/2 > M2 h/2`) there is at most one crossing, and whether there is one
//!   shows at the ends;
//! - the first cell of a stick phase, where `q` starts on the guard with `q' = 0`, is clear if `q'' + M3 h/3 < 0`; otherwise the search
//!   takes value and slope as the zeros they are;
//! - anything else goes to the search by halving of [`super::crossing`].

use super::crossing::{Verdict, Watch, first_crossing};
use super::modal::{Modal, Modes, dot, magnitudes, rotated};
use super::modal_phase::{Contact, End, ModalPair, Phase};
use super::series::Series;

/// End of a phase: time since its start, and coordinates there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Exit {
    pub(super) end: End,
    pub(super) time: f64,
    pub(super) c: Modal,
}

/// What a block of cells is scanned with.
struct Block<'a> {
    modes: &'a Modes,
    phase: &'a Phase,
    c: Modal,
    guards: [f64; 2],
    /// `M2 h^2/8` and `M3 h/3`.
    bulge: f64,
    jerk: f64,
    first: bool,
    /// Whether `q` has been off its guards, beyond rounding, since the phase began.
    armed: bool,
    tolerance: f64,
}

impl ModalPair {
    /// The first end of `phase` within `limit`. An event exactly at the limit counts.
    pub(super) fn exit(&self, phase: &Phase, limit: f64, amplitude_bound: f64) -> Exit {
        let modes = self.modes(phase.contact);
        let guards = self.guards(phase);
        let mut c = phase.c;
        let mut armed = false;
        for number in 0_u64.. {
            let base = number as f64 * (modes.cells as f64 * modes.cell);
            let remaining = limit - base;
            if remaining < 0.0 {
                break;
            }
            let cells = ((remaining / modes.cell) as usize).saturating_add(1).min(modes.cells);
            let [m1, m2] = magnitudes(&c);
            let weighted = |weights: &[f64; 2]| weights[0] * m1 + weights[1] * m2;
            let block = Block {
                modes,
                phase,
                c,
                guards,
                bulge: weighted(&modes.bulge_weights),
                jerk: weighted(&modes.jerk_weights),
                first: number == 0,
                armed,
                tolerance: 16.0 * f64::EPSILON * (m1 + m2 + largest_guard(phase)),
            };
            let found = block.scan(cells);
            let [e1, e2] = self.equilibrium(phase.contact, phase.anchor);
            let amplitude = weighted(&modes.amplitude_weights) + e1.abs().max(e2.abs());
            if amplitude > amplitude_bound || amplitude.is_nan() {
                let until = found.map_or(remaining, |exit| exit.time.min(remaining));
                if let Some(exit) = block.leaves_bound([e1, e2], amplitude_bound, until) {
                    return Exit { time: base + exit.time, ..exit };
                }
            }
            match found {
                Some(exit) if exit.time <= remaining => return Exit { time: base + exit.time, ..exit },
                Some(_) => break,
                None => {
                    armed = block.armed_before(cells);
                    c = Self::after_block(modes, &c);
                }
            }
        }
        Exit { end: End::Limit, time: limit, c: self.advanced(phase, limit) }
    }
}

/// Size of what a guard is computed from: the normalised forces, of size 1, while sticking.
fn largest_guard(phase: &Phase) -> f64 {
    match phase.contact {
        Contact::Stick => phase.limit.abs() + 2.0,
        Contact::Slip => 0.0,
    }
}

impl Block<'_> {
    fn scan(&self, cells: usize) -> Option<Exit> {
        let [lower, upper] = self.guards;
        let (inner_lower, inner_upper) = (lower + self.bulge, upper - self.bulge);
        let inside = |q: f64| q > inner_lower && q < inner_upper;
        let mut left_inside = inside(self.c[0] + self.c[2]);
        if !left_inside && self.first && self.starts_inwards() {
            // Only the far end of the first cell is left to be certified.
            left_inside = true;
        }
        for n in 1..=cells {
            let right_inside = inside(dot(&self.c, &self.modes.coarse[n]));
            if !(left_inside && right_inside)
                && let Some(exit) = self.examine(n)
            {
                return Some(exit);
            }
            left_inside = right_inside;
        }
        None
    }

    /// Whether a stick phase that starts on its upper guard moves away from it throughout the first cell, and far from the lower.
    fn starts_inwards(&self) -> bool {
        let q = self.c[0] + self.c[2];
        self.phase.on_limit && q > self.guards[0] + self.bulge && self.modes.curvature(&self.c) + 1.01 * self.jerk < 0.0
    }

    /// Whether `q` has been off its guards by node `n`.
    fn armed_before(&self, n: usize) -> bool {
        let off = |q: f64| q - self.guards[0] > self.tolerance && self.guards[1] - q > self.tolerance;
        self.armed || (0..=n).rev().any(|n| off(dot(&self.c, &self.modes.coarse[n])))
    }

    fn at_node(&self, n: usize) -> Modal {
        rotated(&self.c, &self.modes.coarse[n])
    }

    /// Decides a doubtful cell, from node `n - 1` to node `n`.
    fn examine(&self, n: usize) -> Option<Exit> {
        let left = self.at_node(n - 1);
        let right = self.at_node(n);
        let (q0, q1) = (left[0] + left[2], right[0] + right[2]);
        let (s0, s1) = (self.modes.slope(&left), self.modes.slope(&right));
        // M2 h/2 = 4 bulge / h.
        let monotone = 0.5 * (s0 + s1).abs() > 4.0 * self.bulge / self.modes.cell && s0 * s1 > 0.0;
        let [lower, upper] = self.guards;
        if monotone && q0 > lower && q0 < upper {
            let (level, end) = if s0 > 0.0 { (upper, End::Upper) } else { (lower, End::Lower) };
            if q1 > lower && q1 < upper {
                return None;
            }
            if let Some((time, c)) = self.modes.root(&left, level, self.estimate([q0, q1], [s0, s1], level)) {
                return Some(Exit { end, time: (n - 1) as f64 * self.modes.cell + time, c });
            }
        }
        self.search(n, &left)
    }

    /// Estimate of the root in a cell: the inverse function as a cubic through both ends and their slopes.
    fn estimate(&self, [q0, q1]: [f64; 2], [s0, s1]: [f64; 2], level: f64) -> f64 {
        let range = q1 - q0;
        let u = (level - q0) / range;
        let (t0, t1) = (range / s0, range / s1);
        let h = self.modes.cell;
        let cubic = u * (t0 + u * ((3.0 * h - 2.0 * t0 - t1) + u * (t0 + t1 - 2.0 * h)));
        if (0.0..=h).contains(&cubic) { cubic } else { u * h }
    }

    /// The certified search by halving, on the series of the cell that starts at node `n - 1`.
    #[cold]
    fn search(&self, n: usize, left: &Modal) -> Option<Exit> {
        let q = self.modes.coefficients(left);
        let [m1, m2] = magnitudes(&self.c);
        let watch = match self.phase.contact {
            Contact::Stick => Watch::Touches { armed: self.armed_before(n - 1) },
            Contact::Slip => Watch::Crossings,
        };
        let verdict = |side: f64, guard: f64| {
            if guard.is_infinite() {
                return Verdict::Clear;
            }
            let mut excess = q.map(|q| side * q);
            excess[0] -= side * guard;
            if self.first && n == 1 && self.phase.on_limit && side > 0.0 {
                excess[..2].fill(0.0);
            }
            let scale = m1 + m2 + largest_guard(self.phase);
            let excess = Series::new(excess, self.modes.cell, scale).of_motion(m1 + m2);
            first_crossing(&excess, self.modes.cell, watch)
        };
        let (up, down) = (verdict(1.0, self.guards[1]), verdict(-1.0, self.guards[0]));
        let (verdict, end) = match (up.time(), down.time()) {
            (None, None) => return None,
            (Some(t_up), Some(t_down)) if t_down < t_up => (down, End::Lower),
            (None, Some(_)) => (down, End::Lower),
            _ => (up, End::Upper),
        };
        let time = verdict.time()?;
        let c = self.modes.after(left, time);
        let end = if matches!(verdict, Verdict::Touches(_)) || self.turns_back(end, &c) { End::Graze } else { end };
        Some(Exit { end, time: (n - 1) as f64 * self.modes.cell + time, c })
    }

    /// Whether a stick phase does not load further where it reached its slip force: to rounding it only touches it.
    fn turns_back(&self, end: End, c: &Modal) -> bool {
        let side = if end == End::Upper { 1.0 } else { -1.0 };
        self.phase.contact == Contact::Stick && side * self.modes.slope(c) < 0.0
    }

    /// First time within `until` at which a position exceeds the bound.
    #[cold]
    fn leaves_bound(&self, equilibrium: [f64; 2], bound: f64, until: f64) -> Option<Exit> {
        let cell = self.modes.cell;
        for n in 1..=self.modes.cells {
            let start = (n - 1) as f64 * cell;
            if start > until {
                return None;
            }
            let left = self.at_node(n - 1);
            let first = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)]
                .into_iter()
                .filter_map(|(index, sign)| {
                    let offset = sign * equilibrium[index] - bound;
                    let excess = self.modes.position_series(&left, index, sign, offset, bound);
                    first_crossing(&excess, cell.min(until - start), Watch::Crossings).time()
                })
                .min_by(f64::total_cmp);
            if let Some(time) = first {
                return Some(Exit { end: End::Bound, time: start + time, c: self.modes.after(&left, time) });
            }
        }
        None
    }
}
