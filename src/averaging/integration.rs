//! Integration by Dormand and Prince's method of order 8(5,3) (crate `ode_solvers`), stopped and restarted at kinks of the field.
//!
//! At a1 = 1 the equivalent damping has a kink: the field is continuous, its derivative jumps, and just above it second derivatives
//! of the stiffness grow without bound. Where the energy passes the sticking limit w(E) begins with the power 3/2, and the derivative of the
//! field with a square root. A step across would be of low order, whatever the method, and its error estimate would rest on smoothness that
//! is not there. So when a step ends on the other side, it is taken again with the length that ends on the kink, found by the
//! false-position method on whole steps (no interpolation, hence no loss of order). Since the field itself is continuous, tangents
//! pass through unchanged: the saltation matrix is the identity.

use super::error::AveragingError;
use nalgebra::allocator::Allocator;
use nalgebra::{Const, DefaultAllocator};
use ode_solvers::dop_shared::IntegrationError;
use ode_solvers::{Dop853, OutputType, SVector, System};

/// Steps of one stretch: far more than any motion needs between two kinks.
const MOST_STEPS: u32 = 1_000_000;
/// |a1 - 1| that counts as on the kink: beyond it, the derivative is wrong over a stretch of this length.
const ON_THE_KINK: f64 = 1e-13;
const MOST_TRIALS: usize = 60;

/// What is integrated: autonomous, smooth but for the kink.
pub(super) trait Field<const N: usize> {
    fn rate(&self, y: &[f64; N], rate: &mut [f64; N]);

    /// Each changes its sign at a kink.
    fn guards(&self, y: &[f64; N]) -> [f64; 2];

    /// Whether the motion has left the range in which the field is known.
    fn has_left(&self, y: &[f64; N]) -> bool;
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tolerance {
    pub(super) relative: f64,
    pub(super) absolute: f64,
    pub(super) longest_step: f64,
}

/// How an integration ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Ending<const N: usize> {
    Completed([f64; N]),
    Left { time: f64 },
}

/// From `y` at time 0 to `t_end`; `record` hears of time and state after each step (start, kinks and, where it leaves, the first state beyond included).
pub(super) fn integrate<const N: usize, F: Field<N>>(
    field: &F,
    y: [f64; N],
    t_end: f64,
    tolerance: Tolerance,
    mut record: impl FnMut(f64, &[f64; N]),
) -> Result<Ending<N>, AveragingError>
where
    DefaultAllocator: Allocator<Const<N>>,
{
    record(0.0, &y);
    let (mut time, mut state) = (0.0, y);
    while time < t_end {
        let mut stretch = Stretch { field, last: (time, state), crossed: None, left: None, record: &mut record };
        advance(&mut stretch, time, t_end, state, tolerance, 0.0)?;
        let (last, crossed, left) = (stretch.last, stretch.crossed, stretch.left);
        if let Some(time) = left {
            return Ok(Ending::Left { time });
        }
        (time, state) = last;
        if let Some(beyond) = crossed {
            (time, state) = first_kink(field, last, beyond, tolerance)?;
            record(time, &state);
        }
    }
    Ok(Ending::Completed(state))
}

/// Steps up to the first that ends beyond the kink.
struct Stretch<'a, const N: usize, F, R> {
    field: &'a F,
    /// The last state on this side.
    last: (f64, [f64; N]),
    /// The first beyond.
    crossed: Option<(f64, [f64; N])>,
    left: Option<f64>,
    record: &'a mut R,
}

impl<const N: usize, F: Field<N>, R: FnMut(f64, &[f64; N])> System<f64, SVector<f64, N>> for &mut Stretch<'_, N, F, R> {
    fn system(&self, _time: f64, y: &SVector<f64, N>, rate: &mut SVector<f64, N>) {
        self.field.rate(&y.data.0[0], &mut rate.data.0[0]);
    }

    fn solout(&mut self, time: f64, y: &SVector<f64, N>, _rate: &SVector<f64, N>) -> bool {
        let y = y.data.0[0];
        if self.field.has_left(&y) {
            self.left = Some(time);
            (self.record)(time, &y);
            return true;
        }
        let guards = [self.field.guards(&self.last.1), self.field.guards(&y)];
        if (0..2).any(|kink| crosses(guards[0][kink], guards[1][kink])) {
            self.crossed = Some((time, y));
            return true;
        }
        self.last = (time, y);
        (self.record)(time, &y);
        false
    }
}

