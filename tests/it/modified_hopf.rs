//! The secondary Hopf point of the second-order scheme with friction averaged over the step, from the exact flow alone: the scheme's modified
//! equation, in which its steps follow a differential equation up to h^3 and switches on the way.
//!
//! One step is `x_(n+1) - 2 x_n + x_(n-1) = h^2 a_n` with `a_n = -K x_n - D u_n - g m_n`. Taylor's formula for the velocity `u_n` that dampers see, for
//! the carried slider force psi and for its mean m_n along the predicted path (prime: d/dt; v the velocity, v1 that of mass 1):
//!
//! ```text
//! u = v - (h^2/3) v'' + (h^3/4) v'''
//! psi' = v1 + (h^2/8) v1'' in stick,  0 in slip;        stick ends at psi = -1, slip where v1 + (h^2/8) v1'' = 0
//! m = mean of psi over t_n - h/2 ... t_n + h/2,  - (h^3/6) v1'' in stick
//! v' = (1 - (h^2/12) d^2/dt^2)(-K x - D u) - g (1 - (h^2/24) d^2/dt^2) psi + g (h^3/6) v1'' (stick)
//! ```
//!
//! where the second differences have been undone (they are means over a triangle of two steps, m_n over one). Where psi bends by `-psi'`, at
//! the end of stick, a time tau after the nearest t_n, its second derivative leaves the jumps
//!
//! ```text
//! v1 += -(g h^2/24) psi',      x1 += -g psi' (tau h^2/24 - tau^3/6)
//! ```
//!
//! of which the second is of third order itself, but its derivative over tau is not: it makes the Hopf point depend on the phase.

use nalgebra::{Complex, Matrix2, Matrix2x5, Matrix5, RowVector5, Vector5};
use stickslip::conformance::hopf::{CycleProblem, Source, over_phases, phases};
use stickslip::conformance::{Case, Configuration, Depth, Rapier, registry};
use stickslip::model::RigParameters;

type Matrix = Matrix5<f64>;
type Vector = Vector5<f64>;

/// Exact secondary Hopf point, period and stick phase of the nominal rig.
const EXACT_HOPF: f64 = -0.0345753708;
const PERIOD: f64 = 6.31599709;
const STICK_PHASE: f64 = 2.47467638;
const PSI: usize = 4;

/// Step, in the terms of second and of third order apart, and the phase of the reversal within a step.
#[derive(Clone, Copy)]
struct Scheme {
    h: f64,
    second: f64,
    third: f64,
    phase: Option<f64>,
}

impl Scheme {
    fn smooth(steps: u64) -> Self {
        let h = PERIOD / steps as f64;
        Self { h, second: h * h, third: h * h * h, phase: None }
    }
}

/// `y' = A y` for y = (x1, x2, v1, v2, psi) in stick and in slip.
struct Modified {
    stick: Matrix,
    slip: Matrix,
    gamma: f64,
    scheme: Scheme,
}

impl Modified {
    fn new(xi1: f64, scheme: Scheme) -> Self {
        let RigParameters { xi2, kappa, gamma, .. } = RigParameters::default();
        let (d1, d2) = (0.5 * (xi1 + xi2), 0.5 * (xi1 - xi2));
        let force =
            Matrix2x5::new(-(1.0 - gamma + kappa), kappa, -d1, -d2, -gamma, kappa, -(1.0 + kappa), -d2, -d1, 0.0);
        let damping = Matrix2::new(d1, d2, d2, d1);
        let (second, third) = (scheme.second, scheme.third);
        let of = |rate: f64| {
            let mut plain = Matrix::zeros();
            (plain[(0, 2)], plain[(1, 3)], plain[(PSI, 2)]) = (1.0, 1.0, rate);
            plain.fixed_view_mut::<2, 5>(2, 0).copy_from(&force);
            // v'', v''' and psi'' as functions of y.
            let (jerk, snap) = (force * plain, force * plain * plain);
            let bend: RowVector5<f64> = (plain * plain).row(PSI).into_owned();
            let mut rates = force - snap * (second / 12.0) + damping * (jerk * (second / 3.0) - snap * (third / 4.0));
            let own = rates.row(0) - bend * (gamma * second / 24.0) + jerk.row(0) * (rate * gamma * third / 6.0);
            rates.set_row(0, &own);
            let mut modified = plain;
            modified.fixed_view_mut::<2, 5>(2, 0).copy_from(&rates);
            let carried = modified.row(PSI) + jerk.row(0) * (rate * second / 8.0);
            modified.set_row(PSI, &carried);
            modified
        };
        Self { stick: of(1.0), slip: of(0.0), gamma, scheme }
    }

    /// Image of a reversal y (psi = 1) after half a period, its derivative at fixed time, and that at the next reversal.
    fn half_period(&self, y: &Vector) -> (Vector, Matrix, Matrix) {
        let end_of_stick = Vector::ith(PSI, 1.0).transpose();
        let (t1, first, before) = until(&self.stick, y, &end_of_stick, -1.0, STICK_PHASE);
        let (h, second, fall) = (self.scheme.h, self.scheme.second, (self.stick * before)[PSI]);
        let mut jump = Matrix::identity();
        jump[(2, 2)] -= self.gamma * second / 24.0;
        let after = jump * before;
        let time = -end_of_stick / fall;
        let mut switch = jump + (jump * self.stick * before - self.slip * after) * time;
        if let Some(phase) = self.scheme.phase {
            let tau = ((phase + t1 / h + 0.5).fract() - 0.5) * h;
            let kick = -self.gamma * fall * (h * h / 24.0 - 0.5 * tau * tau);
            switch += Vector::ith(0, kick) * time;
        }
        let turn: RowVector5<f64> = self.stick.row(PSI).into_owned();
        let (_, last, end) = until(&self.slip, &after, &turn, 0.0, 0.5 * PERIOD - STICK_PHASE);
        let whole = -last * switch * first;
        let (sliding, stuck) = (-(self.slip * end), -(self.stick * end));
        let time = -turn / turn.dot(&sliding.transpose());
        let back = Matrix::identity() + (sliding - stuck) * time;
        let onto_reversals = Matrix::identity() + sliding * time;
        (-end, back * whole, onto_reversals * whole)
    }

