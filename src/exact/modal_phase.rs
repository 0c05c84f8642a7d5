//! One stick or slip phase of the two-mass rig in modal coordinates, and the switch to the next.
//!
//! A phase is kept in a mirrored frame (`y -> sign y`, which maps solutions to solutions) in which a slip is always the one
//! at f = +1 and a stick phase follows such a slip. With the slider held at `anchor = x1 - f`:
//!
//! ```text
//! stick: z* = anchor p,   p = K_stick^-1 (g, 0),   f  = q + anchor (p1 - 1),  left through f = +1 or f = -1
//! slip:  z* = -s,         s = K_slip^-1  (g, 0),   v1 = q,                    left through v1 = 0 downwards
//! ```
//!
//! and a switch is one real 4x4 product between the two sets of modal coordinates, plus constants. What defines a switch holds exactly
//! behind it: `limit`, the value of q at which f = +1, is that of q itself where a slip has just ended, and v1 = 0 there; a
//! slip starts with the velocity at which the stick phase ended. Far equilibria cost digits in all else, never there.

use super::modal::{CELL_ANGLE, Coefficients, Modal, Modes, Scaling, rotated};
use crate::model::{ContactState, Direction, RigParameters};
use nalgebra::{Matrix4, Vector4};

/// Largest equilibrium displacement of a slip phase for which subtracting it costs at most two digits: times of switches stay within
/// 1e-12 then.
const FARTHEST_EQUILIBRIUM: f64 = 1e2;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contact {
    Stick,
    Slip,
}

/// Start of a phase: what its whole course follows from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Phase {
    /// +1 or -1: the frame.
    pub(super) sign: f64,
    pub(super) contact: Contact,
    /// Position of the held slider in the frame; unused while slipping.
    pub(super) anchor: f64,
    /// Value of q at which f = +1; unused while slipping.
    pub(super) limit: f64,
    /// Whether a stick phase starts at f = +1 with v1 = 0, exactly.
    pub(super) on_limit: bool,
    pub(super) c: Modal,
}

impl Phase {
    fn slip(sign: f64, c: Modal) -> Self {
        Self { sign, contact: Contact::Slip, anchor: 0.0, limit: 0.0, on_limit: false, c }
    }
}

/// How a phase ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// f = +1 (in the frame) reached from below.
    Upper,
    /// f = -1 reached from above, or v1 = 0.
    Lower,
    /// f touched +1 or -1: the phase starts anew with the same contact state.
    Graze,
    /// The time asked for is over.
    Limit,
    /// The amplitude bound is exceeded.
    Bound,
}

/// The two sets of modal coordinates, and the passages between them.
#[derive(Debug, Clone)]
pub(super) struct ModalPair {
    pub(super) stick: Modes,
    pub(super) slip: Modes,
    /// `p1, p2` and `s1, s2`.
    stick_equilibrium: [f64; 2],
    slip_equilibrium: [f64; 2],
    slip_to_stick: Matrix4<f64>,
    slip_to_stick_constant: Vector4<f64>,
    /// Modal coordinates of `p` in the stick set.
    anchor_in_stick: Vector4<f64>,
    stick_to_slip: Matrix4<f64>,
    stick_to_slip_constant: Vector4<f64>,
    /// Modal coordinates of `p` in the slip set.
    anchor_in_slip: Vector4<f64>,
}

impl ModalPair {
    /// `None` where modal coordinates degenerate in either contact state.
    pub(super) fn new(parameters: &RigParameters) -> Option<Self> {
        let RigParameters { xi1, xi2, kappa, gamma } = *parameters;
        let (d1, d2) = (0.5 * (xi1 + xi2), 0.5 * (xi1 - xi2));
        let stick = Coefficients { stiffness1: 1.0 + kappa, stiffness2: 1.0 + kappa, kappa, d1, d2 };
        let slip = Coefficients { stiffness1: 1.0 - gamma + kappa, ..stick };
        let stick_equilibrium = equilibrium(&stick, gamma);
        let slip_equilibrium = equilibrium(&slip, gamma);
        if !slip_equilibrium.iter().all(|x| x.abs() <= FARTHEST_EQUILIBRIUM) {
            return None;
        }
        let cell = Modes::suitable_cell(&[&stick, &slip])?;
        let stick = Modes::new(&stick, Scaling::Position, cell)?;
        let slip = Modes::new(&slip, Scaling::Velocity, cell)?;
        let [p, s] = [stick_equilibrium, slip_equilibrium].map(|[x1, x2]| Vector4::new(x1, x2, 0.0, 0.0));
        Some(Self {
            slip_to_stick: stick.to_modal * slip.to_physical,
            slip_to_stick_constant: -(stick.to_modal * s),
            anchor_in_stick: stick.to_modal * p,
            stick_to_slip: slip.to_modal * stick.to_physical,
            stick_to_slip_constant: slip.to_modal * s,
            anchor_in_slip: slip.to_modal * p,
            stick,
            slip,
            stick_equilibrium,
            slip_equilibrium,
        })
    }

    pub(super) fn modes(&self, contact: Contact) -> &Modes {
        match contact {
            Contact::Stick => &self.stick,
            Contact::Slip => &self.slip,
        }
    }

    /// One over the fastest rate.
    pub(super) fn smooth_span(&self) -> f64 {
        self.stick.cell / CELL_ANGLE
    }