/// A start on the kink itself is on neither side.
fn crosses(before: f64, after: f64) -> bool {
    before.abs() > ON_THE_KINK && after.abs() > ON_THE_KINK && (before < 0.0) != (after < 0.0)
}

/// Steps without record or kink: what single steps are taken with.
struct Plain<'a, F>(&'a F);

impl<const N: usize, F: Field<N>> System<f64, SVector<f64, N>> for Plain<'_, F> {
    fn system(&self, _time: f64, y: &SVector<f64, N>, rate: &mut SVector<f64, N>) {
        self.0.rate(&y.data.0[0], &mut rate.data.0[0]);
    }
}

fn advance<const N: usize, S: System<f64, SVector<f64, N>>>(
    system: S,
    time: f64,
    t_end: f64,
    y: [f64; N],
    tolerance: Tolerance,
    first_step: f64,
) -> Result<[f64; N], AveragingError> {
    let Tolerance { relative, absolute, longest_step } = tolerance;
    let start = SVector::<f64, N>::from(y);
    // Defaults of the method but for the longest step; tested for stiffness every 1000 steps.
    let mut solver = Dop853::from_param(
        system,
        time,
        t_end,
        0.0,
        start,
        relative,
        absolute,
        0.9,
        0.0,
        0.333,
        6.0,
        longest_step,
        first_step,
        MOST_STEPS,
        1000,
        OutputType::Sparse,
    );
    solver.integrate().map_err(|error| {
        let time = match error {
            IntegrationError::MaxNumStepReached { x, .. }
            | IntegrationError::StepSizeUnderflow { x }
            | IntegrationError::StiffnessDetected { x } => x,
        };
        AveragingError::Integration { time, reason: error.to_string() }
    })?;
    Ok(solver.y_out().last().map_or(y, |y| y.data.0[0]))
}

/// Time and state on the first kink between two states.
fn first_kink<const N: usize, F: Field<N>>(
    field: &F,
    before: (f64, [f64; N]),
    mut beyond: (f64, [f64; N]),
    tolerance: Tolerance,
) -> Result<(f64, [f64; N]), AveragingError> {
    for kink in 0..2 {
        if crosses(field.guards(&before.1)[kink], field.guards(&beyond.1)[kink]) {
            beyond = on_the_kink(field, kink, before, beyond, tolerance)?;
        }
    }
    Ok(beyond)
}

/// Time and state on a kink between two states on either side of it (Illinois variant of the false-position method).
fn on_the_kink<const N: usize, F: Field<N>>(
    field: &F,
    kink: usize,
    (start, y): (f64, [f64; N]),
    (beyond, y_beyond): (f64, [f64; N]),
    tolerance: Tolerance,
) -> Result<(f64, [f64; N]), AveragingError> {
    let guard = |y: &[f64; N]| field.guards(y)[kink];
    let (mut low, mut high) = ((0.0, guard(&y)), (beyond - start, guard(&y_beyond)));
    let mut best = (beyond, y_beyond);
    for _ in 0..MOST_TRIALS {
        let step = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
        if step <= low.0 || step >= high.0 {
            break;
        }
        let found = advance(Plain(field), 0.0, step, y, tolerance, step)?;
        let value = guard(&found);
        best = (start + step, found);
        if value.abs() <= ON_THE_KINK {
            break;
        }
        if (value < 0.0) == (low.1 < 0.0) {
            low = (step, value);
            high.1 *= 0.5;
        } else {
            high = (step, value);
            low.1 *= 0.5;
        }
    }
    Ok(best)
}