    /// Modulus of the pair of multipliers less 1; `y` is moved onto the orbit by Newton's method.
    fn excess(&self, y: &mut Vector) -> f64 {
        for _ in 0..20 {
            let (end, _, derivative) = self.half_period(y);
            let change = (derivative - Matrix::identity()).lu().solve(&(end - *y)).unwrap();
            *y -= change;
            if change.amax() < 1e-13 {
                let values = self.half_period(y).1.complex_eigenvalues();
                let pair = values.iter().find(|value: &&Complex<f64>| value.im > 1e-3);
                return pair.unwrap().norm() - 1.0;
            }
        }
        panic!("no orbit");
    }
}

/// Time, transition matrix and state where `row y` reaches a value, by Newton's method.
fn until(a: &Matrix, y: &Vector, row: &RowVector5<f64>, value: f64, guess: f64) -> (f64, Matrix, Vector) {
    let mut t = guess;
    for _ in 0..8 {
        let there = (a * t).exp() * y;
        t -= (row * there - nalgebra::Matrix1::new(value))[0] / (row * a * there)[0];
    }
    let transition = (a * t).exp();
    (t, transition, transition * y)
}

/// By the secant method.
fn hopf_point(scheme: Scheme) -> f64 {
    let mut y = Vector::new(1.2, 0.9, 0.0, -0.5, 1.0);
    let (mut before, mut now) = (EXACT_HOPF, EXACT_HOPF + 1e-6);
    let mut excess = Modified::new(before, scheme).excess(&mut y);
    for _ in 0..6 {
        let next = Modified::new(now, scheme).excess(&mut y);
        if next == excess {
            break;
        }
        (before, now, excess) = (now, now - next * (now - before) / (next - excess), next);
    }
    now
}

/// Shift of the Hopf point times n^2.
fn shift(scheme: Scheme) -> f64 {
    (hopf_point(scheme) - EXACT_HOPF) * (PERIOD / scheme.h).powi(2)
}

#[test]
fn the_hopf_point_of_averaged_friction_is_that_of_its_modified_equation() {
    // The exact flow, to the digits that are known.
    assert!((hopf_point(Scheme { second: 0.0, third: 0.0, ..Scheme::smooth(64) }) - EXACT_HOPF).abs() < 1e-10);
    for steps in [128, 256, 512] {
        let n = steps as f64;
        let problem = CycleProblem::symmetric(Source::Theory, Configuration::AVERAGED_FRICTION, steps, 0.0);
        let smooth = Scheme::smooth(steps);
        for point in over_phases(&problem, 8, EXACT_HOPF).unwrap() {
            let found = (point.xi1 - EXACT_HOPF) * n * n;
            let predicted = shift(Scheme { phase: Some(point.phase), ..smooth });
            // Left out: the next order of 15/n, smaller by h, 0.05 and less, and the part of the phase in it, a tenth of it; and the search, 2e-9.
            let allowed = 2.0 / n + 2e-9 * n * n;
            assert!((found - predicted).abs() < allowed, "{steps} {}: {found} {predicted}", point.phase);
            // Negative control: what comes of the lagging path of the friction force left out.
            assert!((found - shift(Scheme { third: 0.0, ..smooth })).abs() > 4.0 * allowed, "{steps}: {found}");
        }
    }
}

#[test]
fn the_report_bounds_the_hopf_point_by_the_leading_terms_of_the_theory() {
    let smooth = Scheme::smooth(1024);
    let second = shift(Scheme { third: 0.0, ..smooth });
    let third = shift(Scheme { second: 0.0, ..smooth }) * 1024.0;
    let over_all: Vec<f64> =
        phases(64).into_iter().map(|phase| shift(Scheme { phase: Some(phase), third: 0.0, ..smooth })).collect();
    let largest = over_all.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let (scenario, variant) = ("secondary_hopf".to_owned(), "2 phases".to_owned());
    let configuration = Configuration::AVERAGED_FRICTION;
    let case = Case { scenario, variant, configuration, steps: vec![128], depth: Depth::Quick };
    let scenario = registry().into_iter().find(|scenario| scenario.id() == "secondary_hopf").unwrap();
    let rows = scenario.run(&case, &Rapier).unwrap();
    let row = rows.iter().find(|row| row.quantity == "secondary_hopf_error_times_n2").unwrap();
    // A tenth above the leading terms, and rounding; constants of three digits.
    let theory = 1.1 * (largest - third / 128.0) + 5e-9 * 128.0 * 128.0;
    assert!((row.limit.unwrap() / theory - 1.0).abs() < 5e-3, "{theory} {row:?}");
    assert!(second < 0.0 && largest > second.abs());
}