    /// The phase that starts at `y = (x1, x2, v1, v2, f)` in the given contact state.
    pub(super) fn start(&self, [x1, x2, v1, v2, f]: [f64; 5], contact: ContactState) -> Phase {
        let (sign, contact) = match contact {
            ContactState::Stick => (frame_of([f, v1, x1, v2, x2]), Contact::Stick),
            ContactState::Slip(direction) => (direction.sign(), Contact::Slip),
        };
        let [x1, x2, v1, v2, f] = [x1, x2, v1, v2, f].map(|component| sign * component);
        let anchor = x1 - f;
        let [e1, e2] = self.equilibrium(contact, anchor);
        let modes = self.modes(contact);
        let c = (modes.to_modal * Vector4::new(x1 - e1, x2 - e2, v1, v2)).into();
        match contact {
            Contact::Slip => Phase { c: modes.with_value(c, v1), ..Phase::slip(sign, c) },
            Contact::Stick => {
                let on_limit = f == 1.0 && v1 == 0.0;
                let c = if on_limit { modes.without_slope(c) } else { c };
                Phase { sign, contact, anchor, limit: c[0] + c[2] + (1.0 - f), on_limit, c }
            }
        }
    }

    /// Equilibrium `(x1*, x2*)` in the frame.
    pub(super) fn equilibrium(&self, contact: Contact, anchor: f64) -> [f64; 2] {
        match contact {
            Contact::Stick => self.stick_equilibrium.map(|p| anchor * p),
            Contact::Slip => self.slip_equilibrium.map(|s| -s),
        }
    }

    /// Values of `q` between which the phase lasts, lower and upper.
    #[inline]
    pub(super) fn guards(&self, phase: &Phase) -> [f64; 2] {
        match phase.contact {
            Contact::Stick => [phase.limit - 2.0, phase.limit],
            Contact::Slip => [0.0, f64::INFINITY],
        }
    }

    /// State `(x1, x2, v1, v2, f)` at coordinates `c` of a phase, |f| <= 1.
    pub(super) fn physical(&self, phase: &Phase, c: &Modal) -> [f64; 5] {
        let [e1, e2] = self.equilibrium(phase.contact, phase.anchor);
        let z = self.modes(phase.contact).to_physical * Vector4::from(*c);
        let (x1, x2) = (z[0] + e1, z[1] + e2);
        let f = match phase.contact {
            Contact::Stick => (1.0 + (c[0] + c[2] - phase.limit)).clamp(-1.0, 1.0),
            Contact::Slip => 1.0,
        };
        [x1, x2, z[2], z[3], f].map(|component| phase.sign * component)
    }

    /// The same at the end of a phase, where what defines the event holds exactly.
    pub(super) fn physical_at_end(&self, phase: &Phase, end: End, c: &Modal) -> [f64; 5] {
        let mut y = self.physical(phase, c);
        match (phase.contact, end) {
            (Contact::Slip, End::Lower) => y[2] = 0.0,
            (Contact::Stick, End::Upper) => y[4] = phase.sign,
            (Contact::Stick, End::Lower) => y[4] = -phase.sign,
            _ => {}
        }
        y
    }

    pub(super) fn contact_state(phase: &Phase) -> ContactState {
        match phase.contact {
            Contact::Stick => ContactState::Stick,
            Contact::Slip if phase.sign > 0.0 => ContactState::Slip(Direction::Positive),
            Contact::Slip => ContactState::Slip(Direction::Negative),
        }
    }

    /// The phase after one that ended at coordinates `c`.
    #[inline]
    pub(super) fn switched(&self, phase: &Phase, end: End, c: &Modal) -> Phase {
        match (phase.contact, end) {
            (Contact::Slip, End::Lower) => self.to_stick(phase, c),
            (Contact::Stick, End::Upper) => self.to_slip(phase, c, 1.0),
            (Contact::Stick, End::Lower) => self.to_slip(phase, c, -1.0),
            _ => Phase { c: *c, on_limit: false, ..*phase },
        }
    }

    #[inline]
    fn to_stick(&self, phase: &Phase, c: &Modal) -> Phase {
        let c = Vector4::from(*c);
        let x1 = self.slip.to_physical.row(0).transpose().dot(&c) - self.slip_equilibrium[0];
        let anchor = x1 - 1.0;
        let c = self.slip_to_stick * c + (self.slip_to_stick_constant - self.anchor_in_stick * anchor);
        let c = self.stick.without_slope(c.into());
        Phase { sign: phase.sign, contact: Contact::Stick, anchor, limit: c[0] + c[2], on_limit: true, c }
    }

    #[inline]
    fn to_slip(&self, phase: &Phase, c: &Modal, side: f64) -> Phase {
        let v1 = side * self.stick.slope(c);
        let moved = self.stick_to_slip * Vector4::from(*c) + self.anchor_in_slip * phase.anchor;
        let c = self.slip.with_value((moved * side + self.stick_to_slip_constant).into(), v1);
        Phase::slip(side * phase.sign, c)
    }

    /// Coordinates at `time` after the start of a phase.
    pub(super) fn advanced(&self, phase: &Phase, time: f64) -> Modal {
        self.modes(phase.contact).after(&phase.c, time)
    }

    /// Coordinates one block later.
    #[inline]
    pub(super) fn after_block(modes: &Modes, c: &Modal) -> Modal {
        rotated(c, &modes.coarse[modes.cells])
    }
}

/// The frame of a stick phase: the sign of the first component that is not zero, so that mirrored motions are the same numbers.
fn frame_of(components: [f64; 5]) -> f64 {
    components.into_iter().find(|component| *component != 0.0).map_or(1.0, f64::signum)
}

/// `K^-1 (g, 0)`.
fn equilibrium(k: &Coefficients, gamma: f64) -> [f64; 2] {
    let determinant = k.stiffness1 * k.stiffness2 - k.kappa * k.kappa;
    [gamma * k.stiffness2 / determinant, gamma * k.kappa / determinant]
}
